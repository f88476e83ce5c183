//! Content that a format has no room for, and words for reports.

use super::{Place, Warning};

/// Returns a number with its noun.
pub(super) fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// Returns a text as a JSON string.
pub(super) fn json_text(text: &str) -> String {
    let mut json = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => json.extend(['\\', character]),
            '\u{0}'..='\u{1f}' => json += &format!("\\u{:04x}", u32::from(character)),
            _ => json.push(character),
        }
    }
    json + "\""
}

/// Content that a file cannot represent, each once.
#[derive(Default)]
pub(super) struct Losses(Vec<Warning>);

impl Losses {
    /// Adds a loss at a JSON pointer into the model.
    pub(super) fn add(&mut self, pointer: String, code: &'static str, text: impl Into<String>) {
        let place = Place::Pointer(pointer);
        if !self.0.iter().any(|lost| lost.place == place && lost.code == code) {
            self.0.push(Warning { place, code, text: text.into() });
        }
    }

    /// Returns the list.
    pub(super) fn into_list(self) -> Vec<Warning> {
        self.0
    }
}
