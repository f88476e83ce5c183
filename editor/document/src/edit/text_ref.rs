//! A reference to a text of the document.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A text of the document, by its index in the list of texts or by its name.
///
/// In JSON a number or a string.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TextRef {
    /// Index in the list of texts, from 0 for the main file.
    Index(usize),
    /// Its path relative to the folder of the main file, with `/` between its parts.
    Name(String),
}

impl fmt::Display for TextRef {
    /// Writes a name in quotes and a number without.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index(index) => write!(out, "{index}"),
            Self::Name(name) => write!(out, "{name:?}"),
        }
    }
}
