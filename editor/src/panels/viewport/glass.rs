//! The background of the overlays in the viewport, and the lines between their parts.

use crate::panels::theme::Theme;
use egui::{CornerRadius, Rect, Sense, Stroke, Ui, vec2};

/// Draws the background of an overlay.
pub(super) fn glass(ui: &Ui, rect: Rect) {
    let theme = Theme::of(ui);
    let stroke = Stroke::new(1.0, theme.glass_line);
    ui.painter().rect(rect, CornerRadius::same(6), theme.glass, stroke, egui::StrokeKind::Inside);
}

pub(super) fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(7.0, 16.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), Stroke::new(1.0, Theme::of(ui).glass_line));
}

pub(super) fn divider_across(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(16.0, 7.0), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(1.0, Theme::of(ui).glass_line));
}
