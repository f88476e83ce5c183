//! A folder into which the user is about to save, with the folders that the save creates.

use std::path::{Path, PathBuf};

/// A folder that was looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LookedFolder {
    folder: PathBuf,
    /// The folders that a save into it creates, as a path in the one that exists.
    created: Option<PathBuf>,
}

impl LookedFolder {
    /// Creates one of a folder, with the folders that a save into it creates.
    pub(super) fn new(folder: PathBuf, created: Option<PathBuf>) -> Self {
        Self { folder, created }
    }

    /// Returns a sentence about the folders that a save into `folder` creates; `None` where it creates none, or that is not known.
    pub(super) fn hint(&self, folder: &Path) -> Option<String> {
        let created = self.created.as_ref().filter(|_| self.folder == folder)?;
        let name = created.display();
        Some(match created.components().nth(1) {
            None => format!("A new folder {name} will be made"),
            Some(_) => format!("New folders {name} will be made"),
        })
    }
}
