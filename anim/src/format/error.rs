//! Errors and warnings of imports and exports, each with a place and a reason.

use std::error::Error as StdError;
use std::fmt;
use thiserror::Error;

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub enum Place {
    /// The file as a whole.
    #[default]
    File,
    /// A value in a JSON text, as a JSON pointer (RFC 6901): `/accessors/3/count`.
    Pointer(String),
    /// Offset from the start of the file, in bytes.
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

/// Reason why a file could not be read. Displayed as `place: reason`, on one line.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ImportError {
    /// The file breaks a rule of its format.
    #[error("{place}: {}", one_line(reason))]
    Invalid {
        /// Place of the invalid value.
        place: Place,
        /// Name of the broken rule: the one of the Khronos glTF validator where that has one.
        code: &'static str,
        /// Description of the error, with the numbers.
        reason: String,
    },
    /// The file may be valid, but needs a feature that is not supported.
    #[error("{place}: needs {}, which is not supported", one_line(feature))]
    Unsupported {
        /// Place that requires the feature.
        place: Place,
        /// Name of the feature.
        feature: String,
    },
    /// The file needs more than the limits in [`crate::limits`] allow.
    #[error("{place}: {what}: {size}, at most {limit}")]
    TooLarge {
        /// Place that exceeds the limit.
        place: Place,
        /// What is counted.
        what: &'static str,
        /// Number that the file needs.
        size: u64,
        /// Largest number allowed.
        limit: u64,
    },
    /// A referenced file is missing, or may not be read.
    #[error("{place}: \"{}\": {}", one_line(uri), one_line(reason))]
    External {
        /// Place of the reference.
        place: Place,
        /// As in [`Self::Invalid`].
        code: &'static str,
        /// The reference as written in the file, shortened when very long.
        uri: String,
        /// Reason why it was not read.
        reason: String,
    },
    /// Neither the name nor the content of the file is of a known format.
    #[error("file: \"{}\" has no known format", one_line(name))]
    UnknownFormat {
        /// Name of the file.
        name: String,
    },
    /// The file cannot be opened for editing, since files of its format can only be read.
    #[error("file: files of the format {title} can only be read; save the model in another format")]
    ReadOnly {
        /// [`Format::title`](super::Format::title) of the format.
        title: &'static str,
    },
    /// [`super::ReadOptions::is_cancelled`] returned `true`.
    #[error("file: cancelled")]
    Cancelled,
}

impl ImportError {
    /// Returns the place of the error.
    pub fn place(&self) -> &Place {
        match self {
            Self::Invalid { place, .. }
            | Self::Unsupported { place, .. }
            | Self::TooLarge { place, .. }
            | Self::External { place, .. } => place,
            Self::UnknownFormat { .. } | Self::ReadOnly { .. } | Self::Cancelled => &Place::File,
        }
    }

    /// Returns the name of the broken rule.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Invalid { code, .. } | Self::External { code, .. } => code,
            Self::Unsupported { .. } => "UNSUPPORTED_EXTENSION",
            Self::TooLarge { .. } => "LIMIT",
            Self::UnknownFormat { .. } => "UNKNOWN_FORMAT",
            Self::ReadOnly { .. } => "READ_ONLY_FORMAT",
            Self::Cancelled => "CANCELLED",
        }
    }
}

/// Reason why a model could not be written: the error of the format, displayed as `place: reason` on one line.
/// Nothing was written.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct ExportError(Box<dyn StdError + Send + Sync>);

impl ExportError {
    /// Wraps the error of a format, or a text.
    pub fn new(error: impl Into<Box<dyn StdError + Send + Sync>>) -> Self {
        Self(error.into())
    }

    /// Returns the error of the format, for downcasting.
    pub fn get_ref(&self) -> &(dyn StdError + Send + Sync + 'static) {
        self.0.as_ref()
    }
}

/// Something in a file that was corrected, left out, or looks wrong. Displayed as `place: text`, on one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Place in the file.
    pub place: Place,
    /// Name of the rule, as in [`ImportError::Invalid`].
    pub code: &'static str,
    /// Description of the problem, and how it was handled.
    pub text: String,
}

impl Warning {
    /// Returns whether this changes neither what is drawn nor what is animated: something unused was left out, or the file
    /// breaks a rule without any effect on what was read.
    pub fn is_harmless(&self) -> bool {
        const HARMLESS: &[&str] = &[
            "ACCESSOR_OFFSET_ALIGNMENT",
            "BUFFER_GLB_CHUNK_TOO_BIG",
            "CAMERA_NOT_SHOWN",
            "FBX_TEXT",
            "IMAGE_MIME_TYPE_INVALID",
            "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
        ];
        HARMLESS.contains(&self.code)
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, one_line(&self.text))
    }
}

/// Returns `text` with control characters escaped and at most 300 characters long, so that text from a file never spans
/// several lines of a message.
pub(crate) fn one_line(text: &str) -> String {
    let mut line: String = text.chars().take(300).flat_map(escape).collect();
    if text.chars().nth(300).is_some() {
        line.push('…');
    }
    line
}

/// Returns the character, or its escape sequence if it is invisible or ends the line.
fn escape(character: char) -> impl Iterator<Item = char> {
    let hidden =
        character.is_control() || matches!(character, '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}');
    let (shown, escaped) =
        if hidden { (None, Some(character.escape_unicode())) } else { (Some(character), None) };
    shown.into_iter().chain(escaped.into_iter().flatten())
}
