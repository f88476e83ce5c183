//! Files: what is opened, saved, left.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::Open, When::Always, "Open…", &[key(CTRL, Key::O)], "Opens a model"),
    command(Id::OpenPath, When::Always, "Open by path…", &[key(CTRL.plus(SHIFT), Key::O)], "Opens a model whose path is typed or pasted"),
    command(Id::OpenBuiltIn, When::Always, "Built-in dragonfly", &[], "Opens the model that is part of the program"),
    command(Id::CancelLoading, When::Loading, "Stop loading", &[], "Keeps what is open and forgets what is being loaded"),
    command(Id::Save, When::Model, "Save", &[key(CTRL, Key::S)], "Saves the model; every byte of the file that was not edited stays as it is"),
    command(Id::SaveAs, When::Model, "Save as…", &[key(CTRL.plus(SHIFT), Key::S)], "Saves to another file, and goes on with that one"),
    command(Id::SaveCopy, When::Model, "Save a copy…", &[], "Saves to another file, and goes on with this one"),
    command(Id::Revert, When::Unsaved, "Revert to saved", &[], "Goes back to what is in the file; Redo brings the changes again"),
    command(Id::WhatWillBeSaved, When::Model, "What will be saved…", &[], "Lists what a save would change in the file, and writes nothing"),
    command(Id::ToggleShowChanges, When::Always, "Show changes before saving", &[], "Lists what a save will change each time before it is written"),
    command(Id::UnsavedWork, When::Always, "Unsaved work…", &[], "Looks for work that was not saved when the program ended"),
    command(Id::Quit, When::Always, "Quit", &[key(CTRL, Key::Q)], "Ends the program"),
];
