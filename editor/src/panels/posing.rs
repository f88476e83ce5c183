//! How a panel or a gizmo changes the pose at the time shown: one place, whoever asks.

use super::state::State;
use crate::document::edit::{BonePose, Edit, TakeRef};

impl State {
    /// The take that is shown, as edits name it.
    pub fn take_ref(&self) -> Option<TakeRef> {
        self.take().and(self.playback.take).map(TakeRef::Index)
    }

    /// The edit that gives bones these poses (parent space) at the time shown; `None` where the rest pose is shown, which
    /// is not edited, or no bone is named.
    pub fn pose_edit(&self, poses: Vec<BonePose>) -> Option<Edit> {
        let take = self.take_ref().filter(|_| !poses.is_empty())?;
        Some(Edit::Set { take, time: self.time(), poses })
    }
}
