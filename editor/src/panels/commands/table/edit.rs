//! Undo, redo, copy and paste.

use super::*;
use crate::panels::actions::clipboard;
use dragonfly_document::Change;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::Undo, When::Undo, "Undo", &[key(CTRL, Key::Z)], "Takes the last step back", |_| Some(Effect::Change(Change::Undo))),
    command(Id::Redo, When::Redo, "Redo", &[key(CTRL.plus(SHIFT), Key::Z), key(CTRL, Key::Y)], "Does again what was undone", |_| Some(Effect::Change(Change::Redo))),
    command(Id::Copy, When::Model, "Copy", &[key(CTRL, Key::C)], "Copies the selected keys where the timeline was touched last, else the pose of the selected bones, or of all", clipboard::copy),
    command(Id::CutKeys, When::Keys, "Cut keys", &[key(CTRL, Key::X)], "Copies the selected keys and deletes them", clipboard::cut_keys),
    command(Id::PastePose, When::Take, "Paste", &[key(CTRL, Key::V)], "Puts the copied keys in at the playhead, or the copied pose on; keys go to the bones they are of, or to as many others that are selected", |_| Some(Effect::PastePose { mirrored: false })),
];
