//! Ghosts: the skeleton some frames or keys before and after the present time, fainter with distance.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::gizmo::{GizmoRole, GizmoShape};
use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::AnimationData;
use std::sync::Arc;

/// The ghosts that are shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GhostAppearance {
    /// Times in the take, seconds, and the distance of each from the present; negative before it.
    pub times: Vec<(f32, i32)>,
    /// Whether ghosts are drawn as skins instead of skeletons.
    pub skins: bool,
}

impl Appearance for GhostAppearance {}

/// Draws ghosts as skeletons.
#[derive(Default)]
pub(super) struct GhostsGraphic {
    /// The takes of the model that is shown.
    animation: Option<Animation>,
}

/// Updates `animation` to the takes that are shown now.
fn follow<'a>(animation: &'a mut Option<Animation>, frame: &ControlFrame<'_>) -> &'a mut Animation {
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
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        let Some(ghosts) = frame.appearances.get::<GhostAppearance>() else { return };
        // A model without a skin shows its skeleton in any case.
        if ghosts.times.is_empty() || (ghosts.skins && !frame.model.items().is_empty()) {
            return;
        }
        let take = frame.model.at().0;
        let most = ghosts.times.iter().map(|(_, place)| place.unsigned_abs()).max().unwrap_or(1) as f32;
        let animation = follow(&mut self.animation, frame);
        let skeleton = &frame.model.loaded().model.animation.skeleton;
        for &(time, place) in &ghosts.times {
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
