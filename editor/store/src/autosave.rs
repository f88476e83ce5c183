//! The autosave folder: journals of open documents, old versions of their files, and a bin. The folders of the
//! documents themselves are not used.

use super::numbered::FolderLimits;
use super::versions::{VersionLimits, Versions};
use super::vfs::Vfs;
use etcetera::{AppStrategy, AppStrategyArgs, choose_app_strategy};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Extension of journal files.
pub(super) const EXTENSION: &str = "journal";

/// The autosave folder.
#[derive(Clone, Debug)]
pub struct Autosave {
    pub(super) files: Arc<dyn Vfs>,
    folder: PathBuf,
    versions: Versions,
    pub(super) bin_bounds: FolderLimits,
}

impl Autosave {
    /// Uses `folder`, or the system's folder for program state (`$XDG_STATE_HOME/dragonfly` on Linux); `None` when
    /// the system has no such folder. The folder is created on first use.
    pub fn new(files: Arc<dyn Vfs>, folder: Option<PathBuf>) -> Option<Self> {
        let usual = || {
            let app = AppStrategyArgs { app_name: "dragonfly".to_owned(), ..Default::default() };
            let places = choose_app_strategy(app).ok()?;
            Some(places.state_dir().unwrap_or_else(|| places.data_dir()))
        };
        let folder = folder.or_else(usual)?;
        let versions = Versions::new(folder.join("versions"), VersionLimits::default());
        let bin_bounds = FolderLimits { least: 3, most: 100, bytes: 512 << 20 };
        Some(Self { files, folder, versions, bin_bounds })
    }

    /// Path of the folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Old versions of documents.
    pub fn versions(&self) -> &Versions {
        &self.versions
    }

    /// Path of the folder with the journals.
    pub fn journals(&self) -> PathBuf {
        self.folder.join("journals")
    }

    /// Path of the folder with discarded journals.
    pub fn bin(&self) -> PathBuf {
        self.folder.join("bin")
    }
}
