//! A small sheet for start and length of a take, and for trimming it.

use super::super::context::PanelContext;
use super::super::drag::FieldGesture;
use super::super::number_field::{FieldEvent, NumberField};
use super::super::number_text::Digits;
use super::super::request::Request;
use super::super::style::GRID;
use super::super::theme::Theme;
use super::super::widgets;
use crate::control::expression::Quantity;
use dragonfly_document::Change;
use dragonfly_document::adapter::TakeId;
use dragonfly_document::edit::{Edit, RetimeTake, TrimTake};
use dragonfly_picture::playback::LATEST;
use egui::{Id, Rect, RichText, Sense, TextStyle, Ui, vec2};
use std::ops::RangeInclusive;

/// Longest take, seconds.
const LONGEST: f64 = LATEST as f64;
/// Shortest length that can be given, seconds.
const SHORTEST: f64 = 0.001;
/// Fractions of a frame below this are rounding errors.
const GRAIN: f64 = 1e-3;

/// The sheet.
#[derive(Debug, Default)]
pub(super) struct TimeSheet {
    /// The drag of start or length.
    gesture: FieldGesture,
    /// Time of `From` or `To` when its drag began, seconds.
    trim_from: Option<f64>,
    /// The take that is about to be trimmed, and the range that will be left of it, seconds.
    trim: Option<(TakeId, [f64; 2])>,
}

impl TimeSheet {
    /// Draws the fields for the take that is shown.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.set_width(240.0);
        let rate = f64::from(context.frame_rate.max(1));
        ui.spacing_mut().item_spacing.y = GRID;
        let Some((take, shown)) = context.shown_take_ref().zip(context.shown_take()) else {
            ui.label(RichText::new("The rest pose has no start and no length").color(Theme::of(ui).weak));
            return;
        };
        let (start, length) = (f64::from(shown.start), f64::from(shown.length));
        let locked = (length <= 0.0).then_some("All keys are at one time");
        ui.label(RichText::new("Move and stretch all keys").small().color(Theme::of(ui).weak));
        let event = number(ui, "Start", start, 0.0..=LONGEST, None, rate);
        let retime = take.clone();
        let change = self.gesture.change(
            event,
            start,
            || context.new_gesture(),
            |start| {
                Edit::RetimeTake(RetimeTake { take: retime.clone(), start: Some(start as f32), length: None })
            },
        );
        requests.extend(change.map(Request::Change));
        let event = number(ui, "Length", length, SHORTEST..=LONGEST, locked, rate);
        let change = self.gesture.change(
            event,
            length,
            || context.new_gesture(),
            |length| {
                Edit::RetimeTake(RetimeTake { take: take.clone(), start: None, length: Some(length as f32) })
            },
        );
        requests.extend(change.map(Request::Change));
        ui.separator();
        ui.label(RichText::new("Delete all keys outside this range").small().color(Theme::of(ui).weak));
        let id = context
            .view
            .as_ref()
            .zip(context.playback.take)
            .and_then(|(view, take)| view.slots.get(take))
            .map(|slot| slot.id);
        let Some(id) = id else { return };
        let mut range = match self.trim {
            Some((of, range)) if of == id => range,
            _ => context.trim_range().map(f64::from),
        };
        let end = start + length;
        range = range.map(|time| time.min(end).max(start));
        for (at, name) in ["From", "To"].into_iter().enumerate() {
            let (low, high) = if at == 0 { (start, range[1]) } else { (range[0], end) };
            match number(ui, name, range[at], low..=high, locked, rate) {
                FieldEvent::Typed(value) => self.trim = Some((id, with(range, at, value))),
                FieldEvent::Dragged(by) => {
                    let from = *self.trim_from.get_or_insert(range[at]);
                    self.trim = Some((id, with(range, at, from + by)));
                }
                FieldEvent::Cancelled => {
                    if let Some(from) = self.trim_from.take() {
                        self.trim = Some((id, with(range, at, from)));
                    }
                }
                FieldEvent::Released => self.trim_from = None,
                FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Changed(_) => {}
            }
        }
        let shorter = range[0] > start || range[1] < end;
        let button = ui.add_enabled(shorter, egui::Button::new("Trim"));
        let button = button
            .on_hover_text("Delete all keys before and after this range")
            .on_disabled_hover_text("The whole take is inside this range");
        if button.clicked() {
            let [from, to] = range.map(|time| time as f32);
            let trim = Edit::TrimTake(TrimTake { take, from, to, to_start: true });
            requests.push(Request::Change(Change::Edit(trim, None)));
            self.trim = None;
        }
    }
}

fn with(mut range: [f64; 2], at: usize, value: f64) -> [f64; 2] {
    range[at] = value;
    range
}

/// Draws a label and two fields for the same time on one line: seconds, and frames at `rate` per second. The event is
/// in seconds.
fn number(
    ui: &mut Ui,
    name: &str,
    value: f64,
    range: RangeInclusive<f64>,
    locked: Option<&str>,
    rate: f64,
) -> FieldEvent {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 24.0), Sense::hover());
    widgets::text_in(ui, rect, name, &TextStyle::Body, Theme::of(ui).text);
    let seconds = NumberField {
        id: Id::unique(("time of a take", name)),
        name,
        value: Some(value),
        quantity: Quantity::Number,
        unit: "s",
        speed: 0.01,
        snap: 0.1,
        grain: 1e-6,
        digits: Digits::Fixed(3),
        range: range.clone(),
        locked,
        help: "",
        quiet: false,
        relative: false,
    };
    let frames = NumberField {
        id: Id::unique(("time of a take in frames", name)),
        name: &format!("{name} in frames"),
        value: Some(value * rate),
        unit: "f",
        speed: 0.2,
        snap: 1.0,
        grain: GRAIN,
        digits: if (value * rate - (value * rate).round()).abs() < GRAIN {
            Digits::Fixed(0)
        } else {
            Digits::Fixed(2)
        },
        // The margin keeps a whole frame inside its range despite rounding errors.
        range: range.start() * rate - GRAIN..=range.end() * rate + GRAIN,
        help: "In frames of the timeline",
        ..seconds.clone()
    };
    let [left, middle] = [rect.right() - 184.0, rect.right() - 88.0];
    let place = Rect::from_x_y_ranges(left..=middle - GRID, rect.y_range());
    let event = seconds.show(ui, place).0;
    let place = Rect::from_x_y_ranges(middle..=rect.right(), rect.y_range());
    match (event, frames.show(ui, place).0) {
        (FieldEvent::Nothing, FieldEvent::Typed(frames)) => {
            FieldEvent::Typed((frames / rate).max(*range.start()).min(*range.end()))
        }
        (FieldEvent::Nothing, FieldEvent::Dragged(by)) => FieldEvent::Dragged(by / rate),
        (FieldEvent::Nothing, event) => event,
        (event, _) => event,
    }
}
