//! Ghosts: the skeleton some frames or keys before and after, fainter the further away.

use super::{Frame, GraphicComponent};
use crate::gizmo::{GizmoRole, GizmoShape};
use crate::message::Appearance;
use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::AnimationData;
use std::sync::Arc;

/// See the module.
#[derive(Default)]
pub(super) struct GhostsGraphic {
    times: Vec<(f32, i32)>,
    /// Are skins shown in their place?
    skins: bool,
    /// Of the model that is shown.
    animation: Option<Animation>,
}

/// The takes as they are shown now.
fn follow<'a>(animation: &'a mut Option<Animation>, frame: &Frame<'_>) -> &'a mut Animation {
    let skeleton = &frame.model.loaded().model.animation.skeleton;
    let takes = frame.model.takes();
    let fits = |animation: &Animation| {
        let data = animation.data();
        Arc::ptr_eq(&data.skeleton, skeleton) && data.takes.len() == takes.len()
    };
    *animation = animation.take().filter(fits);
    let animation = animation.get_or_insert_with(|| {
        Animation::new(AnimationData { skeleton: Arc::clone(skeleton), takes: takes.to_vec() })
    });
    for (index, take) in takes.iter().enumerate() {
        if !Arc::ptr_eq(take, &animation.data().takes[index]) {
            animation.replace_take(index, Arc::clone(take));
        }
    }
    animation
}

impl GraphicComponent for GhostsGraphic {
    fn receive(&mut self, appearance: &Appearance) -> bool {
        match appearance {
            Appearance::Ghosts(times) => self.times.clone_from(times),
            Appearance::GhostSkins(on) => self.skins = *on,
            _ => return false,
        }
        true
    }

    fn present(&mut self, frame: &Frame<'_>, shape: &mut GizmoShape) {
        // A model without a skin has its skeleton to show.
        if self.times.is_empty() || (self.skins && !frame.model.items().is_empty()) {
            return;
        }
        let take = frame.model.at().0;
        let most = self.times.iter().map(|(_, place)| place.unsigned_abs()).max().unwrap_or(1) as f32;
        let animation = follow(&mut self.animation, frame);
        let skeleton = &frame.model.loaded().model.animation.skeleton;
        for &(time, place) in &self.times {
            let to_root = animation.to_root_bone_poses(take, time);
            let role = if place < 0 { GizmoRole::Past } else { GizmoRole::Future };
            let opacity = 0.6 - 0.45 * (place.unsigned_abs() as f32 - 1.0) / most;
            for (index, bone) in skeleton.bones.iter().enumerate() {
                let Some(parent) = bone.parent else { continue };
                if frame.look.hidden.is_hidden(parent) || !frame.model.shape().is_joint(parent) {
                    continue;
                }
                let [from, to] = [parent as usize, index].map(|bone| to_root[bone].w_axis.truncate());
                if from.is_finite() && to.is_finite() {
                    shape.add_line(from, to, role, opacity);
                }
            }
        }
    }
}
