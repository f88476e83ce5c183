//! Texts that change each of several numbers that a field edits: `+5`, `*2`.

use super::{FieldEvent, NumberField};
use crate::control::expression::{Quantity, evaluate};
use crate::panels::number_text::exact;
use dragonfly_document::text::sentence;

/// A change of numbers that may differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RelativeNumber {
    /// Adds this.
    Add(f64),
    /// Multiplies by this.
    Multiply(f64),
}

impl RelativeNumber {
    /// Returns the change that a text describes: `+5`, `+=5`, `-=5`, `*2`, `*=2`, `/2` or `/=2`. `None` if it describes a number,
    /// as `-5` does.
    fn read(text: &str, quantity: Quantity) -> Option<Result<Self, String>> {
        let text = text.trim();
        let operators = ["+=", "-=", "*=", "/=", "+", "*", "/"];
        let operator = operators.into_iter().find(|operator| text.starts_with(operator))?;
        let is_sum = operator.starts_with(['+', '-']);
        let quantity = if is_sum { quantity } else { Quantity::Number };
        let number = match evaluate(&text[operator.len()..], quantity) {
            Ok(number) => number,
            Err(error) => return Some(Err(sentence(&error.to_string()))),
        };
        let change = match operator.as_bytes()[0] {
            b'+' => Self::Add(number),
            b'-' => Self::Add(-number),
            b'*' => Self::Multiply(number),
            _ if number == 0.0 => return Some(Err("A number cannot be divided by zero".to_owned())),
            _ => Self::Multiply(1.0 / number),
        };
        Some(Ok(change))
    }

    /// Returns a number after the change.
    pub fn of(self, number: f64) -> f64 {
        match self {
            Self::Add(by) => number + by,
            Self::Multiply(by) => number * by,
        }
    }
}

impl NumberField<'_> {
    /// Returns the event that entering a text is, or the reason why it is not accepted.
    pub(super) fn entry(&self, text: &str) -> Result<FieldEvent, String> {
        let change = if self.relative { RelativeNumber::read(text, self.quantity) } else { None };
        let Some(change) = change.transpose()? else { return self.read(text).map(FieldEvent::Typed) };
        match self.value {
            // All have this number.
            Some(value) => self.checked(change.of(value)).map(FieldEvent::Typed),
            None => Ok(FieldEvent::Changed(change)),
        }
    }

    /// Whether a text is a number without anything to compute.
    pub(super) fn is_plain(&self, text: &str) -> bool {
        let text = text.trim();
        text.parse::<f64>().is_ok() && !(self.relative && text.starts_with('+'))
    }

    /// Returns what entering a text does, for the hint; `None` if it is not accepted.
    pub(super) fn entry_text(&self, text: &str) -> Option<String> {
        let number = |value| format!("{}{}", exact(value, self.grain.max(1e-6)), self.suffix());
        match self.entry(text).ok()? {
            FieldEvent::Typed(value) => Some(format!("= {}", number(value))),
            FieldEvent::Changed(RelativeNumber::Add(by)) => Some(format!("adds {} to each", number(by))),
            FieldEvent::Changed(RelativeNumber::Multiply(by)) => {
                Some(format!("multiplies each by {}", exact(by, 1e-6)))
            }
            FieldEvent::Nothing
            | FieldEvent::Touched
            | FieldEvent::Dragged(_)
            | FieldEvent::Released
            | FieldEvent::Cancelled => None,
        }
    }
}
