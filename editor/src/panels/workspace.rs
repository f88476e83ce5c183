//! Everything that panels show and commands change: one owner for each part.

use super::camera_state::CameraState;
use super::compared::{CompareWith, ComparedFile};
use super::context::PanelContext;
use super::curves::given::GivenAngles;
use super::dialog_preview::DialogPreview;
use super::dragging::Dragging;
use super::edit_scope::EditOver;
use super::export::AnsweredExport;
use super::foot_contacts::FootContacts;
use super::frame_rate::FrameRate;
use super::keys::KeyEditing;
use super::layer_choice::LayerChoice;
use super::length_unit::LengthUnit;
use super::marks::Marks;
use super::open_model::OpenModel;
use super::player::Player;
use super::pose_library::PoseLibrary;
use super::posed::PoseCache;
use super::prompts::Prompts;
use super::reference::ReferenceTrack;
use super::retarget_source::RetargetSource;
use super::scene::{EnteredThing, LeftScene, SceneEditing, SceneProbe, SceneViewport};
use super::selected_bones::SelectedBones;
use super::selection_sets::SelectionSets;
use super::selection_steps::{SelectionState, SelectionSteps};
use super::selection_trail::SelectionTrail;
use super::settings::Settings;
use super::sound::SoundTrack;
use super::status::{MessageSeverity, Status};
use super::step_remark::StepRemark;
use super::take_findings::TakeFindings;
use super::take_list::TakeListState;
use super::tool_state::ToolState;
use super::window_status::WindowStatus;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::BonePose;
use dragonfly_picture::SceneAround;
use std::sync::Arc;
use std::time::Instant;

/// The owners of the state. A command gets all of them and calls the methods of those that it concerns.
pub(super) struct Workspace {
    /// The document's newest view, and the load in progress.
    pub(super) model: OpenModel,
    /// Poses at the time shown.
    pub(super) posed: PoseCache,
    /// The take and the time that are shown.
    pub(super) player: Player,
    /// The frame rate of the document.
    pub(super) frame_rate: FrameRate,
    /// The unit of length of the model.
    pub(super) unit: LengthUnit,
    /// Selected, hidden and pinned bones.
    pub(super) bones: SelectedBones,
    /// The selection sets of the model.
    pub(super) sets: SelectionSets,
    /// Selection and drag of keys, flags, markers, the play range.
    pub(super) keys: KeyEditing,
    /// The selections around the steps of the history.
    pub(super) selections: SelectionSteps,
    /// The selections between the steps of the history.
    pub(super) trail: SelectionTrail,
    /// The contacts of the take that is shown.
    pub(super) contacts: FootContacts,
    /// The problems of the take that is shown.
    pub(super) findings: TakeFindings,
    /// The angles that were given to rotation keys.
    pub(super) given: GivenAngles,
    /// The pose that was copied last.
    pub(super) copied_pose: Option<Arc<[BonePose]>>,
    /// The list of takes.
    pub(super) takes: TakeListState,
    /// The layer whose keys are shown and edited.
    pub(super) layers: LayerChoice,
    /// The choice of the take with which the one shown is compared.
    pub(super) compared: CompareWith,
    /// The other file with which takes are compared.
    pub(super) compared_file: ComparedFile,
    /// The second skeleton of the dialog that is open.
    pub(super) preview: DialogPreview,
    /// The tools of the viewport.
    pub(super) tools: ToolState,
    /// The keys that edits of poses are for.
    pub(super) over: EditOver,
    /// The camera and the viewport.
    pub(super) camera: CameraState,
    /// The drag in progress, whichever panel it belongs to.
    pub(super) dragging: Dragging,
    /// Questions and overlays.
    pub(super) prompts: Prompts,
    /// The model whose takes are wanted for the open one.
    pub(super) retarget: RetargetSource,
    pub(super) export: Option<AnsweredExport>,
    /// The scene that is open.
    pub(super) scene: SceneEditing,
    /// The scene in the viewport.
    pub(super) stage: SceneViewport,
    /// The surfaces of the scene, where something asks for them.
    pub(super) probe: SceneProbe,
    /// The state of the scene that was left last.
    pub(super) left_scene: Option<LeftScene>,
    /// The thing whose model is about to be opened in the scene.
    pub(super) entered: Option<EnteredThing>,
    /// The scene around the model that is edited in it.
    pub(super) around: Option<Arc<SceneAround>>,
    /// The pose library.
    pub(super) poses: PoseLibrary,
    /// The reference picture.
    pub(super) reference: ReferenceTrack,
    /// The sound.
    pub(super) sound: SoundTrack,
    /// Messages of the status line.
    pub(super) status: Status,
    /// The remark about the newest step.
    pub(super) remark: StepRemark,
    /// Settings that are remembered between runs.
    pub(super) settings: Settings,
    /// Marks of bones that are remembered for each file.
    pub(super) marks: Marks,
    /// Graphics device, frame time, full screen.
    pub(super) window: WindowStatus,
}

impl Workspace {
    /// Returns a workspace without a model.
    pub(super) fn new(settings: Settings, now: Instant) -> Self {
        Self {
            model: OpenModel::default(),
            posed: PoseCache::default(),
            player: Player::new(settings.speed, settings.repeat, now),
            frame_rate: FrameRate::default(),
            unit: LengthUnit::default(),
            bones: SelectedBones::default(),
            sets: SelectionSets::default(),
            keys: KeyEditing::of(settings.timeline),
            selections: SelectionSteps::default(),
            trail: SelectionTrail::default(),
            contacts: FootContacts::default(),
            findings: TakeFindings::default(),
            given: GivenAngles::default(),
            copied_pose: None,
            takes: TakeListState::default(),
            layers: LayerChoice::default(),
            compared: CompareWith::default(),
            compared_file: ComparedFile::default(),
            preview: DialogPreview::default(),
            tools: ToolState::new(settings.tools.ik.on, settings.tools.ik.length),
            over: EditOver::default(),
            camera: CameraState::default(),
            dragging: Dragging::default(),
            prompts: Prompts::default(),
            retarget: RetargetSource::default(),
            export: None,
            scene: SceneEditing::default(),
            stage: SceneViewport::default(),
            probe: SceneProbe::default(),
            left_scene: None,
            entered: None,
            around: None,
            poses: PoseLibrary::default(),
            reference: ReferenceTrack::default(),
            sound: SoundTrack::default(),
            status: Status::default(),
            remark: StepRemark::default(),
            settings,
            marks: Marks::default(),
            window: WindowStatus::default(),
        }
    }

    /// Returns what panels read.
    pub(super) fn read(&self) -> PanelContext<'_> {
        PanelContext {
            view: self.model.view(),
            digest: self.model.digest(),
            loading: self.model.loading(),
            posed: &self.posed,
            selection: self.bones.selection(),
            hidden: self.bones.hidden(),
            pins: self.bones.pins(),
            trail: &self.trail,
            hovered: self.bones.hovered(),
            pointed: self.bones.pointed(),
            pointer: self.bones.pointer(),
            ik: self.tools.ik(),
            over: self.over,
            playback: self.player.playback(),
            now: self.player.now(),
            frame_rate: self.frame_rate.get(),
            unit: self.unit,
            keys: &self.keys,
            contacts: &self.contacts,
            findings: &self.findings,
            given: &self.given,
            copied_pose: self.copied_pose.as_ref(),
            takes: &self.takes,
            layer_choice: self.layers,
            compared: self.compared,
            compared_file: &self.compared_file,
            preview: self.preview,
            camera: *self.camera.camera(),
            viewport: self.camera.viewport(),
            second_view: self.camera.second(),
            is_second_active: self.camera.is_second_active(),
            other_camera: *self.camera.other_camera(),
            other_through: self.camera.other_through(),
            around: self.around.as_ref().filter(|_| self.settings.look.around),
            tools: &self.tools,
            dragging: &self.dragging,
            settings: &self.settings,
            scene_editing: &self.scene,
            stage: &self.stage,
            through: self.camera.through(),
            is_camera_attached: self.camera.is_attached(),
            poses: &self.poses,
            reference: &self.reference,
            sound: &self.sound,
            sets: &self.sets,
            retarget: &self.retarget,
            export: self.export.as_ref(),
            status: &self.status,
            prompts: &self.prompts,
            overlay: self.prompts.overlay(),
            find: self.prompts.finds(),
            window: &self.window,
        }
    }

    /// Returns the selected bones and keys.
    pub(super) fn selection_state(&self) -> SelectionState {
        let take = self.read().key_slot().map(|slot| slot.id);
        SelectionState { bones: self.bones.bones().to_vec(), keys: self.keys.selection().clone(), take }
    }

    /// Returns whether exactly these bones and keys are selected.
    pub(super) fn is_selected(&self, selection: &SelectionState) -> bool {
        selection.bones == self.bones.bones()
            && selection.keys == *self.keys.selection()
            && selection.take == self.read().key_slot().map(|slot| slot.id)
    }

    /// Selects the bones and keys that were selected before; the keys only if their take is shown.
    pub(super) fn restore_selection(&mut self, selection: &SelectionState) {
        self.bones.choose(&selection.bones, Choice::Replace);
        if selection.take.is_some() && selection.take == self.read().key_slot().map(|slot| slot.id) {
            self.keys.restore(&selection.keys);
        }
    }

    /// Adds a message to the status line.
    pub(super) fn say(&mut self, level: MessageSeverity, text: impl Into<String>) {
        self.status.say(level, text);
    }
}
