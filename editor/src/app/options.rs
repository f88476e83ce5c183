//! How the editor is started.

use crate::document::Source;
use crate::document::edit::Edit;
use std::path::PathBuf;

/// How the editor is started.
#[derive(Clone, Debug)]
pub struct Options {
    /// What to open first.
    pub source: Source,
    /// How many more files were asked for: one is open at a time, and the person is told.
    pub passed_over: usize,
    /// While time runs, loses the graphics device after every so many drawn frames, to show that nothing is lost with it.
    pub lose_device_every: Option<u32>,
    /// Draws on however often the device is lost, where the editor would pause: for tests of just that.
    pub never_pause: bool,
    /// Where settings are kept; the system's usual place when it is not given.
    pub settings_folder: Option<PathBuf>,
    /// Where unsaved work is recorded; beside settings that have a folder of their own, else in the system's usual place.
    pub autosave_folder: Option<PathBuf>,
    /// Edits done once the first model is there, as if a person did them: for tests of what becomes of them.
    pub edits: Vec<Edit>,
    /// Lets the document fail at this change, to show that nothing is lost with it.
    pub fail_at: Option<u32>,
}

impl Default for Options {
    /// The built-in model.
    fn default() -> Self {
        Self {
            source: Source::BuiltIn,
            passed_over: 0,
            lose_device_every: None,
            never_pause: false,
            settings_folder: None,
            autosave_folder: None,
            edits: Vec::new(),
            fail_at: None,
        }
    }
}
