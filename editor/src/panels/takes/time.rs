//! Start and length of a take, and what is left of it when it is trimmed: numbers in a small sheet.

use super::super::context::PanelContext;
use super::super::number_field::{Heard, NumberField};
use super::super::number_text::Digits;
use super::super::request::Request;
use super::super::style::GRID;
use super::super::theme::Theme;
use super::super::widgets;
use crate::control::expression::Quantity;
use dragonfly_document::Change;
use dragonfly_document::adapter::TakeId;
use dragonfly_document::edit::Edit;
use dragonfly_document::history::Gesture;
use dragonfly_picture::playback::LATEST;
use egui::{Id, Rect, RichText, Sense, TextStyle, Ui, vec2};
use std::ops::RangeInclusive;

/// Longest take, seconds.
const LONGEST: f64 = LATEST as f64;
/// Shortest length that can be given, seconds.
const SHORTEST: f64 = 0.001;
/// Smaller parts of a frame are what arithmetic leaves over.
const GRAIN: f64 = 1e-3;

/// The sheet.
#[derive(Debug, Default)]
pub(super) struct Times {
    /// A field that is dragged: which gesture, and what the number was.
    held: Option<(Gesture, f64)>,
    /// Of which take what will be left.
    trim: Option<(TakeId, [f64; 2])>,
}

impl Times {
    /// Draws the fields for the take that is shown.
    pub(super) fn show(&mut self, ui: &mut Ui, state: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.set_width(240.0);
        let rate = f64::from(state.settings.frame_rate.max(1));
        ui.spacing_mut().item_spacing.y = GRID;
        let Some((take, shown)) = state.take_ref().zip(state.take()) else {
            ui.label(RichText::new("The rest pose has no time").color(Theme::of(ui).weak));
            return;
        };
        let (start, length) = (f64::from(shown.start), f64::from(shown.length));
        let locked = (length <= 0.0).then_some("All keys are at one time");
        ui.label(RichText::new("Moves and stretches all keys").small().color(Theme::of(ui).weak));
        let heard = number(ui, "Start", start, 0.0..=LONGEST, None, rate);
        let retime = take.clone();
        self.edit(state, start, heard, requests, |start| Edit::RetimeTake {
            take: retime.clone(),
            start: Some(start),
            length: None,
        });
        let heard = number(ui, "Length", length, SHORTEST..=LONGEST, locked, rate);
        self.edit(state, length, heard, requests, |length| Edit::RetimeTake {
            take: take.clone(),
            start: None,
            length: Some(length),
        });
        ui.separator();
        ui.label(RichText::new("Cuts away what lies outside").small().color(Theme::of(ui).weak));
        let id = state
            .view
            .as_ref()
            .zip(state.playback.take)
            .and_then(|(view, take)| view.slots.get(take))
            .map(|slot| slot.id);
        let Some(id) = id else { return };
        let mut range = match self.trim {
            Some((of, range)) if of == id => range,
            _ => state.trim_range().map(f64::from),
        };
        let end = start + length;
        range = range.map(|time| time.min(end).max(start));
        for (at, name) in ["From", "To"].into_iter().enumerate() {
            let (low, high) = if at == 0 { (start, range[1]) } else { (range[0], end) };
            match number(ui, name, range[at], low..=high, locked, rate) {
                Heard::Typed(value) => self.trim = Some((id, with(range, at, value))),
                Heard::Dragged(by) => {
                    let (_, from) = *self.held.get_or_insert((Gesture(0), range[at]));
                    self.trim = Some((id, with(range, at, from + by)));
                }
                Heard::Cancelled => {
                    if let Some((_, from)) = self.held.take() {
                        self.trim = Some((id, with(range, at, from)));
                    }
                }
                Heard::Released => self.held = None,
                Heard::Nothing | Heard::Touched => {}
            }
        }
        let shorter = range[0] > start || range[1] < end;
        let button = ui.add_enabled(shorter, egui::Button::new("Trim"));
        let button = button
            .on_hover_text("Takes away what lies before and after")
            .on_disabled_hover_text("All of the take lies between these times");
        if button.clicked() {
            let [from, to] = range.map(|time| time as f32);
            let trim = Edit::TrimTake { take, from, to, to_start: true };
            requests.push(Request::Change(Change::Edit(trim, None)));
            self.trim = None;
        }
    }

    fn edit(
        &mut self,
        state: &PanelContext<'_>,
        now: f64,
        heard: Heard,
        requests: &mut Vec<Request>,
        edit: impl Fn(f32) -> Edit,
    ) {
        match heard {
            Heard::Typed(value) => requests.push(Request::Change(Change::Edit(edit(value as f32), None))),
            Heard::Dragged(by) => {
                let (gesture, from) = *self.held.get_or_insert_with(|| (state.new_gesture(), now));
                let edit = edit((from + by) as f32);
                requests.push(Request::Change(Change::Edit(edit, Some(gesture))));
            }
            Heard::Cancelled => {
                if let Some((gesture, _)) = self.held.take() {
                    requests.push(Request::Change(Change::Cancel(gesture)));
                }
            }
            Heard::Released => {
                if let Some((gesture, _)) = self.held.take() {
                    requests.push(Request::Change(Change::Release(gesture)));
                }
            }
            Heard::Nothing | Heard::Touched => {}
        }
    }
}

fn with(mut range: [f64; 2], at: usize, value: f64) -> [f64; 2] {
    range[at] = value;
    range
}

/// A name and two fields for the same time on one line: seconds, and frames of which there are so many a second. What is
/// heard is in seconds.
fn number(
    ui: &mut Ui,
    name: &str,
    value: f64,
    range: RangeInclusive<f64>,
    locked: Option<&str>,
    rate: f64,
) -> Heard {
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
        // What single precision left over of a whole frame does not put it outside.
        range: range.start() * rate - GRAIN..=range.end() * rate + GRAIN,
        help: "Counted as the timeline counts them",
        ..seconds.clone()
    };
    let [left, middle] = [rect.right() - 184.0, rect.right() - 88.0];
    let place = Rect::from_x_y_ranges(left..=middle - GRID, rect.y_range());
    let heard = seconds.show(ui, place).0;
    let place = Rect::from_x_y_ranges(middle..=rect.right(), rect.y_range());
    match (heard, frames.show(ui, place).0) {
        (Heard::Nothing, Heard::Typed(frames)) => {
            Heard::Typed((frames / rate).max(*range.start()).min(*range.end()))
        }
        (Heard::Nothing, Heard::Dragged(by)) => Heard::Dragged(by / rate),
        (Heard::Nothing, heard) => heard,
        (heard, _) => heard,
    }
}
