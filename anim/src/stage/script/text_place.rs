//! Lines and columns of byte positions in a text.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A line and a column, both counted from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TextPlace {
    /// The line.
    pub line: u32,
    /// The character in the line.
    pub column: u32,
}

impl fmt::Display for TextPlace {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}:{}", self.line, self.column)
    }
}

/// The starts of the lines of a text. A clone is cheap.
#[derive(Clone, Debug)]
pub(in crate::stage) struct LineIndex {
    text: Arc<str>,
    starts: Arc<[usize]>,
}

impl LineIndex {
    pub(super) fn new(text: &Arc<str>) -> Self {
        let breaks = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n');
        Self {
            text: Arc::clone(text),
            starts: std::iter::once(0).chain(breaks.map(|(at, _)| at + 1)).collect(),
        }
    }

    /// Returns the place of the byte at `at`; that of the end for a position past it.
    pub(super) fn place(&self, at: usize) -> TextPlace {
        let at = at.min(self.text.len());
        let line = self.starts.partition_point(|&start| start <= at);
        let start = self.starts.get(line.saturating_sub(1)).copied().unwrap_or(0);
        let before = self.text.get(start..at).unwrap_or("");
        TextPlace { line: line as u32, column: before.chars().count() as u32 + 1 }
    }

    /// Returns the empty range at a line and a column, both counted from 1; the end of the text past its end.
    pub(super) fn range(&self, line: u32, column: u32) -> Range<usize> {
        let start = self.starts.get(line.saturating_sub(1) as usize).copied().unwrap_or(self.text.len());
        let rest = self.text.get(start..).unwrap_or("");
        let within =
            rest.char_indices().nth(column.saturating_sub(1) as usize).map_or(rest.len(), |found| found.0);
        start + within..start + within
    }
}
