//! How a panel or a gizmo changes the pose at the time shown: one place, whoever asks.

use super::state::State;
use crate::document::adapter::{PendingAt, Slot};
use crate::document::edit::{BonePose, BoneRef, Edit, TakeRef};
use dragonfly_anim::data::BoneIndex;

impl State {
    /// The take that is shown, as edits name it.
    pub fn take_ref(&self) -> Option<TakeRef> {
        self.take().and(self.playback.take).map(TakeRef::Index)
    }

    /// The edit that gives bones these poses (parent space) at the time shown: as keys with auto-key on, as pending poses
    /// with it off. `None` where the rest pose is shown, which is not edited, or no bone is named.
    pub fn pose_edit(&self, poses: Vec<BonePose>) -> Option<Edit> {
        let take = self.take_ref().filter(|_| !poses.is_empty())?;
        let time = self.time();
        Some(if self.settings.auto_key {
            Edit::Set { take, time, poses }
        } else {
            Edit::Pend { take, time, poses }
        })
    }

    /// The take that is shown, in its three forms.
    pub fn slot(&self) -> Option<&Slot> {
        self.view.as_ref()?.slots.get(self.playback.take?).map(|slot| &**slot)
    }

    /// The times of the take shown at which poses are pending, seconds, ascending.
    pub fn pending_times(&self) -> impl Iterator<Item = f32> + '_ {
        self.slot().map_or(&[][..], Slot::pending).iter().map(|at| at.time)
    }

    /// What is pending at the time shown.
    pub fn pending_here(&self) -> Option<&PendingAt> {
        self.slot()?.pending_at(self.time()).map(|at| &**at)
    }

    /// How many poses are pending: in the take shown, and in all takes.
    pub fn pending_poses(&self) -> (usize, usize) {
        let slots = self.view.as_ref().map_or(&[][..], |view| &view.slots);
        let all = slots.iter().map(|slot| slot.pending_poses()).sum();
        (self.slot().map_or(0, Slot::pending_poses), all)
    }

    /// The selected bones as edits name them; all (none named) where nothing is selected.
    pub(super) fn selected_refs(&self) -> Vec<BoneRef> {
        self.selection.bones().iter().map(|&bone| BoneRef::Index(bone)).collect()
    }

    /// The selected bones, or all of them where nothing is selected.
    pub(super) fn selected_or_all(&self) -> Vec<BoneIndex> {
        if !self.selection.bones().is_empty() {
            return self.selection.bones().to_vec();
        }
        let bones = self.loaded().map_or(0, |loaded| loaded.model.animation.skeleton.len());
        (0..bones as BoneIndex).collect()
    }
}
