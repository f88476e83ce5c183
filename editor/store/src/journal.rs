//! The journal of a document: an edit counts as done once the system has accepted its record.
//!
//! A killed program loses nothing that was appended. A power cut may lose the records appended since the last call of
//! [`sync_if_due`](Journal::sync_if_due) that synced: at most [`LONGEST_UNSYNCED`] of work if the document's thread
//! makes the call at [`next_due`](Journal::next_due).

use super::error::reason;
use super::owner::JournalOwner;
use super::record::{self, FileContents, JournalHeader, LONGEST_RECORD, Saving, Tag};
use super::stamp::{FileStamp, hash};
use super::state::JournalState;
use super::successor::{Successor, SuccessorJournal};
use super::vfs::{Vfs, VfsFile, folder_of, retry, write_all};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longest time until a record is flushed to the disk.
pub const LONGEST_UNSYNCED: Duration = Duration::from_millis(200);

/// Capacity in bytes above which the frame buffer is freed, so that one snapshot does not keep its memory.
const LARGE: usize = 1 << 20;

/// Reasons why an operation on a journal failed.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// The system reported an error.
    #[error("{path}: {what}: {}", reason(.error), path = .path.display())]
    Io {
        /// The journal or its folder.
        path: PathBuf,
        /// The operation that failed, in words.
        what: &'static str,
        /// Error of the system.
        #[source]
        error: io::Error,
    },
    /// After an earlier error the content of the file on the disk is unknown. A snapshot ([`Journal::compact`])
    /// repairs it.
    #[error("{path}: recording stopped after a disk error: {reason}", path = .path.display())]
    Broken {
        /// The journal.
        path: PathBuf,
        /// The first error.
        reason: String,
    },
    /// A record longer than [`LONGEST_RECORD`].
    #[error("{path}: a record of {bytes} bytes is too long", path = .path.display())]
    TooLong {
        /// The journal.
        path: PathBuf,
        /// Length of the record in bytes.
        bytes: usize,
    },
    /// Another program, or another window of this one, has the journal open.
    #[error("{path}: is in use by {}", owner_name(.owner.as_ref()), path = .path.display())]
    Held {
        /// The journal.
        path: PathBuf,
        /// The process that has it, if known.
        owner: Option<JournalOwner>,
    },
    /// The journal was opened on another computer, and no record shows that it was closed there.
    #[error("{path}: may still be in use by {owner}, which cannot be checked from here", path = .path.display())]
    OnOtherHost {
        /// The journal.
        path: PathBuf,
        /// The process that opened it.
        owner: JournalOwner,
    },
    /// The journal was written by a newer version of the program.
    #[error("{path}: has format {version}, written by a newer version of this program; it was left unchanged",
        path = .path.display())]
    Newer {
        /// The journal.
        path: PathBuf,
        /// The version of its format.
        version: u32,
    },
    /// The file is not a journal, or is damaged.
    #[error("{path}: is no journal that can be read: {reason}; it was left unchanged", path = .path.display())]
    Damaged {
        /// The journal.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// All names for a journal of this document are in use.
    #[error("{path}: there are too many journals of this document", path = .path.display())]
    TooManyJournals {
        /// The last name tried.
        path: PathBuf,
    },
}

fn owner_name(owner: Option<&JournalOwner>) -> String {
    owner.map_or_else(|| "another program".to_owned(), JournalOwner::to_string)
}

impl JournalError {
    /// Returns a closure for `map_err`.
    pub(super) fn io(path: &Path, what: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |error| Self::Io { path: path.to_path_buf(), what, error }
    }
}

/// A journal that this process has opened exclusively.
#[derive(Debug)]
pub struct Journal {
    pub(super) files: Arc<dyn Vfs>,
    /// The open file, which holds the lock.
    pub(super) file: Box<dyn VfsFile>,
    pub(super) path: PathBuf,
    pub(super) header: JournalHeader,
    pub(super) state: JournalState,
    /// Offset of the next record; only the remains of a failed one can follow it.
    pub(super) length: u64,
    /// Number of the next record.
    pub(super) next: u64,
    /// Deadline for flushing the appended records to the disk.
    pub(super) due: Option<Instant>,
    pub(super) broken: Option<String>,
    /// The record being built; kept to reuse its memory.
    pub(super) frame: Vec<u8>,
}

impl Drop for Journal {
    /// Releases the lock at once: closing the file is not enough while a process that is being started has a copy of its handle.
    fn drop(&mut self) {
        let _ = self.file.unlock();
    }
}

impl Journal {
    /// Begins a journal in `file`, which is new, empty, locked and named `path`.
    pub(super) fn begin(
        files: Arc<dyn Vfs>,
        file: Box<dyn VfsFile>,
        path: PathBuf,
        header: JournalHeader,
    ) -> io::Result<Self> {
        let mut frame = record::header(&header)?;
        let mut state = JournalState::new(&header);
        let opened = serde_json::to_vec(&JournalOwner::this())?;
        record::push(&mut frame, header.number, 0, Tag::Opened, &opened);
        state.add(Tag::Opened, &opened);
        write_all(&*file, &frame, 0)?;
        let length = frame.len() as u64;
        Ok(Self { files, file, path, header, state, length, next: 1, due: None, broken: None, frame })
    }

    /// Path of the journal's file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the document's file; `None` if it was never saved.
    pub fn document(&self) -> Option<PathBuf> {
        self.header.document.as_ref().map(record::PathText::path)
    }

    /// Size in bytes.
    pub fn size(&self) -> u64 {
        self.length
    }

    /// Returns whether the journal contains no edits and no snapshot.
    pub fn is_empty(&self) -> bool {
        self.state.work == 0
    }

    /// Number of edits and snapshots that are not in the document's file.
    pub fn unsaved(&self) -> u64 {
        self.state.unsaved
    }

    /// Stamp of the document's file when it last held the journal's state.
    pub fn stamp(&self) -> Option<&FileStamp> {
        self.state.stamp.as_ref()
    }

    /// The error that stopped recording, until [`compact`](Self::compact) succeeds.
    pub fn broken(&self) -> Option<&str> {
        self.broken.as_deref()
    }

    /// Appends an edit. When this returns `Ok`, the system has the record and the edit counts as done.
    ///
    /// # Errors
    /// When the edit could not be appended; earlier records are unaffected.
    pub fn append(&mut self, edit: &[u8], now: Instant) -> Result<(), JournalError> {
        self.write(Tag::Edit, edit)?;
        self.due_at(now + LONGEST_UNSYNCED);
        Ok(())
    }

    /// Records that the document is about to be saved as `bytes`, so that the file is recognized if the program is
    /// killed right after replacing it. Flushed to the disk before returning.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub fn saving(&mut self, bytes: &[u8]) -> Result<(), JournalError> {
        self.saving_without(0, Some(FileContents { size: bytes.len() as u64, hash: hash(bytes) }))
    }

    /// As [`saving`](Self::saving), for a `file` that does not contain the last `newer` edits, which were appended while it was
    /// computed; `None` where the save writes only other files than that of the document.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub fn saving_without(&mut self, newer: u64, file: Option<FileContents>) -> Result<(), JournalError> {
        self.write_json(Tag::Saving, &Saving { file, newer })?;
        self.sync()
    }

    /// Records that the document was saved: the file contains everything appended before [`saving`](Self::saving), except
    /// for the edits that [`saving_without`](Self::saving_without) named. Flushed to the disk before returning.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub fn saved(&mut self, stamp: &FileStamp) -> Result<(), JournalError> {
        self.write_json(Tag::Saved, stamp)?;
        self.sync()
    }

    /// Makes the appended records due now, at the end of a gesture: a mouse button was released or a value was
    /// entered.
    pub fn end_of_gesture(&mut self, now: Instant) {
        if self.due.is_some() {
            self.due_at(now);
        }
    }

    /// Time at which [`sync_if_due`](Self::sync_if_due) has something to do; `None` while everything is on the disk.
    pub fn next_due(&self) -> Option<Instant> {
        self.due
    }

    /// Flushes the appended records to the disk if they are due. Returns whether it did.
    ///
    /// # Errors
    /// When the disk failed. The sync is not repeated, because the system may have dropped the data: the journal is
    /// [`broken`](Self::broken) until a snapshot is written.
    pub fn sync_if_due(&mut self, now: Instant) -> Result<bool, JournalError> {
        if self.due.is_none_or(|due| due > now) {
            return Ok(false);
        }
        self.sync().map(|()| true)
    }

    /// Flushes all appended records to the disk.
    ///
    /// # Errors
    /// As [`sync_if_due`](Self::sync_if_due).
    pub fn sync(&mut self) -> Result<(), JournalError> {
        self.ensure_recording()?;
        self.due = None;
        retry(|| self.file.sync_data()).map_err(|error| {
            self.broken = Some(reason(&error));
            JournalError::Io { path: self.path.clone(), what: "could not be flushed to the disk", error }
        })
    }

    /// Restarts the journal with `snapshot`, the whole document with its history, in one step: a complete journal
    /// exists at every moment, also if this fails.
    ///
    /// # Errors
    /// When the new journal could not be written: then the old one stays in use. Or when the new one is in use, but
    /// the disk did not confirm its name: then it is [`broken`](Self::broken).
    pub fn compact(&mut self, snapshot: &[u8]) -> Result<(), JournalError> {
        let saved = self.state.unsaved == 0;
        self.compact_as(snapshot, saved)
    }

    /// As [`compact`](Self::compact), with a snapshot that may contain more than the journal, because an edit could
    /// not be appended. `saved` is whether the snapshot equals the document's file.
    ///
    /// # Errors
    /// As [`compact`](Self::compact).
    pub fn compact_as(&mut self, snapshot: &[u8], saved: bool) -> Result<(), JournalError> {
        let new = self.successor().write(snapshot, saved)?;
        self.continue_in(new)
    }

    /// Returns the plan of a journal that is to take the place of this one, for [`Successor::write`] in another thread.
    pub fn successor(&self) -> Successor {
        Successor::of(self)
    }

    /// Continues in `new`, which takes the place of this journal in one step. It must contain everything that this one
    /// contains: the caller appends what was appended here since [`successor`](Self::successor) was called.
    ///
    /// # Errors
    /// As [`compact`](Self::compact).
    pub fn continue_in(&mut self, new: SuccessorJournal) -> Result<(), JournalError> {
        *self = new.renamed_to(&self.path)?;
        retry(|| self.files.sync_folder(folder_of(&self.path))).map_err(|error| {
            self.broken = Some(reason(&error));
            JournalError::io(&self.path, "could not be flushed to the disk")(error)
        })
    }

    /// Closes the journal. A journal without any work is removed; any other is kept for its history.
    ///
    /// # Errors
    /// When the change is not on the disk. The appended records are as safe as before.
    pub fn close(mut self) -> Result<(), JournalError> {
        if self.state.work == 0 {
            let fail = JournalError::io(&self.path, "cannot be removed");
            return retry(|| self.files.remove(&self.path)).map_err(fail);
        }
        self.write(Tag::Closed, &[])?;
        self.sync()
    }

    fn due_at(&mut self, at: Instant) {
        self.due = Some(self.due.map_or(at, |due| due.min(at)));
    }

    fn ensure_recording(&self) -> Result<(), JournalError> {
        match &self.broken {
            None => Ok(()),
            Some(reason) => Err(JournalError::Broken { path: self.path.clone(), reason: reason.clone() }),
        }
    }

    pub(super) fn ensure_fits(&self, bytes: &[u8]) -> Result<(), JournalError> {
        if bytes.len() <= LONGEST_RECORD {
            return Ok(());
        }
        Err(JournalError::TooLong { path: self.path.clone(), bytes: bytes.len() })
    }

    pub(super) fn write_json(&mut self, tag: Tag, value: &impl serde::Serialize) -> Result<(), JournalError> {
        let bytes = serde_json::to_vec(value)
            .map_err(|error| JournalError::io(&self.path, "cannot be written")(error.into()))?;
        self.write(tag, &bytes)
    }

    pub(super) fn write(&mut self, tag: Tag, bytes: &[u8]) -> Result<(), JournalError> {
        self.ensure_recording()?;
        self.ensure_fits(bytes)?;
        self.put(tag, bytes).map_err(JournalError::io(&self.path, "cannot be written"))
    }

    /// Appends a record completely or not at all.
    pub(super) fn put(&mut self, tag: Tag, bytes: &[u8]) -> io::Result<()> {
        self.frame.clear();
        record::push(&mut self.frame, self.header.number, self.next, tag, bytes);
        let written = write_all(&*self.file, &self.frame, self.length);
        if written.is_ok() {
            self.length += self.frame.len() as u64;
            self.next += 1;
            self.state.add(tag, bytes);
        } else {
            // The next record overwrites the remains of this one, so a failed truncation does no harm.
            let _ = retry(|| self.file.set_size(self.length));
        }
        if self.frame.capacity() > LARGE {
            self.frame = Vec::new();
        }
        written
    }
}

/// Returns a random number to identify a journal: each hasher of the standard library has a random seed.
pub(super) fn new_number() -> u64 {
    use std::hash::{BuildHasher, Hasher};
    std::collections::hash_map::RandomState::new().build_hasher().finish()
}
