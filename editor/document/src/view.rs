//! The published state of the document: immutable, shared, without locks.

use super::adapter::{ModelAdapter, PendingAt, TakeVersions};
use super::history::Edited;
use super::images::ImageSurvey;
use super::scene_view::SceneView;
use super::shapes::ModelShapes;
use super::step_amount::StepAmount;
use dragonfly_anim::bounds::Bounds;
use dragonfly_anim::data::{AnimationData, BoneIndex, ModelData, Skeleton, Take, Track};
use dragonfly_anim::format::gltf::GLB;
use dragonfly_anim::format::{Conversion, Format};
use dragonfly_anim::root_bone::BoneShift;
use std::path::PathBuf;
use std::sync::Arc;

/// A model as loaded, with everything that drawing needs.
#[derive(Clone, Debug)]
pub struct LoadedModel {
    /// File name without folder, or "Dragonfly" for the built-in model.
    pub title: String,
    /// Its path; `None` for the built-in model.
    pub path: Option<PathBuf>,
    /// Format of the file that it was read from; `None` for a model that was not read from a file.
    pub format: Option<Format>,
    /// Units, axes and frame rate of the file, as they were converted.
    pub conversion: Conversion,
    /// The data as it was read, with the root bones that edits added. The present takes are in the [`View`].
    pub model: Arc<ModelData>,
    /// Its bounds at the start of its first take, or in the rest pose where it has none.
    pub bounds: Bounds,
    /// The images of the model that can be decoded; the others have a warning. What draws the model decodes them.
    pub images: ImageSurvey,
    /// Contents that are not shown or were sanitized, one sentence each.
    pub warnings: Vec<String>,
    /// Findings while reading that change neither the picture nor the animation, one sentence each.
    pub notes: Vec<String>,
}

/// Height of a human, meters.
const HUMAN_HEIGHT: f32 = 1.7;

impl LoadedModel {
    /// Returns whether it has takes or moves a skin; otherwise it is an object, as props are.
    pub fn is_figure(&self) -> bool {
        !self.model.animation.takes.is_empty() || !self.model.skins.is_empty()
    }

    /// Returns its height at the start of its first take, meters.
    pub fn height(&self) -> f32 {
        self.bounds.max.y - self.bounds.min.y
    }

    /// Returns the factor that makes a figure as high as a human, with two digits, where it is much larger or smaller; otherwise, and for a height that no model has, 1.
    pub fn human_scale(&self) -> f64 {
        let height = self.height();
        if !(1e-6..=1e9).contains(&height) || (0.5..=4.0).contains(&height) {
            return 1.0;
        }
        let scale = f64::from(HUMAN_HEIGHT / height);
        let mut digits = 1.0;
        while scale * digits < 10.0 {
            digits *= 10.0;
        }
        while scale * digits >= 100.0 {
            digits /= 10.0;
        }
        (scale * digits).round() / digits
    }

    /// Returns the model with this skeleton, which edits made from that of `opened`.
    pub(super) fn with_skeleton(opened: &Arc<Self>, skeleton: &Arc<Skeleton>) -> Arc<Self> {
        let own = &opened.model.animation.skeleton;
        if Arc::ptr_eq(own, skeleton) {
            return Arc::clone(opened);
        }
        let model = BoneShift::between(own, skeleton).and_then(|shift| shift.model(&opened.model, skeleton));
        let Some(model) = model else {
            unreachable!("edits change nothing of a skeleton but root bones that carry no mesh");
        };
        Arc::new(Self { model: Arc::new(model), ..Self::clone(opened) })
    }
}

/// The history, for the menu and for the list of the history.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryView {
    /// Label of each step, the first one first.
    pub steps: Vec<&'static str>,
    /// Number of each step, which it keeps as long as it is in the history.
    pub numbers: Vec<u64>,
    /// Bones and take of each step; empty where unknown.
    pub about: Vec<Arc<str>>,
    /// Time and amount of each step; `None` where it neither sets nor offsets poses.
    pub amounts: Vec<Option<StepAmount>>,
    /// Whether the status line shows how far the last applied step moves bones.
    pub shows_difference: bool,
    /// Whether the last applied step adds takes of other files.
    pub brings_takes: bool,
    /// Number of steps that are applied; the others can be redone.
    pub done: usize,
    /// Whether nothing is unsaved.
    pub saved: bool,
    /// Number of steps that were applied when it was opened or saved, or that the project of a model keeps; `None` where neither undo nor
    /// redo leads there.
    pub saved_at: Option<usize>,
}

impl HistoryView {
    /// Returns the history of `edited`.
    pub fn of(edited: &Edited) -> Self {
        let (steps, done) = edited.steps();
        let labels: Vec<_> = steps.iter().map(|step| step.edit.label()).collect();
        let numbers = steps.iter().map(|step| step.number).collect();
        let about = steps.iter().map(|step| Arc::clone(&step.about)).collect();
        let amounts = steps.iter().map(|step| step.amount).collect();
        let last = done.checked_sub(1).and_then(|last| steps.get(last));
        let shows_difference = last.is_some_and(|step| step.edit.shows_difference());
        let brings_takes = last.is_some_and(|step| step.edit.brings_takes());
        let (saved, saved_at) = (!edited.has_unsaved(), edited.settled());
        Self { steps: labels, numbers, about, amounts, shows_difference, brings_takes, done, saved, saved_at }
    }

    /// Returns whether a step with this label was applied or undone since nothing was unsaved.
    pub fn has_unsaved_step(&self, label: &str) -> bool {
        let saved = self.saved_at.unwrap_or_default();
        let unsaved = saved.min(self.done)..saved.max(self.done);
        self.steps.get(unsaved).is_some_and(|steps| steps.contains(&label))
    }

    /// Returns the last unsaved step as a sentence; `None` where nothing is unsaved.
    pub fn last_unsaved(&self) -> Option<String> {
        let label = |at: usize| self.steps.get(at).copied();
        match self.saved_at {
            Some(saved) if saved == self.done => None,
            Some(saved) if saved > self.done => {
                Some(format!("Undone since the last save: {}", label(self.done)?))
            }
            _ => Some(format!("The last change: {}", label(self.done.checked_sub(1)?)?)),
        }
    }

    /// Returns the labels of the steps that undo and redo would affect.
    pub fn labels(&self) -> [Option<&'static str>; 2] {
        [self.done.checked_sub(1), Some(self.done)].map(|at| self.steps.get(at?).copied())
    }
}

/// The file of the document.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileView {
    /// Its name without folder; a substitute where there is no file yet.
    pub title: String,
    /// Its path; `None` where it was never saved: the first save asks for it.
    pub path: Option<PathBuf>,
    /// The extension that a copy of it has.
    pub ending: String,
}

impl FileView {
    /// Returns its key in the program's settings: the absolute path, or the title where there is no file.
    pub fn key(&self) -> String {
        match &self.path {
            Some(path) => std::path::absolute(path).unwrap_or_else(|_| path.clone()).display().to_string(),
            None => format!("built in: {}", self.title),
        }
    }
}

/// A scene that waits while one of its models is edited.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WaitingSceneView {
    /// Title of its file.
    pub title: Arc<str>,
    /// Whether nothing of it is unsaved. The edits of the model are not counted: the scene gets them when it is shown again.
    pub saved: bool,
}

impl From<&str> for WaitingSceneView {
    /// Returns a saved scene with this title.
    fn from(title: &str) -> Self {
        Self { title: title.into(), saved: true }
    }
}

/// Bit that is set in the generation of an echo, so that it differs from the generations of the document.
const ECHO: u64 = 1 << 63;

/// The newest state of the document. Panels read it, and nothing changes it.
#[derive(Clone, Debug)]
pub struct View {
    /// Grows with every change. An echo (see [`Self::echo`]) has its highest bit set.
    pub generation: u64,
    /// Number of the last [numbered change](super::DocumentHandle::change_numbered) that was carried out or refused before
    /// this view was made; 0 before the first.
    pub answered: u64,
    /// The model as it was opened. Two views of one document have the same.
    pub opened: Arc<LoadedModel>,
    /// The model with the skeleton as it is now: the same as `opened` unless edits added root bones.
    pub loaded: Arc<LoadedModel>,
    /// Its takes as they are now. They are separate from the model, so that a change of one take leaves the model as it is, also on the GPU:
    /// two views of one model with the same skeleton have the same `loaded`.
    pub takes: Arc<[Arc<Take>]>,
    /// The same takes with their originals and changes.
    pub slots: Arc<[Arc<TakeVersions>]>,
    /// The shape keys of the model.
    pub shapes: ModelShapes,
    /// The history.
    pub history: Arc<HistoryView>,
    /// The file of the document.
    pub file: Arc<FileView>,
    /// The scene, if a script is open; the model is then an empty one.
    pub scene: Option<Arc<SceneView>>,
    /// The scene that waits while this model of it is edited; `None` for a document that was opened itself.
    pub waiting_scene: Option<WaitingSceneView>,
    /// Whether unsaved work is not recorded, so that a crash would lose it.
    pub is_unrecorded: bool,
}

impl View {
    /// Returns the view of `loaded` without changes.
    pub fn opened(generation: u64, loaded: Arc<LoadedModel>) -> Self {
        let edited = Edited::new(ModelAdapter::of(&loaded.model));
        let history = Arc::new(HistoryView { saved: true, saved_at: Some(0), ..HistoryView::default() });
        let ending = loaded.format.unwrap_or(GLB).extension().to_owned();
        let file = FileView { title: loaded.title.clone(), path: loaded.path.clone(), ending };
        let file = Arc::new(file);
        Self::of(generation, loaded, edited.adapter(), history, file)
    }

    /// Returns the view of `loaded` with the takes of `adapter`.
    pub(super) fn of(
        generation: u64,
        loaded: Arc<LoadedModel>,
        adapter: &ModelAdapter,
        history: Arc<HistoryView>,
        file: Arc<FileView>,
    ) -> Self {
        let takes = adapter.results().cloned().collect();
        let (slots, shapes) = (adapter.slots().into(), adapter.shapes().clone());
        let opened = Arc::clone(&loaded);
        Self {
            generation,
            answered: 0,
            opened,
            loaded,
            takes,
            slots,
            shapes,
            history,
            file,
            scene: None,
            waiting_scene: None,
            is_unrecorded: false,
        }
    }

    /// Returns the renumbering of the bones of `loaded`, the model of an earlier view of this document, to those of this view; `None`
    /// where it is a model of another document.
    pub fn bones_since(&self, opened: &Arc<LoadedModel>, loaded: &Arc<LoadedModel>) -> Option<BoneShift> {
        if !Arc::ptr_eq(&self.opened, opened) {
            return None;
        }
        if Arc::ptr_eq(&self.loaded, loaded) {
            return Some(BoneShift::default());
        }
        BoneShift::between(&loaded.model.animation.skeleton, &self.loaded.model.animation.skeleton)
    }

    /// Returns a copy of the takes of this view, to be edited apart from the document. The copy is cheap: everything
    /// large is shared.
    pub fn edited(&self) -> Edited {
        let adapter = ModelAdapter::of_slots(&self.loaded.model.animation.skeleton, &self.slots);
        Edited::new(adapter.with_shapes(self.shapes.clone()))
    }

    /// Returns this view with the takes of `edited`. A sender shows it until the document has answered change `number`.
    pub fn echo(&self, number: u64, edited: &Edited) -> Self {
        Self { generation: ECHO | number, ..self.with_edited(edited) }
    }

    /// Returns this view with the takes and the skeleton of `edited`.
    pub fn with_edited(&self, edited: &Edited) -> Self {
        let adapter = edited.adapter();
        let loaded = match Arc::ptr_eq(&self.loaded.model.animation.skeleton, adapter.skeleton()) {
            true => Arc::clone(&self.loaded),
            false => LoadedModel::with_skeleton(&self.opened, adapter.skeleton()),
        };
        let takes = adapter.results().cloned().collect();
        Self { loaded, takes, slots: adapter.slots().into(), ..self.clone() }
    }

    /// Returns the pending poses at a time of a take, which are shown instead of the keyed ones.
    pub fn pending(&self, take: Option<usize>, time: f32) -> Option<&PendingAt> {
        self.slots.get(take?)?.pending_at(time).map(|at| &**at)
    }

    /// Returns the takes without the tracks of bones that are shown at rest.
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

    /// Returns the skeleton and the takes as they are now.
    pub fn animation(&self) -> AnimationData {
        let skeleton = Arc::clone(&self.loaded.model.animation.skeleton);
        AnimationData { skeleton, takes: self.takes.to_vec() }
    }
}
