//! The table of all commands, one file for each category. A new command is one row in one of these files: name,
//! condition, title, keys, help, the function that runs it, and `repeats` if a held key runs it repeatedly.

/// Declares the commands of a category, `COMMANDS`, and the id of each from a list of rows. The name is the one that
/// settings store, so it never changes; two commands with the same name are refused by the compiler.
macro_rules! commands {
    ($($name:ident => $when:expr, $title:expr, $shortcuts:expr, $help:expr, $run:expr $(, $repeats:ident)?;)*) => {
        #[allow(non_upper_case_globals, reason = "an id has the name of its command")]
        impl Id {
            $(#[doc = $help] pub const $name: Self = Self::new(stringify!($name));)*
        }

        pub(super) const COMMANDS: &[Command] = &[$(Command {
            id: Id::$name,
            title: $title,
            shortcuts: &$shortcuts,
            help: $help,
            when: $when,
            repeats: commands!(@ $($repeats)?),
            run: $run,
        },)*];
    };
    (@) => { false };
    (@ repeats) => { true };
}

mod camera;
mod contacts;
mod edit;
mod file;
mod help;
mod inbetween;
mod keys;
mod layers;
mod look;
mod playback;
mod pose;
mod scene;
mod selection;
mod takes;
mod tools;
mod window;

use super::command::Command;
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
    (Category::InBetween, inbetween::COMMANDS),
    (Category::Takes, takes::COMMANDS),
    (Category::Contacts, contacts::COMMANDS),
    (Category::Layers, layers::COMMANDS),
    (Category::Scene, scene::COMMANDS),
    (Category::Selection, selection::COMMANDS),
    (Category::Tools, tools::COMMANDS),
    (Category::Camera, camera::COMMANDS),
    (Category::Look, look::COMMANDS),
    (Category::Window, window::COMMANDS),
    (Category::Help, help::COMMANDS),
];
