//! Files: open, save, quit.

use super::*;
use crate::panels::actions::files;
use crate::panels::file_choice::FileChoice;
use crate::panels::prompts::Overlay;
use crate::panels::request::FileAction;
use dragonfly_document::Then;
use dragonfly_document::{DocumentMessage, Source};

commands! {
    Open => When::Always, "Open…", [key(CTRL, Key::O)], "Opens a model", |_| Some(Effect::OpenDialog);
    OpenPath => When::Always, "Open by path…", [key(CTRL.plus(SHIFT), Key::O)], "Opens a model by typing or pasting its path, with import options: unit, up axis, handedness, frame rate", |w| { w.prompts.show(Some(Overlay::OpenPath)); None };
    ImportOptions => When::Model, "Import options…", [], "Opens the file again with another unit, up axis, handedness or frame rate (scale, import settings)", |w| { w.prompts.show(Some(Overlay::ImportOptions)); None };
    OpenBuiltIn => When::Always, "Built-in dragonfly", [], "Opens the built-in example model", |_| Some(Effect::File(FileAction::Leave(Then::Open(Source::BuiltIn))));
    ImportTakes => When::Model, "Import takes…", [], "Adds the takes of other files to the model: bones are matched by name, other figures are retargeted (clips, animations, captures)", |w| Some(Effect::Choose(FileChoice::Takes, w.read().model_folder()));
    CancelLoading => When::Loading, "Stop loading", [], "Cancels loading, or copying the files of a scene, and keeps the open model", |_| Some(Effect::File(FileAction::Send(DocumentMessage::CancelLoading)));
    Save => When::Model, "Save", [key(CTRL, Key::S)], "Saves the model; every byte of the file that was not edited stays as it is", files::save;
    SaveAs => When::Model, "Save as…", [key(CTRL.plus(SHIFT), Key::S)], "Saves to another file, and continues with that file", |_| Some(Effect::File(FileAction::Where { copy: false, then: None }));
    SaveCopy => When::Model, "Save a copy…", [], "Saves to another file, and continues with the current file", |_| Some(Effect::File(FileAction::Where { copy: true, then: None }));
    Export => When::Model, "Export…", [key(CTRL.plus(SHIFT), Key::E)], "Writes the model or its takes in another format, for other programs, and lists what the file cannot contain (fbx, glTF, bvh, obj, convert)", |w| { w.prompts.show(Some(Overlay::Export)); None };
    Revert => When::Unsaved, "Revert to saved", [], "Discards the changes since the last save; Redo restores them", |_| Some(Effect::File(FileAction::Send(DocumentMessage::Revert)));
    Reload => When::Model, "Reload with changes", [], "Opens the file again as it is on disk now, and applies the unsaved changes to it", |_| Some(Effect::File(FileAction::Send(DocumentMessage::Reload)));
    WhatWillBeSaved => When::Model, "What will be saved…", [], "Lists the changes that a save would make, without writing", |_| Some(Effect::File(FileAction::Send(DocumentMessage::Plan(None))));
    ToggleShowChanges => When::Always, "Show changes before saving", [], "Lists the changes before each save", |w| { w.settings.show_changes ^= true; None };
    UnsavedWork => When::Always, "Unsaved work…", [], "Lists unsaved work of earlier runs, to recover it", |_| Some(Effect::File(FileAction::Send(DocumentMessage::Search)));
    Quit => When::Always, "Quit", [key(CTRL, Key::Q)], "Ends the program", |_| Some(Effect::File(FileAction::Leave(Then::Quit)));
}
