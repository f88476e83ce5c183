//! Undo, redo, copy and paste.

use super::*;
use crate::panels::actions::{clipboard, undo};

commands! {
    Undo => When::Undo, "Undo", [key(CTRL, Key::Z)], "Undoes the last step", undo::undo;
    Redo => When::Redo, "Redo", [key(CTRL.plus(SHIFT), Key::Z), key(CTRL, Key::Y)], "Redoes the step that was undone", undo::redo;
    UndoSelections => When::Always, "Undo includes selections", [], "Makes undo and redo also go back and forth through selections of bones and keys", |w| { undo::toggle_selections(w); None };
    Copy => When::Model, "Copy", [key(CTRL, Key::C)], "Copies the selected keys if the timeline was used last, otherwise the pose of the selected bones, or of all bones", clipboard::copy;
    CutKeys => When::Keys, "Cut keys", [key(CTRL, Key::X)], "Copies the selected keys and deletes them", clipboard::cut_keys;
    PastePose => When::Take, "Paste", [key(CTRL, Key::V)], "Pastes the copied keys at the playhead, or the copied pose; keys go to their own bones, or to the same number of other selected bones", |_| Some(Effect::PastePose { mirrored: false });
}
