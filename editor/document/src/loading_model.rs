//! A model that is loading, and what it is loaded for.

use super::scan::Decision;
use super::waiting_scene::SceneModelEdit;
use super::{Offer, Source};
use dragonfly_runtime::Job;

/// A model that is loading. The job is cancelled when the value is dropped.
pub(super) struct LoadingModel {
    pub(super) _job: Job,
    /// The number of the job.
    pub(super) ticket: u64,
    pub(super) source: Source,
    /// The unsaved work that is restored in it.
    pub(super) offer: Option<(Offer, Decision)>,
    /// Whether it is the open file, which gets the unsaved edits of the open document.
    pub(super) gets_edits: bool,
    /// The model of the open scene that it is.
    pub(super) of_scene: Option<SceneModelEdit>,
}
