//! What goes wrong in a file: where, and why.

use std::fmt;
use thiserror::Error;

/// Where in a file.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub enum Place {
    /// The file as a whole.
    #[default]
    File,
    /// A value in a JSON text, as a JSON pointer (RFC 6901): `/accessors/3/count`.
    Pointer(String),
    /// Offset from the start of the file.
    Byte(u64),
    /// Line and column of a text, both from 1; the column counts bytes.
    Line(u32, u32),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => f.write_str("file"),
            Self::Pointer(pointer) if pointer.is_empty() => f.write_str("/"),
            Self::Pointer(pointer) => f.write_str(&one_line(pointer)),
            Self::Byte(offset) => write!(f, "byte {offset}"),
            Self::Line(line, column) => write!(f, "line {line} column {column}"),
        }
    }
}

/// Why a file could not be read. Shown as `place: reason`, on one line.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ImportError {
    /// The file says something that cannot be so.
    #[error("{place}: {}", one_line(reason))]
    Invalid {
        /// Where.
        place: Place,
        /// Name of the broken rule, after the Khronos glTF validator's where it has one.
        code: &'static str,
        /// What is wrong, with the numbers.
        reason: String,
    },
    /// The file may well be right, but needs something that is not read.
    #[error("{place}: needs {}, which is not supported", one_line(feature))]
    Unsupported {
        /// Where it is asked for.
        place: Place,
        /// Its name.
        feature: String,
    },
    /// The file asks for more than [`crate::limits`] grant.
    #[error("{place}: {what}: {size}, at most {limit}")]
    TooLarge {
        /// Where.
        place: Place,
        /// What is counted.
        what: &'static str,
        /// How much the file asks for.
        size: u64,
        /// How much it gets.
        limit: u64,
    },
    /// A file beside this one is missing, or may not be read.
    #[error("{place}: \"{}\": {}", one_line(uri), one_line(reason))]
    External {
        /// Where it is named.
        place: Place,
        /// As in [`Self::Invalid`].
        code: &'static str,
        /// As written in the file, shortened when very long.
        uri: String,
        /// Why not.
        reason: String,
    },
    /// Neither name nor content are those of a known format.
    #[error("file: \"{}\" is of no known format", one_line(name))]
    UnknownFormat {
        /// The file's name.
        name: String,
    },
    /// [`super::ReadOptions::is_cancelled`] said so.
    #[error("file: cancelled")]
    Cancelled,
}

impl ImportError {
    /// Where it went wrong.
    pub fn place(&self) -> &Place {
        match self {
            Self::Invalid { place, .. }
            | Self::Unsupported { place, .. }
            | Self::TooLarge { place, .. }
            | Self::External { place, .. } => place,
            Self::UnknownFormat { .. } | Self::Cancelled => &Place::File,
        }
    }

    /// Name of the broken rule.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Invalid { code, .. } | Self::External { code, .. } => code,
            Self::Unsupported { .. } => "UNSUPPORTED_EXTENSION",
            Self::TooLarge { .. } => "LIMIT",
            Self::UnknownFormat { .. } => "UNKNOWN_FORMAT",
            Self::Cancelled => "CANCELLED",
        }
    }
}

/// Something in a file that was mended, left out, or looks odd. Shown as `place: text`, on one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where.
    pub place: Place,
    /// Name of the rule, as in [`ImportError::Invalid`].
    pub code: &'static str,
    /// What, and what was done about it.
    pub text: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, one_line(&self.text))
    }
}

/// `text` without control characters, at most 300 characters: words of a file never break a message apart.
pub(crate) fn one_line(text: &str) -> String {
    let mut line: String = text.chars().take(300).flat_map(escape).collect();
    if text.chars().nth(300).is_some() {
        line.push('…');
    }
    line
}

/// The character itself, or its escape when it would not show on one line.
fn escape(character: char) -> impl Iterator<Item = char> {
    let hidden =
        character.is_control() || matches!(character, '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}');
    let (shown, escaped) =
        if hidden { (None, Some(character.escape_unicode())) } else { (Some(character), None) };
    shown.into_iter().chain(escaped.into_iter().flatten())
}
