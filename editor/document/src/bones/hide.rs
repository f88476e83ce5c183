//! Hiding and showing bones, which changes the selection.

use super::{BoneSelection, Choice, HiddenBones};
use dragonfly_anim::data::BoneIndex;

impl HiddenBones {
    /// Hides the selected bones and deselects them.
    pub fn hide(&mut self, selection: &mut BoneSelection) {
        self.hidden.resize(selection.bone_count(), false);
        for &bone in selection.bones() {
            self.hidden[bone as usize] = true;
        }
        selection.clear();
    }

    /// Hides all bones that are not selected.
    pub fn hide_others(&mut self, selection: &BoneSelection) {
        self.hidden.clear();
        let others = (0..selection.bone_count()).map(|bone| !selection.contains(bone as BoneIndex));
        self.hidden.extend(others);
    }

    /// Hides these bones and deselects them, or shows them.
    pub fn set(&mut self, bones: &[BoneIndex], hide: bool, selection: &mut BoneSelection) {
        self.hidden.resize(selection.bone_count(), false);
        for &bone in bones {
            if let Some(hidden) = self.hidden.get_mut(bone as usize) {
                *hidden = hide;
                if hide && selection.contains(bone) {
                    selection.click(Some(bone), Choice::Toggle);
                }
            }
        }
    }

    /// Shows all bones and selects those that were hidden, so that the user sees them.
    pub fn show_all(&mut self, selection: &mut BoneSelection) {
        if self.is_empty() {
            return;
        }
        selection.clear();
        let hidden = std::mem::take(&mut self.hidden);
        let was_hidden = hidden.iter().enumerate().filter(|(_, hidden)| **hidden);
        was_hidden.for_each(|(bone, _)| selection.add(bone as BoneIndex));
    }
}
