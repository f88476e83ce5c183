//! The one door through which an importer reaches other files.

use thiserror::Error;

/// Reads files that belong to the one being imported. Whoever implements it decides what is reachable.
///
/// An importer asks only for paths that passed [`super::uri::relative_path`]: relative, `/` between parts, no `..`,
/// no drive, no scheme. An implementation over a real folder must still refuse symbolic links that lead out and
/// anything but regular files: a name says nothing about what it names.
pub trait AssetFs {
    /// The whole file, or why not. A file longer than `limit` bytes is an error, found before it is read.
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError>;
}

/// Why the door stayed shut.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AssetError {
    /// No such file.
    #[error("there is no such file")]
    Missing,
    /// Outside the folder, or not a regular file.
    #[error("may not be read: {0}")]
    Refused(String),
    /// Longer than allowed.
    #[error("too large: {size} bytes, at most {limit}")]
    TooLarge {
        /// Bytes it has.
        size: u64,
        /// Bytes that were allowed.
        limit: u64,
    },
    /// The system said no.
    #[error("could not be read: {0}")]
    Failed(String),
}

/// A door that never opens, for files that must stand alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl AssetFs for NoFiles {
    fn read(&self, _path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
        Err(AssetError::Refused("other files are out of reach here".to_owned()))
    }
}
