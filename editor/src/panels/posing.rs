//! How a panel or a gizmo changes the pose at the time shown: one place, whoever asks.

use super::state::State;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::adapter::{PendingAt, TakeVersions};
use dragonfly_document::edit::{BonePose, BoneRef, Edit, SetPending, SetPose, TakeRef};
use dragonfly_document::posing::{PoseDragState, poses_of_drag};

impl State {
    /// The take that is shown, as edits name it.
    pub fn take_ref(&self) -> Option<TakeRef> {
        self.take().and(self.playback.take).map(TakeRef::Index)
    }

    /// The edit that gives bones these poses (parent space) at the time shown: as keys with auto-key on, as pending poses
    /// with it off. `None` where the rest pose is shown, which is not edited, or no bone is named.
    pub fn pose_edit(&self, poses: Vec<BonePose>) -> Option<Edit> {
        let take = self.take_ref().filter(|_| !poses.is_empty())?;
        Some(self.edit_of(take, self.time(), poses))
    }

    /// The same at any time.
    pub(super) fn edit_of(&self, take: TakeRef, time: f32, poses: Vec<BonePose>) -> Edit {
        if self.settings.auto_key {
            Edit::SetPose(SetPose { take, time, poses, unstep: true })
        } else {
            Edit::SetPending(SetPending { take, time, poses })
        }
    }

    /// The poses with those of all that keeps pinned bones in place, where `hold` is of some.
    pub(super) fn with_pins(hold: &mut Option<PoseDragState>, poses: Vec<BonePose>) -> Vec<BonePose> {
        match hold {
            Some(hold) => poses_of_drag(hold, &poses, &[]),
            None => poses,
        }
    }

    /// The take that is shown, in its three forms.
    pub fn slot(&self) -> Option<&TakeVersions> {
        self.view.as_ref()?.slots.get(self.playback.take?).map(|slot| &**slot)
    }

    /// The times of the take shown at which poses are pending, seconds, ascending.
    pub fn pending_times(&self) -> impl Iterator<Item = f32> + '_ {
        self.slot().map_or(&[][..], TakeVersions::pending).iter().map(|at| at.time)
    }

    /// What is pending at the time shown.
    pub fn pending_here(&self) -> Option<&PendingAt> {
        self.slot()?.pending_at(self.time()).map(|at| &**at)
    }

    /// How many poses are pending: in the take shown, and in all takes.
    pub fn pending_poses(&self) -> (usize, usize) {
        let slots = self.view.as_ref().map_or(&[][..], |view| &view.slots);
        let all = slots.iter().map(|slot| slot.pending_poses()).sum();
        (self.slot().map_or(0, TakeVersions::pending_poses), all)
    }

    /// The selected bones that a change is for: those that are free. Where all of them are locked, all: then the change is
    /// refused, and the person told why.
    pub fn bones_to_pose(&self) -> impl Iterator<Item = BoneIndex> + '_ {
        let bones = self.selection.bones();
        let locked = |bone: &BoneIndex| self.keys.flags.locked(*bone);
        let none_free = self.selection_is_locked();
        bones.iter().copied().filter(move |bone| none_free || !locked(bone))
    }

    /// Are bones selected, and all of them locked?
    pub fn selection_is_locked(&self) -> bool {
        let (bones, flags) = (self.selection.bones(), &self.keys.flags);
        flags.any_locked() && !bones.is_empty() && bones.iter().all(|&bone| flags.locked(bone))
    }

    /// The bones of [`Self::bones_to_pose`] as edits name them; all (none named) where nothing is selected.
    pub(super) fn selected_refs(&self) -> Vec<BoneRef> {
        self.bones_to_pose().map(BoneRef::Index).collect()
    }

    /// All bones that are not locked, as edits name them; none where all are.
    pub(super) fn free_refs(&self) -> Vec<BoneRef> {
        let bones = self.loaded().map_or(0, |loaded| loaded.model.animation.skeleton.len()) as BoneIndex;
        (0..bones).filter(|&bone| !self.keys.flags.locked(bone)).map(BoneRef::Index).collect()
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
