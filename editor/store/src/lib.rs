//! The disk: saving that leaves the old file or the new one, journals that a crash does not harm, and what can be had
//! back after one. Only bytes are known here; what they mean is the document's affair.
//!
//! [`save`] replaces a file in one step. An [`Autosave`] folder holds a [`Journal`] for each open document, old
//! [`Versions`], and a bin. Everything goes through [`Vfs`], so tests fail each single call of the system in turn.

mod autosave;
mod crc;
mod document;
mod error;
mod in_place;
mod journal;
mod owner;
mod real;
mod record;
mod recoverable;
mod recovery;
mod save;
mod shelf;
mod stamp;
mod state;
mod versions;
mod vfs;

pub use autosave::{Autosave, Opening};
pub use document::save_document;
pub use error::{SaveError, Step};
pub use in_place::{cut_off, put_away, put_back};
pub use journal::{Journal, JournalError, LONGEST_UNSYNCED};
pub use owner::{Life, Owner};
pub use real::RealFiles;
pub use record::LONGEST_RECORD;
pub use recoverable::{Entry, Fate, Reading, Recoverable};
pub use recovery::{Claim, Resumed};
pub use save::{Expected, SaveOptions, Saved, replace, save};
pub use shelf::Bounds;
pub use stamp::hash;
pub use stamp::{FileStamp, FileState};
pub use versions::{Version, VersionLimits, Versions};
pub use vfs::folder_of;
pub use vfs::{Attribute, FileData, Kind, Vfs, VfsFile};
