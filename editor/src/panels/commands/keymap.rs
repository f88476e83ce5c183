//! Which keys give which command.

use super::Id;
use egui::KeyboardShortcut;
use std::sync::Arc;

/// Which keys give which command. The one in use lies in the memory of egui, so that every tooltip can name its keys.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Keymap {}

impl Keymap {
    /// The one in use; the usual one before any was put there.
    pub fn of(context: &egui::Context) -> Arc<Self> {
        context.data(|data| data.get_temp::<Arc<Self>>(Self::place())).unwrap_or_default()
    }

    /// Uses this one from now on.
    pub fn install(self: Arc<Self>, context: &egui::Context) {
        context.data_mut(|data| data.insert_temp(Self::place(), self));
    }

    /// The keys of a command; the first is the one that tooltips name.
    pub fn shortcuts(&self, id: Id) -> &[KeyboardShortcut] {
        super::get(id).shortcuts
    }

    fn place() -> egui::Id {
        egui::Id::unique("keymap")
    }
}
