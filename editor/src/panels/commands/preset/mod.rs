//! Sets of keys that users know from other programs.
//!
//! A preset contains only what differs from the table; a key that the preset gives to a command is removed from the
//! command that has this key in the table. A new preset is a file here and a line in the list `presets!`.

mod blender;
mod game_engines;
mod maya;

use super::id::Id;
use super::key_settings::KeyScope;
use super::shortcut::{ALT, CTRL, NONE, PresetKeys, SHIFT, key};
use egui::Key;
use serde::{Deserialize, Serialize};

/// Declares [`Preset`] from a list of `Name => "name on the screen", file;` lines. The name is the one that settings store, so
/// it never changes. The file has two tables: keys, and those over the timeline and the curves.
macro_rules! presets {
    ($($Name:ident => $title:literal, $file:ident;)*) => {
        /// A set of keys.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
        pub enum Preset {
            /// The keys of the table.
            #[default]
            Dragonfly,
            $(#[doc = concat!("The keys of ", $title, ".")] $Name,)*
        }

        impl Preset {
            /// All presets, in the order in which they are offered.
            pub const ALL: &[Self] = &[Self::Dragonfly, $(Self::$Name),*];

            /// Returns its name on the screen.
            pub fn title(self) -> &'static str {
                match self { Self::Dragonfly => "Dragonfly", $(Self::$Name => $title,)* }
            }

            /// Returns the commands with keys that differ from the table in a part of the window.
            pub(super) fn table(self, scope: KeyScope) -> PresetKeys {
                match (scope, self) {
                    (KeyScope::Window, Self::Dragonfly) => &[],
                    (KeyScope::Keys, Self::Dragonfly) => OVER_KEYS,
                    $((KeyScope::Window, Self::$Name) => $file::TABLE,
                    (KeyScope::Keys, Self::$Name) => $file::OVER_KEYS,)*
                }
            }
        }
    };
}

presets! {
    Blender => "Blender", blender;
    Maya => "Maya", maya;
    GameEngines => "Godot / Unity", game_engines;
}

#[rustfmt::skip] // A table is read in columns.
const OVER_KEYS: PresetKeys = &[
    (Id::SelectAllKeys, &[key(CTRL, Key::A)]),
    (Id::BoxSelectKeys, &[key(NONE, Key::B)]),
    (Id::InterpolationMenu, &[key(NONE, Key::T)]),
    (Id::TangentMenu, &[key(NONE, Key::V)]),
];
