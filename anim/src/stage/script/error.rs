//! Errors of scripts: where, what, and what to do.

use super::origin::{IncludedPart, IncludedPlace, located};
use super::text_place::{LineIndex, TextPlace};
use std::fmt;
use std::ops::Range;

/// An error of a script, with its place in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptError {
    /// The bytes of the text that are wrong; those of the `include` for an error in a file that it names.
    pub range: Range<usize>,
    /// Line and column of their start.
    pub place: TextPlace,
    /// The place in the included file, for an error there.
    pub inside: Option<Box<IncludedPlace>>,
    /// The mistake, and what was expected.
    pub message: String,
    /// The likely meaning, or the possible names; empty where there is nothing to suggest.
    pub help: String,
}

impl ScriptError {
    /// Creates an error at some bytes of `text`, for what is found outside of this module, such as a missing file.
    pub fn at(text: &str, range: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Self {
        let place = LineIndex::new(&text.into()).place(range.start);
        Self { range, place, inside: None, message: message.into(), help: help.into() }
    }

    /// Returns the message, with the help after a semicolon.
    pub fn sentence(&self) -> String {
        if self.help.is_empty() { self.message.clone() } else { format!("{}; {}", self.message, self.help) }
    }

    /// Returns the message, with the help after a semicolon; for an error in an included file after `FILE:LINE:COLUMN: ` of that.
    pub fn text(&self) -> String {
        match &self.inside {
            Some(inside) => format!("{inside}: {}", self.sentence()),
            None => self.sentence(),
        }
    }

    /// Returns `FILE:LINE:COLUMN: MESSAGE`, with the help after a semicolon. The file is `file`, or the included one that has the error.
    pub fn in_file(&self, file: &str) -> String {
        match &self.inside {
            Some(_) => self.text(),
            None => format!("{file}:{self}"),
        }
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

/// Largest number of errors that are looked at again because a file is included again: what a hostile script costs.
const MOST_REPEATED: usize = 10_000;

/// Errors that are collected from one text.
#[derive(Debug)]
pub(crate) struct ErrorList<'a> {
    lines: &'a LineIndex,
    parts: &'a [IncludedPart],
    errors: Vec<ScriptError>,
    /// Number of errors that were there already.
    repeated: usize,
}

impl<'a> ErrorList<'a> {
    pub(crate) fn new(lines: &'a LineIndex) -> Self {
        Self::with_parts(lines, &[])
    }

    /// Creates a list for a text with what it includes.
    pub(in crate::stage) fn with_parts(lines: &'a LineIndex, parts: &'a [IncludedPart]) -> Self {
        Self { lines, parts, errors: Vec::new(), repeated: 0 }
    }

    /// Adds an error, unless there are too many. One that a file has, is reported once, however often that is included.
    pub(crate) fn add(&mut self, range: Range<usize>, message: impl Into<String>, help: impl Into<String>) {
        if self.is_full() {
            return;
        }
        let message = message.into();
        // Before its line and column are counted.
        let part = IncludedPart::at(self.parts, range.start);
        if part.is_some_and(|part| self.is_known(&part.file, range.start - part.base, &message)) {
            self.repeated += 1;
            return;
        }
        self.errors.push(located(self.lines, self.parts, range, message, help.into()));
    }

    /// Adds an error that has its place, unless there are too many.
    pub(in crate::stage) fn push(&mut self, error: ScriptError) {
        if !self.is_full() {
            self.errors.push(error);
        }
    }

    /// Returns whether there is this error at a byte of a file already.
    fn is_known(&self, file: &str, at: usize, message: &str) -> bool {
        let is_there = |inside: &IncludedPlace| &*inside.file == file && inside.range.start == at;
        let is_same =
            |error: &ScriptError| error.message == message && error.inside.as_deref().is_some_and(is_there);
        self.errors.iter().any(is_same)
    }

    /// Returns the place of a byte: in its own file, for a byte of an included one.
    pub(crate) fn place(&self, at: usize) -> TextPlace {
        IncludedPart::at(self.parts, at).map_or_else(|| self.lines.place(at), |part| part.place(at))
    }

    /// Returns whether no more errors are added.
    pub(crate) fn is_full(&self) -> bool {
        self.errors.len() >= MOST_ERRORS || self.repeated >= MOST_REPEATED
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// Returns the errors in the order of the text.
    pub(crate) fn sorted(mut self) -> Vec<ScriptError> {
        let inside = |error: &ScriptError| {
            error.inside.as_ref().map(|inside| (inside.file.clone(), inside.range.start))
        };
        self.errors.sort_by_cached_key(|error| (error.range.start, inside(error)));
        self.errors
    }
}
