//! Requests about scenes.

use crate::panels::keys::TimeWindow;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{EditScript, ScriptLabel};
use dragonfly_document::history::Gesture;
use dragonfly_document::{MissingFile, OutdatedEdits, OutdatedEditsChoice};
use dragonfly_picture::ThroughCamera;
use std::sync::Arc;

/// A new text of the script.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptChange {
    /// The text that it was made from; of a gesture, the one at its start.
    pub from: Arc<str>,
    /// The new text.
    pub text: String,
    /// Changes of other texts in the same step: of the project, where things of its cast change, and of other scripts that name them. Their places are
    /// those of the texts at the start of a gesture, too.
    pub also: Vec<EditScript>,
    /// Label of the step in the history.
    pub label: ScriptLabel,
    /// The gesture that it belongs to.
    pub gesture: Option<Gesture>,
    /// The existing things that it changes, by their ids: it is refused while one of them is locked. None for what someone types.
    pub things: Arc<[Box<str>]>,
}

/// A take that is dragged from the list to the timeline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DraggedTake {
    /// Its name.
    pub take: Box<str>,
}

/// A request about a drawn line, by its name in the editor.
#[derive(Clone, Debug, PartialEq)]
pub enum LineRequest {
    /// Selects a line, or none.
    Select(Option<Box<str>>),
    /// Selects lines: replaces, adds or toggles them.
    Choose(Vec<Box<str>>, Choice),
    /// Hides a line, or shows it again.
    Hide(Box<str>, bool),
    /// Sets an attribute of a line, or removes it.
    Set(Box<str>, &'static str, Option<String>),
    /// Starts to rename a line in the list, or has started.
    Rename(Option<Box<str>>),
    /// Deletes a line.
    Delete(Box<str>),
    /// Adds a path along a line to the cast.
    UseAsPath(Box<str>),
    /// Sets the color of lines that are drawn from now on: red, green and blue, sRGB.
    NewColor([u8; 3]),
}

/// A request about a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneRequest {
    /// Replaces the text of the script.
    Text(ScriptChange),
    /// Replaces the text of the script by one with more actions, and selects those.
    AddActions(ScriptChange),
    /// Replaces the text by what someone types; the gesture is a word.
    Typed(ScriptChange),
    /// Replaces the text of the project by what someone types; the gesture is a word.
    TypedProject(ScriptChange),
    /// Shows another script of the project, by the name of its file.
    ShowScript(Box<str>),
    /// Selects things of the cast by their ids: replaces, adds or toggles them.
    SelectThings(Vec<Box<str>>, Choice),
    /// Selects an action, or none.
    SelectAction(Option<usize>),
    /// Selects actions: replaces, adds or toggles them.
    SelectActions(Vec<usize>, Choice),
    /// The cursor of the script is at this byte: what is there is selected.
    Cursor(usize),
    /// Hides things, or shows them again.
    Hide(Vec<Box<str>>, bool),
    /// Locks things, or unlocks them.
    Lock(Vec<Box<str>>, bool),
    /// Starts to rename a thing, or ends it.
    Rename(Option<Box<str>>),
    /// Shows this part of time in the timeline; `None` shows all.
    Window(Option<TimeWindow>),
    /// Tells why a gesture was refused.
    Refused(String),
    /// Looks through a camera of the scene, or through the free one.
    Through(ThroughCamera),
    /// Looks through a camera in the second of two views.
    ThroughSecond(ThroughCamera),
    /// Opens the takes and bones of the model of a thing, in place.
    EditModel(Box<str>),
    /// A request about a drawn line.
    Line(LineRequest),
    /// Applies the edits of a model that were made for another file, or removes them.
    Settle(OutdatedEdits, OutdatedEditsChoice),
    /// Asks where a missing file is now.
    Find(MissingFile),
}
