//! The order to import takes of files.

use super::bone_map::BoneMap;
use std::path::PathBuf;

/// The files whose takes are imported onto the open model, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct ClipOrder {
    /// The files.
    pub files: Vec<PathBuf>,
    /// The map of bones; guessed for each file where absent.
    pub map: Option<BoneMap>,
    /// Whether feet stay where they touch the ground.
    pub contacts: bool,
}

impl ClipOrder {
    /// Returns the order to import files with guessed maps.
    pub fn of(files: Vec<PathBuf>) -> Self {
        Self { files, map: None, contacts: true }
    }
}
