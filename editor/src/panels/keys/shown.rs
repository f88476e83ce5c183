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
            let mut keys = std::mem::take(&mut self.keys.selection);
            keys.drop_bones(|bone| !self.is_wanted(bone));
            self.keys.selection = keys;
        }
    }

    /// Is a bone listed where only those are that are selected, or whose rows were there when one of them was clicked?
    fn is_wanted(&self, bone: BoneIndex) -> bool {
        let kept = self.keys.kept.as_ref().filter(|(_, by)| by == self.selection.bones());
        kept.map_or_else(|| self.selection.contains(bone), |(listed, _)| listed.contains(&bone))
    }
}

/// The bones that the timeline lists, in the order of the tree: those with keys, and of these the selected ones where
/// only they are wanted, and those that are called as the filter says.
pub fn bones(state: &State) -> Vec<BoneIndex> {
    let Some(take) = state.take() else { return Vec::new() };
    let only = state.lists_only_selected();
    let filter = state.keys.filter.to_lowercase();
    let wanted = |&bone: &BoneIndex| {
        (!only || state.is_wanted(bone))
            && channel::channels(take, bone).next().is_some()
            && (filter.is_empty() || state.bone_name(bone).to_lowercase().contains(&filter))
    };
    state.digest.rows.iter().map(|row| row.bone).filter(wanted).collect()
}
