//! The folder of the pose library, as the document read it.

use dragonfly_document::PoseFolder;
use std::path::{Path, PathBuf};

/// The poses of the library.
#[derive(Debug, Default)]
pub struct PoseLibrary {
    folder: PoseFolder,
    /// Grows with every reading.
    version: u64,
    usual: Option<PathBuf>,
}

impl PoseLibrary {
    /// Returns the folder with its poses.
    pub fn folder(&self) -> &PoseFolder {
        &self.folder
    }

    /// Returns a number that grows with every reading.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Returns the folder that is used if none was chosen.
    pub fn usual(&self) -> Option<&Path> {
        self.usual.as_deref()
    }

    pub(super) fn set_usual(&mut self, folder: Option<PathBuf>) {
        self.usual = folder;
    }

    pub(super) fn set_folder(&mut self, folder: PoseFolder) {
        self.folder = folder;
        self.version += 1;
    }
}
