//! Poses of what is open, computed when somebody reads them.

use crate::document::View;
use dragonfly_anim::animation::Animation;
use std::sync::Arc;

/// Poses at the time shown, computed when somebody reads them.
#[derive(Debug, Default)]
pub struct Posed {
    animation: Option<(u64, Animation)>,
    at: Option<(Option<usize>, f32)>,
}

impl Posed {
    /// The poses of `view` in `take` at `time`.
    pub fn update(&mut self, view: &View, take: Option<usize>, time: f32) -> &Animation {
        let skeleton = &view.loaded.model.animation.skeleton;
        let fits = |animation: &Animation| {
            let data = animation.data();
            Arc::ptr_eq(&data.skeleton, skeleton) && data.takes.len() == view.takes.len()
        };
        self.animation = self.animation.take().filter(|(_, animation)| fits(animation));
        let (generation, animation) =
            self.animation.get_or_insert_with(|| (view.generation, Animation::new(view.animation())));
        if *generation != view.generation {
            // What was edited, and nothing else: a drag brings a view with every move of the mouse.
            for (index, take) in view.takes.iter().enumerate() {
                animation.replace_take(index, Arc::clone(take));
            }
            *generation = view.generation;
            self.at = None;
        }
        if self.at != Some((take, time)) {
            animation.to_root_bone_poses(take, time);
            self.at = Some((take, time));
        }
        animation
    }

    /// The poses computed last, if there is a model.
    pub fn animation(&self) -> Option<&Animation> {
        self.animation.as_ref().map(|(_, animation)| animation)
    }
}
