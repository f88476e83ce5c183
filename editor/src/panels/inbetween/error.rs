//! Distance by which a drag of a slider moves the bones.

use crate::panels::context::PanelContext;
use crate::panels::count_text::grouped;
use crate::panels::difference_text::difference_text;
use dragonfly_anim::data::Take;
use std::sync::Arc;

/// The largest difference between a take before a drag and the take as it is shown, computed when that changes.
#[derive(Debug, Default)]
pub(super) struct DragError {
    shown: Option<Arc<Take>>,
    text: String,
}

impl DragError {
    /// Returns the number of keys and the largest difference, with its bone and its frame; `None` where a take is too long to be compared
    /// while it is dragged.
    pub(super) fn text(&mut self, before: &Arc<Take>, context: &PanelContext<'_>) -> Option<String> {
        let (now, view) = (context.shared_take()?, context.view?);
        if self.shown.as_ref().is_none_or(|shown| !Arc::ptr_eq(shown, now)) {
            let skeleton = &view.loaded.model.animation.skeleton;
            let difference = difference_text((before, now), skeleton, context.scale())?;
            self.text = format!("{} → {} keys · {difference}", grouped(before.keys()), grouped(now.keys()));
            self.shown = Some(Arc::clone(now));
        }
        Some(self.text.clone())
    }
}
