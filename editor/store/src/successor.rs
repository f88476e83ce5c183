//! A journal that takes the place of another one. Its snapshot may be large, so that it can be written in another thread
//! while edits are still appended to the old journal.

use super::journal::{Journal, JournalError, new_number};
use super::lock::lock_with_retries;
use super::record::{JournalHeader, LONGEST_RECORD, Saving, Tag};
use super::stamp::FileStamp;
use super::vfs::{Vfs, retry};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A journal that is to take the place of another one, see [`Journal::successor`].
#[derive(Debug)]
pub struct Successor {
    files: Arc<dyn Vfs>,
    /// Path of the journal that it replaces.
    journal: PathBuf,
    document: Option<super::record::PathText>,
    stamp: Option<FileStamp>,
    saving: Option<Saving>,
}

impl Successor {
    pub(super) fn of(journal: &Journal) -> Self {
        Self {
            files: Arc::clone(&journal.files),
            journal: journal.path.clone(),
            document: journal.header.document.clone(),
            stamp: journal.state.stamp,
            // A snapshot contains all edits.
            saving: journal.state.saving.map(|(saving, _)| Saving { newer: 0, ..saving }),
        }
    }

    /// Writes the journal with `snapshot`, the whole document with its history, and flushes it to the disk. `saved` is
    /// whether the snapshot equals the document's file.
    ///
    /// # Errors
    /// When it could not be written. Nothing is left of it then.
    pub fn write(self, snapshot: &[u8], saved: bool) -> Result<SuccessorJournal, JournalError> {
        if snapshot.len() > LONGEST_RECORD {
            return Err(JournalError::TooLong { path: self.journal, bytes: snapshot.len() });
        }
        // Only the holder of the old journal's lock uses this name: an existing file with it was left by a killed program.
        let path = self.journal.with_extension("compact");
        let _ = retry(|| self.files.remove(&path));
        let name = TemporaryName { files: Arc::clone(&self.files), path, unsynced: false, is_used: false };
        let journal = self
            .filled(&name.path, snapshot, saved)
            .map_err(JournalError::io(&self.journal, "its snapshot cannot be written"))?;
        Ok(SuccessorJournal { journal, name })
    }

    fn filled(&self, temporary: &Path, snapshot: &[u8], saved: bool) -> io::Result<Journal> {
        let file = retry(|| self.files.create_new(temporary, true))?;
        lock_with_retries(&*file)?;
        let header =
            JournalHeader { number: new_number(), document: self.document.clone(), stamp: self.stamp };
        let mut new = Journal::begin(Arc::clone(&self.files), file, temporary.to_path_buf(), header)?;
        if let Some(saving) = &self.saving {
            new.put(Tag::Saving, &serde_json::to_vec(saving)?)?;
        }
        new.put(Tag::Snapshot, snapshot)?;
        if let Some(stamp) = self.stamp.filter(|_| saved) {
            new.put(Tag::Saved, &serde_json::to_vec(&stamp)?)?;
        }
        retry(|| new.file.sync_all())?;
        Ok(new)
    }
}

/// A journal with a snapshot that has a temporary name. It is removed when it is dropped, unless
/// [`Journal::continue_in`] gives it the name of the journal that it replaces.
#[derive(Debug)]
pub struct SuccessorJournal {
    journal: Journal,
    name: TemporaryName,
}

impl SuccessorJournal {
    /// Appends an edit that was appended to the old journal after the snapshot was taken.
    ///
    /// # Errors
    /// When it could not be written.
    pub fn append(&mut self, edit: &[u8]) -> Result<(), JournalError> {
        self.name.unsynced = true;
        self.journal.write(Tag::Edit, edit)
    }

    /// Flushes the appended edits to the disk and renames the journal to `path`.
    pub(super) fn renamed_to(mut self, path: &Path) -> Result<Journal, JournalError> {
        if self.name.unsynced {
            self.journal.sync()?;
        }
        retry(|| self.journal.files.rename(&self.name.path, path))
            .map_err(JournalError::io(path, "its snapshot cannot be written"))?;
        // The old file has no name anymore, so the new one is the journal even if syncing the folder fails.
        self.name.is_used = true;
        self.journal.path = path.to_path_buf();
        Ok(self.journal)
    }
}

/// The temporary name of a journal, which is removed when it was not renamed.
#[derive(Debug)]
struct TemporaryName {
    files: Arc<dyn Vfs>,
    path: PathBuf,
    /// Whether edits were appended that are not flushed to the disk.
    unsynced: bool,
    /// Whether it was renamed.
    is_used: bool,
}

impl Drop for TemporaryName {
    fn drop(&mut self) {
        if !self.is_used {
            // If it cannot be removed, the next successor removes it.
            let _ = retry(|| self.files.remove(&self.path));
        }
    }
}
