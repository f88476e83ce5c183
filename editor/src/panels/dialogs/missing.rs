//! The question where a missing file of the scene is, with a field for the path, for desktops without a file dialog.

use super::ask::{Ask, PathPart};
use super::kind::QuestionKind;
use crate::panels::request::Request;
use dragonfly_document::{MissingFile, View};

/// Asks for the path of a file of the scene that is missing.
#[derive(Clone, Debug, PartialEq)]
pub struct MissingQuestion {
    /// The file.
    pub missing: MissingFile,
}

impl QuestionKind for MissingQuestion {
    fn name(&self) -> &'static str {
        "asked where a file of the scene is"
    }

    /// Returns the path where the file is missing.
    fn proposal(&self, view: Option<&View>) -> String {
        let folder = view.and_then(|view| view.file.path.as_deref()?.parent());
        let path = folder.map(|folder| folder.join(&self.missing.file));
        path.map_or_else(|| self.missing.file.clone(), |path| path.display().to_string())
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(520.0);
        ask.title(&format!("Where is {} now?", self.missing.file));
        let find = ("Find", "Use this file, and others that are missing and next to it");
        let cancel = ("Cancel", "Leave the file missing");
        if let Some(path) = ask.path("Path of the file", find, cancel, PathPart::Name) {
            ask.requests.push(Request::FileFound(path));
        }
    }
}
