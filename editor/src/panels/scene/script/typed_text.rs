//! The text of the script as the field shows it. It is copied when something is typed, not in each frame.

use egui::TextBuffer;
use egui::text::CharIndex;
use std::any::TypeId;
use std::ops::Range;

/// The text, and how it was before it was changed.
#[derive(Debug, Default)]
pub(super) struct TypedText {
    text: String,
    before: Option<String>,
}

impl TypedText {
    /// Shows another text, which no one has typed.
    pub(super) fn set(&mut self, text: &str) {
        (self.text, self.before) = (text.to_owned(), None);
    }

    /// Replaces a range of bytes as if it was typed. Returns whether there is such a range.
    pub(super) fn replace_range(&mut self, range: Range<usize>, text: &str) -> bool {
        let is_there = self.text.get(range.clone()).is_some();
        if is_there {
            self.note();
            self.text.replace_range(range, text);
        }
        is_there
    }

    /// Returns the text before what was typed since the last call; `None` if it is the same.
    pub(super) fn take_before(&mut self) -> Option<String> {
        self.before.take().filter(|before| *before != self.text)
    }

    fn note(&mut self) {
        self.before.get_or_insert_with(|| self.text.clone());
    }
}

impl TextBuffer for TypedText {
    fn is_mutable(&self) -> bool {
        true
    }

    fn as_str(&self) -> &str {
        &self.text
    }

    fn insert_text(&mut self, text: &str, char_index: CharIndex) -> usize {
        self.note();
        self.text.insert_text(text, char_index)
    }

    fn delete_char_range(&mut self, char_range: Range<CharIndex>) {
        self.note();
        self.text.delete_char_range(char_range);
    }

    fn type_id(&self) -> TypeId {
        TypeId::of::<Self>()
    }
}
