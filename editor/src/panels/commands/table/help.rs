//! Help.

use super::*;
use crate::panels::prompts::Overlay;

commands! {
    Palette => When::Always, "Find a command", [key(NONE, Key::F3), key(CTRL, Key::P)], "Searches all commands and takes", |w| { w.prompts.toggle(Overlay::Palette); None };
    Shortcuts => When::Always, "Shortcuts", [key(NONE, Key::F1), key(SHIFT, Key::Slash), key(SHIFT, Key::Questionmark)], "Shows and edits all shortcuts; with presets of Blender, Maya, Godot and Unity", |w| { w.prompts.toggle(Overlay::Shortcuts); None };
    About => When::Always, "About Dragonfly", [], "Shows the version and the licenses", |w| { w.prompts.toggle(Overlay::About); None };
}
