//! A warning or an error next to the pointer, where the user looks, for some seconds. The status line shows it, too.

use super::context::PanelContext;
use super::status_line::{sentence, tone};
use super::style::GRID;
use super::theme::Theme;
use egui::{Pos2, Sense, Ui, vec2};

/// The newest warning or error, and the place where it is shown.
#[derive(Debug, Default)]
pub(super) struct Toast {
    /// Number of the message, and the position of the pointer when it was shown first.
    shown: Option<(u64, Pos2)>,
}

/// Greatest width of the text, points.
const WIDTH: f32 = 320.0;

impl Toast {
    /// Draws the message, unless the pointer is outside of the window. It neither takes clicks nor moves with the pointer.
    pub(super) fn show(&mut self, ui: &Ui, context: &PanelContext<'_>) {
        let Some((number, line)) = context.status.toast() else { return };
        if self.shown.is_none_or(|(shown, _)| shown != number) {
            self.shown = ui.ctx().pointer_latest_pos().map(|at| (number, at));
        }
        let Some((_, at)) = self.shown else { return };
        let (icon, color) = tone(line.level, Theme::of(ui));
        let area = egui::Area::new(egui::Id::unique("toast"))
            .order(egui::Order::Tooltip)
            .fixed_pos(at + vec2(16.0, 20.0))
            .constrain(true)
            .interactable(false);
        area.show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(WIDTH);
                ui.horizontal_top(|ui| {
                    let (mark, _) = ui.allocate_exact_size(vec2(16.0, 16.0), Sense::hover());
                    icon.paint(ui.painter(), mark, color);
                    ui.add_space(GRID);
                    ui.add(egui::Label::new(sentence(line)).wrap());
                });
            });
        });
    }
}
