//! Edits of a script that keep every other byte of its text: comments, layout, order and spelling.
//!
//! ```text
//! a gesture → function of this module → TextSplices → apply: the new text; inverse: back to the old one
//! ```
//!
//! | change | where it is put |
//! |---|---|
//! | a value | inside its quotes |
//! | a new attribute | after the last one: in its line, or in a line of its own where the last one has that |
//! | a new element | in a line of its own, with the indentation of its siblings; in the line of its parent where they are all in one line |
//! | a deleted element | its whole lines; comments above it and behind it only where asked for |
//! | a new name | wherever the old one is used |
//!
//! None of the functions reads the new text: whether it is a valid script, [`StageScript::read`](super::script::StageScript::read)
//! decides.

mod attribute;
mod element;
mod half;
mod insert;
mod layout;
mod names;
mod tag;

pub use attribute::{remove_attribute, set_attribute};
pub use element::{AttachedComments, delete, duplicate, move_all_after, move_to};
pub(in crate::stage) use half::insert_half;
pub use insert::{ElementPlace, NewElement, insert, insert_text, written_element};
pub use names::{RenameRefusal, elements_that_name, rename, rename_references, unique_id};
pub(in crate::stage) use names::{named, unique_among};

use super::script::SHARED;
use std::ops::Range;

/// A replacement of some bytes of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextSplice {
    /// The bytes that are replaced; empty for an insertion.
    pub range: Range<usize>,
    /// The text in their place.
    pub text: String,
}

/// Replacements of one text, in its order. They do not overlap.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextSplices(Vec<TextSplice>);

impl TextSplice {
    /// Returns the shortest replacement that leads from `old` to `new`; `None` where they are the same.
    pub fn between(old: &str, new: &str) -> Option<Self> {
        let start = old.bytes().zip(new.bytes()).take_while(|(old, new)| old == new).count();
        if start == old.len() && start == new.len() {
            return None;
        }
        let start =
            (0..=start).rev().find(|&at| old.is_char_boundary(at) && new.is_char_boundary(at)).unwrap_or(0);
        let (old_rest, new_rest) = (old.get(start..)?, new.get(start..)?);
        let same =
            old_rest.bytes().rev().zip(new_rest.bytes().rev()).take_while(|(old, new)| old == new).count();
        let fits = |&same: &usize| {
            old_rest.is_char_boundary(old_rest.len() - same)
                && new_rest.is_char_boundary(new_rest.len() - same)
        };
        let same = (0..=same).rev().find(fits).unwrap_or(0);
        let text = new_rest.get(..new_rest.len() - same)?.to_owned();
        Some(Self { range: start..old.len() - same, text })
    }
}

impl TextSplices {
    /// Creates replacements in any order; `None` where two of them overlap or a range ends before it starts.
    pub fn new(mut splices: Vec<TextSplice>) -> Option<Self> {
        splices.sort_by_key(|splice| (splice.range.start, splice.range.end));
        let is_ordered = splices.iter().all(|splice| splice.range.start <= splice.range.end)
            && splices.is_sorted_by(|one, next| one.range.end <= next.range.start);
        is_ordered.then_some(Self(splices))
    }

    /// Joins replacements of the same text; `None` where two of them overlap.
    pub fn joined(parts: impl IntoIterator<Item = Self>) -> Option<Self> {
        Self::new(parts.into_iter().flat_map(|part| part.0).collect())
    }

    /// Creates one replacement.
    pub(super) fn one(range: Range<usize>, text: impl Into<String>) -> Self {
        Self(vec![TextSplice { range, text: text.into() }])
    }

    /// Creates replacements that do not overlap, in any order.
    pub(super) fn of(mut splices: Vec<TextSplice>) -> Self {
        splices.sort_by_key(|splice| (splice.range.start, splice.range.end));
        debug_assert!(splices.is_sorted_by(|one, next| one.range.end <= next.range.start));
        Self(splices)
    }

    /// Returns the replacements before a byte, and those from it on, as those of a text that begins there.
    pub(in crate::stage) fn split(&self, at: usize) -> (Self, Self) {
        let first = self.0.partition_point(|splice| splice.range.start < at);
        let moved = |splice: &TextSplice| TextSplice {
            range: splice.range.start - at..splice.range.end.max(splice.range.start) - at,
            text: splice.text.clone(),
        };
        (Self(self.0[..first].to_vec()), Self(self.0[first..].iter().map(moved).collect()))
    }

    /// Returns the replacements with `by` added to their places.
    pub(in crate::stage) fn shifted(self, by: usize) -> Self {
        let moved = |splice: TextSplice| TextSplice {
            range: splice.range.start + by..splice.range.end + by,
            ..splice
        };
        Self(self.0.into_iter().map(moved).collect())
    }

    /// Returns whether one of them is in the text of the project that a script belongs to.
    pub fn has_shared(&self) -> bool {
        self.0.last().is_some_and(|splice| splice.range.start >= SHARED)
    }

    /// Returns the replacements, in the order of the text.
    pub fn list(&self) -> &[TextSplice] {
        &self.0
    }

    /// Returns `text` with the replacements. Ranges that are not in `text` are left out.
    pub fn apply(&self, text: &str) -> String {
        let added: usize = self.0.iter().map(|splice| splice.text.len()).sum();
        let (mut new, mut done) = (String::with_capacity(text.len() + added), 0);
        for splice in &self.0 {
            let Some(between) = text.get(done..splice.range.start) else { continue };
            if !text.is_char_boundary(splice.range.end) {
                continue;
            }
            new += between;
            new += &splice.text;
            done = splice.range.end;
        }
        new + text.get(done..).unwrap_or_default()
    }

    /// Returns the replacements that lead from the new text back to `text`, the one before.
    pub fn inverse(&self, text: &str) -> Self {
        let (mut inverse, mut grown, mut shrunk) = (Vec::with_capacity(self.0.len()), 0, 0);
        for splice in &self.0 {
            let start = splice.range.start + grown - shrunk;
            let old = text.get(splice.range.clone()).unwrap_or_default();
            inverse.push(TextSplice { range: start..start + splice.text.len(), text: old.to_owned() });
            grown += splice.text.len();
            shrunk += splice.range.len();
        }
        Self(inverse)
    }
}

/// Returns a value as it is written between quotes of this kind.
pub(in crate::stage) fn escaped(value: &str, quote: char) -> String {
    let mut text = String::with_capacity(value.len());
    for letter in value.chars() {
        match letter {
            '&' => text += "&amp;",
            '<' => text += "&lt;",
            '"' if quote == '"' => text += "&quot;",
            '\'' if quote == '\'' => text += "&apos;",
            // Written as they are, these would be read as blanks.
            '\n' => text += "&#10;",
            '\r' => text += "&#13;",
            '\t' => text += "&#9;",
            other => text.push(other),
        }
    }
    text
}
