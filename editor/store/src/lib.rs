//! Files of Dragonfly: saving, journals and recovery.
//!
//! This crate owns everything that reaches the disk safely: [`save`] replaces a file in one step, so that a crash leaves
//! the complete old file or the complete new one; an [`Autosave`] folder contains a [`Journal`] for each open document,
//! old [`Versions`] of files, and a bin; journals can be resumed after a crash. It handles only bytes and paths: it must
//! not know what a document, an edit or a model is, and it depends on no other crate of the workspace.
//!
//! All access to the file system goes through the trait [`Vfs`], so that tests can make every single call fail.
//!
//! The modules depend on each other in one direction: `vfs` ← `stamp` ← `target`, `temporary` ← `in_place`, `versions` ←
//! `save` ← `growing`; `record`, `state`, `lock` ← `journal` (with `successor`) ← `autosave` ← `recoverable` ← `begin` ← `recovery`.

mod autosave;
mod begin;
mod document;
mod error;
mod growing;
mod in_place;
mod journal;
mod lock;
mod numbered;
mod owner;
mod real;
mod record;
mod recoverable;
mod recovery;
mod save;
mod stamp;
mod state;
mod successor;
mod target;
mod temporary;
mod versions;
mod vfs;

pub use autosave::Autosave;
pub use begin::Opening;
pub use document::save_document;
pub use error::{FileSaveError, SaveStep};
pub use growing::GrowingFile;
pub use in_place::{discard_old_content, interrupted_save, restore_old_content};
pub use journal::{Journal, JournalError, LONGEST_UNSYNCED};
pub use numbered::FolderLimits;
pub use owner::{JournalOwner, OwnerStatus};
pub use real::RealFiles;
pub use record::{FileContents, LONGEST_RECORD};
pub use recoverable::{DocumentFileState, JournalEntry, Readability, Recoverable};
pub use recovery::{Claim, Resumed};
pub use save::{SaveOptions, SaveOutcome, replace, save, save_one_of_many};
pub use stamp::{FileStamp, FileState, hash};
pub use successor::{Successor, SuccessorJournal};
pub use target::ExpectedFile;
pub use temporary::remove_unfinished;
pub use versions::{OldVersion, VersionLimits, Versions};
pub use vfs::{Attribute, FileData, FileKind, Vfs, VfsFile, folder_of};
