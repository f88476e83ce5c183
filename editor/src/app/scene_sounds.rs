//! Reads the peaks of the sounds of a scene in jobs, one after the other.

use crate::panels::State;
use crate::panels::status::MessageSeverity;
use dragonfly_document::{Cancel, SoundPeaks};
use dragonfly_runtime::{Address, Job, JobContext};
use std::path::Path;

/// Reads the sounds that the script of the open scene names.
#[derive(Debug, Default)]
pub(super) struct SceneSoundLoader {
    /// The number of the document whose sound is read, and the job.
    reading: Option<(u64, Job)>,
}

/// The answer of a job: the number of the document, the sound as the script names it, and its peaks.
pub(super) type SceneSoundAnswer = (u64, String, Result<SoundPeaks, String>);

impl SceneSoundLoader {
    /// Starts to read the next sound that is not known, unless another one is being read.
    pub(super) fn update(&mut self, state: &mut State, to: &Address<SceneSoundAnswer>) {
        let read = state.read();
        let opened = read.scene_editing.sounds().opened();
        // A job for another document is cancelled.
        self.reading.take_if(|(of, _)| *of != opened);
        if self.reading.is_some() {
            return;
        }
        let plan = read.scene().and_then(|scene| scene.plan.as_ref());
        let Some(source) = plan.and_then(|plan| read.scene_editing.sounds().wanted(plan)).map(str::to_owned)
        else {
            return;
        };
        let folder = read.model_folder();
        state.scene_sounds().begin(&source);
        let Some(folder) = folder else {
            let reason = "the scene is in no folder yet: save it first".to_owned();
            return state.scene_sounds().receive(&source, Err(reason));
        };
        let (name, failed_name) = (source.clone(), source);
        let work = move |job: &JobContext<SceneSoundAnswer>| {
            let peaks = peaks_below(&folder, &name, job.cancel_flag());
            (opened, name, peaks)
        };
        let failed = move |reason: &str| (opened, failed_name, Err(reason.to_owned()));
        match Job::start(to, "read sound of a scene", work, failed) {
            Ok(job) => self.reading = Some((opened, job)),
            Err(error) => state.say(MessageSeverity::Error, format!("The sound could not be read: {error}")),
        }
    }

    /// Receives the answer of a job.
    pub(super) fn receive(&mut self, state: &mut State, (opened, source, peaks): SceneSoundAnswer) {
        if opened != state.read().scene_editing.sounds().opened() {
            return;
        }
        self.reading = None;
        if let Err(reason) = &peaks {
            state.say(MessageSeverity::Warning, format!("No sound: {reason}"));
        }
        state.scene_sounds().receive(&source, peaks);
    }
}

/// Reads a sound in a folder or below it; a link that leads elsewhere is refused.
fn peaks_below(folder: &Path, source: &str, cancel: &Cancel) -> Result<SoundPeaks, String> {
    let missing = |error: std::io::Error| format!("{source}: {error}");
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (root, file) =
        (folder.canonicalize().map_err(missing)?, folder.join(source).canonicalize().map_err(missing)?);
    if !file.starts_with(&root) {
        return Err(format!("{source} is outside of the folder of the scene"));
    }
    SoundPeaks::read(&file, cancel)
}
