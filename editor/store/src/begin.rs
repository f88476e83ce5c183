//! Beginning the journal of a document in the autosave folder.

use super::autosave::{Autosave, EXTENSION};
use super::journal::{Journal, JournalError, new_number};
use super::lock::{LockResult, lock_with_retries};
use super::owner::OwnerStatus;
use super::record::{JournalHeader, PathText};
use super::recoverable::{Readability, Recoverable};
use super::stamp::FileStamp;
use super::target::{canonical, key};
use super::vfs::{VfsFile, folder_of, retry};
use std::io;
use std::path::Path;
use std::sync::Arc;

/// Number of names tried for the journal of one document. Damaged journals, and journals written by newer programs,
/// keep their names.
const TRIES: usize = 100;
/// Result of [`Autosave::begin`].
#[derive(Debug)]
pub enum Opening {
    /// A new journal.
    New(Box<Journal>),
    /// A journal left by an earlier run, with unsaved work or at least its history. The caller resumes it, copies it
    /// or discards it, and then begins again.
    Found(Box<Recoverable>),
}

impl Autosave {
    /// Begins the journal of the document at `document`, whose `stamp` was taken when the file was read. `None` is a
    /// document that was never saved.
    ///
    /// # Errors
    /// [`JournalError::Held`] names the process that already has the document open; any other error means that no
    /// journal can be written.
    pub fn begin(&self, document: Option<&Path>, stamp: Option<&FileStamp>) -> Result<Opening, JournalError> {
        self.create(document, stamp, false)
    }

    /// Begins another journal of the document next to the existing ones, even if they are in use.
    ///
    /// # Errors
    /// When no journal can be written.
    pub fn begin_another(
        &self,
        document: Option<&Path>,
        stamp: Option<&FileStamp>,
    ) -> Result<Journal, JournalError> {
        match self.create(document, stamp, true)? {
            Opening::New(journal) => Ok(*journal),
            Opening::Found(other) => Err(JournalError::TooManyJournals { path: other.journal }),
        }
    }

    /// Implements [`begin`](Self::begin); with `another`, skips existing journals instead of returning them.
    fn create(
        &self,
        document: Option<&Path>,
        stamp: Option<&FileStamp>,
        another: bool,
    ) -> Result<Opening, JournalError> {
        let folder = self.journals();
        retry(|| self.files.create_folder(&folder))
            .map_err(JournalError::io(&folder, "the folder of journals cannot be created"))?;
        let number = new_number();
        let document = document.map(|path| canonical(&*self.files, path));
        let header =
            JournalHeader { number, document: document.as_deref().map(PathText::new), stamp: stamp.copied() };
        let key = document.map_or_else(|| format!("untitled-{number:016x}"), |path| key(&*self.files, &path));
        let mut path = folder.clone();
        for turn in 1..=TRIES {
            let name = if turn == 1 { key.clone() } else { format!("{key}-{turn}") };
            path = folder.join(format!("{name}.{EXTENSION}"));
            let fail = JournalError::io(&path, "the journal cannot be created");
            match retry(|| self.files.create_new(&path, true)) {
                Ok(file) => return self.start(file, &path, header).map(Box::new).map(Opening::New),
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(fail(error)),
                Err(_) if another => continue,
                Err(_) => {}
            }
            if let Some(file) = self.empty(&path).map_err(fail)? {
                return self.start(file, &path, header).map(Box::new).map(Opening::New);
            }
            let found = self.inspect(&path)?;
            if found.owner_status == OwnerStatus::Running {
                return Err(JournalError::Held { path, owner: found.owner });
            }
            match found.reading {
                Readability::Whole | Readability::Cut(_) => return Ok(Opening::Found(Box::new(found))),
                // Left unchanged: they may contain work, but this program cannot continue them.
                Readability::Newer(_) | Readability::Damaged(_) => {}
            }
        }
        Err(JournalError::TooManyJournals { path })
    }

    /// Opens and locks the file at `path` if it is empty and no other process is about to write to it.
    fn empty(&self, path: &Path) -> io::Result<Option<Box<dyn VfsFile>>> {
        let file = match retry(|| self.files.open_to_write(path)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            other => other?,
        };
        let empty = |file: &dyn VfsFile| Ok::<_, io::Error>(retry(|| file.metadata())?.size == 0);
        if !empty(&*file)? || lock_with_retries(&*file)? == LockResult::Held || !empty(&*file)? {
            return Ok(None);
        }
        Ok(Some(file))
    }

    fn start(
        &self,
        file: Box<dyn VfsFile>,
        path: &Path,
        header: JournalHeader,
    ) -> Result<Journal, JournalError> {
        let begun = lock_with_retries(&*file).and_then(|lock| {
            if lock == LockResult::Held {
                return Ok(None);
            }
            let journal = Journal::begin(Arc::clone(&self.files), file, path.to_path_buf(), header)?;
            retry(|| journal.file.sync_all())?;
            retry(|| self.files.sync_folder(folder_of(path)))?;
            Ok(Some(journal))
        });
        match begun {
            Ok(Some(journal)) => Ok(journal),
            Ok(None) => Err(JournalError::Held { path: path.to_path_buf(), owner: None }),
            Err(error) => {
                let _ = retry(|| self.files.remove(path));
                Err(JournalError::io(path, "the journal cannot be created")(error))
            }
        }
    }
}
