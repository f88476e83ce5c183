//! Files and folders that the user chooses with the system's dialog, apart from models.

use super::request::Request;
use std::path::PathBuf;

/// The purpose of a file or folder that the user chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileChoice {
    /// The folder of the pose library.
    PoseFolder,
}

impl FileChoice {
    /// Returns the title of the dialog.
    pub fn title(self) -> &'static str {
        match self {
            Self::PoseFolder => "Choose the folder of poses",
        }
    }

    /// Returns whether a folder is chosen.
    pub fn is_folder(self) -> bool {
        match self {
            Self::PoseFolder => true,
        }
    }

    /// Returns the message for a desktop without such a dialog.
    pub fn no_dialog(self) -> &'static str {
        match self {
            Self::PoseFolder => "This desktop has no dialog for choosing folders; type the path instead",
        }
    }

    /// Returns the request that uses what was chosen.
    pub fn request(self, path: PathBuf) -> Request {
        match self {
            Self::PoseFolder => Request::PoseFolder(path),
        }
    }
}
