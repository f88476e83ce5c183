//! Options of the editor at its start.

use dragonfly_document::edit::Edit;
use dragonfly_document::{FaultInjection, Source};
use std::path::PathBuf;

/// Options of the editor at its start.
#[derive(Clone, Debug)]
pub struct Options {
    /// Document to open first.
    pub source: Source,
    /// Number of further files on the command line. Only one document is open at a time; a message reports the others.
    pub passed_over: usize,
    /// Folder of the settings; the system's usual folder when `None`.
    pub settings_folder: Option<PathBuf>,
    /// Folder of the journals; by default next to the settings if those have a folder of their own, otherwise the
    /// system's usual folder.
    pub autosave_folder: Option<PathBuf>,
    /// Edits applied once the first model is open, as if the user made them.
    pub edits: Vec<Edit>,
    /// Faults that a test injects.
    pub faults: FaultInjection,
}

impl Default for Options {
    /// Opens the built-in model.
    fn default() -> Self {
        Self {
            source: Source::BuiltIn,
            passed_over: 0,
            settings_folder: None,
            autosave_folder: None,
            edits: Vec::new(),
            faults: FaultInjection::default(),
        }
    }
}
