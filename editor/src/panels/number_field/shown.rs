//! Draws a number field without focus.

use super::{NumberField, RefusedNumber};
use crate::panels::number_text::exact;
use crate::panels::style::{self, RADIUS};
use crate::panels::theme::Theme;
use egui::{Align2, Color32, CornerRadius, FontId, Rect, Response, Stroke, StrokeKind, Ui, pos2, vec2};

impl NumberField<'_> {
    pub(super) fn paint(&self, ui: &Ui, rect: Rect, response: &Response, refused: Option<&RefusedNumber>) {
        let theme = Theme::of(ui);
        let open = self.locked.is_none() && ui.is_enabled();
        let radius = CornerRadius::same(RADIUS);
        let held = ui.ctx().is_being_dragged(self.id);
        let fill = match () {
            () if !open => Color32::TRANSPARENT,
            () if response.hovered() || held => theme.hover,
            () => theme.sunken,
        };
        ui.painter().rect_filled(rect, radius, fill);
        let edge = match () {
            () if refused.is_some() => Some(theme.error),
            () if held => Some(theme.accent),
            // White on nearly white needs a border to be recognizable as a field.
            () if open && !theme.dark => Some(theme.line),
            () => None,
        };
        if let Some(edge) = edge {
            ui.painter().rect_stroke(rect, radius, Stroke::new(1.0, edge), StrokeKind::Inside);
        }
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        let color = if open && !self.quiet { theme.text } else { theme.weak };
        let none = if self.relative { "mixed" } else { "–" };
        let text = self.value.map_or(none.to_owned(), |value| self.digits.text_from(self.grain, value));
        let mut right = rect.right() - 5.0;
        if !self.unit.is_empty() && rect.width() > 64.0 + 7.0 * self.unit.chars().count() as f32 {
            let unit = FontId::proportional(style::SMALL);
            let at = pos2(right, rect.center().y);
            right = painter.text(at, Align2::RIGHT_CENTER, self.unit, unit, theme.faint).left() - 3.0;
        }
        let at = pos2(right, rect.center().y);
        painter.text(at, Align2::RIGHT_CENTER, text, FontId::monospace(style::NUMBER), color);
    }

    pub(super) fn tooltip(&self, ui: &mut Ui) {
        let theme = Theme::of(ui);
        ui.set_max_width(260.0);
        ui.spacing_mut().item_spacing = vec2(4.0, 2.0);
        ui.label(format!("{}{}", self.title(), self.full()));
        if !self.help.is_empty() {
            ui.colored_label(theme.weak, self.help);
        }
        let how = if self.relative {
            "Drag, or click and type: 45/2, pi/4 rad; +5 adds, -=5 subtracts, *2 multiplies. Shift is finer, Ctrl snaps."
        } else {
            "Drag, or click and type: 45/2, pi/4 rad. Shift is finer, Ctrl snaps."
        };
        ui.colored_label(theme.faint, how);
    }

    pub(super) fn title(&self) -> String {
        format!("{}: ", self.name)
    }

    pub(super) fn full(&self) -> String {
        match self.value {
            Some(value) => format!("{}{}", exact(value, self.grain), self.suffix()),
            None => "different values".to_owned(),
        }
    }

    pub(super) fn suffix(&self) -> String {
        match self.unit {
            "" => String::new(),
            "°" => "°".to_owned(),
            unit => format!(" {unit}"),
        }
    }
}
