//! Access to the files that an imported file refers to.

use thiserror::Error;

/// Reads files next to the one that is being imported. The implementation decides which files are reachable.
///
/// An importer asks only for paths that passed [`super::uri::relative_path`]: relative, `/` between the parts, no `..`,
/// no drive, no scheme. An implementation over a real folder must also refuse symbolic links that lead out of the
/// folder and everything but regular files, because a path alone does not show either.
pub trait AssetFs {
    /// Returns the bytes of the file at `path`. A file longer than `limit` bytes is an error, detected before its bytes
    /// are read.
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError>;
}

/// Reason why a referenced file was not read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AssetError {
    /// The file does not exist.
    #[error("there is no such file")]
    Missing,
    /// The path leads outside of the folder, or not to a regular file.
    #[error("may not be read: {0}")]
    Refused(String),
    /// The file is longer than allowed.
    #[error("too large: {size} bytes, at most {limit}")]
    TooLarge {
        /// Length of the file in bytes.
        size: u64,
        /// Number of bytes allowed.
        limit: u64,
    },
    /// The operating system reported an error.
    #[error("could not be read: {0}")]
    Failed(String),
}

/// An [`AssetFs`] that refuses every path, for files that are complete on their own.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl AssetFs for NoFiles {
    fn read(&self, _path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
        Err(AssetError::Refused("other files are not available here".to_owned()))
    }
}
