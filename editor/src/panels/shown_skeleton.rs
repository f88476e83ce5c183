//! The skeleton to which the own state of a panel or dialog belongs.

use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::{LoadedModel, View};
use std::sync::Arc;

/// The change of the skeleton since the panel was last drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SkeletonChange {
    /// Nothing.
    Same,
    /// It has other root bones: bones have other indices.
    Shifted(BoneShift),
    /// Another model is open, or none.
    Replaced,
}

/// The skeleton that a panel showed last.
#[derive(Debug, Default)]
pub(super) struct ShownSkeleton {
    /// The model as it was opened, and with its present skeleton.
    of: Option<[Arc<LoadedModel>; 2]>,
}

impl ShownSkeleton {
    /// Goes to the skeleton of a view, and returns how it changed.
    pub(super) fn follow(&mut self, view: Option<&View>) -> SkeletonChange {
        let now = view.map(|view| [&view.opened, &view.loaded]);
        let change = match (&self.of, view) {
            (None, None) => SkeletonChange::Same,
            (Some([opened, loaded]), Some(view)) => match view.bones_since(opened, loaded) {
                Some(shift) if shift.is_identity() => SkeletonChange::Same,
                Some(shift) => SkeletonChange::Shifted(shift),
                None => SkeletonChange::Replaced,
            },
            (None, Some(_)) | (Some(_), None) => SkeletonChange::Replaced,
        };
        if self.of.as_ref().map(|of| of.each_ref().map(Arc::as_ptr)) != now.map(|now| now.map(Arc::as_ptr)) {
            self.of = now.map(|now| now.map(Arc::clone));
        }
        change
    }
}
