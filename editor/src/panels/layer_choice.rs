//! The layer whose keys are shown and edited.

use dragonfly_document::adapter::TakeId;

/// The chosen layer. A layer that is gone, or of a take that is not shown, is not active: then the take itself is edited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LayerChoice {
    chosen: Option<TakeId>,
    /// Whether the next new layer is to be chosen.
    awaits_new: bool,
}

impl LayerChoice {
    /// Returns the chosen layer; `None` for the take itself.
    pub fn chosen(self) -> Option<TakeId> {
        self.chosen
    }

    /// Chooses a layer; `None` chooses the take itself.
    pub(super) fn choose(&mut self, layer: Option<TakeId>) {
        self.chosen = layer;
    }

    /// Chooses the next layer that is added.
    pub(super) fn choose_next_new(&mut self) {
        self.awaits_new = true;
    }

    /// Compares the layers with those before: a layer that was to be chosen when it is added is chosen. Returns whether it was.
    pub(super) fn update(&mut self, before: &[TakeId], now: &[TakeId]) -> bool {
        let new = now.iter().find(|id| !before.contains(id)).filter(|_| self.awaits_new);
        if new.is_some() {
            self.chosen = new.copied();
            self.awaits_new = false;
        }
        new.is_some()
    }
}
