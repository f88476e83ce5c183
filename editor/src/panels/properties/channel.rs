//! One channel of a bone as a table: a row for each axis, and columns for original, change and result.

use super::super::context::PanelContext;
use super::super::edit_scope_menu;
use super::super::number_field::{self, FieldEvent, NumberField};
use super::super::number_slider::{NumberSlider, SliderScale};
use super::super::number_text::{Digits, exact};
use super::super::request::Request;
use super::super::style::{GRID, NUMBER, RADIUS};
use super::super::theme::Theme;
use super::drag::{FieldDrag, Spot};
use super::parts::{Column, NumberForm, Pair};
use crate::control::expression::Quantity;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::edit::Property;
use egui::accesskit::Role;
use egui::{Align2, CornerRadius, FontId, Id, Rect, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2};

/// Width of the letters at the left.
const LETTER: f32 = 14.0;
/// Height of a field.
const FIELD: f32 = 22.0;
/// Height of a slider.
const SLIDER: f32 = 14.0;

/// The table of a bone.
pub(super) struct ChannelTable<'a> {
    pub(super) context: &'a PanelContext<'a>,
    pub(super) bone: BoneIndex,
    pub(super) pair: Pair,
    /// Reason why nothing can be changed.
    pub(super) locked: Option<&'a str>,
    /// Radius of the model in parent space: about how far a translation goes.
    pub(super) size: f64,
    /// Meters of the scene per unit of parent space.
    pub(super) meters: f64,
}

/// Returns the columns that fit, and their positions.
pub(super) fn columns(left: f32, width: f32) -> Vec<(Column, egui::Rangef)> {
    let shown: &[Column] = match width {
        width if width >= 196.0 => &Column::ALL,
        width if width >= 136.0 => &Column::ALL[1..],
        _ => &Column::ALL[2..],
    };
    let gap = GRID;
    let count = shown.len() as f32;
    let each = ((width - LETTER - gap * (count - 1.0)) / count).max(8.0);
    let place = |index: usize| left + LETTER + index as f32 * (each + gap);
    shown
        .iter()
        .enumerate()
        .map(|(at, &column)| (column, egui::Rangef::new(place(at), place(at) + each)))
        .collect()
}

/// Draws the headings of the columns.
pub(super) fn heads(ui: &mut Ui) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 16.0), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, "Original, change, result"));
    let theme = Theme::of(ui);
    for (column, x) in columns(rect.left(), rect.width()) {
        let at = pos2(x.max - 5.0, rect.center().y);
        let font = TextStyle::Small.resolve(ui.style());
        ui.painter().text(at, Align2::RIGHT_CENTER, column.title(), font, theme.faint);
    }
}

/// The area of the rows of a channel.
#[derive(Clone, Copy)]
pub(super) struct ChannelRows {
    rect: Rect,
    property: Property,
    form: NumberForm,
    sliders: bool,
}

/// One number of the table.
#[derive(Clone, Copy)]
struct Cell {
    spot: Spot,
    /// Component, 0 for X.
    index: usize,
    /// Number that all selected bones share; `None` if they differ.
    value: Option<f64>,
    /// Position, points.
    rect: Rect,
}

impl ChannelRows {
    /// Returns the distance from row to row, points.
    fn step(&self) -> f32 {
        FIELD + 2.0 + if self.sliders { SLIDER } else { 0.0 }
    }

    fn top(&self, index: usize) -> f32 {
        self.rect.top() + index as f32 * self.step()
    }
}

impl ChannelTable<'_> {
    /// Allocates the rows of a channel and draws the letters of its axes. The fields are drawn later, together with
    /// those of all channels.
    pub(super) fn room(
        &self,
        ui: &mut Ui,
        property: Property,
        form: NumberForm,
        sliders: bool,
    ) -> ChannelRows {
        let count = form.count();
        let step = FIELD + 2.0 + if sliders { SLIDER } else { 0.0 };
        let size = vec2(ui.available_width(), step * count as f32 - 2.0);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let rows = ChannelRows { rect, property, form, sliders };
        let theme = Theme::of(ui);
        let letters =
            ["X", "Y", "Z", "W"].into_iter().zip([theme.axes[0], theme.axes[1], theme.axes[2], theme.weak]);
        for (index, (letter, color)) in letters.take(count).enumerate() {
            let at = pos2(rect.left(), rows.top(index) + FIELD / 2.0);
            ui.painter().text(at, Align2::LEFT_CENTER, letter, FontId::proportional(11.0), color);
        }
        rows
    }

    /// Draws the fields of all channels, column by column, so that Tab moves down through all of them. Returns whether
    /// one was in use.
    pub(super) fn fields(
        &self,
        ui: &mut Ui,
        drag: &mut FieldDrag,
        channels: &[ChannelRows],
        requests: &mut Vec<Request>,
    ) -> bool {
        let mut in_use = false;
        for column in Column::ALL.into_iter().rev() {
            for rows in channels {
                in_use |= self.column(ui, drag, rows, column, requests);
            }
        }
        for rows in channels.iter().filter(|rows| rows.sliders) {
            in_use |= self.sliders(ui, drag, rows, requests);
        }
        in_use
    }

    fn column(
        &self,
        ui: &mut Ui,
        drag: &mut FieldDrag,
        rows: &ChannelRows,
        column: Column,
        requests: &mut Vec<Request>,
    ) -> bool {
        let ChannelRows { rect, property, form, .. } = *rows;
        let columns = columns(rect.left(), rect.width());
        let Some(&(_, x)) = columns.iter().find(|(other, _)| *other == column) else { return false };
        let spot = Spot { property, column, form };
        let shared = drag.shared(self.bone, &self.pair, spot, self.grain(property, form));
        let mut in_use = false;
        for (index, value) in shared.into_iter().enumerate().take(form.count()) {
            let place = Rect::from_x_y_ranges(x, rows.top(index)..=rows.top(index) + FIELD);
            let value = value.map(|value| self.without_dust(spot, value));
            let cell = Cell { spot, index, value, rect: place };
            in_use |= match column {
                Column::Original => {
                    self.original(ui, &cell, drag, requests);
                    false
                }
                Column::Change | Column::Result => self.field(ui, &cell, drag, requests),
            };
        }
        in_use
    }

    fn sliders(
        &self,
        ui: &mut Ui,
        drag: &mut FieldDrag,
        rows: &ChannelRows,
        requests: &mut Vec<Request>,
    ) -> bool {
        let ChannelRows { rect, property, form, .. } = *rows;
        let spot = Spot { property, column: Column::Change, form };
        let shared = drag.shared(self.bone, &self.pair, spot, self.grain(property, form));
        let mut in_use = false;
        for (index, value) in shared.into_iter().enumerate().take(form.count()) {
            let top = rows.top(index) + FIELD;
            let place = Rect::from_min_max(
                pos2(rect.left() + LETTER + 6.0, top),
                pos2(rect.right() - 6.0, top + SLIDER - 1.0),
            );
            let value = value.map(|value| self.without_dust(spot, value));
            in_use |= self.slider(ui, &Cell { spot, index, value, rect: place }, drag, requests);
        }
        in_use
    }

    /// Draws the original number; a click copies it to the result.
    fn original(&self, ui: &Ui, cell: &Cell, drag: &mut FieldDrag, requests: &mut Vec<Request>) {
        let Cell { spot, index, value, rect } = *cell;
        let theme = Theme::of(ui);
        let enabled = self.locked.is_none() && value.is_some();
        let sense = if enabled { Sense::click() } else { Sense::hover() };
        let response = ui.interact(rect, self.id(spot, index), sense);
        let grain = self.grain(spot.property, spot.form);
        let text = value.map_or("–".to_owned(), |value| self.digits(spot).text_from(grain, value));
        let name = name(spot, index);
        response.widget_info(|| {
            let role = if enabled { Role::Button } else { Role::Label };
            WidgetInfo::labeled(role, ui.is_enabled(), format!("{name}: {text}"))
        });
        if response.hovered() && enabled {
            ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.hover);
        }
        super::super::widgets::focus_ring(ui, &response, rect);
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        let at = pos2(rect.right() - 5.0, rect.center().y);
        painter.text(at, Align2::RIGHT_CENTER, &text, FontId::monospace(NUMBER), theme.weak);
        let Some(value) = value.filter(|_| enabled) else { return };
        let full = exact(value, grain);
        if response.clicked() {
            let result = Spot { column: Column::Result, ..spot };
            // A result that is equal already needs no edit.
            let _ = drag.apply(self.context, result, index, FieldEvent::Typed(value), requests);
        }
        response.on_hover_text(format!("{name}: {full}\nClick to copy this number to the result"));
    }

    fn field(&self, ui: &mut Ui, cell: &Cell, drag: &mut FieldDrag, requests: &mut Vec<Request>) -> bool {
        let Cell { spot, index, value, rect } = *cell;
        let id = self.id(spot, index);
        let quantity = match (spot.property, spot.form) {
            (Property::Translation, _) => Quantity::Length,
            (_, NumberForm::Euler(_)) => Quantity::Angle,
            _ => Quantity::Number,
        };
        let (speed, snap) = self.steps(spot);
        let help = match (spot.property, spot.form) {
            (_, NumberForm::Quaternion) => {
                "The quaternion is normalized when you leave its fields.".to_owned()
            }
            (Property::Translation, _) if !self.is_metric() => {
                format!("In parent space, where 1 unit is {} m", Digits::Fitting.text(self.meters))
            }
            _ => String::new(),
        };
        let field = NumberField {
            id,
            name: &name(spot, index),
            value,
            quantity,
            unit: self.unit(spot),
            speed,
            snap,
            grain: self.grain(spot.property, spot.form),
            digits: self.digits(spot),
            range: f64::from(f32::MIN)..=f64::from(f32::MAX),
            locked: self.locked,
            help: &help,
            quiet: spot.column == Column::Change && value == Some(unchanged(spot, index)),
            relative: false,
        };
        let (event, response) = field.show(ui, rect);
        response.context_menu(|ui| edit_scope_menu::entries(ui, self.context, requests));
        if let Err(reason) = drag.apply(self.context, spot, index, event, requests) {
            number_field::refuse(ui, id, value, reason);
        }
        response.has_focus() || response.dragged()
    }

    fn slider(&self, ui: &mut Ui, cell: &Cell, drag: &mut FieldDrag, requests: &mut Vec<Request>) -> bool {
        let Cell { spot, index, value, rect } = *cell;
        let theme = Theme::of(ui);
        let scale = match (spot.property, spot.form) {
            (Property::Translation, _) => SliderScale::Linear(self.size),
            (Property::Rotation, NumberForm::Quaternion) => SliderScale::Linear(1.0),
            (Property::Rotation, _) => SliderScale::Linear(180.0),
            (Property::Scale, _) => SliderScale::Factor(10.0),
        };
        let id = self.id(spot, index).with("slider");
        let slider = NumberSlider {
            id,
            name: &format!("{} slider", name(spot, index)),
            value,
            scale,
            snap: self.steps(spot).1,
            color: theme.axes.get(index).copied().unwrap_or(theme.weak),
            enabled: self.locked.is_none(),
        };
        let event = slider.show(ui, rect);
        let in_use = event != FieldEvent::Nothing;
        // A number that is impossible is skipped during a drag.
        let _ = drag.apply(self.context, spot, index, event, requests);
        in_use
    }

    fn id(&self, spot: Spot, index: usize) -> Id {
        Id::unique(("number of a bone", self.bone, spot, index))
    }

    /// Returns the change per point of a drag, and the step that a drag snaps to.
    fn steps(&self, spot: Spot) -> (f64, f64) {
        match (spot.property, spot.form) {
            (Property::Translation, _) => {
                let decade = 10_f64.powf(self.size.max(1e-6).log10().floor());
                (self.size / 500.0, decade / 10.0)
            }
            (_, NumberForm::Euler(_)) => (0.5, 15.0),
            _ => (0.005, 0.1),
        }
    }

    /// Returns a number as it is shown: a translation below a millionth of the model is a rounding error.
    fn without_dust(&self, spot: Spot, value: f64) -> f64 {
        let dust = spot.property == Property::Translation && value.abs() < self.size * 1e-6;
        if dust { 0.0 } else { value }
    }

    /// Returns the rounding error of single precision.
    fn grain(&self, property: Property, form: NumberForm) -> f64 {
        match (property, form) {
            (Property::Translation, _) => {
                let [original, result] =
                    [self.pair.original, self.pair.result].map(|pose| pose.translation.abs().max_element());
                f64::from(original.max(result)) * 1e-6 + self.size * 1e-9
            }
            (_, NumberForm::Euler(_)) => 1e-4,
            (Property::Scale, _) => f64::from(self.pair.result.scale.abs().max_element()) * 1e-6 + 1e-9,
            _ => 1e-6,
        }
    }

    /// Whether units of parent space are meters.
    pub(super) fn is_metric(&self) -> bool {
        (self.meters - 1.0).abs() < 0.01
    }

    /// Returns the unit after the number: `m`, `°`, `×`.
    fn unit(&self, spot: Spot) -> &'static str {
        match (spot.property, spot.form, spot.column) {
            (Property::Translation, ..) if self.is_metric() => "m",
            (_, NumberForm::Euler(_), _) => "°",
            (Property::Scale, _, Column::Change) => "×",
            _ => "",
        }
    }

    fn digits(&self, spot: Spot) -> Digits {
        match spot.form {
            NumberForm::Euler(_) => Digits::Fixed(2),
            NumberForm::Quaternion => Digits::Fixed(4),
            NumberForm::Vector => Digits::Fitting,
        }
    }
}

/// Returns the number of an unchanged component.
fn unchanged(spot: Spot, index: usize) -> f64 {
    match (spot.property, spot.form) {
        (Property::Scale, _) => 1.0,
        (_, NumberForm::Quaternion) if index == 3 => 1.0,
        _ => 0.0,
    }
}

/// Returns the accessible name: `Rotation change X`.
fn name(spot: Spot, index: usize) -> String {
    let channel = match (spot.property, spot.form) {
        (Property::Translation, _) => "Translation",
        (Property::Rotation, NumberForm::Quaternion) => "Quaternion",
        (Property::Rotation, _) => "Rotation",
        (Property::Scale, _) => "Scale",
    };
    format!("{channel} {} {}", spot.column.title().to_lowercase(), ["X", "Y", "Z", "W"][index.min(3)])
}
