//! Content that a format has no room for, and words for reports.

use super::{Place, Warning};
use crate::data::ModelData;

/// Code of a loss: parts of the body and facial expressions.
const AVATAR_NOT_STORED: &str = "AVATAR_NOT_STORED";

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

/// Returns the loss of the humanoid bones and expressions of VRM, if the model has any.
pub(super) fn avatar_lost(model: &ModelData) -> Option<Warning> {
    (!model.avatar.is_empty()).then(|| Warning {
        place: Place::Pointer("/avatar".to_owned()),
        code: AVATAR_NOT_STORED,
        text: "humanoid bones and facial expressions are written to .vrma only".to_owned(),
    })
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

    /// Returns the list, with what the format has no room for in any model.
    pub(super) fn into_list_of(self, model: &ModelData) -> Vec<Warning> {
        let mut list = self.0;
        list.extend(avatar_lost(model));
        list
    }

    /// Returns the list.
    pub(super) fn into_list(self) -> Vec<Warning> {
        self.0
    }
}
