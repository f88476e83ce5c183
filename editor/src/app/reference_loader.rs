//! Reads and decodes the reference picture in jobs: first its files, then the frame at the playhead and the next ones.

use super::frame_cache::FrameCache;
use crate::panels::State;
use crate::panels::reference::ReferenceInfo;
use crate::panels::status::MessageSeverity;
use dragonfly_document::{DecodedImage, ReferenceSource};
use dragonfly_picture::ReferencePicture;
use dragonfly_runtime::{Address, Job, JobContext};
use std::path::PathBuf;
use std::sync::Arc;

/// Memory for decoded frames, bytes.
const BUDGET: u64 = 256 << 20;
/// Number of frames that a job decodes: the one at the playhead and those after it.
const AHEAD: usize = 16;

/// Reads and decodes the reference that the settings name.
#[derive(Debug)]
pub(super) struct ReferenceLoader {
    /// The file that was asked for, and whether as a sequence.
    asked: Option<(PathBuf, bool)>,
    /// Counts the files, so that answers about earlier ones are ignored.
    number: u64,
    source: Option<ReferenceSource>,
    survey: Option<Job>,
    decoding: Option<Decoding>,
    cache: FrameCache,
}

/// A job that decodes frames.
#[derive(Debug)]
struct Decoding {
    _job: Job,
    frames: std::ops::Range<usize>,
}

/// An answer of a job about the file with this number.
#[derive(Debug)]
pub(super) enum ReferenceAnswer {
    /// The frames of the file.
    Found(u64, Result<ReferenceSource, String>),
    /// A decoded frame.
    Frame(u64, usize, Result<DecodedImage, String>),
    /// A job that decoded frames has ended.
    Decoded(u64),
}

impl Default for ReferenceLoader {
    fn default() -> Self {
        let cache = FrameCache::new(BUDGET);
        Self { asked: None, number: 0, source: None, survey: None, decoding: None, cache }
    }
}

impl ReferenceLoader {
    /// Starts the jobs for what the panels want to show now, and shows the frame if it is decoded.
    pub(super) fn update(&mut self, state: &mut State, to: &Address<ReferenceAnswer>) {
        let settings = state.read().reference.settings();
        let wanted = settings.is_chosen().then_some((&settings.file, settings.sequence));
        if self.asked.as_ref().map(|(file, sequence)| (file, *sequence)) != wanted {
            self.asked = wanted.map(|(file, sequence)| (file.clone(), sequence));
            self.number += 1;
            (self.source, self.survey, self.decoding) = (None, None, None);
            self.cache.clear();
            if let Some((file, sequence)) = self.asked.clone() {
                self.survey = start(state, to, self.number, move |job| {
                    ReferenceSource::survey(&file, sequence, job.cancel_flag())
                });
            }
        }
        let Some(frame) = state.read().reference_frame() else { return };
        if let Some(picture) = self.cache.get(frame) {
            if state.read().reference.picture() != Some(picture) {
                let picture = picture.clone();
                state.reference().show(Some(picture));
            }
            self.decode_ahead(state, frame, to);
            return;
        }
        if self.decoding.as_ref().is_none_or(|decoding| !decoding.frames.contains(&frame)) {
            self.decode(state, frame, to);
        }
    }

    /// Decodes the frames after the one at the playhead, as long as no job runs.
    fn decode_ahead(&mut self, state: &mut State, frame: usize, to: &Address<ReferenceAnswer>) {
        let Some(source) = self.source.as_ref().filter(|_| self.decoding.is_none()) else { return };
        let ahead = (AHEAD / 2).min(self.cache.room(source.size()));
        let missing = (frame + 1..(frame + 1 + ahead).min(source.frames())).find(|&at| !self.cache.has(at));
        if let Some(first) = missing {
            self.decode(state, first, to);
        }
    }

    /// Starts a job that decodes frames from `first` on. An earlier job ends.
    fn decode(&mut self, state: &mut State, first: usize, to: &Address<ReferenceAnswer>) {
        let Some(source) = self.source.clone() else { return };
        self.decoding = None;
        let count = AHEAD.min(self.cache.room(source.size())).max(1);
        let end = (first..(first + count).min(source.frames())).find(|&at| self.cache.has(at));
        let frames = first..end.unwrap_or((first + count).min(source.frames())).max(first + 1);
        let (number, answers, range) = (self.number, to.clone(), frames.clone());
        let work = move |job: &JobContext<ReferenceAnswer>| {
            source.decode(range.start, range.len(), |frame, image| {
                // Without a receiver the window is closed, and the job ends.
                let sent = answers.send(ReferenceAnswer::Frame(number, frame, image)).is_ok();
                sent && !job.is_cancelled()
            });
            ReferenceAnswer::Decoded(number)
        };
        let failed = move |reason: &str| ReferenceAnswer::Frame(number, first, Err(reason.to_owned()));
        match Job::start(to, "decode reference", work, failed) {
            Ok(job) => self.decoding = Some(Decoding { _job: job, frames }),
            Err(error) => say(state, &error),
        }
    }

    /// Receives an answer of a job.
    pub(super) fn receive(&mut self, state: &mut State, answer: ReferenceAnswer) {
        match answer {
            ReferenceAnswer::Found(number, found) if number == self.number => {
                self.survey = None;
                let about = |source: &ReferenceSource| ReferenceInfo {
                    frames: source.frames(),
                    rate: source.rate(),
                    size: source.size(),
                };
                if let Err(reason) = &found {
                    state.say(MessageSeverity::Warning, format!("No reference: {reason}"));
                }
                state.reference().found(found.as_ref().map(about).map_err(String::clone));
                self.source = found.ok();
            }
            ReferenceAnswer::Frame(number, frame, Ok(image)) if number == self.number => {
                self.cache.insert(frame, ReferencePicture(Arc::new(image)));
            }
            ReferenceAnswer::Frame(number, _, Err(reason)) if number == self.number => {
                // A frame that cannot be decoded would be asked for in every frame of the window.
                (self.source, self.decoding) = (None, None);
                state.say(MessageSeverity::Warning, format!("The reference stays as it is: {reason}"));
                state.reference().fail(reason);
            }
            ReferenceAnswer::Decoded(number) if number == self.number => self.decoding = None,
            ReferenceAnswer::Found(..) | ReferenceAnswer::Frame(..) | ReferenceAnswer::Decoded(_) => {}
        }
    }
}

/// Starts a job that finds the frames of a file.
fn start(
    state: &mut State,
    to: &Address<ReferenceAnswer>,
    number: u64,
    find: impl FnOnce(&JobContext<ReferenceAnswer>) -> Result<ReferenceSource, String> + Send + 'static,
) -> Option<Job> {
    let work = move |job: &JobContext<ReferenceAnswer>| ReferenceAnswer::Found(number, find(job));
    let failed = move |reason: &str| ReferenceAnswer::Found(number, Err(reason.to_owned()));
    Job::start(to, "read reference", work, failed).inspect_err(|error| say(state, error)).ok()
}

fn say(state: &mut State, error: &std::io::Error) {
    state.say(MessageSeverity::Error, format!("The reference could not be read: {error}"));
}
