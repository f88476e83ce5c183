//! The table of all commands, a file a category. A new command is a row in a file and its name in [`Id`]: the row names the
//! function that runs it.

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

use super::command::{Command, command};
use super::shortcut::{ALT, CTRL, NONE, SHIFT, key};
use super::{Category, Id, When};
use crate::panels::request::Effect;
use egui::Key;

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
