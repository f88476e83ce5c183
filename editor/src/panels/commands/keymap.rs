//! The keys of commands: those of the table, of a preset, and those that the user chose.

use super::Command;
use super::id::Id;
use super::key_settings::{KeyScope, KeySettings};
use super::shortcut::parse;
use egui::{Key, KeyboardShortcut, Modifiers};
use std::collections::HashMap;
use std::sync::Arc;

/// The keys of commands. The keymap in use is in the memory of egui, so that every tooltip can name its keys.
#[derive(Clone, Debug)]
pub struct Keymap {
    settings: KeySettings,
    /// Commands whose keys differ from the table.
    other: HashMap<(KeyScope, Id), Vec<KeyboardShortcut>>,
}

impl Default for Keymap {
    fn default() -> Self {
        Self::new(KeySettings::default())
    }
}

impl Keymap {
    /// Applies `settings`. A shortcut that one layer gives to a command is removed from the commands that have it from
    /// a lower layer: the preset overrides the table, the user overrides the preset.
    pub fn new(settings: KeySettings) -> Self {
        let mut keymap = Self { other: HashMap::new(), settings };
        for scope in KeyScope::ALL {
            for (id, shortcuts) in keymap.settings.preset.table(scope) {
                keymap.give(scope, *id, shortcuts.to_vec());
            }
            let own = keymap.settings.of(scope).clone();
            for (name, shortcuts) in &own {
                if let Some(id) = super::named(name) {
                    keymap.give(scope, id, shortcuts.iter().filter_map(|text| parse(text)).collect());
                }
            }
        }
        keymap
    }

    fn give(&mut self, scope: KeyScope, id: Id, shortcuts: Vec<KeyboardShortcut>) {
        for shortcut in &shortcuts {
            let losers: Vec<Id> = super::all()
                .filter(|command| command.id != id && self.of_command(scope, command).contains(shortcut))
                .map(|command| command.id)
                .collect();
            for loser in losers {
                let own = self.shortcuts(scope, loser);
                let kept = own.iter().filter(|other| *other != shortcut).copied().collect();
                self.other.insert((scope, loser), kept);
            }
        }
        self.other.insert((scope, id), shortcuts);
    }

    /// Returns the keymap in use; the default one before any was installed.
    pub fn of(context: &egui::Context) -> Arc<Self> {
        context.data(|data| data.get_temp::<Arc<Self>>(Self::place())).unwrap_or_default()
    }

    /// Uses these settings from now on; does nothing if they are in use already.
    pub fn install(settings: &KeySettings, context: &egui::Context) {
        if Self::of(context).settings != *settings {
            let keymap = Arc::new(Self::new(settings.clone()));
            context.data_mut(|data| data.insert_temp(Self::place(), keymap));
        }
    }

    /// Returns the keys of a command in a part of the window.
    pub fn shortcuts(&self, scope: KeyScope, id: Id) -> &[KeyboardShortcut] {
        self.of_command(scope, super::get(id))
    }

    /// Returns the key of a command that tooltips name: one that it has everywhere, else one over the keys.
    pub fn first_shortcut(&self, id: Id) -> Option<&KeyboardShortcut> {
        KeyScope::ALL.into_iter().find_map(|scope| self.shortcuts(scope, id).first())
    }

    /// Returns the keys of the command of a row.
    fn of_command(&self, scope: KeyScope, command: &Command) -> &[KeyboardShortcut] {
        let usual = match scope {
            KeyScope::Window => command.shortcuts,
            KeyScope::Keys => &[],
        };
        self.other.get(&(scope, command.id)).map_or(usual, Vec::as_slice)
    }

    /// Returns the command that this shortcut runs by its meaning in a part of the window.
    pub fn command_of(&self, scope: KeyScope, key: Key, modifiers: Modifiers) -> Option<Id> {
        let gives = |shortcut: &KeyboardShortcut| {
            shortcut.logical_key == key && modifiers.matches_exact(shortcut.modifiers)
        };
        let found = |command: &&Command| self.of_command(scope, command).iter().any(gives);
        super::all().find(found).map(|command| command.id)
    }

    /// Returns whether a key is being chosen for a command, so that it must not run another one.
    pub fn is_asking(context: &egui::Context) -> bool {
        context.data(|data| data.get_temp::<bool>(Self::asking())).unwrap_or_default()
    }

    /// Sets whether a key is being chosen for a command.
    pub fn set_asking(context: &egui::Context, asking: bool) {
        context.data_mut(|data| data.insert_temp(Self::asking(), asking));
    }

    fn place() -> egui::Id {
        egui::Id::unique("keymap")
    }

    fn asking() -> egui::Id {
        egui::Id::unique("keymap asks")
    }
}
