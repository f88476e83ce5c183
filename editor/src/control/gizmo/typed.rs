//! Numbers typed while dragging: `45`, `-1.5`, `45/2`, `.5`; Backspace takes back, Tab goes on to the next axis.

use crate::control::expression::{Quantity, evaluate};
use crate::control::key::Key;

/// Longest number that can be typed, letters.
const LONGEST: usize = 40;

#[derive(Clone, Debug, Default)]
struct Field {
    text: String,
    /// Of the text, or of the last one that was a number.
    value: f64,
    is_number: bool,
}

/// Up to three numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Typed {
    fields: [Field; 3],
    current: usize,
}

impl Typed {
    /// Forgets all; keeps the memory.
    pub(super) fn clear(&mut self) {
        self.current = 0;
        for field in &mut self.fields {
            field.text.clear();
            field.text.reserve(LONGEST * 4);
            (field.value, field.is_number) = (0.0, false);
        }
    }

    /// Has something been typed? Then the pointer counts no more.
    pub(super) fn is_used(&self, count: usize) -> bool {
        self.fields.iter().take(count).any(|field| !field.text.is_empty())
    }

    /// Numbers of the first `count` fields; `None` where nothing is typed.
    pub(super) fn values(&self, count: usize) -> [Option<f64>; 3] {
        std::array::from_fn(|index| {
            let field = &self.fields[index];
            (index < count && !field.text.is_empty()).then_some(field.value)
        })
    }

    /// What is typed in a field, and whether it is a number as it stands.
    pub(super) fn text(&self, field: usize) -> (&str, bool) {
        self.fields.get(field).map_or(("", true), |field| (&field.text, field.is_number))
    }

    /// Which field is typed into.
    pub(super) fn current(&self) -> usize {
        self.current
    }

    /// Fewer fields than before: typing goes on in one that there is.
    pub(super) fn limit(&mut self, count: usize) {
        self.current = self.current.min(count.saturating_sub(1));
    }

    /// Takes a key; `false` for one that no number has. Letters continue a number (`10cm`, `1e3`), they begin none.
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
        // `45/` on the way to `45/2`: what was there stays.
        field.value = value.unwrap_or(field.value);
        true
    }
}
