//! The keys that the user gave to commands, as they are remembered between runs.

use super::id::Id;
use super::preset::Preset;
use super::shortcut::text;
use egui::KeyboardShortcut;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The part of the window in which a key runs a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KeyScope {
    /// Everywhere.
    Window,
    /// While the pointer is over the timeline or the curves; these keys come before the others.
    Keys,
}

impl KeyScope {
    /// Both, in the order in which they are shown.
    pub const ALL: [Self; 2] = [Self::Window, Self::Keys];
}

/// The preset and the keys of single commands.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct KeySettings {
    /// The preset, whose keys apply to every command whose keys the user did not change.
    pub preset: Preset,
    /// Names of commands with the keys that the user gave them, as [`text`] writes them; an empty list: no key at all.
    /// Names and keys that do not exist (any more) are ignored.
    pub own: BTreeMap<String, Vec<String>>,
    /// As [`Self::own`], for the keys that commands have while the pointer is over the timeline or the curves.
    pub over_keys: BTreeMap<String, Vec<String>>,
}

impl KeySettings {
    /// Sets the keys that a command has in a part of the window.
    pub fn set(&mut self, scope: KeyScope, id: Id, shortcuts: &[KeyboardShortcut]) {
        self.scope_mut(scope).insert(id.name().to_owned(), shortcuts.iter().map(text).collect());
    }

    /// Resets the keys that a command has in a part of the window to those of the preset.
    pub fn reset(&mut self, scope: KeyScope, id: Id) {
        self.scope_mut(scope).remove(id.name());
    }

    /// Returns whether the user changed the keys that this command has in a part of the window.
    pub fn is_own(&self, scope: KeyScope, id: Id) -> bool {
        self.of(scope).contains_key(id.name())
    }

    /// Returns whether the user changed no key.
    pub fn is_preset(&self) -> bool {
        self.own.is_empty() && self.over_keys.is_empty()
    }

    /// Returns the keys that the user gave to commands in a part of the window.
    pub(super) fn of(&self, scope: KeyScope) -> &BTreeMap<String, Vec<String>> {
        match scope {
            KeyScope::Window => &self.own,
            KeyScope::Keys => &self.over_keys,
        }
    }

    fn scope_mut(&mut self, scope: KeyScope) -> &mut BTreeMap<String, Vec<String>> {
        match scope {
            KeyScope::Window => &mut self.own,
            KeyScope::Keys => &mut self.over_keys,
        }
    }
}
