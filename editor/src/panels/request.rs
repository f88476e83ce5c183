//! Requests of the panels, and effects that reach beyond the panels.

use super::commands::id::Id;
use super::commands::key_settings::KeySettings;
use super::compared::CompareWith;
use super::curves::given::GivenCurve;
use super::curves::look::CurvesLook;
use super::dialog_preview::DialogPreview;
use super::dropped_files::{DroppedModels, UnknownModels, WantedFiles};
use super::edit_scope::FalloffSettings;
use super::file_choice::FileChoice;
use super::keys::request::KeysRequest;
use super::overlay::Overlay;
use super::properties::look::PropertiesLook;
use super::reference::settings::ReferenceSettings;
use super::scene::SceneRequest;
use super::selection_sets::SetAction;
use super::settings::GhostSettings;
use super::sound::SoundSettings;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::adapter::TakeId;
use dragonfly_document::bones::Choice;
use dragonfly_document::{Change, ClipOrder, DocumentMessage, Offer, Source, Then};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::OwnedRegion;
use std::path::PathBuf;
use std::sync::Arc;

/// A request of a panel.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Runs a command of the table.
    Command(Id),
    /// Selects a bone, or none.
    Select(Option<BoneIndex>),
    /// Changes the selection by these bones: replaces, adds or toggles them.
    SelectBones(Vec<BoneIndex>, Choice),
    /// Edits, undoes or redoes.
    Change(Change),
    /// Hides bones, or shows them again.
    Hide {
        /// The bones.
        bones: Vec<BoneIndex>,
        /// Whether they are hidden; otherwise they are shown.
        hide: bool,
    },
    /// A request about keys.
    Timeline(KeysRequest),
    /// Shows these angles of rotation keys, of all that describe the same rotations.
    Angles(Arc<GivenCurve>),
    /// Pastes the poses or the keys in a text from the clipboard.
    PastePose {
        /// The text of the clipboard.
        text: String,
        /// Whether the pose goes to the bones of the other side.
        mirrored: bool,
    },
    /// The pointer is over the row of this bone.
    Hover(BoneIndex),
    /// Shows a take, or the rest pose.
    ShowTake(Option<usize>),
    /// Makes a layer active, whose keys are then shown and edited, or the take itself.
    ChooseLayer(Option<TakeId>),
    /// Compares the take that is shown with another one.
    CompareWith(CompareWith),
    /// Shows the second skeleton of the dialog that is open.
    Preview(DialogPreview),
    /// Goes to this time, seconds.
    Seek(f32),
    /// Sets the speed of playback, seconds of the take per second.
    Speed(f32),
    /// Sets what happens at the end of the take.
    Repeat(dragonfly_picture::playback::Repeat),
    /// Sets the frame rate of the timeline, frames per second.
    FrameRate(u32),
    /// Sets the meters in one unit of the model; `None`: guessed from its size.
    LengthUnit(Option<f32>),
    /// Sets the scale of the window's content.
    Scale(f32),
    /// Replaces the keys of commands.
    Keys(KeySettings),
    /// Replaces the camera.
    Camera(Camera),
    /// Sets the rectangle of the viewport, points.
    Viewport(egui::Rect),
    /// Sets the rectangle of the second view of a scene, points; `None` without one.
    SecondView(Option<egui::Rect>),
    /// Sets the rectangles of the tools over the viewport, points.
    Shields(Vec<egui::Rect>),
    /// Sets how ghosts are shown.
    Ghosts(GhostSettings),
    /// Sets the size of the falloff of edits.
    Falloff(FalloffSettings),
    /// The wheel was turned over the viewport: points, positive is nearer.
    Wheel(f32),
    /// Position of the pointer over the viewport, points; `None` if it is elsewhere or a button is held.
    Point(Option<egui::Pos2>),
    /// The pointer has left the viewport: nothing in it is under the pointer any more.
    PointElsewhere,
    /// Opens a model.
    Open(Source),
    /// Imports the takes of files onto the open model. Bones are matched by name.
    ImportTakes(Vec<PathBuf>),
    /// Asks for files whose takes are imported with this map; the order has no files yet.
    ChooseMapped(Box<ClipOrder>),
    /// Imports the takes of files with the map of [`Self::ChooseMapped`].
    ImportMapped(Vec<PathBuf>),
    /// Shows an overlay, or none.
    Overlay(Option<Overlay>),
    /// Shows or hides the panel with this id.
    TogglePanel(&'static str),
    /// Starts to rename a take, or ends it.
    RenameTake(Option<usize>),
    /// Answers a question.
    Answer(FileAction),
    /// Closes a question without an answer.
    Dismiss,
    /// Sets how the numbers of a bone are shown.
    PropertiesLook(PropertiesLook),
    /// Sets how curves are shown.
    CurvesLook(CurvesLook),
    /// Sets the folder of the pose library.
    PoseFolder(PathBuf),
    /// Shows the system's dialog for choosing a file or folder, starting at this path.
    Choose(FileChoice, Option<PathBuf>),
    /// Sets the sound and where it starts.
    Sound(SoundSettings),
    /// Shows this file as the reference.
    ReferenceFile(PathBuf),
    /// Sets the reference picture and how it is shown.
    Reference(ReferenceSettings),
    /// Changes the selection sets, or selects bones by them.
    Sets(SetAction),
    /// A request about the scene that is open.
    Scene(SceneRequest),
    /// Files were dropped onto the window.
    Dropped(Vec<PathBuf>),
    /// Adds models that were dropped onto the scene, once it is known what they are.
    DroppedModels(Box<DroppedModels>),
    /// Copies the files that are outside of the folder of the scene into it, and uses them.
    CopyFiles(Box<WantedFiles>),
    /// Uses this file in place of the missing one of [`SceneRequest::Find`].
    FileFound(PathBuf),
    /// Asks for the path of the missing file, which is typed.
    TypeFoundFile,
    /// Asks which folders a save into this folder would create.
    LookAtFolder(PathBuf),
    /// Adds a layer with the keys of the take with this index over the take that is shown.
    AddLayerFrom(usize),
    /// Adds this model to the scene as a role.
    AddRole(PathBuf),
    /// Adds this model to the scene as a prop.
    AddProp(PathBuf),
    /// Adds this sound to the scene, at the playhead.
    AddSound(PathBuf),
    /// Makes a scene of two roles with this model, next to its file, and opens it.
    NewScene(PathBuf),
    /// Writes two figures and a scene with them into this folder, and opens the scene.
    DemoScene(PathBuf),
}

/// An action that only the application around the panels can carry out.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Shows the system's dialog for opening files.
    OpenDialog,
    /// Shows the system's dialog for the file with which takes are compared.
    CompareDialog,
    /// Shows the system's dialog for choosing a file or folder, starting in this folder.
    Choose(FileChoice, Option<PathBuf>),
    /// Cancels the drag in progress, as if it had never begun.
    CancelDrag,
    /// Ends the drag in progress; no button is held any more.
    ReleaseDrag,
    /// Sends a change to the document.
    Change(Change),
    /// Sends a change to the document under this number: [`Self::Change`] and [`Self::Changes`] are replaced by this
    /// when they are passed on.
    Send(u64, Change),
    /// Sends several changes to the document, each a step.
    Changes(Vec<Change>),
    /// Puts a text into the clipboard.
    Copy(String),
    /// Puts a text into the clipboard, and sends the change that deletes what was copied.
    Cut(String, Change),
    /// Executes [`Request::PastePose`] with the text of the clipboard.
    PastePose {
        /// Whether the pose goes to the bones of the other side.
        mirrored: bool,
    },
    /// Asks the graphics thread which bone is at this position, in points from the window's top left, and changes the
    /// selection by it.
    Pick(egui::Pos2, Choice),
    /// Asks the graphics thread which bones are in this region, in points from the viewport's top left, and changes the
    /// selection by them.
    Catch(OwnedRegion, Choice),
    /// Switches between the whole screen and a window.
    FullScreen,
    /// Shows or hides a panel.
    TogglePanel(&'static str),
    /// Shows a panel, in front of those in the same place.
    ShowPanel(&'static str),
    /// Resets the arrangement of the panels to the default one.
    ResetLayout,
    /// Tries to start the graphics device again.
    RetryDevice,
    /// Opens, saves, ends or recovers.
    File(FileAction),
    /// Writes a scene of two roles with this model next to its file, and opens it.
    NewScene(PathBuf),
    /// Writes two figures and a scene with them into this folder, and opens the scene.
    DemoScene(PathBuf),
    /// Reads these models, then executes [`Request::DroppedModels`].
    LookAtModels(Box<UnknownModels>),
    /// Looks where these files are: those outside of the folder of the scene are copied into it if the user agrees.
    LookAtFiles(Box<WantedFiles>),
    /// Copies these files into the folder of the scene, and uses them.
    CopyFiles(Box<WantedFiles>),
    /// Writes a project with this script next to its file, and opens it.
    NewProject(PathBuf),
}

/// An action about files.
#[derive(Clone, Debug, PartialEq)]
pub enum FileAction {
    /// Sends a message to the document: saves, recovers, looks at the file.
    Send(DocumentMessage),
    /// Asks the user where to save.
    Where {
        /// Whether the document keeps its own file.
        copy: bool,
        /// The action to run after saving.
        then: Option<Then>,
    },
    /// Continues without saving.
    DoNotSave(Then),
    /// Reads the file again; unsaved changes are lost.
    Reload,
    /// Asks the user where the file of unsaved work is now.
    Find(Box<Offer>),
    /// Opens another model or ends the program, unless there are unsaved changes.
    Leave(Then),
    /// Ends the program: nothing is unsaved.
    QuitNow,
    /// The program does not end: there are unsaved changes.
    Stay,
}

impl FileAction {
    /// Returns whether a drag may continue: the action does not concern the open model.
    pub(super) fn spares_drag(&self) -> bool {
        match self {
            Self::Send(
                DocumentMessage::LookAtFile
                | DocumentMessage::LookAtFolder(_)
                | DocumentMessage::Search
                | DocumentMessage::CancelLoading
                | DocumentMessage::ReadSource(_)
                | DocumentMessage::ReadCompared(_)
                | DocumentMessage::MapFile(_)
                | DocumentMessage::CheckTake(_)
                | DocumentMessage::Poses(_),
            )
            | Self::Stay => true,
            Self::Send(_)
            | Self::Where { .. }
            | Self::DoNotSave(_)
            | Self::Reload
            | Self::Find(_)
            | Self::Leave(_)
            | Self::QuitNow => false,
        }
    }
}
