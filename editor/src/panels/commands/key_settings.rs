//! The keys that the user gave to commands, as they are remembered between runs.

use super::id::Id;
use super::preset::Preset;
use super::shortcut::text;
use egui::KeyboardShortcut;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The preset and the keys of single commands.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct KeySettings {
    /// The preset, whose keys apply to every command whose keys the user did not change.
    pub preset: Preset,
    /// Names of commands with the keys that the user gave them, as [`text`] writes them; an empty list: no key at all.
    /// Names and keys that do not exist (any more) are ignored.
    pub own: BTreeMap<String, Vec<String>>,
}

impl KeySettings {
    /// Sets the keys of a command.
    pub fn set(&mut self, id: Id, shortcuts: &[KeyboardShortcut]) {
        self.own.insert(id.name().to_owned(), shortcuts.iter().map(text).collect());
    }

    /// Resets the keys of a command to those of the preset.
    pub fn reset(&mut self, id: Id) {
        self.own.remove(id.name());
    }

    /// Returns whether the user changed the keys of this command.
    pub fn is_own(&self, id: Id) -> bool {
        self.own.contains_key(id.name())
    }
}
