//! What the document publishes: immutable, shared, never locked.

use super::adapter::{ModelAdapter, PendingAt, Slot};
use super::history::Edited;
use dragonfly_anim::bounds::Bounds;
use dragonfly_anim::data::{AnimationData, BoneIndex, ModelData, Take, Track};
use std::path::PathBuf;
use std::sync::Arc;

/// Pixels ready for the device, decoded once by the job that loaded the model.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodedImage {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// RGBA, 8 bits each, rows from the top, `width * height * 4` bytes.
    pub pixels: Vec<u8>,
}

/// A model as loaded, with everything that drawing needs.
#[derive(Debug)]
pub struct LoadedModel {
    /// File name without folder, or "Dragonfly" for the built-in model.
    pub title: String,
    /// `None` for the built-in model.
    pub path: Option<PathBuf>,
    /// "glb", "gltf", "dfm".
    pub format: String,
    /// The data as it was read; which takes there are now is in the [`View`].
    pub model: Arc<ModelData>,
    /// How much room it takes at the begin of its first take, or in the rest pose when it has none.
    pub bounds: Bounds,
    /// One an image of the model; `None` where it could not be decoded (a warning says why).
    /// Shared, because several images of a file may name the same source.
    pub images: Vec<Option<Arc<DecodedImage>>>,
    /// What is not shown or was mended, one sentence each.
    pub warnings: Vec<String>,
}

/// What was done so far, for the menu and the list of the history.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HistoryView {
    /// A few words for each step, the first one first.
    pub steps: Vec<&'static str>,
    /// For each step, what it was done to: bone, take. Empty where that is not known.
    pub about: Vec<Arc<str>>,
    /// How many of them are done; the others can be done again.
    pub done: usize,
    /// Is everything as it was opened or saved?
    pub saved: bool,
    /// How many steps were done when it was opened or saved; `None` where no undo and no redo leads there.
    pub saved_at: Option<usize>,
}

impl HistoryView {
    /// The history of `edited`.
    pub fn of(edited: &Edited) -> Self {
        let (steps, done) = edited.steps();
        let labels: Vec<_> = steps.iter().map(|step| step.edit.label()).collect();
        let about = steps.iter().map(|step| Arc::clone(&step.about)).collect();
        Self { steps: labels, about, done, saved: edited.is_saved(), saved_at: edited.saved() }
    }

    /// What was done last since it was opened or saved, as a sentence; `None` where nothing was.
    pub fn last_unsaved(&self) -> Option<String> {
        let label = |at: usize| self.steps.get(at).copied();
        match self.saved_at {
            Some(saved) if saved == self.done => None,
            Some(saved) if saved > self.done => {
                Some(format!("Undone since it was saved: {}", label(self.done)?))
            }
            _ => Some(format!("The last one: {}", label(self.done.checked_sub(1)?)?)),
        }
    }

    /// What undo would take back, and what redo would bring back.
    pub fn labels(&self) -> [Option<&'static str>; 2] {
        [self.done.checked_sub(1), Some(self.done)].map(|at| self.steps.get(at?).copied())
    }
}

/// Which file the document is saved as.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileView {
    /// Its name without folder; a stand-in where there is no file yet.
    pub title: String,
    /// Where it is; `None` for what was never saved: the first save asks where.
    pub path: Option<PathBuf>,
}

impl FileView {
    /// What the program's own folder calls it: where the file is, whole, or the name of what has none.
    pub fn key(&self) -> String {
        match &self.path {
            Some(path) => std::path::absolute(path).unwrap_or_else(|_| path.clone()).display().to_string(),
            None => format!("built in: {}", self.title),
        }
    }
}

/// Set in the generation of an echo, so that it differs from those of the document.
const ECHO: u64 = 1 << 63;

/// The newest state of the document. Panels read it; nobody changes it.
#[derive(Clone, Debug)]
pub struct View {
    /// Grows with every change. An echo (see [`Self::echo`]) has its highest bit set.
    pub generation: u64,
    /// Number of the last [numbered change](super::DocumentMessage::NumberedChange) that was carried out or refused before
    /// this view was made; 0 before the first.
    pub answered: u64,
    /// The model as it was opened.
    pub loaded: Arc<LoadedModel>,
    /// Its takes as they are now. They are apart from the model, so that a change of one keeps everything else, on the
    /// device as well: who has a model shown compares the `loaded` of two views.
    pub takes: Arc<[Arc<Take>]>,
    /// The same takes as they were read, and what was changed of them.
    pub slots: Arc<[Arc<Slot>]>,
    /// What was done.
    pub history: Arc<HistoryView>,
    /// Where it is saved.
    pub file: Arc<FileView>,
}

impl View {
    /// `loaded`, unchanged.
    pub fn opened(generation: u64, loaded: Arc<LoadedModel>) -> Self {
        let edited = Edited::new(ModelAdapter::new(&loaded.model.animation));
        let history = Arc::new(HistoryView { saved: true, saved_at: Some(0), ..HistoryView::default() });
        let file = Arc::new(FileView { title: loaded.title.clone(), path: loaded.path.clone() });
        Self::of(generation, loaded, edited.adapter(), history, file)
    }

    /// `loaded` with its takes as they are in `adapter`.
    pub(super) fn of(
        generation: u64,
        loaded: Arc<LoadedModel>,
        adapter: &ModelAdapter,
        history: Arc<HistoryView>,
        file: Arc<FileView>,
    ) -> Self {
        let takes = adapter.results().cloned().collect();
        Self { generation, answered: 0, loaded, takes, slots: adapter.slots().into(), history, file }
    }

    /// The takes of this view, to be edited apart from the document. The copy is cheap: everything large is shared.
    pub fn edited(&self) -> Edited {
        Edited::new(ModelAdapter::of_slots(&self.loaded.model.animation.skeleton, &self.slots))
    }

    /// This view with the takes of `edited`: what a sender shows until the document has answered change `number`.
    pub fn echo(&self, number: u64, edited: &Edited) -> Self {
        let adapter = edited.adapter();
        let takes = adapter.results().cloned().collect();
        Self { generation: ECHO | number, takes, slots: adapter.slots().into(), ..self.clone() }
    }

    /// The poses that are pending at a time of a take and seen there instead of what its keys say.
    pub fn pending(&self, take: Option<usize>, time: f32) -> Option<&PendingAt> {
        self.slots.get(take?)?.pending_at(time).map(|at| &**at)
    }

    /// The takes as they are now, but for bones that are shown at rest.
    pub fn takes_without(&self, still: &[BoneIndex]) -> Arc<[Arc<Take>]> {
        if still.is_empty() {
            return Arc::clone(&self.takes);
        }
        let quiet = |take: &Arc<Take>| {
            let mut take = Take::clone(take);
            for &bone in still {
                if let Some(track) = take.tracks.get_mut(bone as usize).filter(|track| track.bone == bone) {
                    *track = Track { bone, ..Track::default() };
                }
            }
            Arc::new(take)
        };
        self.takes.iter().map(quiet).collect()
    }

    /// The skeleton and the takes as they are now.
    pub fn animation(&self) -> AnimationData {
        let skeleton = Arc::clone(&self.loaded.model.animation.skeleton);
        AnimationData { skeleton, takes: self.takes.to_vec() }
    }
}
