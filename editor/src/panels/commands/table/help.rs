//! Help.

use super::*;
use crate::panels::prompts::Overlay;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::Palette, When::Always, "Find a command", &[key(NONE, Key::F3), key(CTRL, Key::P)], "Searches everything the program can do", |w| { w.prompts.toggle(Overlay::Palette); None }),
    command(Id::Shortcuts, When::Always, "Keys and mouse", &[key(NONE, Key::F1), key(SHIFT, Key::Slash), key(SHIFT, Key::Questionmark)], "Shows every shortcut, to be changed; sets of keys as in Blender, Maya, Godot and Unity", |w| { w.prompts.toggle(Overlay::Shortcuts); None }),
    command(Id::About, When::Always, "About Dragonfly", &[], "Version and licenses", |w| { w.prompts.toggle(Overlay::About); None }),
];
