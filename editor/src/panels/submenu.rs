//! Menus in menus.

use egui::Ui;

/// Width at the left of the entries, where a check mark is, points.
pub(super) const GUTTER: f32 = 20.0;

/// Draws a button that opens a menu, with its title below those of the other entries.
pub(super) fn submenu<R>(
    ui: &mut Ui,
    title: impl Into<egui::WidgetText>,
    entries: impl FnOnce(&mut Ui) -> R,
) {
    ui.scope(|ui| {
        ui.spacing_mut().button_padding.x += GUTTER;
        let title: egui::WidgetText = title.into();
        ui.menu_button(title, entries);
    });
}

/// Draws an entry that is no command, with its title below those of the others.
pub(super) fn entry(ui: &mut Ui, title: &str) -> egui::Response {
    ui.scope(|ui| {
        ui.spacing_mut().button_padding.x += GUTTER;
        ui.add(egui::Button::new(title).frame_when_inactive(false))
    })
    .inner
}
