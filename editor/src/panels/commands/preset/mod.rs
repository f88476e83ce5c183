//! Sets of keys that users know from other programs.
//!
//! A preset contains only what differs from the table; a key that it gives to a command is removed from the command that has
//! it in the table.

mod blender;
mod game_engines;
mod maya;

use super::id::Id;
use super::shortcut::{ALT, CTRL, NONE, PresetKeys, SHIFT, key};
use egui::Key;
use serde::{Deserialize, Serialize};

/// A set of keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preset {
    /// The keys of the table.
    #[default]
    Dragonfly,
    /// The keys of Blender.
    Blender,
    /// The keys of Maya.
    Maya,
    /// The keys that Godot and Unity share, or that one of them has.
    GameEngines,
}

impl Preset {
    /// All presets, in the order in which they are offered.
    pub const ALL: &[Self] = &[Self::Dragonfly, Self::Blender, Self::Maya, Self::GameEngines];

    /// Returns its name on the screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Dragonfly => "Dragonfly",
            Self::Blender => "Blender",
            Self::Maya => "Maya",
            Self::GameEngines => "Godot / Unity",
        }
    }

    /// Returns the commands with keys that differ from the table.
    pub(super) fn table(self) -> PresetKeys {
        match self {
            Self::Dragonfly => &[],
            Self::Blender => blender::TABLE,
            Self::Maya => maya::TABLE,
            Self::GameEngines => game_engines::TABLE,
        }
    }
}
