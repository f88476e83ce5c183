//! What panels ask for, and what of it reaches further than the panels.

use super::commands::{Id, KeySettings};
use super::keys::KeysRequest;
use super::saving::Deed;
use super::settings::GhostSettings;
use super::state::Overlay;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::Choice;
use dragonfly_document::{Change, Source};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::OwnedRegion;

/// What a panel asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Does a command of the table.
    Command(Id),
    /// Selects a bone, or none.
    Select(Option<BoneIndex>),
    /// Selects bones, in this way.
    SelectBones(Vec<BoneIndex>, Choice),
    /// Edits, undoes, does again.
    Change(Change),
    /// Puts bones out of sight, or shows them again.
    Hide {
        /// Which.
        bones: Vec<BoneIndex>,
        /// Else they are shown.
        hide: bool,
    },
    /// About keys: selects, drags, marks.
    Timeline(KeysRequest),
    /// Puts on the poses in a text from the clipboard, or in the keys.
    PastePose {
        /// As it was there.
        text: String,
        /// On the other side?
        mirrored: bool,
    },
    /// The pointer is over this bone's row.
    Hover(BoneIndex),
    /// Shows a take, or the rest pose.
    ShowTake(Option<usize>),
    /// Goes to this time, seconds.
    Seek(f32),
    /// Take seconds a second.
    Speed(f32),
    /// At the end of the take.
    Repeat(dragonfly_picture::playback::Repeat),
    /// Frames a second for the display.
    FrameRate(u32),
    /// Scale of the window's content.
    Scale(f32),
    /// Other keys for commands.
    Keys(KeySettings),
    /// From where.
    Camera(Camera),
    /// Where the picture is, in points.
    Viewport(egui::Rect),
    /// Tools that lie over the picture, in points.
    Shields(Vec<egui::Rect>),
    /// How ghosts are shown.
    Ghosts(GhostSettings),
    /// The wheel was turned over the picture: points, positive is nearer.
    Wheel(f32),
    /// The pointer is here over the picture, in points, and does nothing else; or it is not.
    Point(Option<egui::Pos2>),
    /// Opens a model.
    Open(Source),
    /// Shows an overlay, or none.
    Overlay(Option<Overlay>),
    /// Shows or hides the panel of this name.
    TogglePanel(&'static str),
    /// Begins to rename a take, or ends it.
    RenameTake(Option<usize>),
    /// Answers a question.
    Deed(Deed),
    /// Leaves a question without an answer.
    Dismiss,
    /// How the numbers of a bone are shown.
    PropertiesLook(super::properties::PropertiesLook),
}

/// What only the surroundings of the panels can do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Shows the system's dialog for opening files.
    OpenDialog,
    /// Opens a model.
    Open(Source),
    /// Takes back what is dragged, as if it had never begun.
    TakeBack,
    /// No button is held: what was dragged is over, said or not.
    HandsOff,
    /// Stops the job that loads.
    CancelLoading,
    /// Tells the document.
    Change(Change),
    /// Tells the document, under this number: what becomes of [`Self::Change`] and [`Self::Changes`] when a drag does not
    /// stand in their way.
    Send(u64, Change),
    /// Tells the document several things, each a step.
    Changes(Vec<Change>),
    /// Puts a text into the clipboard.
    Copy(String),
    /// The same, and tells the document: what was copied goes.
    Cut(String, Change),
    /// Asks for [`Request::PastePose`] with what is in the clipboard.
    PastePose {
        /// On the other side?
        mirrored: bool,
    },
    /// Asks the graphics thread which bone lies there, in points from the window's top left, and selects it in this way.
    Pick(egui::Pos2, Choice),
    /// Asks which bones lie in there, in points from the picture's top left.
    Catch(OwnedRegion, Choice),
    /// Uses the whole screen, or a window again.
    FullScreen,
    /// Shows or hides a panel.
    TogglePanel(&'static str),
    /// Puts every panel where it was at first.
    ResetLayout,
    /// Tries the device again.
    RetryDevice,
    /// Ends the program.
    Quit,
    /// Saves, leaves, brings back.
    Deed(Deed),
    /// The program does not end, since something is not saved.
    Stays,
}
