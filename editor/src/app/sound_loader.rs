//! Reads the peaks of the sound in a job.

use crate::panels::State;
use crate::panels::status::MessageSeverity;
use dragonfly_document::{SoundPeaks, SoundSource};
use dragonfly_runtime::{Address, Job, JobContext};
use std::path::PathBuf;

/// Reads the sound that the settings name.
#[derive(Debug, Default)]
pub(super) struct SoundLoader {
    /// The file that was asked for.
    asked: PathBuf,
    /// Counts the files, so that answers about earlier ones are ignored.
    number: u64,
    reading: Option<Job>,
}

/// The answer of a job: the number of its file, and the peaks.
pub(super) type SoundAnswer = (u64, Result<SoundPeaks, String>);

impl SoundLoader {
    /// Starts to read a file that was chosen since the last call.
    pub(super) fn update(&mut self, state: &mut State, to: &Address<SoundAnswer>) {
        if state.read().sound.settings().file == self.asked {
            return;
        }
        self.asked = state.read().sound.settings().file.clone();
        self.number += 1;
        self.reading = None;
        if self.asked.as_os_str().is_empty() {
            return;
        }
        let (number, file) = (self.number, self.asked.clone());
        let source = SoundSource::File(file);
        let work = move |job: &JobContext<SoundAnswer>| (number, source.peaks(job.cancel_flag()));
        let failed = move |reason: &str| (number, Err(reason.to_owned()));
        match Job::start(to, "read sound", work, failed) {
            Ok(job) => self.reading = Some(job),
            Err(error) => {
                state.say(MessageSeverity::Error, format!("The sound could not be read: {error}"));
            }
        }
    }

    /// Receives the answer of a job.
    pub(super) fn receive(&mut self, state: &mut State, (number, peaks): SoundAnswer) {
        if number != self.number {
            return;
        }
        self.reading = None;
        if let Err(reason) = &peaks {
            state.say(MessageSeverity::Warning, format!("No sound: {reason}"));
        }
        state.sound().read(peaks);
    }
}
