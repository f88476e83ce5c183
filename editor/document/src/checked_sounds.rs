//! The sounds of a scene that is checked: which of them can be read.

use super::Cancel;
use super::sound::SoundSource;
use super::source::LoadError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The sounds that were looked at. One that can be read is not read again, one that cannot is read once for each question.
pub(super) struct CheckedSounds {
    /// The folder of the script or project.
    folder: PathBuf,
    /// The reason where one cannot be read, by the text with which a script names it.
    read: BTreeMap<String, Result<(), String>>,
}

impl CheckedSounds {
    /// Begins with sounds of this folder, or of the present one.
    pub(super) fn new(folder: Option<&Path>) -> Self {
        Self { folder: folder.map(Path::to_owned).unwrap_or_default(), read: BTreeMap::new() }
    }

    /// Begins a question: what could not be read before may be there now.
    pub(super) fn begin(&mut self) {
        self.read.retain(|_, read| read.is_ok());
    }

    /// Returns the reason where a sound cannot be read.
    ///
    /// # Errors
    ///
    /// It was cancelled.
    pub(super) fn check(&mut self, name: &str, cancel: &Cancel) -> Result<Result<(), String>, LoadError> {
        if let Some(known) = self.read.get(name) {
            return Ok(known.clone());
        }
        if cancel.is_cancelled() {
            return Err(LoadError::Cancelled);
        }
        let read = SoundSource::Below { folder: self.folder.clone(), name: name.to_owned() }.check();
        self.read.insert(name.to_owned(), read.clone());
        Ok(read)
    }
}
