//! Hidden bones: they cannot be picked, and commands that select neighbors skip them.

use super::{BoneSelection, Choice};
use dragonfly_anim::data::BoneIndex;

/// The set of hidden bones. A bone below a hidden one is shown nevertheless.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HiddenBones {
    hidden: Vec<bool>,
}

impl HiddenBones {
    /// Returns whether this bone is hidden.
    pub fn is_hidden(&self, bone: BoneIndex) -> bool {
        self.hidden.get(bone as usize) == Some(&true)
    }

    /// Returns whether no bone is hidden.
    pub fn is_empty(&self) -> bool {
        !self.hidden.contains(&true)
    }

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

    /// Removes hidden bones from a list of hits.
    pub fn retain_shown(&self, bones: &mut Vec<BoneIndex>) {
        bones.retain(|&bone| !self.is_hidden(bone));
    }
}
