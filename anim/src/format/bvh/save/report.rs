//! Description of what a save changes, and of what it cannot store.

use crate::format::{ChangeReport, Place, Warning, one_line};
use std::fmt::Write;

/// Property of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Property {
    Translation,
    Rotation,
    Scale,
}

impl Property {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
            Self::Scale => "scale",
        }
    }
}

/// Edited frames of a property of a joint.
pub(super) struct ChangedColumn {
    pub(super) bone: String,
    pub(super) property: Property,
    pub(super) frames: usize,
}

/// All changes of a save.
#[derive(Default)]
pub(super) struct BvhChanges {
    pub(super) columns: Vec<ChangedColumn>,
    /// Number of replaced numbers.
    pub(super) numbers: usize,
    pub(super) appended: usize,
    pub(super) removed: usize,
}

impl BvhChanges {
    /// Returns the changes for users and for programs.
    pub(super) fn report(&self) -> ChangeReport {
        let mut text = String::new();
        let mut bones = Vec::new();
        for column in &self.columns {
            let (name, property) = (&column.bone, column.property.name());
            let _ = writeln!(text, "\"{}\", {property}: {}", one_line(name), count(column.frames, "frame"));
            let name = json_text(name);
            bones.push(format!("{{\"bone\":{name},\"frames\":{},\"path\":\"{property}\"}}", column.frames));
        }
        for (frames, what) in [(self.appended, "appended"), (self.removed, "removed")] {
            if frames > 0 {
                let _ = writeln!(text, "{} {what} at the end", count(frames, "frame"));
            }
        }
        let head = if text.is_empty() {
            "nothing changes".to_owned()
        } else {
            count(self.numbers, "number") + " replaced"
        };
        let json = format!(
            "{{\"channels\":[{}],\"framesAppended\":{},\"framesRemoved\":{},\"numbers\":{}}}",
            bones.join(","),
            self.appended,
            self.removed,
            self.numbers
        );
        ChangeReport { text: format!("{head}\n{text}"), json }
    }
}

/// Returns a number with its noun.
pub(super) fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// Returns a text as a JSON string.
fn json_text(text: &str) -> String {
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

/// Content that a BVH file cannot represent, each once.
#[derive(Default)]
pub(in super::super) struct Losses(Vec<Warning>);

impl Losses {
    /// Adds a loss at a JSON pointer into the model.
    pub(in super::super) fn add(&mut self, pointer: String, code: &'static str, text: impl Into<String>) {
        let place = Place::Pointer(pointer);
        if !self.0.iter().any(|lost| lost.place == place && lost.code == code) {
            self.0.push(Warning { place, code, text: text.into() });
        }
    }

    /// Returns the list.
    pub(in super::super) fn into_list(self) -> Vec<Warning> {
        self.0
    }
}
