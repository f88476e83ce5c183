//! Where to find what.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::Palette, When::Always, "Find a command", &[key(NONE, Key::F3), key(CTRL, Key::P)], "Searches everything the program can do"),
    command(Id::Shortcuts, When::Always, "Keys and mouse", &[key(NONE, Key::F1), key(SHIFT, Key::Slash), key(SHIFT, Key::Questionmark)], "Shows every shortcut, to be changed; sets of keys as in Blender, Maya, Godot and Unity"),
    command(Id::About, When::Always, "About Dragonfly", &[], "Version and licences"),
];
