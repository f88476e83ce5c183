//! A row of the panel: the name of a tool, its slider and its number.

use super::InBetweenTool;
use crate::control::expression::Quantity;
use crate::panels::number_field::{FieldEvent, NumberField};
use crate::panels::number_slider::NumberSlider;
use crate::panels::style::{CONTROL, GRID};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use egui::{Id, Rect, Sense, TextStyle, Ui, pos2, vec2};

/// Smallest width of a row.
pub(super) const NARROWEST: f32 = 220.0;
/// Width of the name.
const NAME: f32 = 82.0;
/// Width of the number.
const NUMBER: f32 = 80.0;

/// A tool as its row shows it.
pub(super) struct Row {
    pub(super) tool: InBetweenTool,
    pub(super) value: f64,
    /// Reason why it cannot be used; `None` if it can.
    pub(super) locked: Option<&'static str>,
}

impl Row {
    /// Draws the row. Returns what the user did with the slider or the number.
    pub(super) fn show(self, ui: &mut Ui) -> FieldEvent {
        let tool = self.tool;
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), CONTROL), Sense::hover());
        let rect = rect.shrink2(vec2(2.0 * GRID, 0.0));
        let theme = Theme::of(ui);
        let name = Rect::from_min_max(rect.min, pos2(rect.left() + NAME, rect.bottom()));
        let color = if self.locked.is_some() { theme.faint } else { theme.text };
        widgets::text_in(ui, name, tool.title(), &TextStyle::Body, color);
        let help = match self.locked {
            Some(why) => format!("{}\n{}\n{why}", tool.title(), tool.help()),
            None => format!("{}\n{}", tool.title(), tool.help()),
        };
        ui.interact(name, ui.scope_id().with(("name", tool)), Sense::hover()).on_hover_text(help);
        let number = Rect::from_min_max(pos2(rect.right() - NUMBER, rect.top()), rect.max);
        let line = Rect::from_min_max(
            pos2(name.right() + 2.0 * GRID, rect.top()),
            pos2(number.left() - 3.0 * GRID, rect.bottom()),
        );
        let slider = NumberSlider {
            id: Id::unique(("in-between slider", tool)),
            name: &format!("{} slider", tool.title()),
            value: Some(self.value),
            scale: tool.scale(),
            snap: tool.snap(),
            color: theme.accent,
            enabled: self.locked.is_none(),
        };
        let by_slider = if line.width() > 24.0 { slider.show(ui, line) } else { FieldEvent::Nothing };
        let field = NumberField {
            id: Id::unique(("in-between number", tool)),
            name: tool.title(),
            value: Some(self.value),
            quantity: Quantity::Number,
            unit: tool.unit(),
            speed: tool.snap() * 0.2,
            snap: tool.snap(),
            grain: 1e-9,
            digits: tool.digits(),
            range: tool.range(),
            locked: self.locked,
            help: tool.help(),
            quiet: self.value == tool.neutral(),
            relative: false,
        };
        let (by_number, _) = field.show(ui, number);
        if by_number == FieldEvent::Nothing { by_slider } else { by_number }
    }
}
