//! Reads the peaks of the sounds of a scene in jobs, one after the other.

use crate::panels::State;
use dragonfly_anim::stage::StagePlan;
use dragonfly_document::{DocumentMessage, SoundPeaks, SoundSource, SoundStamp};
use dragonfly_runtime::{Address, Job, JobContext};
use std::path::PathBuf;
use std::sync::Arc;

/// Reads the sounds that the script of the open scene names.
#[derive(Debug, Default)]
pub struct SceneSoundLoader {
    /// The number of the document whose sound is read, and the job.
    reading: Option<(u64, Job)>,
    /// The plan whose sounds were looked at last.
    plan: Option<Arc<StagePlan>>,
    /// The folder from which sounds were read last.
    folder: Option<PathBuf>,
    /// The lengths that the document does not have yet, and the number of the document.
    lengths: (u64, Vec<(SoundSource, Option<f64>)>),
}

/// The answer of a job about a sound.
#[derive(Debug)]
pub struct SceneSoundAnswer {
    /// The number of the document.
    opened: u64,
    /// The sound as the script names it.
    source: String,
    folder: PathBuf,
    /// The state of its file, and its peaks; `None` where the file is as it was.
    read: Option<(Option<SoundStamp>, Result<SoundPeaks, String>)>,
}

impl SceneSoundLoader {
    /// Starts to read the next sound that is not known, unless another one is being read. While a word of the script is typed, the name of
    /// a sound may be a part of one, so that nothing is read.
    pub fn update(&mut self, state: &mut State, to: &Address<SceneSoundAnswer>) {
        let folder = state.read().model_folder();
        if folder.is_some() && self.folder != folder {
            if self.folder.is_some() {
                state.scene_sounds().forget();
            }
            self.folder = folder;
        }
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
        let known = state.scene_sounds().begin(&source);
        let Some(folder) = folder else {
            let reason = "the scene is in no folder yet: save it first".to_owned();
            return state.scene_sounds().receive(&source, Err(reason));
        };
        let file = SoundSource::Below { folder: folder.clone(), name: source.clone() };
        let (name, place) = (source.clone(), folder.clone());
        let work = move |job: &JobContext<SceneSoundAnswer>| {
            // Before it is read, so that a change while it is read is noticed the next time.
            let stamp = file.stamp();
            let is_same = stamp.is_some() && stamp == known;
            let read = (!is_same).then(|| {
                let peaks = file.peaks(job.cancel_flag());
                // A file that changed while it was read is read again.
                (stamp.filter(|stamp| file.stamp() == Some(*stamp)), peaks)
            });
            SceneSoundAnswer { opened, source: name, folder: place, read }
        };
        let name = source.clone();
        let failed = move |reason: &str| {
            let read = Some((None, Err(reason.to_owned())));
            SceneSoundAnswer { opened, source: name, folder, read }
        };
        match Job::start(to, "read sound of a scene", work, failed) {
            Ok(job) => self.reading = Some((opened, job)),
            Err(error) => state.scene_sounds().receive(&source, Err(format!("{source}: {error}"))),
        }
    }

    /// Receives the answer of a job. The bar of a sound that cannot be read shows why. With the last sound that is wanted, returns the message
    /// for the document, which plans the ends of all that were read, at once.
    pub fn receive(&mut self, state: &mut State, answer: SceneSoundAnswer) -> Option<DocumentMessage> {
        let SceneSoundAnswer { opened, source, folder, read } = answer;
        if opened != state.read().scene_editing.sounds().opened() {
            return None;
        }
        self.reading = None;
        if self.lengths.0 != opened {
            self.lengths = (opened, Vec::new());
        }
        if let Some((stamp, peaks)) = read {
            let seconds = peaks.as_ref().ok().map(SoundPeaks::seconds);
            state.scene_sounds().stamp(&source, stamp);
            state.scene_sounds().receive(&source, peaks);
            self.lengths.1.push((SoundSource::Below { folder, name: source }, seconds));
        }
        let read = state.read();
        let plan = read.scene().and_then(|scene| scene.plan.clone());
        let is_last = plan.is_none_or(|plan| read.scene_editing.sounds().wanted(&plan).is_none());
        let lengths = std::mem::take(&mut self.lengths.1);
        if is_last && !lengths.is_empty() {
            return Some(DocumentMessage::SoundsRead(lengths));
        }
        self.lengths.1 = lengths;
        None
    }
}
