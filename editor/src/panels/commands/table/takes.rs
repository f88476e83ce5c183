//! Takes: created, named, split, ordered.

use super::*;
use crate::panels::actions::takes;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::NewTake, When::Model, "New take", &[], "Creates a take with the rest pose", takes::create),
    command(Id::DuplicateTake, When::Take, "Duplicate take", &[], "Copies the take that is shown", takes::duplicate),
    command(Id::RenameTake, When::Take, "Rename take", &[key(NONE, Key::F2)], "Renames the take", |w| { takes::rename_shown(w); None }),
    command(Id::DeleteTake, When::OtherTakes, "Delete take", &[], "Deletes the take from the model; the last one stays", takes::delete),
    command(Id::MoveTakeUp, When::OtherTakes, "Move take up", &[key(CTRL, Key::PageUp)], "Puts the take one place earlier in the list", |w| takes::move_in_list(w, -1)),
    command(Id::MoveTakeDown, When::OtherTakes, "Move take down", &[key(CTRL, Key::PageDown)], "Puts the take one place later in the list", |w| takes::move_in_list(w, 1)),
    command(Id::SplitTake, When::Take, "Split take here", &[], "Splits the take in two at the time shown", takes::split),
    command(Id::TrimTake, When::Take, "Trim take to what plays", &[], "Deletes all keys outside the play range", takes::trim),
    command(Id::RetimeTake, When::Take, "Start and length…", &[], "Moves and stretches the take in time: all its keys move along", |w| { takes::ask_times(w); None }),
    command(Id::ReverseTake, When::Take, "Reverse take", &[], "Reverses the take in time", takes::reverse),
];
