//! The bones that a click means, whatever of the model is shown.

use super::{pick_all, pick_met};
use crate::message::BoneLook;
use crate::scene::Scene;
use dragonfly_anim::data::BoneIndex;
use std::sync::Arc;

impl Scene {
    /// Returns the bones at a pixel of the window in the pose prepared last, nearest first: the bones drawn there; if
    /// there are none, or bones are not shown, those with the most influence on the skin there; and then those that
    /// the pixel just misses.
    pub fn pick_all(&mut self, position: [f32; 2]) -> Vec<BoneIndex> {
        let mut bones = Vec::new();
        let hidden = Arc::clone(&self.look.hidden);
        // Lines have no area, so they are picked by distance.
        match (self.look.skeleton, self.look.bone_look) {
            (true, BoneLook::Lines) => pick_all(self, position, &hidden, &mut bones),
            (true, _) => pick_met(self, position, &hidden, &mut bones),
            (false, _) => {}
        }
        if bones.is_empty()
            && self.look.surface
            && let Some((ray, _)) = self.ray(position)
            && let Some((model, skin)) = self.skin_picker()
        {
            skin.pick(model, &ray, &hidden, &mut bones);
        }
        if bones.is_empty() {
            pick_all(self, position, &hidden, &mut bones);
        }
        bones
    }
}
