//! The origins of the elements of a script: its text, its project, or a file that it includes.
//!
//! Elements of included files have ranges too: bytes after the end of the text, file after file; those of a project have bytes far after all of these. So what
//! reports an error at a range need not know where that is, and a splice of the text at such a range finds no bytes there.

use super::error::ScriptError;
use super::text_place::{LineIndex, TextPlace};
use crate::stage::time::StageRate;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Added to the bytes of what a script shares with its project: more than all texts have, so that no byte of another one is meant.
pub(in crate::stage) const SHARED: usize = 1 << 30;

/// The text that has an element of a script.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ElementOrigin {
    /// In the text of the script.
    #[default]
    Text,
    /// In the cast of the project that the script belongs to. Its bytes are those of the project's text, moved beyond all texts.
    Project,
    /// In an included file: the number of the included part. Its bytes are after the end of the script's text then.
    Included(usize),
}

/// A place in an included file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IncludedPlace {
    /// The file, relative to the folder of the document.
    pub file: Arc<str>,
    /// The bytes in it.
    pub range: Range<usize>,
    /// Line and column of their start.
    pub place: TextPlace,
}

impl fmt::Display for IncludedPlace {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}:{}", self.file, self.place)
    }
}

/// The elements that one `include` brings.
#[derive(Clone, Debug)]
pub(in crate::stage) struct IncludedPart {
    /// The file, relative to the folder of the document.
    pub(super) file: Arc<str>,
    /// The lines of its text.
    pub(super) lines: LineIndex,
    /// The frame rate that its times in frames have.
    pub(super) rate: StageRate,
    /// The element of the `include`.
    pub(super) include: usize,
    /// The element of the `include` in the text of the script: the same, or the outermost one around it.
    pub(super) outermost: usize,
    /// The bytes of the name of that.
    pub(super) name: Range<usize>,
    /// Its own elements.
    pub(super) elements: Range<usize>,
    /// The number of the part after the last one that is included by it or by what it includes.
    pub(super) end: usize,
    /// The first of the bytes that the file has in the ranges of its elements.
    pub(super) base: usize,
}

impl IncludedPart {
    /// Returns the part with a byte; `None` for a byte of the text itself, or of its project.
    pub(super) fn at(parts: &[Self], at: usize) -> Option<&Self> {
        if at >= SHARED {
            return None;
        }
        parts[..parts.partition_point(|part| part.base <= at)].last()
    }

    /// Returns line and column in the file of a byte.
    pub(super) fn place(&self, at: usize) -> TextPlace {
        self.lines.place(at.saturating_sub(self.base))
    }
}

/// Returns an error at some bytes of a text with its included parts.
pub(super) fn located(
    lines: &LineIndex,
    parts: &[IncludedPart],
    range: Range<usize>,
    message: String,
    help: String,
) -> ScriptError {
    let Some(part) = IncludedPart::at(parts, range.start) else {
        return ScriptError { place: lines.place(range.start), range, inside: None, message, help };
    };
    let inside = IncludedPlace {
        file: Arc::clone(&part.file),
        place: part.place(range.start),
        range: range.start - part.base..range.end.max(range.start) - part.base,
    };
    let (place, range) = (lines.place(part.name.start), part.name.clone());
    ScriptError { place, range, inside: Some(Box::new(inside)), message, help }
}
