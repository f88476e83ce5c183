//! Listing the journals in the autosave folder and what can be recovered from them, without changing them.

use super::autosave::{Autosave, EXTENSION};
use super::journal::JournalError;
use super::lock::{LockResult, lock, lock_with_retries};
use super::numbered;
use super::owner::{JournalOwner, OwnerStatus};
use super::record::{self, JournalScan, PathText, ReadFailure, Tag};
use super::stamp::{FileStamp, FileState};
use super::state::JournalState;
use super::vfs::{Vfs, VfsFile, metadata_if_exists, retry};
use std::io;
use std::path::{Path, PathBuf};

/// Number of attempts to inspect a journal that its owner keeps restarting.
const INSPECT_ATTEMPTS: usize = 10;

/// Readable part of a journal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Readability {
    /// All of it.
    Whole,
    /// All but this number of bytes at its end: an unfinished record, or everything after a damaged one.
    Cut(u64),
    /// Nothing, because it has this later format.
    Newer(u32),
    /// Nothing, for this reason.
    Damaged(String),
}

/// State of the document's file, compared with the state that the journal continues.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DocumentFileState {
    /// The document was never saved.
    Unsaved,
    /// The file has the content that the journal continues.
    Same,
    /// The file has other content.
    Changed,
    /// There is no file: it was removed or moved.
    Missing,
    /// The file cannot be read, for this reason.
    Unknown(String),
}

/// A journal in the autosave folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recoverable {
    /// Path of the journal.
    pub journal: PathBuf,
    /// Path of the document's file; `None` if it was never saved.
    pub document: Option<PathBuf>,
    /// Time of the last write, in nanoseconds since 1970.
    pub when: i64,
    /// Number of edits; a snapshot counts as one.
    pub work: u64,
    /// Number of those edits that are not in the document's file.
    pub unsaved: u64,
    /// Size in bytes.
    pub bytes: u64,
    /// Readable part of it.
    pub reading: Readability,
    /// State of the document's file.
    pub file: DocumentFileState,
    /// Stamp of that file when it last had the content that the journal continues.
    pub stamp: Option<FileStamp>,
    /// Size and hash of the file that a save was writing, if no record shows how the save ended.
    pub saving: Option<(u64, u64)>,
    /// The process that opened it last.
    pub owner: Option<JournalOwner>,
    /// Whether that process still runs.
    pub owner_status: OwnerStatus,
}

impl Recoverable {
    /// Returns the entry of a journal of which only the path and the readability are known.
    fn unreadable(journal: PathBuf, reading: Readability) -> Self {
        Self {
            journal,
            document: None,
            when: 0,
            work: 0,
            unsaved: 0,
            bytes: 0,
            reading,
            file: DocumentFileState::Unsaved,
            stamp: None,
            saving: None,
            owner: None,
            owner_status: OwnerStatus::Exited,
        }
    }

    /// Returns whether a file with this stamp, at any path, has the content that the document's file had last, or
    /// that a save without a recorded end was to write.
    pub fn held(&self, stamp: &FileStamp) -> bool {
        let then = self.stamp.map(|then| (then.size, then.hash));
        [then, self.saving].contains(&Some((stamp.size, stamp.hash)))
    }

    /// Returns whether the journal is offered at the start of the program: it has unsaved work and is not in use.
    pub fn is_offered(&self) -> bool {
        self.unsaved > 0 && self.owner_status != OwnerStatus::Running
    }
}

/// An entry of a journal, in the order of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JournalEntry {
    /// The whole document with its history; earlier entries do not matter.
    Snapshot(Vec<u8>),
    /// One edit.
    Edit(Vec<u8>),
    /// The document was saved at this point.
    Saved,
}

impl Autosave {
    /// Lists all journals, last written first, including those without unsaved work, so that the user can see them.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn recoverable(&self) -> Result<Vec<Recoverable>, JournalError> {
        let folder = self.journals();
        let names = numbered::names(&*self.files, &folder)
            .map_err(JournalError::io(&folder, "the folder of journals cannot be read"))?;
        let mut found = Vec::new();
        for path in names.into_iter().map(|name| folder.join(name)) {
            if path.extension().is_none_or(|ending| ending != EXTENSION) {
                continue;
            }
            match self.inspect(&path) {
                Ok(recoverable) => found.push(recoverable),
                Err(JournalError::Io { error, .. }) if error.kind() == io::ErrorKind::NotFound => {}
                // The other journals can still be recovered.
                Err(error) => {
                    found.push(Recoverable::unreadable(path, Readability::Damaged(error.to_string())))
                }
            }
        }
        found.sort_by(|one, other| other.when.cmp(&one.when).then_with(|| one.journal.cmp(&other.journal)));
        Ok(found)
    }

    /// Returns the content of a journal, to show it before the user decides. Changes nothing.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn entries(&self, found: &Recoverable) -> Result<Vec<JournalEntry>, JournalError> {
        let path = &found.journal;
        let file = retry(|| self.files.open(path)).map_err(JournalError::io(path, "cannot be read"))?;
        let mut contents = contents(&*file, path)?;
        contents.compare_file(&*self.files);
        Ok(contents.entries)
    }

    /// Inspects one journal without changing it.
    pub(super) fn inspect(&self, path: &Path) -> Result<Recoverable, JournalError> {
        let fail = |error| JournalError::io(path, "cannot be read")(error);
        for _ in 0..INSPECT_ATTEMPTS {
            let file = retry(|| self.files.open(path)).map_err(fail)?;
            let found = self.read_summary(&*file, path)?;
            // The owner may have replaced the journal by a restarted one; then the file that was read is no longer
            // the journal.
            if same(&*self.files, &*file, path).map_err(fail)? {
                return Ok(found);
            }
        }
        // A journal that is restarted this often is in use.
        let found = Recoverable::unreadable(path.to_path_buf(), Readability::Whole);
        Ok(Recoverable { owner_status: OwnerStatus::Running, ..found })
    }

    fn read_summary(&self, file: &dyn VfsFile, path: &Path) -> Result<Recoverable, JournalError> {
        let fail = |error| JournalError::io(path, "cannot be read")(error);
        let data = retry(|| file.metadata()).map_err(fail)?;
        let found = Recoverable::unreadable(path.to_path_buf(), Readability::Whole);
        let mut found = Recoverable { when: data.modified, bytes: data.size, ..found };
        let mut state = JournalState::default();
        let scan = match record::scan(file, |tag, bytes| state.add(tag, bytes)) {
            Ok(scan) => scan,
            Err(refused) => {
                found.reading = match refused {
                    ReadFailure::Newer(version) => Readability::Newer(version),
                    ReadFailure::Damaged(why) => Readability::Damaged(why.to_owned()),
                    ReadFailure::Io(error) => return Err(fail(error)),
                };
                found.owner_status = owner_status(file, &state).map_err(fail)?;
                return Ok(found);
            }
        };
        state.stamp = state.stamp.or(scan.header.stamp);
        if scan.valid < scan.size {
            found.reading = Readability::Cut(scan.size - scan.valid);
        }
        found.owner_status = owner_status(file, &state).map_err(fail)?;
        found.document = scan.header.document.as_ref().map(PathText::path);
        found.file = document_file_state(&*self.files, found.document.as_deref(), &mut state);
        found.stamp = state.stamp;
        found.saving = state.saving.and_then(|(saving, _)| saving.file).map(|file| (file.size, file.hash));
        found.work = state.work;
        found.unsaved = state.unsaved;
        found.owner = state.owner;
        Ok(found)
    }
}

/// The content of a journal.
pub(super) struct JournalContents {
    pub(super) scan: JournalScan,
    pub(super) state: JournalState,
    pub(super) entries: Vec<JournalEntry>,
}

impl JournalContents {
    /// Compares the document's file with the journal. If a save was finished but not recorded, adds it to the entries
    /// and returns the stamp of the file.
    pub(super) fn compare_file(&mut self, files: &dyn Vfs) -> Option<FileStamp> {
        let document = self.scan.header.document.as_ref().map(PathText::path);
        self.compare_file_at(files, document.as_deref())
    }

    /// As [`compare_file`](Self::compare_file), for a file that was moved to `path`.
    pub(super) fn compare_file_at(&mut self, files: &dyn Vfs, path: Option<&Path>) -> Option<FileStamp> {
        let waits = self.state.saving.is_some();
        document_file_state(files, path, &mut self.state);
        let settled = self.state.stamp.filter(|_| waits && self.state.saving.is_none());
        if settled.is_some() {
            mark_saved(&mut self.entries, &self.state);
        }
        settled
    }
}

/// Inserts a [`JournalEntry::Saved`] before the unsaved edits that `state` counts.
fn mark_saved(entries: &mut Vec<JournalEntry>, state: &JournalState) {
    let unsaved = usize::try_from(state.unsaved).unwrap_or(usize::MAX);
    entries.insert(entries.len().saturating_sub(unsaved), JournalEntry::Saved);
}

/// Reads the whole journal in `file`.
pub(super) fn contents(file: &dyn VfsFile, path: &Path) -> Result<JournalContents, JournalError> {
    let mut state = JournalState::default();
    let mut entries = Vec::new();
    let scan = record::scan(file, |tag, bytes| {
        let understood = state.add(tag, bytes);
        match tag {
            Tag::Snapshot => {
                entries.clear();
                entries.push(JournalEntry::Snapshot(bytes.to_vec()));
            }
            Tag::Edit => entries.push(JournalEntry::Edit(bytes.to_vec())),
            Tag::Saved if understood => mark_saved(&mut entries, &state),
            _ => {}
        }
        understood
    });
    let scan = scan.map_err(|refused| match refused {
        ReadFailure::Newer(version) => JournalError::Newer { path: path.to_path_buf(), version },
        ReadFailure::Damaged(reason) => {
            JournalError::Damaged { path: path.to_path_buf(), reason: reason.to_owned() }
        }
        ReadFailure::Io(error) => JournalError::io(path, "cannot be read")(error),
    })?;
    state.stamp = state.stamp.or(scan.header.stamp);
    Ok(JournalContents { scan, state, entries })
}

/// Returns whether `path` still names `file`.
pub(super) fn same(files: &dyn Vfs, file: &dyn VfsFile, path: &Path) -> io::Result<bool> {
    let (opened, named) = (retry(|| file.metadata())?, retry(|| files.metadata(path))?);
    Ok((opened.device, opened.inode) == (named.device, named.inode))
}

/// Returns whether the process that opened the journal in `file` still runs.
fn owner_status(file: &dyn VfsFile, state: &JournalState) -> io::Result<OwnerStatus> {
    let owner = state
        .owner
        .as_ref()
        .filter(|_| !state.closed)
        .map_or(OwnerStatus::Exited, JournalOwner::owner_status);
    // If the owner runs, it is the process that holds the lock; otherwise the lock is held by a process that only
    // inspects the journal and releases it soon.
    let lock = if owner == OwnerStatus::Running { lock(file)? } else { lock_with_retries(file)? };
    if lock == LockResult::Ours {
        // Closing the file is not enough: a process that is being started has a copy of the handle for a moment, and the next
        // inspection would take its lock for that of the owner.
        let _ = file.unlock();
    }
    Ok(match lock {
        LockResult::Held => OwnerStatus::Running,
        // A lock held on another computer may not be visible here.
        LockResult::Ours if owner == OwnerStatus::OnOtherHost => owner,
        LockResult::Ours => OwnerStatus::Exited,
        LockResult::Unsupported => owner,
    })
}

/// Compares the document's file with `state`. A save that was finished but not recorded is settled in `state`.
pub(super) fn document_file_state(
    files: &dyn Vfs,
    document: Option<&Path>,
    state: &mut JournalState,
) -> DocumentFileState {
    let Some(document) = document else { return DocumentFileState::Unsaved };
    if state.saving.is_some()
        && let Ok(stamp) = FileStamp::take(files, document)
        && state.settle(stamp)
    {
        return DocumentFileState::Same;
    }
    let document_file_state = match &state.stamp {
        Some(stamp) => stamp.state(files, document),
        None => metadata_if_exists(files, document).map(|data| match data {
            Some(_) => FileState::Changed,
            None => FileState::Missing,
        }),
    };
    match document_file_state {
        Ok(FileState::Same) => DocumentFileState::Same,
        Ok(FileState::Changed) => DocumentFileState::Changed,
        Ok(FileState::Missing) => DocumentFileState::Missing,
        Err(error) => DocumentFileState::Unknown(super::error::reason(&error)),
    }
}
