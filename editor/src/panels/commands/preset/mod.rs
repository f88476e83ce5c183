//! Keys as hands know them from other programs.
//!
//! A preset says only what differs from the table; a key that it gives to a command is taken from the command that has it
//! in the table.

mod blender;
mod game_engines;
mod maya;

use super::id::Id;
use super::shortcut::{ALT, CTRL, NONE, SHIFT, key};
use egui::{Key, KeyboardShortcut};
use serde::{Deserialize, Serialize};

/// What differs from the table.
type Table = &'static [(Id, &'static [KeyboardShortcut])];

/// Whose keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preset {
    /// Those of the table.
    #[default]
    Dragonfly,
    /// Blender's.
    Blender,
    /// Maya's.
    Maya,
    /// Those that Godot and Unity share, or one of them has.
    GameEngines,
}

impl Preset {
    /// All, in the order in which they are offered.
    pub const ALL: &[Self] = &[Self::Dragonfly, Self::Blender, Self::Maya, Self::GameEngines];

    /// Its name on the screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Dragonfly => "Dragonfly",
            Self::Blender => "Blender",
            Self::Maya => "Maya",
            Self::GameEngines => "Godot / Unity",
        }
    }

    /// What differs from the table.
    pub(super) fn table(self) -> Table {
        match self {
            Self::Dragonfly => &[],
            Self::Blender => blender::TABLE,
            Self::Maya => maya::TABLE,
            Self::GameEngines => game_engines::TABLE,
        }
    }
}
