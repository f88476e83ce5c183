//! Moments: a time after the usual begin, or one relative to another action.

use crate::stage::time::{StageRate, StageTime, parse_time};

/// A value of `begin` or `end` as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MomentText {
    /// A time after the usual begin.
    Offset(StageTime),
    /// A moment of another action, such as `grab.touch-0.5`.
    Of {
        /// The id of the action, or `prev`.
        action: String,
        /// `begin`, `end`, or the name of an `at`.
        point: String,
        /// Added to it.
        offset: StageTime,
    },
}

impl MomentText {
    /// Reads a moment: a time, or `ID.POINT` with `+TIME` or `-TIME` after it or not. `None` for anything else.
    ///
    /// In the name of a point a `-` is only before a letter, so that in `anna-hit.end-0.5` the last one is a minus.
    pub fn parse(text: &str, rate: StageRate) -> Option<Self> {
        if let Some(time) = parse_time(text, rate) {
            return Some(Self::Offset(time));
        }
        // The first point ends the id, so an id may contain `-` before a digit.
        let (action, rest) = text.split_once('.')?;
        let (point, rest) = rest.split_at(point_length(rest));
        if !is_name(action) || point.is_empty() {
            return None;
        }
        let offset = match rest.as_bytes() {
            [] => StageTime::ZERO,
            [b'+', digit, ..] if *digit != b'-' => parse_time(&rest[1..], rate)?,
            [b'-', digit, ..] if *digit != b'-' => -parse_time(&rest[1..], rate)?,
            [_, ..] => return None,
        };
        Some(Self::Of { action: action.to_owned(), point: point.to_owned(), offset })
    }
}

/// Returns whether `text` is a name: letters, digits, `_`, and `-` before one of these; it does not begin with a digit or `-`.
pub fn is_name(text: &str) -> bool {
    !text.is_empty() && name_length(text, |next| next.is_ascii_alphanumeric() || next == b'_') == text.len()
}

/// Returns whether `text` is a name for a moment: as [`is_name`], but `-` is only before a letter, so that in `grab.touch-0.5` it is a minus.
pub(super) fn is_moment_name(text: &str) -> bool {
    !text.is_empty() && point_length(text) == text.len()
}

fn point_length(text: &str) -> usize {
    name_length(text, |next| next.is_ascii_alphabetic())
}

/// Returns the length of the name at the start of `text` in bytes; `follows` returns whether a byte may be after `-`.
fn name_length(text: &str, follows: impl Fn(u8) -> bool) -> usize {
    let bytes = text.as_bytes();
    if !bytes.first().is_some_and(|first| first.is_ascii_alphabetic() || *first == b'_') {
        return 0;
    }
    let belongs = |at: usize| {
        let next = || bytes.get(at + 1).is_some_and(|&next| follows(next));
        bytes[at].is_ascii_alphanumeric() || bytes[at] == b'_' || (bytes[at] == b'-' && next())
    };
    (0..bytes.len()).find(|&at| !belongs(at)).unwrap_or(bytes.len())
}
