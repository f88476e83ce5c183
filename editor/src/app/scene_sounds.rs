//! Reads the peaks of the sounds of a scene in jobs, one after the other.

use crate::panels::State;
use dragonfly_anim::stage::StagePlan;
use dragonfly_document::{DocumentMessage, SoundPeaks, SoundSource};
use dragonfly_runtime::{Address, Job, JobContext};
use std::sync::Arc;

/// Reads the sounds that the script of the open scene names.
#[derive(Debug, Default)]
pub struct SceneSoundLoader {
    /// The number of the document whose sound is read, and the job.
    reading: Option<(u64, Job)>,
    /// The plan whose sounds were looked at last.
    plan: Option<Arc<StagePlan>>,
}

/// The answer of a job: the number of the document, the sound as the script names it, and its peaks.
pub type SceneSoundAnswer = (u64, String, Result<SoundPeaks, String>);

impl SceneSoundLoader {
    /// Starts to read the next sound that is not known, unless another one is being read. While a word of the script is typed, the name of
    /// a sound may be a part of one, so that nothing is read.
    pub fn update(&mut self, state: &mut State, to: &Address<SceneSoundAnswer>) {
        let read = state.read();
        let opened = read.scene_editing.sounds().opened();
        // A job for another document is cancelled.
        self.reading.take_if(|(of, _)| *of != opened);
        let plan = read.scene().and_then(|scene| scene.plan.clone());
        let Some(plan) = plan.filter(|_| !read.scene_editing.is_typing(read.dragging.open())) else { return };
        if !self.plan.as_ref().is_some_and(|old| Arc::ptr_eq(old, &plan)) {
            state.scene_sounds().keep_named(&plan);
            self.plan = Some(Arc::clone(&plan));
        }
        let read = state.read();
        let wanted = read.scene_editing.sounds().wanted(&plan).filter(|_| self.reading.is_none());
        let (Some(source), folder) = (wanted.map(str::to_owned), read.model_folder()) else { return };
        state.scene_sounds().begin(&source);
        let Some(folder) = folder else {
            let reason = "the scene is in no folder yet: save it first".to_owned();
            return state.scene_sounds().receive(&source, Err(reason));
        };
        let (name, failed_name) = (source.clone(), source.clone());
        let file = SoundSource::Below { folder, name: source.clone() };
        let work = move |job: &JobContext<SceneSoundAnswer>| (opened, name, file.peaks(job.cancel_flag()));
        let failed = move |reason: &str| (opened, failed_name, Err(reason.to_owned()));
        match Job::start(to, "read sound of a scene", work, failed) {
            Ok(job) => self.reading = Some((opened, job)),
            Err(error) => state.scene_sounds().receive(&source, Err(format!("{source}: {error}"))),
        }
    }

    /// Receives the answer of a job. The bar of a sound that cannot be read shows why. Returns the message for the document, which plans
    /// the end of the sound.
    pub fn receive(
        &mut self,
        state: &mut State,
        (opened, source, peaks): SceneSoundAnswer,
    ) -> Option<DocumentMessage> {
        if opened != state.read().scene_editing.sounds().opened() {
            return None;
        }
        self.reading = None;
        let seconds = peaks.as_ref().ok().map(SoundPeaks::seconds);
        state.scene_sounds().receive(&source, peaks);
        let folder = state.read().model_folder()?;
        Some(DocumentMessage::SoundRead(SoundSource::Below { folder, name: source }, seconds?))
    }
}
