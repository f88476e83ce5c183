//! Poses of the model that is open, computed when they are read.

use super::keys::BoneFlags;
use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::{AnimationData, BoneIndex, Take};
use dragonfly_document::{LoadedModel, View};
use std::sync::Arc;

/// Poses at the time shown, computed when they are read.
#[derive(Debug, Default)]
pub struct PoseCache {
    animation: Option<(Arc<LoadedModel>, u64, Animation)>,
    at: Option<(Option<usize>, f32, bool)>,
    /// Whether time passes. Then the keys are shown, without pending poses.
    running: bool,
    /// Version of the flags, and the bones that they show at rest.
    still: (u64, Vec<BoneIndex>),
}

impl PoseCache {
    /// Sets whether time passes, from the next update on.
    pub(super) fn set_running(&mut self, running: bool) {
        self.running = running;
    }

    /// Shows muted bones at rest, from the next update on.
    pub(super) fn hold_still(&mut self, flags: &BoneFlags, view: &View) {
        if self.still.0 == flags.version() {
            return;
        }
        let still = flags.still(view.loaded.model.animation.skeleton.len());
        if still != self.still.1 {
            self.animation = None;
            self.at = None;
        }
        self.still = (flags.version(), still);
    }

    /// Returns the takes of `view` as they are shown: muted bones rest.
    pub(super) fn takes(&self, view: &View) -> Arc<[Arc<Take>]> {
        view.takes_without(&self.still.1)
    }

    /// Computes the poses of `view` in `take` at `time`, with the pending poses there. For the model that was posed last only
    /// the takes are replaced.
    pub fn update(&mut self, view: &View, take: Option<usize>, time: f32) -> &Animation {
        let is_same = |(loaded, ..): &(Arc<LoadedModel>, u64, Animation)| Arc::ptr_eq(loaded, &view.loaded);
        if !self.animation.as_ref().is_some_and(is_same) {
            self.animation = None;
            self.at = None;
        }
        let still = &self.still.1;
        let data = || AnimationData { takes: view.takes_without(still).to_vec(), ..view.animation() };
        let (_, generation, animation) = self
            .animation
            .get_or_insert_with(|| (Arc::clone(&view.loaded), view.generation, Animation::new(data())));
        if *generation != view.generation {
            *generation = view.generation;
            self.at = None;
            if animation.data().takes.len() == view.takes.len() {
                for (index, take) in view.takes_without(still).iter().enumerate() {
                    animation.replace_take(index, Arc::clone(take));
                }
            } else {
                *animation = Animation::new(data());
            }
        }
        if self.at != Some((take, time, self.running)) {
            animation.to_root_bone_poses(take, time);
            if let Some(pending) = view.pending(take, time).filter(|_| !self.running) {
                animation.to_root_bone_poses_with(|poses| pending.put_on(poses));
            }
            self.at = Some((take, time, self.running));
        }
        animation
    }

    /// Returns the poses that were computed last, if there is a model.
    pub fn animation(&self) -> Option<&Animation> {
        self.animation.as_ref().map(|(_, _, animation)| animation)
    }
}
