//! Where the eye goes to see the model, or a part of it.

use super::state::State;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::evaluator::Evaluator;
use glam::Vec3;
use std::sync::Arc;

impl State {
    /// Puts the model into the middle of the picture, as it stands in its file.
    pub(super) fn frame_model(&mut self) {
        let aspect = self.aspect();
        if let Some(loaded) = self.loaded() {
            let (min, max) = (loaded.bounds.min, loaded.bounds.max);
            self.camera.frame_box(min, max, aspect);
        }
    }

    /// Puts everything into the middle of the picture, as it stands now: a run is longer than the fox that stands.
    pub fn frame_shown(&mut self) {
        let Some(view) = self.view.clone() else { return };
        let time = self.playback.time_at(self.now);
        let poses = self.posed.update(&view, self.playback.take, time).poses();
        let mut evaluator = Evaluator::new(Arc::clone(&view.loaded.model));
        evaluator.pose_with(None, 0.0, |own| {
            if own.len() == poses.len() {
                own.copy_from_slice(poses);
            }
        });
        let (bounds, aspect) = (evaluator.bounds(), self.aspect());
        self.camera.frame_box(bounds.min, bounds.max, aspect);
    }

    /// Puts the selected bone and its children into the middle, or everything when none is selected.
    pub fn frame_selected(&mut self) {
        let (Some(view), Some(selected)) = (self.view.clone(), self.selected()) else {
            return self.frame_shown();
        };
        let skeleton = &view.loaded.model.animation.skeleton;
        let time = self.playback.time_at(self.now);
        let to_root = self.posed.update(&view, self.playback.take, time).to_root();
        let at = |bone: BoneIndex| to_root.get(bone as usize).map(|matrix| matrix.w_axis.truncate());
        let Some(origin) = at(selected).filter(|origin| origin.is_finite()) else { return };
        let (mut min, mut max) = (origin, origin);
        for point in skeleton.children(Some(selected)).filter_map(at).filter(|point| point.is_finite()) {
            min = min.min(point);
            max = max.max(point);
        }
        // A bone without children has no size: a tenth of the model is seen around it.
        let room = Vec3::splat((view.loaded.bounds.sphere.radius * 0.1).max(1e-4));
        let aspect = self.aspect();
        self.camera.frame_box(min - room, max + room, aspect);
    }
}
