//! A model to open, and the reason why it could not be opened.

use super::FileAccessError;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The model to open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The model that is part of the program.
    BuiltIn,
    /// A file.
    File(PathBuf),
}

impl Source {
    /// Returns the file name without folder, or "Dragonfly" for the built-in model.
    pub fn title(&self) -> String {
        match self {
            Self::BuiltIn => "Dragonfly".to_owned(),
            Self::File(path) => file_name(path),
        }
    }
}

/// The reason why a model could not be opened, with its place.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The file could not be read.
    #[error("{}", not_read(path, reason))]
    File {
        /// The path.
        path: PathBuf,
        /// The reason.
        reason: FileAccessError,
    },
    /// Its contents are wrong.
    #[error("{title}: {reason}")]
    Format {
        /// The title.
        title: String,
        /// Place in the file, and reason.
        reason: String,
    },
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Returns why the file was not read; a folder is no file at all.
fn not_read(path: &Path, reason: &FileAccessError) -> String {
    if let FileAccessError::NotRegular(kind) = reason {
        return format!("{} is {kind}", path.display());
    }
    format!("{}: file: {reason}", path.display())
}

/// Returns the last part of `path`, or all of it where it has no parts.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
