//! Distance by which a drag of a slider moves the bones.

use crate::panels::context::PanelContext;
use crate::panels::count_text::grouped;
use dragonfly_anim::compare::compare_takes;
use dragonfly_anim::data::Take;
use std::sync::Arc;

/// The largest difference between a take before a drag and the take as it is shown, computed when that changes.
#[derive(Debug, Default)]
pub(super) struct DragError {
    shown: Option<Arc<Take>>,
    text: String,
}

/// Largest number of keys times bones of a take that is compared in a frame.
const MOST: usize = 1_000_000;

impl DragError {
    /// Returns the number of keys and the largest difference, with its bone and its frame; `None` where a take is too long to be compared
    /// while it is dragged.
    pub(super) fn text(&mut self, before: &Arc<Take>, context: &PanelContext<'_>) -> Option<String> {
        let (now, view) = (context.shared_take()?, context.view?);
        let skeleton = &view.loaded.model.animation.skeleton;
        if before.keys().saturating_mul(skeleton.len()) > MOST {
            return None;
        }
        if self.shown.as_ref().is_none_or(|shown| !Arc::ptr_eq(shown, now)) {
            let difference = compare_takes((skeleton, before), (skeleton, now));
            let (far, turned) = (difference.farthest()?, difference.most_turned()?);
            let frame = |time: f32| (f64::from(time) * f64::from(context.frame_rate)).round();
            self.text = format!(
                "{} → {} keys · {:.2} mm {} frame {} · {:.2}° {} frame {}",
                grouped(before.keys()),
                grouped(now.keys()),
                far.distance.value * 1000.0,
                context.bone_name(far.first),
                frame(far.distance.time),
                turned.angle.value.to_degrees(),
                context.bone_name(turned.first),
                frame(turned.angle.time),
            );
            self.shown = Some(Arc::clone(now));
        }
        Some(self.text.clone())
    }
}
