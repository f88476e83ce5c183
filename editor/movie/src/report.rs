//! The result of a movie.

use std::path::PathBuf;

/// The result of a movie.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MovieReport {
    /// Number of frames that were written.
    pub frames: u64,
    /// The file, or that of the last frame; `None` for a stream.
    pub path: Option<PathBuf>,
    /// Number of bytes of all files.
    pub bytes: u64,
    /// Number of frames at the end that were left out, because the disk was full when the movie was completed. There is a notice, too.
    pub left_out: u64,
    /// Differences from the frames that were given, in sentences for the user.
    pub notices: Vec<String>,
}
