//! A scene that waits while one of its models is edited.

use super::open::Open;
use super::scene_model_source::SceneModelSource;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A model of the open scene that is to be edited.
#[derive(Clone, Debug)]
pub(super) struct SceneModelEdit {
    /// The name by which the script means it.
    pub(super) name: String,
    /// Its origin.
    pub(super) source: SceneModelSource,
    /// Path of its file.
    pub(super) path: PathBuf,
}

/// Edits of a model that its project keeps, and that were made for another file than the one that is there now. They may be in it already,
/// so that they are not applied until the user decides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutdatedEdits {
    /// The name by which the script means the model.
    pub model: String,
    /// Name of its file.
    pub title: String,
    /// Hash of the file as it is now.
    pub hash: u64,
}

/// The decision of the user about edits that were made for another file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutdatedEditsChoice {
    /// They are applied to the file as it is now.
    Apply,
    /// The project does not keep them any more.
    Remove,
}

/// A scene that waits while one of its models is edited.
pub(super) struct WaitingScene {
    pub(super) open: Open,
    pub(super) model: SceneModelEdit,
}

impl WaitingScene {
    /// Returns whether the scene has work that is not saved.
    pub(super) fn has_unsaved_work(&self) -> bool {
        self.open.has_unsaved_work()
    }

    /// Flushes its journal where that is due. Returns the time at which there is something to do again.
    pub(super) fn keep(&mut self, now: Instant) -> Option<Instant> {
        self.open.keep(now);
        self.open.journal_writer.next_due()
    }

    /// Returns the path of its journal.
    pub(super) fn journal(&self) -> Option<&Path> {
        self.open.journal_writer.path()
    }

    /// Returns the document of the scene.
    pub(super) fn into_open(self) -> Open {
        self.open
    }
}
