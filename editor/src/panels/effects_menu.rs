//! The menu View > Effects: one line for each effect of the scene.

use super::commands::Id;
use super::context::PanelContext;
use super::menu_entries::item;
use super::request::Request;
use dragonfly_picture::EffectLook;
use egui::Ui;

/// Returns the command that switches each effect, and whether it is on.
fn switches(effects: &EffectLook) -> [(Id, bool); 2] {
    [(Id::ToggleShadows, effects.shadows), (Id::ToggleStudioShadows, effects.studio_shadows)]
}

/// Draws the entries.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    for (id, on) in switches(&context.settings.look.effects) {
        item(ui, context, id, on, requests);
    }
}
