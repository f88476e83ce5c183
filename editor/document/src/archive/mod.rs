//! Archives of projects: ZIP files with the files of one folder.
//!
//! The crate `zip` knows the format. Only what such an archive needs is written and read: files that are stored or deflated, without
//! encryption, and no links. Names lead downwards only, and what an archive may unpack to is limited before memory is allocated.

mod read;
mod write;

pub use read::read_archive;
pub use write::write_archive;

use dragonfly_anim::limits::FILE_BYTES;
use thiserror::Error;

/// Largest number of bytes that an archive may unpack to.
pub const MOST_UNPACKED: u64 = 4 << 30;

/// Largest number of files in an archive.
pub const MOST_FILES: usize = 65_534;

/// A file in an archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArchivedFile {
    /// Its path, with `/` between its parts.
    pub name: String,
    /// Its contents.
    pub bytes: Vec<u8>,
}

/// The reason why an archive cannot be read or written.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ArchiveError {
    /// The bytes are no ZIP archive, or damaged.
    #[error("this is not a ZIP archive, or it is damaged: {0}")]
    Damaged(String),
    /// It uses a feature of the format that is not supported.
    #[error("{name}: {feature} is not supported")]
    Unsupported {
        /// Name of the file; of the archive, "the archive".
        name: String,
        /// The feature.
        feature: &'static str,
    },
    /// A name leads out of the folder, or is no name of a file.
    #[error("{name:?}: {reason}")]
    Name {
        /// The name.
        name: String,
        /// The reason.
        reason: String,
    },
    /// Two files have the same name.
    #[error("{0}: the archive has this file twice")]
    Twice(String),
    /// It has too many files.
    #[error("the archive would have {0} files; at most {MOST_FILES} are possible")]
    TooMany(usize),
    /// It would unpack to too many bytes.
    #[error("the archive unpacks to more than {MOST_UNPACKED} bytes")]
    TooLarge,
    /// The archive itself would have too many bytes to be read again.
    #[error("the archive would have {0} bytes; at most {FILE_BYTES} can be unpacked")]
    TooLong(u64),
    /// It cannot be written.
    #[error("the archive cannot be written: {0}")]
    Unwritten(String),
    /// The contents of a file are not those that were packed.
    #[error("{0}: its contents are damaged")]
    Checksum(String),
}

/// Returns the name if it leads to a file below a folder.
fn checked_name(name: &str) -> Result<(), ArchiveError> {
    match crate::folder::checked(name) {
        Ok(_) => Ok(()),
        Err(error) => Err(ArchiveError::Name { name: name.to_owned(), reason: error.to_string() }),
    }
}
