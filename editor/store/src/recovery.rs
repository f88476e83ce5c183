//! What a person may do with a journal that can be had back: keep it, open it beside, discard it. Nothing is deleted
//! unasked, and the document's own file is only looked at.

use super::autosave::{Autosave, Lock, lock_patiently};
use super::journal::{Journal, JournalError};
use super::owner::{Life, Owner};
use super::record::Tag;
use super::recoverable::{Contents, Entry, Reading, Recoverable, contents, same};
use super::shelf::{self, Bounds};
use super::vfs::{VfsFile, again, folder_of, look, read_pieces, write_all};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A journal that goes on.
#[derive(Debug)]
pub struct Resumed {
    /// This process has it now.
    pub journal: Journal,
    /// What was in it.
    pub entries: Vec<Entry>,
    /// Bytes at its end that could not be read; they lie in the bin.
    pub cut: u64,
}

/// Is a journal taken that was last taken on another machine, which cannot be asked?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// No: say so.
    IfFree,
    /// Yes: a person said that nobody works with it.
    Anyway,
}

impl Autosave {
    /// Goes on with a journal: its work is given back, and new work appended to it. What cannot be read at its end
    /// is cut off and put into the bin.
    ///
    /// Whether the document's file is still what the journal goes on from is for the caller to see
    /// ([`Recoverable::file`]); nothing here writes to it.
    ///
    /// # Errors
    /// When somebody has it, or it cannot be read or written. What could be read of it still can be.
    pub fn keep(&self, found: &Recoverable, claim: Claim) -> Result<Resumed, JournalError> {
        let path = &found.journal;
        let fail = |error| JournalError::io(path, "cannot be taken")(error);
        let (file, locked) = self.take(path)?;
        let mut contents = contents(&*file, path)?;
        let state = &contents.state;
        let life =
            if state.closed { Life::Gone } else { state.owner.as_ref().map_or(Life::Gone, Owner::life) };
        match (life, state.owner.clone()) {
            // Who has the lock has the journal, so what its owner's number says matters only without one.
            (Life::Lives, owner) if !locked => {
                return Err(JournalError::Held { path: path.clone(), owner });
            }
            (Life::Elsewhere, Some(owner)) if claim == Claim::IfFree => {
                return Err(JournalError::Elsewhere { path: path.clone(), owner });
            }
            _ => {}
        }
        let cut = contents.scan.size - contents.scan.valid;
        if cut > 0 {
            self.cut(&*file, path, contents.scan.valid).map_err(fail)?;
        }
        let saving = contents.state.saving;
        let settled = contents.look_at_file(&*self.files);
        let Contents { scan, mut state, entries, .. } = contents;
        // It settles again when the record below is written.
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
        journal.write_json(Tag::Opened, &Owner::this())?;
        journal.sync()?;
        Ok(Resumed { journal, entries, cut })
    }

    /// Copies the work in a journal into a new one, of the document at `document`, whose file is the one that the work was
    /// done on, or of one not yet saved. The journal itself stays as it is, and may be somebody else's.
    ///
    /// # Errors
    /// When it cannot be read or the new one cannot be written.
    pub fn beside(&self, found: &Recoverable, document: Option<&Path>) -> Result<Resumed, JournalError> {
        let path = &found.journal;
        let file = again(|| self.files.open(path)).map_err(JournalError::io(path, "cannot be read"))?;
        let mut contents = contents(&*file, path)?;
        if document.is_some() {
            contents.look_at_file_in(&*self.files, document);
        }
        let Contents { scan, state, entries } = contents;
        let mut journal = self.begin_beside(document, state.stamp.as_ref())?;
        let copied = entries.iter().try_for_each(|entry| match entry {
            Entry::Snapshot(bytes) => journal.write(Tag::Snapshot, bytes),
            Entry::Edit(bytes) => journal.write(Tag::Edit, bytes),
            // Which of several saves it was the stamp does not say, and only the last one matters.
            Entry::Saved => match state.stamp.filter(|_| document.is_some()) {
                Some(stamp) => journal.write_json(Tag::Saved, &stamp),
                None => Ok(()),
            },
        });
        if let Err(error) = copied.and_then(|()| journal.sync()) {
            let _ = again(|| self.files.remove(&journal.path));
            return Err(error);
        }
        Ok(Resumed { journal, entries, cut: scan.size - scan.valid })
    }

    /// Puts a journal into the bin; where it is there. The oldest in the bin make room when it is full.
    ///
    /// # Errors
    /// When somebody has it, or it cannot be moved. It stays then.
    pub fn discard(&self, found: &Recoverable) -> Result<PathBuf, JournalError> {
        let path = &found.journal;
        let fail = |error| JournalError::io(path, "cannot be put into the bin")(error);
        // Held until it has moved, so that nobody takes it meanwhile.
        let (_file, _) = self.take(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let to = self.place_in_bin(&name).map_err(fail)?;
        again(|| self.files.rename(path, &to)).map_err(fail)?;
        again(|| self.files.sync_folder(folder_of(&to))).map_err(fail)?;
        again(|| self.files.sync_folder(folder_of(path))).map_err(fail)?;
        shelf::trim(&*self.files, &self.bin(), self.bin_bounds);
        Ok(to)
    }

    /// Puts a journal that this process has into the bin; where it is there.
    ///
    /// # Errors
    /// As [`discard`](Self::discard).
    pub fn put_away(&self, journal: Journal) -> Result<PathBuf, JournalError> {
        let path = journal.path().to_path_buf();
        // Its lock goes with it; whoever is quicker to take it has it.
        drop(journal);
        let found = self.inspect(&path)?;
        self.discard(&found)
    }

    /// What is in the bin, last discarded first.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn discarded(&self) -> Result<Vec<PathBuf>, JournalError> {
        let bin = self.bin();
        let found = shelf::numbered(&*self.files, &bin).map_err(JournalError::io(&bin, "cannot be read"))?;
        Ok(found.into_iter().rev().map(|file| file.path).collect())
    }

    /// Takes a discarded journal out of the bin again; where it is.
    ///
    /// # Errors
    /// When it cannot be moved, or another one has its place meanwhile. It stays then.
    pub fn bring_back(&self, discarded: &Path) -> Result<PathBuf, JournalError> {
        let fail = |error| JournalError::io(discarded, "cannot be brought back")(error);
        let name = discarded.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let name = name.split_once('-').map_or(name.as_str(), |(_, name)| name);
        let to = self.journals().join(name);
        if look(&*self.files, &to).map_err(fail)?.is_some() {
            return Err(fail(io::ErrorKind::AlreadyExists.into()));
        }
        again(|| self.files.rename(discarded, &to)).map_err(fail)?;
        again(|| self.files.sync_folder(folder_of(&to))).map_err(fail)?;
        Ok(to)
    }

    /// Puts journals with nothing but history into the bin, those written longest ago, until the others are within
    /// `bounds`. How many.
    ///
    /// # Errors
    /// When the folder of journals cannot be read.
    pub fn tidy(&self, bounds: Bounds) -> Result<usize, JournalError> {
        let (mut bytes, mut stay, mut gone) = (0_u64, 0, 0);
        for found in self.recoverable()? {
            let history =
                matches!(found.reading, Reading::Whole) && found.unsaved == 0 && found.life == Life::Gone;
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

    /// Opens the journal at `path` and locks it, if files can be locked here.
    fn take(&self, path: &Path) -> Result<(Box<dyn VfsFile>, bool), JournalError> {
        let fail = |error| JournalError::io(path, "cannot be taken")(error);
        loop {
            let file = again(|| self.files.open_to_write(path)).map_err(fail)?;
            let lock = lock_patiently(&*file).map_err(fail)?;
            if lock == Lock::Held {
                let owner = contents(&*file, path).ok().and_then(|contents| contents.state.owner);
                return Err(JournalError::Held { path: path.to_path_buf(), owner });
            }
            // Its owner may have begun it anew under the same name before it let go.
            if same(&*self.files, &*file, path).map_err(fail)? {
                return Ok((file, lock == Lock::Ours));
            }
        }
    }

    /// Cuts the journal off at `valid`, after what is behind was put into the bin.
    fn cut(&self, file: &dyn VfsFile, path: &Path, valid: u64) -> io::Result<()> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let tail = self.place_in_bin(&format!("{name}.tail"))?;
        let to = again(|| self.files.create_new(&tail, true))?;
        let kept = read_pieces(file, |offset, piece| {
            let skip = usize::try_from(valid.saturating_sub(offset)).unwrap_or(usize::MAX).min(piece.len());
            write_all(&*to, &piece[skip..], (offset + skip as u64).saturating_sub(valid))
        });
        let kept = kept.and_then(|_| again(|| to.sync_all()));
        if let Err(error) = kept {
            let _ = again(|| self.files.remove(&tail));
            return Err(error);
        }
        again(|| file.set_size(valid))?;
        again(|| file.sync_all())?;
        shelf::trim(&*self.files, &self.bin(), self.bin_bounds);
        Ok(())
    }

    fn place_in_bin(&self, name: &str) -> io::Result<PathBuf> {
        let bin = self.bin();
        again(|| self.files.create_folder(&bin))?;
        Ok(shelf::next(&bin, &shelf::numbered(&*self.files, &bin)?, name))
    }
}
