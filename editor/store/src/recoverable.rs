//! What can be had back: the journals in the autosave folder, looked at and not changed.

use super::autosave::{Autosave, ENDING, Lock, lock, lock_patiently};
use super::journal::JournalError;
use super::owner::{Life, Owner};
use super::record::{self, PathText, Refused, Scan, Tag};
use super::shelf;
use super::stamp::{FileStamp, FileState};
use super::state::State;
use super::vfs::{Vfs, VfsFile, again, look};
use std::io;
use std::path::{Path, PathBuf};

/// How often a journal is looked at that is begun anew meanwhile.
const LOOKS: usize = 10;

/// Can the journal be read?
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reading {
    /// To its end.
    Whole,
    /// But for so many bytes at its end: a record that was not finished, or all that follows a damaged one.
    Cut(u64),
    /// Not by this program: it is of this later format.
    Newer(u32),
    /// No: why not.
    Damaged(String),
}

/// What became of the document's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fate {
    /// There never was one.
    Unsaved,
    /// It is what the journal goes on from.
    Same,
    /// It is another one than the journal goes on from.
    Changed,
    /// It is not there: removed, or moved.
    Missing,
    /// It cannot be looked at: why not.
    Unknown(String),
}

/// A journal in the autosave folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recoverable {
    /// The journal.
    pub journal: PathBuf,
    /// The document's file; none for one never saved.
    pub document: Option<PathBuf>,
    /// When it was last written, in nanoseconds since 1970.
    pub when: i64,
    /// Edits in it, and a snapshot as one.
    pub work: u64,
    /// Of them, those not in the document's file.
    pub unsaved: u64,
    /// Its bytes.
    pub bytes: u64,
    /// Can it be read?
    pub reading: Reading,
    /// What became of the document's file?
    pub file: Fate,
    /// What that file was when it last held what the journal goes on from.
    pub stamp: Option<FileStamp>,
    /// Size and hash of what the file was about to become, when nothing is said of how that save ended.
    pub saving: Option<(u64, u64)>,
    /// Who had it last.
    pub owner: Option<Owner>,
    /// Does that one still?
    pub life: Life,
}

impl Recoverable {
    /// Of which nothing is known but this.
    fn unread(journal: PathBuf, reading: Reading) -> Self {
        Self {
            journal,
            document: None,
            when: 0,
            work: 0,
            unsaved: 0,
            bytes: 0,
            reading,
            file: Fate::Unsaved,
            stamp: None,
            saving: None,
            owner: None,
            life: Life::Gone,
        }
    }

    /// Is a file that is like this, wherever it lies, the document's: does it hold what it held last?
    pub fn held(&self, stamp: &FileStamp) -> bool {
        let then = self.stamp.map(|then| (then.size, then.hash));
        [then, self.saving].contains(&Some((stamp.size, stamp.hash)))
    }

    /// Is it to be offered at the start: work that is in no file, and nobody has it?
    pub fn is_offered(&self) -> bool {
        self.unsaved > 0 && self.life != Life::Lives
    }
}

/// What a journal gives back, in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Entry {
    /// The whole document with its history; nothing before it matters.
    Snapshot(Vec<u8>),
    /// One edit.
    Edit(Vec<u8>),
    /// The document was saved here.
    Saved,
}

impl Autosave {
    /// All journals there are, last written first; those with nothing to offer too, so that a person can see them.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn recoverable(&self) -> Result<Vec<Recoverable>, JournalError> {
        let folder = self.journals();
        let names = shelf::list(&*self.files, &folder)
            .map_err(JournalError::io(&folder, "the folder of journals cannot be read"))?;
        let mut found = Vec::new();
        for path in names.into_iter().map(|name| folder.join(name)) {
            if path.extension().is_none_or(|ending| ending != ENDING) {
                continue;
            }
            match self.inspect(&path) {
                Ok(recoverable) => found.push(recoverable),
                Err(JournalError::Io { error, .. }) if error.kind() == io::ErrorKind::NotFound => {}
                // The others can be had back all the same.
                Err(error) => found.push(Recoverable::unread(path, Reading::Damaged(error.to_string()))),
            }
        }
        found.sort_by(|one, other| other.when.cmp(&one.when).then_with(|| one.journal.cmp(&other.journal)));
        Ok(found)
    }

    /// What is in a journal, to show it before anything is decided; changes nothing.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn entries(&self, found: &Recoverable) -> Result<Vec<Entry>, JournalError> {
        let path = &found.journal;
        let file = again(|| self.files.open(path)).map_err(JournalError::io(path, "cannot be read"))?;
        let mut contents = contents(&*file, path)?;
        contents.look_at_file(&*self.files);
        Ok(contents.entries)
    }

    /// Looks at one journal; changes nothing.
    pub(super) fn inspect(&self, path: &Path) -> Result<Recoverable, JournalError> {
        let fail = |error| JournalError::io(path, "cannot be read")(error);
        for _ in 0..LOOKS {
            let file = again(|| self.files.open(path)).map_err(fail)?;
            let found = self.look_at(&*file, path)?;
            // Its owner may have begun it anew meanwhile; then what was looked at is nobody's any more.
            if same(&*self.files, &*file, path).map_err(fail)? {
                return Ok(found);
            }
        }
        // Whoever begins it anew so often is at work.
        let found = Recoverable::unread(path.to_path_buf(), Reading::Whole);
        Ok(Recoverable { life: Life::Lives, ..found })
    }

    fn look_at(&self, file: &dyn VfsFile, path: &Path) -> Result<Recoverable, JournalError> {
        let fail = |error| JournalError::io(path, "cannot be read")(error);
        let data = again(|| file.metadata()).map_err(fail)?;
        let found = Recoverable::unread(path.to_path_buf(), Reading::Whole);
        let mut found = Recoverable { when: data.modified, bytes: data.size, ..found };
        let mut state = State::default();
        let scan = match record::scan(file, |tag, bytes| state.add(tag, bytes)) {
            Ok(scan) => scan,
            Err(refused) => {
                found.reading = match refused {
                    Refused::Newer(version) => Reading::Newer(version),
                    Refused::Damaged(why) => Reading::Damaged(why.to_owned()),
                    Refused::Io(error) => return Err(fail(error)),
                };
                found.life = life(file, &state).map_err(fail)?;
                return Ok(found);
            }
        };
        state.stamp = state.stamp.or(scan.header.stamp);
        if scan.valid < scan.size {
            found.reading = Reading::Cut(scan.size - scan.valid);
        }
        found.life = life(file, &state).map_err(fail)?;
        found.document = scan.header.document.as_ref().map(PathText::path);
        found.file = fate(&*self.files, found.document.as_deref(), &mut state);
        found.stamp = state.stamp;
        found.saving = state.saving.map(|(saving, _)| (saving.size, saving.hash));
        found.work = state.work;
        found.unsaved = state.unsaved;
        found.owner = state.owner;
        Ok(found)
    }
}

/// All that is in a journal.
pub(super) struct Contents {
    pub(super) scan: Scan,
    pub(super) state: State,
    pub(super) entries: Vec<Entry>,
}

impl Contents {
    /// Looks at the document's file where it was. Where a save was finished, but not recorded, the entries say so from now
    /// on, and the stamp of the file comes back.
    pub(super) fn look_at_file(&mut self, files: &dyn Vfs) -> Option<FileStamp> {
        let document = self.scan.header.document.as_ref().map(PathText::path);
        self.look_at_file_in(files, document.as_deref())
    }

    /// The same where the file is now.
    pub(super) fn look_at_file_in(&mut self, files: &dyn Vfs, path: Option<&Path>) -> Option<FileStamp> {
        let waits = self.state.saving.is_some();
        fate(files, path, &mut self.state);
        let settled = self.state.stamp.filter(|_| waits && self.state.saving.is_none());
        if settled.is_some() {
            mark_saved(&mut self.entries, &self.state);
        }
        settled
    }
}

/// Says among the entries that the document was saved, before those that `state` counts as unsaved.
fn mark_saved(entries: &mut Vec<Entry>, state: &State) {
    let unsaved = usize::try_from(state.unsaved).unwrap_or(usize::MAX);
    entries.insert(entries.len().saturating_sub(unsaved), Entry::Saved);
}

/// All that is in the journal in `file`.
pub(super) fn contents(file: &dyn VfsFile, path: &Path) -> Result<Contents, JournalError> {
    let mut state = State::default();
    let mut entries = Vec::new();
    let scan = record::scan(file, |tag, bytes| {
        let understood = state.add(tag, bytes);
        match tag {
            Tag::Snapshot => {
                entries.clear();
                entries.push(Entry::Snapshot(bytes.to_vec()));
            }
            Tag::Edit => entries.push(Entry::Edit(bytes.to_vec())),
            Tag::Saved if understood => mark_saved(&mut entries, &state),
            _ => {}
        }
        understood
    });
    let scan = scan.map_err(|refused| match refused {
        Refused::Newer(version) => JournalError::Newer { path: path.to_path_buf(), version },
        Refused::Damaged(reason) => {
            JournalError::Damaged { path: path.to_path_buf(), reason: reason.to_owned() }
        }
        Refused::Io(error) => JournalError::io(path, "cannot be read")(error),
    })?;
    state.stamp = state.stamp.or(scan.header.stamp);
    Ok(Contents { scan, state, entries })
}

/// Is `file` still the one called `path`?
pub(super) fn same(files: &dyn Vfs, file: &dyn VfsFile, path: &Path) -> io::Result<bool> {
    let (opened, named) = (again(|| file.metadata())?, again(|| files.metadata(path))?);
    Ok((opened.device, opened.inode) == (named.device, named.inode))
}

/// Does somebody have the journal in `file`?
fn life(file: &dyn VfsFile, state: &State) -> io::Result<Life> {
    let owner = state.owner.as_ref().filter(|_| !state.closed).map_or(Life::Gone, Owner::life);
    // When its owner lives, the lock is its own; else somebody only looks, and will be done soon.
    let lock = if owner == Life::Lives { lock(file)? } else { lock_patiently(file)? };
    Ok(match lock {
        Lock::Held => Life::Lives,
        // A lock of another machine may not be seen here.
        Lock::Ours if owner == Life::Elsewhere => owner,
        Lock::Ours => Life::Gone,
        Lock::Unsupported => owner,
    })
}

/// What became of the document's file; a save that was begun and finished, but not recorded, is settled in `state`.
pub(super) fn fate(files: &dyn Vfs, document: Option<&Path>, state: &mut State) -> Fate {
    let Some(document) = document else { return Fate::Unsaved };
    if state.saving.is_some()
        && let Ok(stamp) = FileStamp::take(files, document)
        && state.settle(stamp)
    {
        return Fate::Same;
    }
    let fate = match &state.stamp {
        Some(stamp) => stamp.state(files, document),
        None => look(files, document).map(|data| match data {
            Some(_) => FileState::Changed,
            None => FileState::Missing,
        }),
    };
    match fate {
        Ok(FileState::Same) => Fate::Same,
        Ok(FileState::Changed) => Fate::Changed,
        Ok(FileState::Missing) => Fate::Missing,
        Err(error) => Fate::Unknown(super::error::reason(&error)),
    }
}
