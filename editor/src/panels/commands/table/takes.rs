//! Takes: created, named, split, ordered.

use super::*;
use crate::panels::actions::takes;

commands! {
    NewTake => When::Model, "New take", [], "Creates a take that contains the rest pose", takes::create;
    DuplicateTake => When::Take, "Duplicate take", [], "Duplicates the shown take", takes::duplicate;
    RenameTake => When::Take, "Rename take", [key(NONE, Key::F2)], "Renames the take", |w| { takes::rename_shown(w); None };
    DeleteTake => When::OtherTakes, "Delete take", [], "Deletes the take from the model; the only take cannot be deleted", takes::delete;
    MoveTakeUp => When::OtherTakes, "Move take up", [key(CTRL, Key::PageUp)], "Moves the take one position up in the list", |w| takes::move_in_list(w, -1);
    MoveTakeDown => When::OtherTakes, "Move take down", [key(CTRL, Key::PageDown)], "Moves the take one position down in the list", |w| takes::move_in_list(w, 1);
    SplitTake => When::Take, "Split take here", [], "Splits the take in two at the playhead", takes::split;
    TrimTake => When::Take, "Trim take to play range", [], "Deletes all keys outside the play range", takes::trim;
    RetimeTake => When::Take, "Change start and length…", [], "Moves and stretches all keys of the take in time", |w| { takes::ask_times(w); None };
    ReverseTake => When::Take, "Reverse take", [], "Reverses the take in time", takes::reverse;
}
