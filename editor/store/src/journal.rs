//! The journal of a document: every edit is in the hands of the system before it counts as done.
//!
//! A program that is killed loses nothing that was appended. The machine may be cut off from power: then what was
//! appended since the last call of [`sync_if_due`](Journal::sync_if_due) that had something to do may be lost, which
//! is at most [`LONGEST_UNSYNCED`] if the document's thread calls it at [`next_due`](Journal::next_due).

use super::autosave::lock_patiently;
use super::error::reason;
use super::owner::Owner;
use super::record::{self, Header, LONGEST_RECORD, Saving, Tag};
use super::stamp::{FileStamp, hash};
use super::state::State;
use super::vfs::{Vfs, VfsFile, again, folder_of, write_all};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longest time that a record waits to be brought to the disk.
pub const LONGEST_UNSYNCED: Duration = Duration::from_millis(200);

/// Larger frames than this are given back, so that one snapshot does not hold its memory for ever, in bytes.
const LARGE: usize = 1 << 20;

/// Why a journal did not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// The system said no.
    #[error("{path}: {what}: {}", reason(.error), path = .path.display())]
    Io {
        /// The journal or its folder.
        path: PathBuf,
        /// What could not be done.
        what: &'static str,
        /// What the system said.
        #[source]
        error: io::Error,
    },
    /// An earlier error left it unknown what is on the disk. A snapshot ([`Journal::compact`]) makes it known again.
    #[error("{path}: nothing is recorded any more since an error of the disk: {reason}", path = .path.display())]
    Broken {
        /// The journal.
        path: PathBuf,
        /// What went wrong first.
        reason: String,
    },
    /// Longer than [`LONGEST_RECORD`].
    #[error("{path}: {bytes} bytes are more than a record may have", path = .path.display())]
    TooLong {
        /// The journal.
        path: PathBuf,
        /// How long it was.
        bytes: usize,
    },
    /// Another program, or another window of this one, has it.
    #[error("{path}: is in use by {}", whom(.owner.as_ref()), path = .path.display())]
    Held {
        /// The journal.
        path: PathBuf,
        /// Who, as far as it is known.
        owner: Option<Owner>,
    },
    /// It was taken on another machine, and nothing says that it was let go.
    #[error("{path}: may still be in use by {owner}, which cannot be asked", path = .path.display())]
    Elsewhere {
        /// The journal.
        path: PathBuf,
        /// Who.
        owner: Owner,
    },
    /// Written by a newer program.
    #[error("{path}: is of format {version}, which a newer version of this program wrote; it was left as it is",
        path = .path.display())]
    Newer {
        /// The journal.
        path: PathBuf,
        /// The version of its format.
        version: u32,
    },
    /// No journal, or none any more.
    #[error("{path}: is no journal that can be read: {reason}; it was left as it is", path = .path.display())]
    Damaged {
        /// The journal.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// All names for a journal of this document are taken.
    #[error("{path}: there are too many journals of this document", path = .path.display())]
    Crowded {
        /// The last name tried.
        path: PathBuf,
    },
}

fn whom(owner: Option<&Owner>) -> String {
    owner.map_or_else(|| "another program".to_owned(), Owner::to_string)
}

impl JournalError {
    /// For `map_err`.
    pub(super) fn io(path: &Path, what: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |error| Self::Io { path: path.to_path_buf(), what, error }
    }
}

/// A journal that this process has, and nobody else.
#[derive(Debug)]
pub struct Journal {
    pub(super) files: Arc<dyn Vfs>,
    /// Its lock goes with it.
    pub(super) file: Box<dyn VfsFile>,
    pub(super) path: PathBuf,
    pub(super) header: Header,
    pub(super) state: State,
    /// Where the next record goes; behind it is nothing, or the rest of a failed one.
    pub(super) length: u64,
    /// Number of the next record.
    pub(super) next: u64,
    /// When what was appended must be on the disk.
    pub(super) due: Option<Instant>,
    pub(super) broken: Option<String>,
    /// The record being made; kept for its memory.
    pub(super) frame: Vec<u8>,
}

impl Journal {
    /// Begins a journal in `file`, which is new, empty, locked and called `path`.
    pub(super) fn begin(
        files: Arc<dyn Vfs>,
        file: Box<dyn VfsFile>,
        path: PathBuf,
        header: Header,
    ) -> io::Result<Self> {
        let mut frame = record::header(&header)?;
        let mut state = State::new(&header);
        let opened = serde_json::to_vec(&Owner::this())?;
        record::push(&mut frame, header.number, 0, Tag::Opened, &opened);
        state.add(Tag::Opened, &opened);
        write_all(&*file, &frame, 0)?;
        let length = frame.len() as u64;
        Ok(Self { files, file, path, header, state, length, next: 1, due: None, broken: None, frame })
    }

    /// The journal's own file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The document's file; none for one never saved.
    pub fn document(&self) -> Option<PathBuf> {
        self.header.document.as_ref().map(record::PathText::path)
    }

    /// Bytes in it.
    pub fn size(&self) -> u64 {
        self.length
    }

    /// Is there no work in it?
    pub fn is_empty(&self) -> bool {
        self.state.work == 0
    }

    /// Edits and snapshots in it that are not in the document's file.
    pub fn unsaved(&self) -> u64 {
        self.state.unsaved
    }

    /// What the document's file was when it last held what this journal says.
    pub fn stamp(&self) -> Option<&FileStamp> {
        self.state.stamp.as_ref()
    }

    /// What went wrong, if nothing is recorded any more until [`compact`](Self::compact) succeeds.
    pub fn broken(&self) -> Option<&str> {
        self.broken.as_deref()
    }

    /// Appends an edit. When this returns `Ok`, the system has it, and the edit counts as done.
    ///
    /// # Errors
    /// When it is not in the journal; what was in it before still is.
    pub fn append(&mut self, edit: &[u8], now: Instant) -> Result<(), JournalError> {
        self.write(Tag::Edit, edit)?;
        self.due_at(now + LONGEST_UNSYNCED);
        Ok(())
    }

    /// Says that the document is about to be saved as `bytes`, so that a program killed right after the file was
    /// replaced knows it again. On the disk when this returns.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub fn saving(&mut self, bytes: &[u8]) -> Result<(), JournalError> {
        self.write_json(Tag::Saving, &Saving { size: bytes.len() as u64, hash: hash(bytes) })?;
        self.sync()
    }

    /// Says that the document was saved: what was appended before [`saving`](Self::saving) is in the file.
    /// On the disk when this returns.
    ///
    /// # Errors
    /// As [`append`](Self::append).
    pub fn saved(&mut self, stamp: &FileStamp) -> Result<(), JournalError> {
        self.write_json(Tag::Saved, stamp)?;
        self.sync()
    }

    /// A mouse button was released, a value was entered: what was appended is due now.
    pub fn end_of_gesture(&mut self, now: Instant) {
        if self.due.is_some() {
            self.due_at(now);
        }
    }

    /// When [`sync_if_due`](Self::sync_if_due) has something to do; never while all is on the disk.
    pub fn next_due(&self) -> Option<Instant> {
        self.due
    }

    /// Brings what was appended to the disk if it is due; was it?
    ///
    /// # Errors
    /// When the disk failed. It is not asked again, since it may have dropped what it was given: the journal is
    /// [`broken`](Self::broken) until a snapshot is written.
    pub fn sync_if_due(&mut self, now: Instant) -> Result<bool, JournalError> {
        if self.due.is_none_or(|due| due > now) {
            return Ok(false);
        }
        self.sync().map(|()| true)
    }

    /// Brings all that was appended to the disk.
    ///
    /// # Errors
    /// As [`sync_if_due`](Self::sync_if_due).
    pub fn sync(&mut self) -> Result<(), JournalError> {
        self.whole()?;
        self.due = None;
        again(|| self.file.sync_data()).map_err(|error| {
            self.broken = Some(reason(&error));
            JournalError::Io { path: self.path.clone(), what: "could not be brought to the disk", error }
        })
    }

    /// Begins the journal anew with `snapshot`, which is all of the document with its history, in one step: before it,
    /// after it and if it fails, there is a whole journal.
    ///
    /// # Errors
    /// When the new one is not on the disk. The old one goes on then.
    pub fn compact(&mut self, snapshot: &[u8]) -> Result<(), JournalError> {
        let saved = self.state.unsaved == 0;
        self.compact_as(snapshot, saved)
    }

    /// The same with a snapshot that may hold more than the journal does, after an edit could not be appended: `saved`
    /// says whether it is what the document's file holds.
    ///
    /// # Errors
    /// As [`compact`](Self::compact).
    pub fn compact_as(&mut self, snapshot: &[u8], saved: bool) -> Result<(), JournalError> {
        self.fits(snapshot)?;
        // The lock makes the name ours, and what has it is of a program that was killed.
        let beside = self.path.with_extension("compact");
        let _ = again(|| self.files.remove(&beside));
        let made = self.make_compact(&beside, snapshot, saved).and_then(|new| {
            again(|| self.files.rename(&beside, &self.path))?;
            Ok(new)
        });
        let mut new = match made {
            Ok(new) => new,
            Err(error) => {
                let _ = again(|| self.files.remove(&beside));
                return Err(JournalError::io(&self.path, "its snapshot cannot be written")(error));
            }
        };
        new.path.clone_from(&self.path);
        // From here on the old file has no name, so the new one is the journal whatever happens.
        *self = new;
        again(|| self.files.sync_folder(folder_of(&self.path))).map_err(|error| {
            self.broken = Some(reason(&error));
            JournalError::io(&self.path, "could not be brought to the disk")(error)
        })
    }

    fn make_compact(&self, beside: &Path, snapshot: &[u8], saved: bool) -> io::Result<Self> {
        let file = again(|| self.files.create_new(beside, true))?;
        lock_patiently(&*file)?;
        let header =
            Header { number: new_number(), document: self.header.document.clone(), stamp: self.state.stamp };
        let mut new = Self::begin(Arc::clone(&self.files), file, beside.to_path_buf(), header)?;
        if let Some((saving, _)) = &self.state.saving {
            new.put(Tag::Saving, &serde_json::to_vec(saving)?)?;
        }
        new.put(Tag::Snapshot, snapshot)?;
        if let Some(stamp) = self.state.stamp.filter(|_| saved) {
            new.put(Tag::Saved, &serde_json::to_vec(&stamp)?)?;
        }
        again(|| new.file.sync_all())?;
        Ok(new)
    }

    /// Lets go of it in order. A journal without any work in it is removed; any other stays, for its history.
    ///
    /// # Errors
    /// When that is not on the disk. What was appended is as safe as before.
    pub fn close(mut self) -> Result<(), JournalError> {
        if self.state.work == 0 {
            let fail = JournalError::io(&self.path, "cannot be removed");
            return again(|| self.files.remove(&self.path)).map_err(fail);
        }
        self.write(Tag::Closed, &[])?;
        self.sync()
    }

    fn due_at(&mut self, at: Instant) {
        self.due = Some(self.due.map_or(at, |due| due.min(at)));
    }

    fn whole(&self) -> Result<(), JournalError> {
        match &self.broken {
            None => Ok(()),
            Some(reason) => Err(JournalError::Broken { path: self.path.clone(), reason: reason.clone() }),
        }
    }

    fn fits(&self, bytes: &[u8]) -> Result<(), JournalError> {
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
        self.whole()?;
        self.fits(bytes)?;
        self.put(tag, bytes).map_err(JournalError::io(&self.path, "cannot be written"))
    }

    /// Appends a record whole or not at all.
    fn put(&mut self, tag: Tag, bytes: &[u8]) -> io::Result<()> {
        self.frame.clear();
        record::push(&mut self.frame, self.header.number, self.next, tag, bytes);
        let written = write_all(&*self.file, &self.frame, self.length);
        if written.is_ok() {
            self.length += self.frame.len() as u64;
            self.next += 1;
            self.state.add(tag, bytes);
        } else {
            // The next record is written over what came of this one, so a rest that stays does no harm.
            let _ = again(|| self.file.set_size(self.length));
        }
        if self.frame.capacity() > LARGE {
            self.frame = Vec::new();
        }
        written
    }
}

/// A number that no other journal has: each hasher of the standard library begins at random.
pub(super) fn new_number() -> u64 {
    use std::hash::{BuildHasher, Hasher};
    std::collections::hash_map::RandomState::new().build_hasher().finish()
}
