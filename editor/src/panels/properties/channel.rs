//! One channel of a bone as a table: a row an axis, a column each for original, change and result.

use super::super::context::PanelContext;
use super::super::number_field::{self, Heard, NumberField};
use super::super::number_slider::{NumberSlider, Scale};
use super::super::number_text::{Digits, exact};
use super::super::request::Request;
use super::super::style::{GRID, NUMBER, RADIUS};
use super::super::theme::Theme;
use super::hand::{Hand, Spot};
use super::parts::{Column, Form, Pair};
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

/// What a table is about.
pub(super) struct Table<'a> {
    pub(super) state: &'a PanelContext<'a>,
    pub(super) bone: BoneIndex,
    pub(super) pair: Pair,
    /// Why nothing can be changed, if so.
    pub(super) locked: Option<&'a str>,
    /// Radius of the model in the parent's space: how far a translation is likely to go.
    pub(super) size: f64,
    /// Metres of the scene that 1 is in the parent's space.
    pub(super) metres: f64,
}

/// Columns for which there is room, and where they are.
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

/// The heads of the columns.
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

/// The place of a channel's rows.
#[derive(Clone, Copy)]
pub(super) struct Rows {
    rect: Rect,
    property: Property,
    form: Form,
    sliders: bool,
}

impl Rows {
    /// Points from row to row.
    fn step(&self) -> f32 {
        FIELD + 2.0 + if self.sliders { SLIDER } else { 0.0 }
    }

    fn top(&self, index: usize) -> f32 {
        self.rect.top() + index as f32 * self.step()
    }
}

impl Table<'_> {
    /// Room for the rows of a channel, with the letters of its axes. Its fields come later, with those of all channels.
    pub(super) fn room(&self, ui: &mut Ui, property: Property, form: Form, sliders: bool) -> Rows {
        let count = form.count();
        let step = FIELD + 2.0 + if sliders { SLIDER } else { 0.0 };
        let size = vec2(ui.available_width(), step * count as f32 - 2.0);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let rows = Rows { rect, property, form, sliders };
        let theme = Theme::of(ui);
        let letters =
            ["X", "Y", "Z", "W"].into_iter().zip([theme.axes[0], theme.axes[1], theme.axes[2], theme.weak]);
        for (index, (letter, color)) in letters.take(count).enumerate() {
            let at = pos2(rect.left(), rows.top(index) + FIELD / 2.0);
            ui.painter().text(at, Align2::LEFT_CENTER, letter, FontId::proportional(11.0), color);
        }
        rows
    }

    /// Draws the fields of all channels, column by column, so that Tab goes down through all of them; was one in use?
    pub(super) fn fields(
        &self,
        ui: &mut Ui,
        hand: &mut Hand,
        channels: &[Rows],
        requests: &mut Vec<Request>,
    ) -> bool {
        let mut in_use = false;
        for column in Column::ALL.into_iter().rev() {
            for rows in channels {
                in_use |= self.column(ui, hand, rows, column, requests);
            }
        }
        for rows in channels.iter().filter(|rows| rows.sliders) {
            in_use |= self.sliders(ui, hand, rows, requests);
        }
        in_use
    }

    fn column(
        &self,
        ui: &mut Ui,
        hand: &mut Hand,
        rows: &Rows,
        column: Column,
        requests: &mut Vec<Request>,
    ) -> bool {
        let Rows { rect, property, form, .. } = *rows;
        let columns = columns(rect.left(), rect.width());
        let Some(&(_, x)) = columns.iter().find(|(other, _)| *other == column) else { return false };
        let spot = Spot { property, column, form };
        let shared = hand.shared(self.state, self.bone, &self.pair, spot, self.grain(property, form));
        let mut in_use = false;
        for (index, value) in shared.into_iter().enumerate().take(form.count()) {
            let place = Rect::from_x_y_ranges(x, rows.top(index)..=rows.top(index) + FIELD);
            in_use |= match column {
                Column::Original => {
                    self.original(ui, place, hand, spot, index, value, requests);
                    false
                }
                _ => self.field(ui, place, hand, spot, index, value, requests),
            };
        }
        in_use
    }

    fn sliders(&self, ui: &mut Ui, hand: &mut Hand, rows: &Rows, requests: &mut Vec<Request>) -> bool {
        let Rows { rect, property, form, .. } = *rows;
        let spot = Spot { property, column: Column::Change, form };
        let shared = hand.shared(self.state, self.bone, &self.pair, spot, self.grain(property, form));
        let mut in_use = false;
        for (index, value) in shared.into_iter().enumerate().take(form.count()) {
            let top = rows.top(index) + FIELD;
            let place = Rect::from_min_max(
                pos2(rect.left() + LETTER + 6.0, top),
                pos2(rect.right() - 6.0, top + SLIDER - 1.0),
            );
            in_use |= self.slider(ui, place, hand, spot, index, value, requests);
        }
        in_use
    }

    /// As it was read; a click gives it to the result.
    #[expect(clippy::too_many_arguments, reason = "place, number, and what comes of it")]
    fn original(
        &self,
        ui: &Ui,
        rect: Rect,
        hand: &mut Hand,
        spot: Spot,
        index: usize,
        value: Option<f64>,
        requests: &mut Vec<Request>,
    ) {
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
            // What is already there leaves nothing to do.
            let _ = hand.hear(self.state, result, index, Heard::Typed(value), requests);
        }
        response.on_hover_text(format!("{name}: {full}\nClick to give the result this number"));
    }

    #[expect(clippy::too_many_arguments, reason = "place, number, and what comes of it")]
    fn field(
        &self,
        ui: &mut Ui,
        rect: Rect,
        hand: &mut Hand,
        spot: Spot,
        index: usize,
        value: Option<f64>,
        requests: &mut Vec<Request>,
    ) -> bool {
        let id = self.id(spot, index);
        let quantity = match (spot.property, spot.form) {
            (Property::Translation, _) => Quantity::Length,
            (_, Form::Euler(_)) => Quantity::Angle,
            _ => Quantity::Number,
        };
        let (speed, snap) = self.steps(spot);
        let help = match (spot.property, spot.form) {
            (_, Form::Quaternion) => "All four are brought to length 1 when you leave them.".to_owned(),
            (Property::Translation, _) if !self.is_metric() => {
                format!("In the parent's space, where 1 is {} m", Digits::Fitting.text(self.metres))
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
        };
        let (heard, response) = field.show(ui, rect);
        if let Err(reason) = hand.hear(self.state, spot, index, heard, requests) {
            number_field::refuse(ui, id, value, reason);
        }
        response.has_focus() || response.dragged()
    }

    #[expect(clippy::too_many_arguments, reason = "place, number, and what comes of it")]
    fn slider(
        &self,
        ui: &mut Ui,
        rect: Rect,
        hand: &mut Hand,
        spot: Spot,
        index: usize,
        value: Option<f64>,
        requests: &mut Vec<Request>,
    ) -> bool {
        let theme = Theme::of(ui);
        let scale = match (spot.property, spot.form) {
            (Property::Translation, _) => Scale::Linear(self.size),
            (Property::Rotation, Form::Quaternion) => Scale::Linear(1.0),
            (Property::Rotation, _) => Scale::Linear(180.0),
            (Property::Scale, _) => Scale::Factor(10.0),
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
        let heard = slider.show(ui, rect);
        let in_use = heard != Heard::Nothing;
        // A number that cannot be is left out on the way.
        let _ = hand.hear(self.state, spot, index, heard, requests);
        in_use
    }

    fn id(&self, spot: Spot, index: usize) -> Id {
        Id::unique(("number of a bone", self.bone, spot, index))
    }

    /// Per point of a drag, and multiples at which a drag snaps.
    fn steps(&self, spot: Spot) -> (f64, f64) {
        match (spot.property, spot.form) {
            (Property::Translation, _) => {
                let decade = 10_f64.powf(self.size.max(1e-6).log10().floor());
                (self.size / 500.0, decade / 10.0)
            }
            (_, Form::Euler(_)) => (0.5, 15.0),
            _ => (0.005, 0.1),
        }
    }

    /// What numbers of 32 bits leave over.
    fn grain(&self, property: Property, form: Form) -> f64 {
        match (property, form) {
            (Property::Translation, _) => {
                let [original, result] =
                    [self.pair.original, self.pair.result].map(|pose| pose.translation.abs().max_element());
                f64::from(original.max(result)) * 1e-6 + self.size * 1e-9
            }
            (_, Form::Euler(_)) => 1e-4,
            (Property::Scale, _) => f64::from(self.pair.result.scale.abs().max_element()) * 1e-6 + 1e-9,
            _ => 1e-6,
        }
    }

    /// Are numbers of the parent's space metres?
    pub(super) fn is_metric(&self) -> bool {
        (self.metres - 1.0).abs() < 0.01
    }

    /// `m`, `°`, `×`: behind the number.
    fn unit(&self, spot: Spot) -> &'static str {
        match (spot.property, spot.form, spot.column) {
            (Property::Translation, ..) if self.is_metric() => "m",
            (_, Form::Euler(_), _) => "°",
            (Property::Scale, _, Column::Change) => "×",
            _ => "",
        }
    }

    fn digits(&self, spot: Spot) -> Digits {
        match spot.form {
            Form::Euler(_) => Digits::Fixed(2),
            Form::Quaternion => Digits::Fixed(4),
            Form::Vector => Digits::Fitting,
        }
    }
}

/// What stands there where nothing is changed.
fn unchanged(spot: Spot, index: usize) -> f64 {
    match (spot.property, spot.form) {
        (Property::Scale, _) => 1.0,
        (_, Form::Quaternion) if index == 3 => 1.0,
        _ => 0.0,
    }
}

/// `Rotation change X`.
fn name(spot: Spot, index: usize) -> String {
    let channel = match (spot.property, spot.form) {
        (Property::Translation, _) => "Translation",
        (Property::Rotation, Form::Quaternion) => "Quaternion",
        (Property::Rotation, _) => "Rotation",
        (Property::Scale, _) => "Scale",
    };
    format!("{channel} {} {}", spot.column.title().to_lowercase(), ["X", "Y", "Z", "W"][index.min(3)])
}
