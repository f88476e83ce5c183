//! Takes: created, named, split, ordered.

use super::*;
use crate::panels::actions::takes;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::NewTake, When::Model, "New take", &[], "Creates a take that contains the rest pose", takes::create),
    command(Id::DuplicateTake, When::Take, "Duplicate take", &[], "Duplicates the shown take", takes::duplicate),
    command(Id::RenameTake, When::Take, "Rename take", &[key(NONE, Key::F2)], "Renames the take", |w| { takes::rename_shown(w); None }),
    command(Id::DeleteTake, When::OtherTakes, "Delete take", &[], "Deletes the take from the model; the last take cannot be deleted", takes::delete),
    command(Id::MoveTakeUp, When::OtherTakes, "Move take up", &[key(CTRL, Key::PageUp)], "Moves the take one position up in the list", |w| takes::move_in_list(w, -1)),
    command(Id::MoveTakeDown, When::OtherTakes, "Move take down", &[key(CTRL, Key::PageDown)], "Moves the take one position down in the list", |w| takes::move_in_list(w, 1)),
    command(Id::SplitTake, When::Take, "Split take here", &[], "Splits the take in two at the playhead", takes::split),
    command(Id::TrimTake, When::Take, "Trim take to what plays", &[], "Deletes all keys outside the play range", takes::trim),
    command(Id::RetimeTake, When::Take, "Start and length…", &[], "Moves and stretches all keys of the take in time", |w| { takes::ask_times(w); None }),
    command(Id::ReverseTake, When::Take, "Reverse take", &[], "Reverses the take in time", takes::reverse),
];
