//! A scene that waits while one of its models is edited.

use super::open::Open;
use super::scene_model_source::SceneModelSource;
use super::view::WaitingSceneView;
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

    /// Returns it as it is shown.
    pub(super) fn view(&self) -> WaitingSceneView {
        let title = self.open.file.title.as_str().into();
        WaitingSceneView { title, saved: !self.open.edited.has_unsaved() }
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
