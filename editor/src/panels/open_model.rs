//! The model that is open, as the document sent it last, and the model that is being loaded.

use super::digest::{Digest, ShownKeys};
use super::echo::Echo;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_document::adapter::TakeVersions;
use dragonfly_document::{Change, LoadedModel, Progress, View};
use std::sync::Arc;

/// A model that is being loaded.
#[derive(Clone, Debug, PartialEq)]
pub struct Loading {
    /// Title of the model.
    pub title: String,
    /// Progress of the load.
    pub progress: Progress,
}

/// The newest view of the document, what is computed from it, and the load in progress.
#[derive(Debug, Default)]
pub struct OpenModel {
    view: Option<View>,
    digest: Digest,
    loading: Option<Loading>,
    /// Number of files that were opened together with the model that is being loaded, and that stay closed.
    passed_over: usize,
}

impl OpenModel {
    /// Returns the newest view; `None` before the first model is open.
    pub fn view(&self) -> Option<&View> {
        self.view.as_ref()
    }

    /// Replaces the view and returns the one before it.
    pub(super) fn replace(&mut self, view: View) -> Option<View> {
        self.view.replace(view)
    }

    /// Returns what to show when the document sends `view`: the view, with the edits that it does not contain yet.
    pub(super) fn receive(&mut self, view: View, echo: &mut Echo) -> View {
        echo.receive(view, &mut self.view)
    }

    /// Assigns a number to a change that is sent to the document, and shows its result at once if that is quick.
    pub(super) fn send(&mut self, change: &Change, echo: &mut Echo) -> u64 {
        echo.send(change, &mut self.view)
    }

    /// Returns whether `view` is of another model than the one that is open.
    pub(super) fn is_replaced_by(&self, view: &View) -> bool {
        self.view.as_ref().is_none_or(|old| !Arc::ptr_eq(&old.opened, &view.opened))
    }

    /// Returns rows, totals and key times computed from the view.
    pub fn digest(&self) -> &Digest {
        &self.digest
    }

    /// Computes the digest for the keys that are shown and the active bone.
    pub(super) fn update_digest(&mut self, keys: ShownKeys, bone: Option<BoneIndex>) {
        self.digest.update(self.view.as_ref(), keys, bone);
    }

    /// Returns the model that is open.
    pub fn loaded(&self) -> Option<&LoadedModel> {
        self.view.as_ref().map(|view| &*view.loaded)
    }

    /// Returns the number of bones of the model; 0 if none is open.
    pub(super) fn bones(&self) -> usize {
        self.loaded().map_or(0, |loaded| loaded.model.animation.skeleton.len())
    }

    /// Returns the takes in the order of the list.
    pub(super) fn takes(&self) -> &[Arc<Take>] {
        self.view.as_ref().map_or(&[], |view| &view.takes)
    }

    /// Returns the takes with their originals and pending poses.
    pub(super) fn slots(&self) -> &[Arc<TakeVersions>] {
        self.view.as_ref().map_or(&[], |view| &view.slots)
    }

    /// Returns whether the document has a file of its own.
    pub(super) fn has_file(&self) -> bool {
        self.view.as_ref().is_some_and(|view| view.file.path.is_some())
    }

    /// Returns the load in progress.
    pub fn loading(&self) -> Option<&Loading> {
        self.loading.as_ref()
    }

    /// Sets the load in progress; `None` when it ended.
    pub fn set_loading(&mut self, loading: Option<Loading>) {
        self.loading = loading;
    }

    /// Notes the number of files that stay closed because one model is open at a time.
    pub fn pass_over(&mut self, files: usize) {
        self.passed_over = files;
    }

    /// Returns the number of files that stay closed, and forgets it.
    pub fn take_passed_over(&mut self) -> usize {
        std::mem::take(&mut self.passed_over)
    }
}
