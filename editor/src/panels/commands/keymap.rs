//! The keys of commands: those of the table, of a preset, and those that the user chose.

use super::Command;
use super::id::Id;
use super::key_settings::KeySettings;
use super::shortcut::parse;
use egui::{Key, KeyboardShortcut, Modifiers};
use std::collections::HashMap;
use std::sync::Arc;

/// The keys of commands. The keymap in use is in the memory of egui, so that every tooltip can name its keys.
#[derive(Clone, Debug, Default)]
pub struct Keymap {
    settings: KeySettings,
    /// Commands whose keys differ from the table.
    other: HashMap<Id, Vec<KeyboardShortcut>>,
}

impl Keymap {
    /// Applies `settings`. A shortcut that one layer gives to a command is removed from the commands that have it from
    /// a lower layer: the preset overrides the table, the user overrides the preset.
    pub fn new(settings: KeySettings) -> Self {
        let mut keymap = Self { other: HashMap::new(), settings };
        for (id, shortcuts) in keymap.settings.preset.table() {
            keymap.give(*id, shortcuts.to_vec());
        }
        let own = keymap.settings.own.clone();
        for (name, shortcuts) in &own {
            if let Some(id) = super::named(name) {
                keymap.give(id, shortcuts.iter().filter_map(|text| parse(text)).collect());
            }
        }
        keymap
    }

    fn give(&mut self, id: Id, shortcuts: Vec<KeyboardShortcut>) {
        for shortcut in &shortcuts {
            let losers: Vec<Id> = super::all()
                .filter(|command| command.id != id && self.of_command(command).contains(shortcut))
                .map(|command| command.id)
                .collect();
            for loser in losers {
                let kept = self.shortcuts(loser).iter().filter(|other| *other != shortcut).copied().collect();
                self.other.insert(loser, kept);
            }
        }
        self.other.insert(id, shortcuts);
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

    /// Returns the keys of a command; tooltips name the first.
    pub fn shortcuts(&self, id: Id) -> &[KeyboardShortcut] {
        self.of_command(super::get(id))
    }

    /// Returns the keys of the command of a row.
    fn of_command(&self, command: &Command) -> &[KeyboardShortcut] {
        self.other.get(&command.id).map_or(command.shortcuts, Vec::as_slice)
    }

    /// Returns the command that this shortcut runs.
    pub fn command_of(&self, key: Key, modifiers: Modifiers) -> Option<Id> {
        let gives = |shortcut: &KeyboardShortcut| {
            shortcut.logical_key == key && modifiers.matches_exact(shortcut.modifiers)
        };
        super::all().find(|command| self.of_command(command).iter().any(gives)).map(|command| command.id)
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
