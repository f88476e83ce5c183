//! Recovering a journal: resume it, copy it or discard it. Nothing is deleted without being asked, and the document's
//! own file is only read.

use super::autosave::Autosave;
use super::journal::{Journal, JournalError};
use super::lock::{LockResult, lock_with_retries};
use super::numbered::{self, FolderLimits};
use super::owner::{JournalOwner, OwnerStatus};
use super::record::Tag;
use super::recoverable::{JournalContents, JournalEntry, Readability, Recoverable, contents, same};
use super::vfs::{VfsFile, folder_of, metadata_if_exists, read_pieces, retry, write_all};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A resumed journal.
#[derive(Debug)]
pub struct Resumed {
    /// The journal, now open in this process.
    pub journal: Journal,
    /// Its entries.
    pub entries: Vec<JournalEntry>,
    /// Number of unreadable bytes cut off its end; they are kept in the bin.
    pub cut: u64,
}

/// Whether to open a journal that was last opened on another computer, whose processes cannot be checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// Return an error instead.
    IfFree,
    /// Open it: the user has confirmed that it is not in use.
    Anyway,
}

impl Autosave {
    /// Resumes a journal: returns its entries and appends new work to it. An unreadable end is cut off and put into
    /// the bin.
    ///
    /// The caller checks whether the document's file still has the content that the journal continues
    /// ([`Recoverable::file`]); this function does not write to it.
    ///
    /// # Errors
    /// When the journal is in use, or cannot be read or written. Its readable part stays readable.
    pub fn resume(&self, found: &Recoverable, claim: Claim) -> Result<Resumed, JournalError> {
        let path = &found.journal;
        let fail = |error| JournalError::io(path, "cannot be opened")(error);
        let (file, locked) = self.take(path)?;
        let mut contents = contents(&*file, path)?;
        let state = &contents.state;
        let owner_status = if state.closed {
            OwnerStatus::Exited
        } else {
            state.owner.as_ref().map_or(OwnerStatus::Exited, JournalOwner::owner_status)
        };
        match (owner_status, state.owner.clone()) {
            // The holder of the lock owns the journal, so the process number matters only without a lock.
            (OwnerStatus::Running, owner) if !locked => {
                return Err(JournalError::Held { path: path.clone(), owner });
            }
            (OwnerStatus::OnOtherHost, Some(owner)) if claim == Claim::IfFree => {
                return Err(JournalError::OnOtherHost { path: path.clone(), owner });
            }
            _ => {}
        }
        let cut = contents.scan.size - contents.scan.valid;
        if cut > 0 {
            self.cut(&*file, path, contents.scan.valid).map_err(fail)?;
        }
        let saving = contents.state.saving;
        let settled = contents.compare_file(&*self.files);
        let JournalContents { scan, mut state, entries, .. } = contents;
        // `compare_file` has settled this save; writing the record below settles it again.
        state.saving = saving;
        let mut journal = Journal {
            files: Arc::clone(&self.files),
            file,
            path: path.clone(),
            header: scan.header,
            state,
            length: scan.valid,
            next: scan.records,
            due: None,
            broken: None,
            frame: Vec::new(),
        };
        if let Some(stamp) = settled {
            journal.write_json(Tag::Saved, &stamp)?;
        }
        journal.write_json(Tag::Opened, &JournalOwner::this())?;
        journal.sync()?;
        Ok(Resumed { journal, entries, cut })
    }

    /// Copies the work in a journal into a new one, for the document at `document`, whose file is the one the work
    /// was based on, or for a document that was never saved. The original stays unchanged and may be in use.
    ///
    /// # Errors
    /// When it cannot be read or the new one cannot be written.
    pub fn copy(&self, found: &Recoverable, document: Option<&Path>) -> Result<Resumed, JournalError> {
        let path = &found.journal;
        let file = retry(|| self.files.open(path)).map_err(JournalError::io(path, "cannot be read"))?;
        let mut contents = contents(&*file, path)?;
        if document.is_some() {
            contents.compare_file_at(&*self.files, document);
        }
        let JournalContents { scan, state, entries } = contents;
        let mut journal = self.begin_another(document, state.stamp.as_ref())?;
        let copied = entries.iter().try_for_each(|entry| match entry {
            JournalEntry::Snapshot(bytes) => journal.write(Tag::Snapshot, bytes),
            JournalEntry::Edit(bytes) => journal.write(Tag::Edit, bytes),
            // All saves get the stamp of the last one: earlier stamps are not known, and only the last save matters.
            JournalEntry::Saved => match state.stamp.filter(|_| document.is_some()) {
                Some(stamp) => journal.write_json(Tag::Saved, &stamp),
                None => Ok(()),
            },
        });
        if let Err(error) = copied.and_then(|()| journal.sync()) {
            let _ = retry(|| self.files.remove(&journal.path));
            return Err(error);
        }
        Ok(Resumed { journal, entries, cut: scan.size - scan.valid })
    }

    /// Moves a journal into the bin and returns its path there. When the bin is full, its oldest files are removed.
    ///
    /// # Errors
    /// When the journal is in use or cannot be moved. It stays in place.
    pub fn discard(&self, found: &Recoverable) -> Result<PathBuf, JournalError> {
        let path = &found.journal;
        let fail = |error| JournalError::io(path, "cannot be put into the bin")(error);
        // Locked until it has moved, so that no other process opens it before.
        let (_file, _) = self.take(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let to = self.path_in_bin(&name).map_err(fail)?;
        retry(|| self.files.rename(path, &to)).map_err(fail)?;
        retry(|| self.files.sync_folder(folder_of(&to))).map_err(fail)?;
        retry(|| self.files.sync_folder(folder_of(path))).map_err(fail)?;
        numbered::trim(&*self.files, &self.bin(), self.bin_bounds);
        Ok(to)
    }

    /// Moves a journal of this process into the bin and returns its path there.
    ///
    /// # Errors
    /// As [`discard`](Self::discard).
    pub fn discard_own(&self, journal: Journal) -> Result<PathBuf, JournalError> {
        let path = journal.path().to_path_buf();
        // Releases the lock. Another process may take it before `discard` does, which is then an error.
        drop(journal);
        let found = self.inspect(&path)?;
        self.discard(&found)
    }

    /// Lists the bin, last discarded first.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn discarded(&self) -> Result<Vec<PathBuf>, JournalError> {
        let bin = self.bin();
        let found = numbered::files(&*self.files, &bin).map_err(JournalError::io(&bin, "cannot be read"))?;
        Ok(found.into_iter().rev().map(|file| file.path).collect())
    }

    /// Moves a discarded journal out of the bin again and returns its path.
    ///
    /// # Errors
    /// When it cannot be moved, or another journal has taken its name. In both cases it stays in the bin.
    pub fn restore(&self, discarded: &Path) -> Result<PathBuf, JournalError> {
        let fail = |error| JournalError::io(discarded, "cannot be restored from the bin")(error);
        let name = discarded.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let name = name.split_once('-').map_or(name.as_str(), |(_, name)| name);
        let to = self.journals().join(name);
        if metadata_if_exists(&*self.files, &to).map_err(fail)?.is_some() {
            return Err(fail(io::ErrorKind::AlreadyExists.into()));
        }
        retry(|| self.files.rename(discarded, &to)).map_err(fail)?;
        retry(|| self.files.sync_folder(folder_of(&to))).map_err(fail)?;
        Ok(to)
    }

    /// Moves the oldest journals without unsaved work into the bin until the others are within `bounds`. Returns the
    /// number of journals moved.
    ///
    /// # Errors
    /// When the folder of journals cannot be read.
    pub fn tidy(&self, bounds: FolderLimits) -> Result<usize, JournalError> {
        let (mut bytes, mut stay, mut gone) = (0_u64, 0, 0);
        for found in self.recoverable()? {
            let history = matches!(found.reading, Readability::Whole)
                && found.unsaved == 0
                && found.owner_status == OwnerStatus::Exited;
            if !history {
                continue;
            }
            bytes = bytes.saturating_add(found.bytes);
            if stay < bounds.least || (stay < bounds.most && bytes <= bounds.bytes) {
                stay += 1;
            } else if self.discard(&found).is_ok() {
                gone += 1;
            }
        }
        Ok(gone)
    }

    /// Opens the journal at `path` and locks it. Returns whether the file system has locks.
    fn take(&self, path: &Path) -> Result<(Box<dyn VfsFile>, bool), JournalError> {
        let fail = |error| JournalError::io(path, "cannot be opened")(error);
        loop {
            let file = retry(|| self.files.open_to_write(path)).map_err(fail)?;
            let lock = lock_with_retries(&*file).map_err(fail)?;
            if lock == LockResult::Held {
                let owner = contents(&*file, path).ok().and_then(|contents| contents.state.owner);
                return Err(JournalError::Held { path: path.to_path_buf(), owner });
            }
            // The owner may have replaced the journal by a restarted one of the same name before releasing the lock.
            if same(&*self.files, &*file, path).map_err(fail)? {
                return Ok((file, lock == LockResult::Ours));
            }
        }
    }

    /// Cuts the journal off at `valid` and keeps the rest in the bin.
    fn cut(&self, file: &dyn VfsFile, path: &Path, valid: u64) -> io::Result<()> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let tail = self.path_in_bin(&format!("{name}.tail"))?;
        let to = retry(|| self.files.create_new(&tail, true))?;
        let kept = read_pieces(file, |offset, piece| {
            let skip = usize::try_from(valid.saturating_sub(offset)).unwrap_or(usize::MAX).min(piece.len());
            write_all(&*to, &piece[skip..], (offset + skip as u64).saturating_sub(valid))
        });
        let kept = kept.and_then(|_| retry(|| to.sync_all()));
        if let Err(error) = kept {
            let _ = retry(|| self.files.remove(&tail));
            return Err(error);
        }
        retry(|| file.set_size(valid))?;
        retry(|| file.sync_all())?;
        numbered::trim(&*self.files, &self.bin(), self.bin_bounds);
        Ok(())
    }

    fn path_in_bin(&self, name: &str) -> io::Result<PathBuf> {
        let bin = self.bin();
        retry(|| self.files.create_folder(&bin))?;
        Ok(numbered::next_path(&bin, &numbered::files(&*self.files, &bin)?, name))
    }
}
