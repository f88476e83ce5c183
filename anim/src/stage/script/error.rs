//! Errors of scripts: where, what, and what to do.

use super::text_place::{LineIndex, TextPlace};
use std::fmt;
use std::ops::Range;

/// An error of a script, with its place in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptError {
    /// The bytes of the text that are wrong.
    pub range: Range<usize>,
    /// Line and column of their start.
    pub place: TextPlace,
    /// The mistake, and what was expected.
    pub message: String,
    /// The likely meaning, or the possible names; empty where there is nothing to suggest.
    pub help: String,
}

impl ScriptError {
    /// Creates an error at some bytes of `text`, for what is found outside of this module, such as a missing file.
    pub fn at(text: &str, range: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Self {
        let place = LineIndex::new(&text.into()).place(range.start);
        Self { range, place, message: message.into(), help: help.into() }
    }

    /// Returns the message, with the help after a semicolon.
    pub fn text(&self) -> String {
        if self.help.is_empty() { self.message.clone() } else { format!("{}; {}", self.message, self.help) }
    }

    /// Returns `FILE:LINE:COLUMN: MESSAGE`, with the help after a semicolon.
    pub fn in_file(&self, file: &str) -> String {
        format!("{file}:{self}")
    }
}

impl fmt::Display for ScriptError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}: {}", self.place, self.text())
    }
}

impl std::error::Error for ScriptError {}

/// Largest number of errors that are collected; a text that is wrong throughout needs no more.
pub const MOST_ERRORS: usize = 100;

/// Errors that are collected from one text.
#[derive(Debug)]
pub(crate) struct ErrorList<'a> {
    lines: &'a LineIndex,
    errors: Vec<ScriptError>,
}

impl<'a> ErrorList<'a> {
    pub(crate) fn new(lines: &'a LineIndex) -> Self {
        Self { lines, errors: Vec::new() }
    }

    /// Adds an error, unless there are too many.
    pub(crate) fn add(&mut self, range: Range<usize>, message: impl Into<String>, help: impl Into<String>) {
        if self.errors.len() < MOST_ERRORS {
            let place = self.lines.place(range.start);
            self.errors.push(ScriptError { range, place, message: message.into(), help: help.into() });
        }
    }

    /// Returns the place of a byte.
    pub(crate) fn place(&self, at: usize) -> TextPlace {
        self.lines.place(at)
    }

    /// Returns whether no more errors are added.
    pub(crate) fn is_full(&self) -> bool {
        self.errors.len() >= MOST_ERRORS
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// Returns the errors in the order of the text.
    pub(crate) fn sorted(mut self) -> Vec<ScriptError> {
        self.errors.sort_by_key(|error| error.range.start);
        self.errors
    }
}
