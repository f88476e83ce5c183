//! The autosave folder: journals of documents, their old versions, and a bin. Never the documents' own folders.

use super::journal::{Journal, JournalError, new_number};
use super::owner::Life;
use super::record::{Header, PathText};
use super::recoverable::{Reading, Recoverable};
use super::shelf::Bounds;
use super::stamp::{FileStamp, hash};
use super::versions::{VersionLimits, Versions};
use super::vfs::{Vfs, VfsFile, again, folder_of};
use etcetera::{AppStrategy, AppStrategyArgs, choose_app_strategy};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Ends the names of journals.
pub(super) const ENDING: &str = "journal";

/// Names tried for the journal of one document: those of newer programs and damaged ones are left alone.
const TRIES: usize = 100;

/// The autosave folder.
#[derive(Clone, Debug)]
pub struct Autosave {
    pub(super) files: Arc<dyn Vfs>,
    folder: PathBuf,
    versions: Versions,
    pub(super) bin_bounds: Bounds,
}

/// What came of beginning a journal.
#[derive(Debug)]
pub enum Opening {
    /// A new one.
    New(Box<Journal>),
    /// There is one of an earlier time, with unsaved work or at least its history: keep it, open it beside, or
    /// discard it, and begin again.
    Found(Box<Recoverable>),
}

impl Autosave {
    /// In `folder`, or where the system keeps such things (`$XDG_STATE_HOME/dragonfly` and the like); `None` when it
    /// has no such place. Nothing is made before there is something to keep.
    pub fn new(files: Arc<dyn Vfs>, folder: Option<PathBuf>) -> Option<Self> {
        let usual = || {
            let app = AppStrategyArgs { app_name: "dragonfly".to_owned(), ..Default::default() };
            let places = choose_app_strategy(app).ok()?;
            Some(places.state_dir().unwrap_or_else(|| places.data_dir()))
        };
        let folder = folder.or_else(usual)?;
        let versions = Versions::new(folder.join("versions"), VersionLimits::default());
        let bin_bounds = Bounds { least: 3, most: 100, bytes: 512 << 20 };
        Some(Self { files, folder, versions, bin_bounds })
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Old versions of documents.
    pub fn versions(&self) -> &Versions {
        &self.versions
    }

    /// Where journals are.
    pub fn journals(&self) -> PathBuf {
        self.folder.join("journals")
    }

    /// Where discarded journals are.
    pub fn bin(&self) -> PathBuf {
        self.folder.join("bin")
    }

    /// Begins the journal of the document at `document`, of which `stamp` was taken when it was read; of a document
    /// never saved when `None`.
    ///
    /// # Errors
    /// [`JournalError::Held`] says who has the document open already; others, that no journal can be written.
    pub fn begin(&self, document: Option<&Path>, stamp: Option<&FileStamp>) -> Result<Opening, JournalError> {
        self.create(document, stamp, false)
    }

    /// Begins a journal of the document beside those that there are, whoever has them.
    ///
    /// # Errors
    /// When no journal can be written.
    pub fn begin_beside(
        &self,
        document: Option<&Path>,
        stamp: Option<&FileStamp>,
    ) -> Result<Journal, JournalError> {
        match self.create(document, stamp, true)? {
            Opening::New(journal) => Ok(*journal),
            Opening::Found(other) => Err(JournalError::Crowded { path: other.journal }),
        }
    }

    /// As [`begin`](Self::begin); `beside` all that is there.
    pub(super) fn create(
        &self,
        document: Option<&Path>,
        stamp: Option<&FileStamp>,
        beside: bool,
    ) -> Result<Opening, JournalError> {
        let folder = self.journals();
        again(|| self.files.create_folder(&folder))
            .map_err(JournalError::io(&folder, "the folder of journals cannot be made"))?;
        let number = new_number();
        let document = document.map(|path| meant(&*self.files, path));
        let header =
            Header { number, document: document.as_deref().map(PathText::new), stamp: stamp.copied() };
        let key = document.map_or_else(|| format!("untitled-{number:016x}"), |path| key(&*self.files, &path));
        let mut path = folder.clone();
        for turn in 1..=TRIES {
            let name = if turn == 1 { key.clone() } else { format!("{key}-{turn}") };
            path = folder.join(format!("{name}.{ENDING}"));
            let fail = JournalError::io(&path, "the journal cannot be made");
            match again(|| self.files.create_new(&path, true)) {
                Ok(file) => return self.start(file, &path, header).map(Box::new).map(Opening::New),
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(fail(error)),
                Err(_) if beside => continue,
                Err(_) => {}
            }
            if let Some(file) = self.empty(&path).map_err(fail)? {
                return self.start(file, &path, header).map(Box::new).map(Opening::New);
            }
            let found = self.inspect(&path)?;
            if found.life == Life::Lives {
                return Err(JournalError::Held { path, owner: found.owner });
            }
            match found.reading {
                Reading::Whole | Reading::Cut(_) => return Ok(Opening::Found(Box::new(found))),
                // Left as they are: they may be somebody's work, but not what this program can go on with.
                Reading::Newer(_) | Reading::Damaged(_) => {}
            }
        }
        Err(JournalError::Crowded { path })
    }

    /// The file at `path`, locked, if it is an empty one: nothing is in it, and nobody is about to fill it.
    fn empty(&self, path: &Path) -> io::Result<Option<Box<dyn VfsFile>>> {
        let file = match again(|| self.files.open_to_write(path)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            other => other?,
        };
        let empty = |file: &dyn VfsFile| Ok::<_, io::Error>(again(|| file.metadata())?.size == 0);
        if !empty(&*file)? || lock_patiently(&*file)? == Lock::Held || !empty(&*file)? {
            return Ok(None);
        }
        Ok(Some(file))
    }

    fn start(&self, file: Box<dyn VfsFile>, path: &Path, header: Header) -> Result<Journal, JournalError> {
        let begun = lock_patiently(&*file).and_then(|lock| {
            if lock == Lock::Held {
                return Ok(None);
            }
            let journal = Journal::begin(Arc::clone(&self.files), file, path.to_path_buf(), header)?;
            again(|| journal.file.sync_all())?;
            again(|| self.files.sync_folder(folder_of(path)))?;
            Ok(Some(journal))
        });
        match begun {
            Ok(Some(journal)) => Ok(journal),
            Ok(None) => Err(JournalError::Held { path: path.to_path_buf(), owner: None }),
            Err(error) => {
                let _ = again(|| self.files.remove(path));
                Err(JournalError::io(path, "the journal cannot be made")(error))
            }
        }
    }
}

/// What came of locking a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lock {
    Ours,
    Held,
    /// Files cannot be locked here.
    Unsupported,
}

/// Takes the lock of `file`, if nobody has it.
pub(super) fn lock(file: &dyn VfsFile) -> io::Result<Lock> {
    match again(|| file.try_lock()) {
        Ok(true) => Ok(Lock::Ours),
        Ok(false) => Ok(Lock::Held),
        Err(error) if error.kind() == io::ErrorKind::Unsupported => Ok(Lock::Unsupported),
        Err(error) => Err(error),
    }
}

/// Who looks at a journal holds its lock for a moment; who works with it holds it for long.
const PATIENCE: usize = 50;

/// Takes the lock of `file`; when another one has it, tries for a tenth of a second.
pub(super) fn lock_patiently(file: &dyn VfsFile) -> io::Result<Lock> {
    for _ in 1..PATIENCE {
        match lock(file)? {
            Lock::Held => std::thread::park_timeout(Duration::from_millis(2)),
            other => return Ok(other),
        }
    }
    lock(file)
}

/// The file that `path` leads to, free of links, so that two ways to it are one document; as it is, if it leads
/// nowhere.
fn meant(files: &dyn Vfs, path: &Path) -> PathBuf {
    super::save::resolved(files, path)
        .or_else(|_| std::path::absolute(path))
        .unwrap_or_else(|_| path.to_path_buf())
}

/// What files of the document at `path` are called in the autosave folder: something a person recognises, and what
/// tells it from all others.
pub(super) fn key(files: &dyn Vfs, path: &Path) -> String {
    let path = meant(files, path);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |letter: char| if letter.is_alphanumeric() { letter } else { '_' };
    let stem: String = stem.chars().take(32).map(plain).collect();
    format!("{stem}-{:016x}", hash(path.as_os_str().as_encoded_bytes()))
}
