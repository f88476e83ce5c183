//! Poses and pending poses at the time shown, and the edits that change them.

use super::PanelContext;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::adapter::{PendingAt, TakeVersions};
use dragonfly_document::edit::{AddKeys, BonePose, BoneRef, Edit, NewKey, SetPending, SetPose, TakeRef};
use dragonfly_document::posing::{PoseDragState, poses_of_drag};

impl<'a> PanelContext<'a> {
    /// Returns the edit that sets these poses (parent space) at the time shown: as keys with auto-key on, as pending poses
    /// with it off. In a scope of many keys it offsets all of these, with auto-key on or off. `None` if the rest pose is
    /// shown, which is not edited, no bone is named, or the scope has no keys there.
    pub fn pose_edit(&self, poses: Vec<BonePose>) -> Option<Edit> {
        let take = self.take_ref().filter(|_| !poses.is_empty() && self.scope_refusal().is_none())?;
        Some(self.edit_of(take, self.time(), poses))
    }

    /// Returns the edit that sets these poses (parent space) at the time shown and nowhere else, whatever the scope of
    /// edits is: for resets.
    pub(in crate::panels) fn pose_edit_here(&self, poses: Vec<BonePose>) -> Option<Edit> {
        let take = self.take_ref().filter(|_| !poses.is_empty())?;
        Some(self.edit_of_frame(take, self.time(), poses))
    }

    /// Returns the edit that sets these poses (parent space) at any time, in the scope of edits.
    pub(in crate::panels) fn edit_of(&self, take: TakeRef, time: f32, poses: Vec<BonePose>) -> Edit {
        match self.offset_edit(take.clone(), time, poses) {
            Ok(edit) => edit,
            Err(poses) => self.edit_of_frame(take, time, poses),
        }
    }

    /// Returns the edit that sets these poses at a time and nowhere else.
    fn edit_of_frame(&self, take: TakeRef, time: f32, poses: Vec<BonePose>) -> Edit {
        if self.settings.auto_key {
            Edit::SetPose(SetPose { take, time, poses, unstep: true })
        } else {
            Edit::SetPending(SetPending { take, time, poses })
        }
    }

    /// Returns the edit that adds keys at the time shown that leave the motion as it is: of the selected bones; with none
    /// selected in all channels that have keys, except those of locked bones.
    pub(in crate::panels) fn key_edit(&self) -> Option<Edit> {
        let all = self.selection.bones().is_empty();
        let bones =
            if all && self.keys.flags().any_locked() { self.free_refs() } else { self.selected_refs() };
        let (properties, value) = (Vec::new(), NewKey::Current);
        let (take, time) = (self.take_ref()?, self.time());
        let keyed_only = all && !bones.is_empty();
        Some(Edit::AddKeys(AddKeys { take, time, bones, properties, value, keyed_only }))
    }

    /// Returns the times of the take shown at which poses are pending, seconds, ascending.
    pub fn pending_times(&self) -> impl Iterator<Item = f32> + 'a {
        self.slot().map_or(&[][..], TakeVersions::pending).iter().map(|at| at.time)
    }

    /// Returns the poses that are pending at the time shown.
    pub fn pending_here(&self) -> Option<&'a PendingAt> {
        self.slot()?.pending_at(self.time()).map(|at| &**at)
    }

    /// Returns the number of pending poses: in the take shown, and in all takes.
    pub fn pending_poses(&self) -> (usize, usize) {
        let slots = self.view.map_or(&[][..], |view| &view.slots);
        let all = slots.iter().map(|slot| slot.pending_poses()).sum();
        (self.slot().map_or(0, TakeVersions::pending_poses), all)
    }

    /// Returns the selected bones that a change is for: those that are not locked. If all of them are locked, returns
    /// all, so that the change is refused with a message.
    pub fn bones_to_pose(&self) -> impl Iterator<Item = BoneIndex> + use<'a> {
        let none_free = self.selection_is_locked();
        let (bones, flags) = (self.selection.bones(), self.keys.flags());
        bones.iter().copied().filter(move |bone| none_free || !flags.locked(*bone))
    }

    /// Returns whether bones are selected and all of them are locked.
    pub fn selection_is_locked(&self) -> bool {
        let (bones, flags) = (self.selection.bones(), self.keys.flags());
        flags.any_locked() && !bones.is_empty() && bones.iter().all(|&bone| flags.locked(bone))
    }

    /// Returns the bones of [`Self::bones_to_pose`] as edits name them; an empty list, which means all bones, if none is
    /// selected.
    pub(in crate::panels) fn selected_refs(&self) -> Vec<BoneRef> {
        self.bones_to_pose().map(BoneRef::Index).collect()
    }

    /// Returns the bones that are not locked, as edits name them.
    pub(in crate::panels) fn free_refs(&self) -> Vec<BoneRef> {
        let bones = 0..self.bone_count() as BoneIndex;
        bones.filter(|&bone| !self.keys.flags().locked(bone)).map(BoneRef::Index).collect()
    }

    /// Returns the selected bones, or all bones if none is selected.
    pub(in crate::panels) fn selected_or_all(&self) -> Vec<BoneIndex> {
        if !self.selection.bones().is_empty() {
            return self.selection.bones().to_vec();
        }
        (0..self.bone_count() as BoneIndex).collect()
    }
}

impl PanelContext<'_> {
    /// Returns the poses together with those that keep pinned bones in place, if `hold` is given.
    pub(in crate::panels) fn with_pins(
        hold: &mut Option<PoseDragState>,
        poses: Vec<BonePose>,
    ) -> Vec<BonePose> {
        match hold {
            Some(hold) => poses_of_drag(hold, &poses, &[]),
            None => poses,
        }
    }
}
