//! A list of lines in a question, which scrolls where it is long.

use super::ask::inset;
use crate::panels::style::{self, GRID};
use crate::panels::theme::Theme;
use egui::{Align, Label, Layout, RichText, ScrollArea, Ui, vec2};

/// Height of a line, in points.
const LINE: f32 = 18.0;

/// Draws the lines; only those in view cost time.
pub(super) fn line_list(ui: &mut Ui, lines: &[String]) {
    let theme = Theme::of(ui);
    inset(theme).inner_margin(2.0 * GRID).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let height = (lines.len() as f32 * LINE).min(320.0);
        ScrollArea::both()
            .max_height(height)
            .min_scrolled_height(height)
            .auto_shrink([false, true])
            .show_rows(ui, LINE, lines.len(), |ui, range| {
                for line in &lines[range] {
                    let text = RichText::new(line).monospace().size(style::SMALL);
                    let room = vec2(ui.available_width(), LINE);
                    ui.allocate_ui_with_layout(room, Layout::left_to_right(Align::Center), |ui| {
                        ui.set_min_height(LINE);
                        ui.add(Label::new(text).extend());
                    });
                }
            });
    });
}
