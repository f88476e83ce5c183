//! A model to open, and the reason why it could not be opened.

use super::FileAccessError;
use dragonfly_anim::format::Conventions;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The model to open.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// The model that is part of the program.
    BuiltIn,
    /// A file, with the units, axes and frame rate that it states.
    File(PathBuf),
    /// A file, with units, axes and a frame rate that the user chose.
    FileAs(PathBuf, Conventions),
}

impl Source {
    /// Returns the source of a file with these conventions; where none is chosen, those of the file are taken.
    pub fn of(path: PathBuf, chosen: Conventions) -> Self {
        if chosen == Conventions::default() { Self::File(path) } else { Self::FileAs(path, chosen) }
    }

    /// Returns the path of the file; `None` for the built-in model.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::BuiltIn => None,
            Self::File(path) | Self::FileAs(path, _) => Some(path),
        }
    }

    /// Returns the conventions that the user chose.
    pub fn conventions(&self) -> Conventions {
        match self {
            Self::BuiltIn | Self::File(_) => Conventions::default(),
            Self::FileAs(_, chosen) => *chosen,
        }
    }

    /// Returns the file name without folder, or "Dragonfly" for the built-in model.
    pub fn title(&self) -> String {
        match self {
            Self::BuiltIn => "Dragonfly".to_owned(),
            Self::File(path) | Self::FileAs(path, _) => file_name(path),
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
