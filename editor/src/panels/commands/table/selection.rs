//! Which bones are chosen.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ClearSelection, When::Always, "Select nothing", &[key(NONE, Key::Escape)], "Clears the selection"),
    command(Id::SelectParent, When::Model, "Parent bone", &[key(NONE, Key::OpenBracket)], "Selects the parent of the selected bone"),
    command(Id::SelectChild, When::Model, "Child bone", &[key(NONE, Key::CloseBracket)], "Selects the first child of the selected bone"),
    command(Id::Find, When::Model, "Find a bone", &[key(CTRL, Key::F)], "Puts the cursor into the search field of the skeleton"),
];
