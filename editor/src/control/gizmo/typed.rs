//! Numbers typed during a drag: `45`, `-1.5`, `45/2`, `.5`. Backspace deletes, Tab moves on to the next axis.

use crate::control::expression::{Quantity, evaluate};
use crate::control::key::Key;

/// Longest number that can be typed, in characters.
const LONGEST: usize = 40;

#[derive(Clone, Debug, Default)]
struct Field {
    text: String,
    /// Value of the text, or of the last text that was a number.
    value: f64,
    is_number: bool,
}

/// Up to three numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct TypedNumbers {
    fields: [Field; 3],
    current: usize,
}

impl TypedNumbers {
    /// Clears all fields, and keeps their memory.
    pub(super) fn clear(&mut self) {
        self.current = 0;
        for field in &mut self.fields {
            field.text.clear();
            field.text.reserve(LONGEST * 4);
            (field.value, field.is_number) = (0.0, false);
        }
    }

    /// Whether something was typed, so that the pointer has no effect.
    pub(super) fn is_used(&self, count: usize) -> bool {
        self.fields.iter().take(count).any(|field| !field.text.is_empty())
    }

    /// Returns the numbers of the first `count` fields; `None` if nothing is typed.
    pub(super) fn values(&self, count: usize) -> [Option<f64>; 3] {
        std::array::from_fn(|index| {
            let field = &self.fields[index];
            (index < count && !field.text.is_empty()).then_some(field.value)
        })
    }

    /// Returns the text of a field, and whether it is a number as it is.
    pub(super) fn text(&self, field: usize) -> (&str, bool) {
        self.fields.get(field).map_or(("", true), |field| (&field.text, field.is_number))
    }

    /// Returns the index of the field that is typed into.
    pub(super) fn current(&self) -> usize {
        self.current
    }

    /// Limits the number of fields; the current one moves into the range.
    pub(super) fn limit(&mut self, count: usize) {
        self.current = self.current.min(count.saturating_sub(1));
    }

    /// Handles a key; false if it cannot be part of a number. Letters continue a number (`10cm`, `1e3`), but do not
    /// begin one.
    pub(super) fn key(&mut self, key: Key, count: usize, quantity: Quantity) -> bool {
        self.limit(count);
        let field = &mut self.fields[self.current];
        match key {
            Key::Tab => {
                self.current = (self.current + 1) % count.max(1);
                return true;
            }
            Key::Backspace => {
                if field.text.pop().is_none() {
                    return false;
                }
            }
            Key::Letter(letter) => {
                let begins = letter.is_ascii_digit() || matches!(letter, '.' | ',' | '-' | '+' | '−' | '(');
                let continues =
                    letter.is_alphabetic() || matches!(letter, ' ' | '*' | '/' | '%' | ')' | '^' | '°');
                let fits = begins || (continues && !field.text.is_empty());
                if !fits {
                    return false;
                }
                if field.text.chars().count() < LONGEST {
                    field.text.push(letter);
                }
            }
            _ => return false,
        }
        let value = evaluate(&field.text, quantity);
        field.is_number = value.is_ok();
        if field.text.is_empty() {
            (field.value, field.is_number) = (0.0, true);
        }
        // `45/` on the way to `45/2`: the last number stays.
        field.value = value.unwrap_or(field.value);
        true
    }
}
