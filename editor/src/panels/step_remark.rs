//! The remark in the status line about the newest step, which is written again when a drag that belongs to the step has ended.

use super::change_summary::describe_change;
use super::difference_text::ShownScale;
use super::status::Status;
use dragonfly_document::View;

/// The state before the newest step, and the remark about it.
#[derive(Clone, Debug, Default)]
pub(super) struct StepRemark {
    /// The view before the step, and the number of messages up to the remark.
    noted: Option<(View, u64)>,
}

impl StepRemark {
    /// Adds a remark about the change from `before`.
    pub(super) fn say(&mut self, before: &View, text: String, status: &mut Status) {
        self.noted = status.remark(text).then(|| (before.clone(), status.said()));
    }

    /// Writes the remark again where the step does something else by now, as after a drag; does nothing once another message
    /// followed.
    pub(super) fn update(&mut self, now: &View, scale: ShownScale, status: &mut Status) {
        let Some((before, said)) = self.noted.as_mut().filter(|(_, said)| *said == status.said()) else {
            return;
        };
        if let Some(text) = describe_change(before, now, scale) {
            status.replace_last(text);
            *said = status.said();
        }
    }
}
