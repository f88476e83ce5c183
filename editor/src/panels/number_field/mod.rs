//! A number field: dragged, typed as an expression, or stepped by a screen reader.
//!
//! The field reports what the user does as a [`FieldEvent`], and its owner makes edits of that. While it has the focus
//! it is a text field; a text that is not a number stays in it, with a red border and the reason, until it is corrected
//! or Escape is pressed.

mod dragged;
mod relation;
mod shown;
mod spoken;
mod typed;

pub use relation::RelativeNumber;

use super::number_text::Digits;
use crate::control::expression::{Quantity, evaluate};
use dragonfly_document::text::sentence;
use egui::{Id, Rect, Response, Sense, Ui};
use std::ops::RangeInclusive;
use std::time::Duration;

/// Longest text, in characters.
const LONGEST: usize = 1000;

/// Settings of a field: its number, and how it is edited and shown.
#[derive(Clone, Debug)]
pub struct NumberField<'a> {
    /// Identifies the field between frames.
    pub id: Id,
    /// Accessible name, such as `Rotation change X`.
    pub name: &'a str,
    /// Number that is shown; `None` if several bones or keys differ, or there is none.
    pub value: Option<f64>,
    /// Quantity, which decides which units can be typed.
    pub quantity: Quantity,
    /// Unit shown after the number, where there is space; empty for none.
    pub unit: &'a str,
    /// Change per point of a drag.
    pub speed: f64,
    /// Step: with Ctrl, a drag snaps to multiples of it; a screen reader steps by it.
    pub snap: f64,
    /// Differences below this are rounding errors.
    pub grain: f64,
    /// Number of digits shown.
    pub digits: Digits,
    /// Range that can be typed and dragged to.
    pub range: RangeInclusive<f64>,
    /// Reason why the number cannot be changed; `None` if it can.
    pub locked: Option<&'a str>,
    /// Sentence for the tooltip; empty for none.
    pub help: &'a str,
    /// Whether the number is drawn faintly, because it is the default.
    pub quiet: bool,
    /// Whether texts such as `+5` and `*2` change the number, or the number of each of several keys.
    pub relative: bool,
}

/// An action of the user on a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldEvent {
    /// Nothing happened.
    Nothing,
    /// A drag began, or the field got the focus: the number should stop changing by itself.
    Touched,
    /// The drag moved. The payload is the difference to the number at its start.
    Dragged(f64),
    /// The drag was released.
    Released,
    /// The drag was cancelled.
    Cancelled,
    /// The user entered this number.
    Typed(f64),
    /// The user entered a change of numbers that differ. Only relative fields report it.
    Changed(RelativeNumber),
}

/// A text that is being typed.
#[derive(Clone, Debug, Default)]
struct Typing {
    text: String,
    /// Text when typing began.
    first: String,
    /// Reason why the text is not accepted.
    refused: Option<String>,
}

/// A number field that is dragged.
#[derive(Clone, Copy, Debug)]
struct DraggedNumber {
    /// Number when the drag began.
    start: f64,
    /// Amount that the drag has added, before limits and snapping.
    raw: f64,
    /// Amount that was reported last: the number minus `start`.
    reported: f64,
}

/// Time for which a field shows that a number was refused after the focus left it, seconds. The old number is in the
/// field again, so nothing is wrong any more.
const REFUSED: f64 = 6.0;

/// A number that was refused when the focus left the field; shown for a while, as long as the number stays the same.
#[derive(Clone, Debug, Default)]
struct RefusedNumber {
    reason: String,
    value: Option<f64>,
    /// Time at which it is forgotten, on egui's clock, seconds.
    until: f64,
    /// Number of frames in which the number may still change by itself: fields that belong together, such as the
    /// components of a quaternion, show the typed numbers until the focus leaves them.
    settles: u8,
}

impl RefusedNumber {
    fn new(ui: &Ui, reason: String, value: Option<f64>) -> Self {
        Self { reason, value, until: ui.input(|input| input.time) + REFUSED, settles: 2 }
    }

    /// Returns what remains of it in the next frame, in which the field shows `value`.
    fn next(self, ui: &Ui, value: Option<f64>) -> Option<Self> {
        let left = self.until - ui.input(|input| input.time);
        if left <= 0.0 {
            return None;
        }
        ui.ctx().request_repaint_after(Duration::from_secs_f64(left));
        match self.settles {
            0 => Some(self).filter(|refused| refused.value == value),
            settles => Some(Self { value, settles: settles - 1, ..self }),
        }
    }
}

/// Shows at a field for a while why the last typed number was refused.
pub fn refuse(ui: &Ui, id: Id, value: Option<f64>, reason: &str) {
    let refused = RefusedNumber::new(ui, reason.to_owned(), value);
    ui.data_mut(|data| data.insert_temp(id, refused));
}

impl NumberField<'_> {
    /// Draws the field into `rect`.
    pub fn show(self, ui: &mut Ui, rect: Rect) -> (FieldEvent, Response) {
        let id = self.id;
        if self.locked.is_some() || !ui.is_enabled() {
            let response = ui.interact(rect, id, Sense::hover());
            self.paint(ui, rect, &response, None);
            self.describe(ui, &response, None);
            let response = match self.locked {
                Some(why) => response.on_hover_text(format!("{}{}\n{why}", self.title(), self.full())),
                None => response,
            };
            return (FieldEvent::Nothing, response);
        }
        let early = self.keys(ui);
        let has_focus = ui.memory_mut(|memory| {
            memory.interested_in_focus(id, ui.layer_id());
            memory.has_focus(id)
        });
        let (late, response) = if has_focus { self.edit(ui, rect) } else { self.rest(ui, rect) };
        let stepped = self.asked_by_reader(ui);
        (early.or(stepped).unwrap_or(late), response)
    }

    /// Returns the value of a text.
    fn read(&self, text: &str) -> Result<f64, String> {
        self.checked(evaluate(text, self.quantity).map_err(|error| sentence(&error.to_string()))?)
    }

    /// Returns the value, or the reason why it is not in the range.
    fn checked(&self, value: f64) -> Result<f64, String> {
        if !self.range.contains(&value) || !(value as f32).is_finite() {
            let edge = |edge: &f64| Digits::Fitting.text(*edge);
            return Err(format!(
                "Enter a number from {} to {}",
                edge(self.range.start()),
                edge(self.range.end())
            ));
        }
        Ok(value)
    }

    fn clamp(&self, value: f64) -> f64 {
        value.max(*self.range.start()).min(*self.range.end())
    }
}
