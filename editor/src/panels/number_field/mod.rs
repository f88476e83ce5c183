//! A field that holds a number: dragged, typed as an expression, stepped by a screen reader.
//!
//! The field knows nothing of what its number is about. It says what a person does to it ([`FieldEvent`]), and its owner
//! makes edits of that. While it has the focus it is a text field; a text that is no number stays in it with a red edge
//! and the reason, until it is mended or taken back with Escape.

mod dragged;
mod shown;
mod spoken;
mod typed;

use super::number_text::Digits;
use crate::control::expression::{Quantity, evaluate};
use dragonfly_document::text::sentence;
use egui::{Id, Rect, Response, Sense, Ui};
use std::ops::RangeInclusive;
use std::time::Duration;

/// Longest text that a field takes, letters.
const LONGEST: usize = 1000;

/// What a field is and shows.
#[derive(Clone, Debug)]
pub struct NumberField<'a> {
    /// Stays the same as long as the field is about the same thing.
    pub id: Id,
    /// What a screen reader says: `Rotation change X`.
    pub name: &'a str,
    /// `None` where there are several, or none.
    pub value: Option<f64>,
    /// Which units can be typed.
    pub quantity: Quantity,
    /// Behind the number, where there is room; empty for none.
    pub unit: &'a str,
    /// Per point of a drag.
    pub speed: f64,
    /// With Ctrl, a drag stops at whole multiples of this; also what a screen reader steps by.
    pub snap: f64,
    /// Smaller differences are what arithmetic leaves over.
    pub grain: f64,
    /// How it is shown.
    pub digits: Digits,
    /// What can be typed and dragged to.
    pub range: RangeInclusive<f64>,
    /// Why it cannot be changed; `None` where it can.
    pub locked: Option<&'a str>,
    /// A sentence for the tooltip; empty for none.
    pub help: &'a str,
    /// Shown weaker: it is what it is where nobody did anything.
    pub quiet: bool,
}

/// What a person does to a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldEvent {
    /// Nothing.
    Nothing,
    /// Takes hold of it, or puts the cursor into it: what it shows should stand still.
    Touched,
    /// Drags: so much is added to what it was when the drag began.
    Dragged(f64),
    /// Lets go.
    Released,
    /// Takes a drag back.
    Cancelled,
    /// This number is wanted.
    Typed(f64),
}

/// A text that is being typed.
#[derive(Clone, Debug, Default)]
struct Typing {
    text: String,
    /// As it was at the begin.
    first: String,
    /// Why it is not taken.
    refused: Option<String>,
}

/// A number field that is dragged.
#[derive(Clone, Copy, Debug)]
struct DraggedNumber {
    /// Number when the drag began.
    start: f64,
    /// What the drag has added, before limits and snapping.
    raw: f64,
    /// What was reported last: the number minus `start`.
    reported: f64,
}

/// Seconds for which a field says that a number was refused, once the cursor has left it: nothing is wrong any more, since
/// the old number stands there.
const REFUSED: f64 = 6.0;

/// What was refused when the cursor left the field; said for a while, as long as the number stays the same.
#[derive(Clone, Debug, Default)]
struct Refused {
    reason: String,
    value: Option<f64>,
    /// egui's seconds at which it is forgotten.
    until: f64,
    /// Frames in which the number may still become another one without anybody having changed it: fields that belong
    /// together show what was typed until the cursor has left them, as the parts of a quaternion do.
    settles: u8,
}

impl Refused {
    fn new(ui: &Ui, reason: String, value: Option<f64>) -> Self {
        Self { reason, value, until: ui.input(|input| input.time) + REFUSED, settles: 2 }
    }

    /// What is left of it in the next frame, in which the field shows `value`.
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

/// Shows at a field for a while why the number typed last was not taken.
pub fn refuse(ui: &Ui, id: Id, value: Option<f64>, reason: &str) {
    let refused = Refused::new(ui, reason.to_owned(), value);
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

    /// The number that a text says, or why it is none.
    fn read(&self, text: &str) -> Result<f64, String> {
        let value = evaluate(text, self.quantity).map_err(|error| sentence(&error.to_string()))?;
        if !self.range.contains(&value) || !(value as f32).is_finite() {
            let edge = |edge: &f64| Digits::Fitting.text(*edge);
            return Err(format!(
                "A number from {} to {} is wanted",
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
