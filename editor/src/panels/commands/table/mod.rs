//! The table of all commands, a file a category. Adding one: a line in a file, its name in [`Id`], its deed in
//! [`super::super::execute`].

mod camera;
mod edit;
mod file;
mod help;
mod keys;
mod look;
mod playback;
mod pose;
mod selection;
mod takes;
mod tools;
mod window;

use super::{Category, Command, Id, When};
use egui::{Key, KeyboardShortcut, Modifiers};

pub(super) const NONE: Modifiers = Modifiers::NONE;
pub(super) const CTRL: Modifiers = Modifiers::COMMAND;
pub(super) const SHIFT: Modifiers = Modifiers::SHIFT;
pub(super) const ALT: Modifiers = Modifiers::ALT;

pub(super) const fn key(modifiers: Modifiers, key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(modifiers, key)
}

const fn command(
    id: Id,
    when: When,
    title: &'static str,
    shortcuts: &'static [KeyboardShortcut],
    help: &'static str,
) -> Command {
    Command { id, title, shortcuts, help, when }
}

/// The commands of each category, in the order in which they are shown.
pub const TABLE: &[(Category, &[Command])] = &[
    (Category::File, file::COMMANDS),
    (Category::Edit, edit::COMMANDS),
    (Category::Pose, pose::COMMANDS),
    (Category::Playback, playback::COMMANDS),
    (Category::Keys, keys::COMMANDS),
    (Category::Takes, takes::COMMANDS),
    (Category::Selection, selection::COMMANDS),
    (Category::Tools, tools::COMMANDS),
    (Category::Camera, camera::COMMANDS),
    (Category::Look, look::COMMANDS),
    (Category::Window, window::COMMANDS),
    (Category::Help, help::COMMANDS),
];
