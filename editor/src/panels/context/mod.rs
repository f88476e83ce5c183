//! Read access of the panels: references to the owners of the state, and queries that need several of them.

mod compared;
mod feet;
mod ik;
mod keys;
mod layer;
mod pose;
mod reference;
mod scene;
mod scope;
mod title;

pub(super) use title::title_with_dot;

use super::compared::{CompareWith, ComparedFile};
use super::curves::given::GivenAngles;
use super::dialog_preview::DialogPreview;
use super::digest::Digest;
use super::dragging::Dragging;
use super::edit_scope::EditOver;
use super::export::AnsweredExport;
use super::foot_contacts::FootContacts;
use super::keys::KeyEditing;
use super::layer_choice::LayerChoice;
use super::length_unit::LengthUnit;
use super::open_model::Loading;
use super::pose_library::PoseLibrary;
use super::posed::PoseCache;
use super::prompts::{Overlay, Prompts, Question};
use super::reference::ReferenceTrack;
use super::retarget_source::RetargetSource;
use super::scene::{SceneEditing, SceneViewport};
use super::selection_sets::SelectionSets;
use super::selection_trail::SelectionTrail;
use super::settings::Settings;
use super::sound::SoundTrack;
use super::status::Status;
use super::take_findings::TakeFindings;
use super::take_list::TakeListState;
use super::tool_state::ToolState;
use super::window_status::WindowStatus;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_document::adapter::TakeVersions;
use dragonfly_document::bones::{BoneSelection, HiddenBones};
use dragonfly_document::edit::BonePose;
use dragonfly_document::history::Gesture;
use dragonfly_document::posing::IkMode;
use dragonfly_document::{LoadedModel, View};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::{SceneAround, ThroughCamera};
use egui::{Pos2, Rect};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Everything that a panel reads in one frame. A panel changes nothing of it: it pushes requests.
#[derive(Clone, Copy)]
pub struct PanelContext<'a> {
    /// The newest view of the document; `None` before the first model is open.
    pub view: Option<&'a View>,
    /// Rows, totals and key times computed from the view.
    pub digest: &'a Digest,
    /// The model that is being loaded.
    pub loading: Option<&'a Loading>,
    /// Poses at the time shown.
    pub posed: &'a PoseCache,
    /// The selected bones.
    pub selection: &'a BoneSelection,
    /// The hidden bones.
    pub hidden: &'a HiddenBones,
    /// The pinned bones.
    pub pins: &'a [BoneIndex],
    /// The selections between the steps of the history.
    pub trail: &'a SelectionTrail,
    /// The bone whose row is under the pointer.
    pub hovered: Option<BoneIndex>,
    /// The bone under the pointer in the viewport.
    pub pointed: Option<BoneIndex>,
    /// Position of the pointer over the viewport, points.
    pub pointer: Option<Pos2>,
    /// How bones follow one that is moved.
    pub ik: IkMode,
    /// The keys that edits of poses are for.
    pub over: EditOver,
    /// The take and the time that are shown.
    pub playback: PlaybackClock,
    /// The moment of the frame that is drawn.
    pub now: Instant,
    /// Frame rate of the document, frames per second.
    pub frame_rate: u32,
    /// The unit of length of the model.
    pub unit: LengthUnit,
    /// Selection and drag of keys, flags, markers, the play range.
    pub keys: &'a KeyEditing,
    /// The contacts of the take that is shown.
    pub contacts: &'a FootContacts,
    /// The problems of the take that is shown.
    pub findings: &'a TakeFindings,
    /// The angles that were given to rotation keys.
    pub given: &'a GivenAngles,
    /// The pose that was copied last; `None` if none of this model was.
    pub copied_pose: Option<&'a Arc<[BonePose]>>,
    /// The list of takes.
    pub takes: &'a TakeListState,
    /// The layer whose keys are shown and edited.
    pub layer_choice: LayerChoice,
    /// The choice of the take with which the one shown is compared.
    pub compared: CompareWith,
    /// The other file with which takes are compared.
    pub compared_file: &'a ComparedFile,
    /// The second skeleton of the dialog that is open.
    pub preview: DialogPreview,
    /// The camera.
    pub camera: Camera,
    /// The viewport, points.
    pub viewport: Rect,
    /// The rectangle of the other one of two views of a scene, points; `None` while there is one. Camera and viewport are those of the active one.
    pub second_view: Option<egui::Rect>,
    /// Whether the active one of two views is the second one.
    pub is_second_active: bool,
    /// The free camera of the view that is not active.
    pub other_camera: Camera,
    /// The camera of the scene through which that looks.
    pub other_through: &'a ThroughCamera,
    /// The scene around the model that is edited in it, where it is shown.
    pub around: Option<&'a Arc<SceneAround>>,
    /// The tools of the viewport, their drag, motion path and IK.
    pub tools: &'a ToolState,
    /// The drag in progress, whichever panel it belongs to.
    pub dragging: &'a Dragging,
    /// Settings that are remembered between runs.
    pub settings: &'a Settings,
    /// The model whose takes are wanted for the open one.
    pub retarget: &'a RetargetSource,
    /// The export that the document answered last.
    pub export: Option<&'a AnsweredExport>,
    /// The selection sets of the model.
    pub sets: &'a SelectionSets,
    /// The scene that is open: selection, lanes, the newest text.
    pub scene_editing: &'a SceneEditing,
    /// The scene in the viewport.
    pub stage: &'a SceneViewport,
    /// The camera of the scene through which the viewport looks.
    pub through: &'a ThroughCamera,
    /// Whether moving the view moves that camera.
    pub is_camera_attached: bool,
    /// The pose library.
    pub poses: &'a PoseLibrary,
    /// The reference picture.
    pub reference: &'a ReferenceTrack,
    /// The sound.
    pub sound: &'a SoundTrack,
    /// Messages of the status line.
    pub status: &'a Status,
    /// Questions and overlays.
    pub prompts: &'a Prompts,
    /// The overlay that is shown.
    pub overlay: Option<Overlay>,
    /// Whether the search field is to get the cursor.
    pub find: bool,
    /// Graphics device, frame time, full screen.
    pub window: &'a WindowStatus,
}

impl<'a> PanelContext<'a> {
    /// Returns the model that is open.
    pub fn loaded(&self) -> Option<&'a LoadedModel> {
        self.view.map(|view| &*view.loaded)
    }

    /// Returns the folder of the file of the model; `None` for one that is in no file.
    pub(crate) fn model_folder(&self) -> Option<PathBuf> {
        let view = self.view?;
        let path = view.file.path.as_deref().or(view.loaded.path.as_deref())?;
        path.parent().map(Path::to_owned)
    }

    /// Returns the number of bones of the model; 0 if none is open.
    pub(super) fn bone_count(&self) -> usize {
        self.loaded().map_or(0, |loaded| loaded.model.animation.skeleton.len())
    }

    /// Returns the keys that are shown and edited, see [`Self::shared_take`].
    pub fn take(&self) -> Option<&'a Take> {
        self.shared_take().map(|take| &**take)
    }

    /// Returns the take that is shown with its original and its pending poses.
    pub fn slot(&self) -> Option<&'a TakeVersions> {
        self.view?.slots.get(self.playback.take?).map(|slot| &**slot)
    }

    /// Returns the time shown, seconds in the take.
    pub fn time(&self) -> f32 {
        self.playback.time_at(self.now)
    }

    /// Returns the name of a bone, or `Bone 7` if it has none.
    pub fn bone_name(&self, bone: BoneIndex) -> String {
        let bones = self.loaded().map(|loaded| &loaded.model.animation.skeleton.bones);
        let name = bones.and_then(|bones| bones.get(bone as usize)).map_or("", |bone| bone.name.as_str());
        if name.is_empty() { format!("Bone {bone}") } else { name.to_owned() }
    }

    /// Returns whether bones are drawn: if the setting is on, but also if a bone is selected, if bones are hidden (in
    /// order to see the others), and if the model has no surface.
    pub fn shows_skeleton(&self) -> bool {
        let bare = self.loaded().is_some_and(|loaded| loaded.model.instances.is_empty());
        self.settings.look.skeleton || self.selected().is_some() || !self.hidden.is_empty() || bare
    }

    /// Returns the active bone: the one selected last.
    pub fn selected(&self) -> Option<BoneIndex> {
        self.selection.active()
    }

    /// Begins a gesture: a drag, or a slider that is held, whose edits are one step.
    pub fn new_gesture(&self) -> Gesture {
        self.dragging.new_gesture()
    }

    /// Returns the bone that is highlighted: under the pointer, in the tree or in the viewport.
    pub fn highlighted(&self) -> Option<BoneIndex> {
        self.hovered.or(self.pointed)
    }

    /// Returns whether keys run commands: no question is shown, and nothing is dragged.
    pub fn takes_shortcuts(&self) -> bool {
        self.question().is_none()
            && (!self.dragging.is_open() || self.keeps_gesture())
            && self.keys.buttonless().is_none()
    }

    /// Returns whether the gesture in progress is kept when something else is done: a word that is typed, a camera that the wheel moves.
    pub fn keeps_gesture(&self) -> bool {
        let open = self.dragging.open();
        self.scene_editing.is_typing(open) || self.stage.is_turning(open)
    }

    /// Returns the folder of the pose library: the one that was chosen, or the program's own.
    pub fn pose_folder(&self) -> Option<&'a Path> {
        self.settings.pose_folder.as_deref().or(self.poses.usual())
    }

    /// Returns the question that is shown.
    pub fn question(&self) -> Option<&'a Question> {
        self.prompts.question()
    }
}
