//! Settings and positions of panels on the disk. A failure to store them is reported and stops nothing.

use etcetera::{AppStrategy, AppStrategyArgs, choose_app_strategy};
use std::path::PathBuf;

/// A folder with small text files.
#[derive(Clone, Debug, Default)]
pub struct Store {
    folder: Option<PathBuf>,
}

/// File name of the settings.
pub const SETTINGS: &str = "settings.json";
/// File name of the positions of panels.
pub const LAYOUT: &str = "layout.json";
/// A file larger than this was not written by this program.
const LARGEST: u64 = 1 << 20;

impl Store {
    /// Uses `folder`, or the system's folder for settings; nothing is stored where there is neither.
    pub fn new(folder: Option<PathBuf>) -> Self {
        let usual = || {
            let app = AppStrategyArgs { app_name: "dragonfly".to_owned(), ..Default::default() };
            Some(choose_app_strategy(app).ok()?.config_dir())
        };
        Self { folder: folder.or_else(usual) }
    }

    /// Returns the folder of the pose library that is used if none was chosen.
    pub fn poses(&self) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join("poses"))
    }

    /// Returns the text of a file; empty when there is none or it cannot be read.
    pub fn read(&self, name: &str) -> String {
        let Some(folder) = &self.folder else { return String::new() };
        let path = folder.join(name);
        let small = path.metadata().is_ok_and(|data| data.is_file() && data.len() <= LARGEST);
        if small { std::fs::read_to_string(path).unwrap_or_default() } else { String::new() }
    }

    /// Replaces a file in one step, so that a crash leaves the old or the new one.
    pub fn write(&self, name: &str, text: &str) -> std::io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
        dragonfly_store::replace(&path, text.as_bytes()).map_err(std::io::Error::other)?;
        Ok(())
    }
}
