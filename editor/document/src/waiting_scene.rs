//! A scene that waits while one of its models is edited.

use super::open::Open;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// A model of the open scene that is to be edited.
#[derive(Clone, Debug)]
pub(super) struct SceneModelEdit {
    pub(super) name: String,
    /// Its file, relative to the folder of the scene.
    pub(super) file: String,
    /// The edits that the project keeps, one a line.
    pub(super) edits: Option<Arc<str>>,
}

/// A scene that waits while one of its models is edited.
pub(super) struct WaitingScene {
    pub(super) open: Open,
    pub(super) model: SceneModelEdit,
}

impl WaitingScene {
    /// Returns whether the scene has work that is not saved.
    pub(super) fn has_unsaved_work(&self) -> bool {
        !self.open.edited.is_saved()
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
