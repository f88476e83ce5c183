//! A row of the list: the name of a shape key, a slider for its weight, and the number.

use crate::control::expression::Quantity;
use crate::panels::number_field::{FieldEvent, NumberField};
use crate::panels::number_slider::{NumberSlider, SliderScale};
use crate::panels::number_text::Digits;
use crate::panels::style::{CONTROL, GRID};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use egui::{Id, Rect, Response, Sense, TextStyle, Ui, pos2, vec2};

/// Width of the number, points.
const NUMBER: f32 = 52.0;
/// Part of the remaining width that the name gets.
const NAME: f32 = 0.5;
/// Smallest and largest weight that can be typed.
const RANGE: f64 = 100.0;

/// A shape key as its row shows it.
pub(super) struct ShapeRow<'a> {
    pub(super) instance: u32,
    pub(super) shape: usize,
    pub(super) mesh: &'a str,
    pub(super) name: &'a str,
    pub(super) weight: f64,
    /// Weight where nothing animates it.
    pub(super) rest: f64,
    /// Whether the weight is pending: shown, but in no key.
    pub(super) pending: bool,
    /// Reason why it cannot be changed; `None` if it can.
    pub(super) locked: Option<&'static str>,
}

impl ShapeRow<'_> {
    /// Draws the row. Returns what the user did with the slider or the number, and the response of the name.
    pub(super) fn show(&self, ui: &mut Ui) -> (FieldEvent, Response) {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), CONTROL), Sense::hover());
        let rect = rect.shrink2(vec2(2.0 * GRID, 0.0));
        let theme = Theme::of(ui);
        let number = Rect::from_min_max(pos2(rect.right() - NUMBER, rect.top()), rect.max);
        let middle = rect.left() + NAME * (number.left() - rect.left());
        let name = Rect::from_min_max(rect.min, pos2(middle - 2.0 * GRID, rect.bottom()));
        let line =
            Rect::from_min_max(pos2(middle, rect.top()), pos2(number.left() - 2.0 * GRID, rect.bottom()));
        let is_rest = (self.weight - self.rest).abs() < 1e-6;
        let color = match () {
            () if self.pending => theme.warning,
            () if is_rest || self.locked.is_some() => theme.weak,
            () => theme.text,
        };
        let cut = widgets::cut_in_middle(ui, self.name, name.width(), &TextStyle::Body);
        widgets::text_in(ui, name, &cut, &TextStyle::Body, color);
        let response = ui.interact(name, self.id("name"), Sense::click());
        let slider_name = format!("{}, slider", self.name);
        let slider = NumberSlider {
            id: self.id("slider"),
            name: &slider_name,
            value: Some(self.weight),
            scale: SliderScale::Upward(1.0),
            snap: 0.1,
            color: if self.pending { theme.warning } else { theme.accent },
            enabled: self.locked.is_none(),
        };
        let by_slider = if line.width() > 24.0 { slider.show(ui, line) } else { FieldEvent::Nothing };
        let pending = if self.pending { "\nPending: shown, but in no key yet" } else { "" };
        let help = format!("Weight of the shape key, usually 0 to 1  ·  {}{pending}", self.mesh);
        let field = NumberField {
            id: self.id("number"),
            name: self.name,
            value: Some(self.weight),
            quantity: Quantity::Number,
            unit: "",
            speed: 0.01,
            snap: 0.1,
            grain: 1e-9,
            digits: Digits::Fixed(3),
            range: -RANGE..=RANGE,
            locked: self.locked,
            help: &help,
            quiet: is_rest,
            relative: false,
        };
        let (by_number, _) = field.show(ui, number);
        let event = if by_number == FieldEvent::Nothing { by_slider } else { by_number };
        (event, response.on_hover_text(format!("{}\n{}", widgets::shortened(self.name), self.mesh)))
    }

    /// Returns the id of a part of the row.
    pub(super) fn id(&self, part: &str) -> Id {
        Id::unique(("shape key", part, self.instance, self.shape))
    }
}
