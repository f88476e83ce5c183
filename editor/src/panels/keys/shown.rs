//! Which bones the timeline lists.

use super::channel;
use crate::panels::state::State;
use dragonfly_anim::data::BoneIndex;

impl State {
    /// Are only the selected bones listed? Where none is selected all are.
    pub(in crate::panels) fn lists_only_selected(&self) -> bool {
        self.keys.only_selected && self.selected().is_some()
    }

    /// Keys that are not listed any more are not selected any more: what is deleted or moved is what is seen.
    pub(in crate::panels) fn forget_unlisted_keys(&mut self) {
        if self.keys.drag.is_none() && self.lists_only_selected() {
            let bones = &self.selection;
            self.keys.selection.drop_bones(|bone| !bones.contains(bone));
        }
    }
}

/// The bones that the timeline lists, in the order of the tree: those with keys, and of these the selected ones where
/// only they are wanted, and those that are called as the filter says.
pub fn bones(state: &State) -> Vec<BoneIndex> {
    let Some(take) = state.take() else { return Vec::new() };
    let only = state.lists_only_selected();
    let filter = state.keys.filter.to_lowercase();
    let wanted = |&bone: &BoneIndex| {
        (!only || state.selection.contains(bone))
            && channel::channels(take, bone).next().is_some()
            && (filter.is_empty() || state.bone_name(bone).to_lowercase().contains(&filter))
    };
    state.digest.rows.iter().map(|row| row.bone).filter(wanted).collect()
}
