//! What was done, undone and done again.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::Undo, When::Undo, "Undo", &[key(CTRL, Key::Z)], "Takes the last step back"),
    command(Id::Redo, When::Redo, "Redo", &[key(CTRL.plus(SHIFT), Key::Z), key(CTRL, Key::Y)], "Does again what was undone"),
];
