//! Help.

use super::*;
use crate::panels::prompts::Overlay;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::Palette, When::Always, "Find a command", &[key(NONE, Key::F3), key(CTRL, Key::P)], "Searches all commands and takes", |w| { w.prompts.toggle(Overlay::Palette); None }),
    command(Id::Shortcuts, When::Always, "Keys and mouse", &[key(NONE, Key::F1), key(SHIFT, Key::Slash), key(SHIFT, Key::Questionmark)], "Shows and edits all shortcuts; with presets of Blender, Maya, Godot and Unity", |w| { w.prompts.toggle(Overlay::Shortcuts); None }),
    command(Id::About, When::Always, "About Dragonfly", &[], "Shows the version and the licenses", |w| { w.prompts.toggle(Overlay::About); None }),
];
