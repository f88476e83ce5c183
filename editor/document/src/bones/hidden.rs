//! Bones that are put out of sight: they are not picked, not boxed, and no neighbour of what is seen.

use super::{BoneSelection, Choice};
use dragonfly_anim::data::BoneIndex;

/// Which bones are hidden. A bone below a hidden one is shown all the same.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HiddenBones {
    hidden: Vec<bool>,
}

impl HiddenBones {
    /// Is this bone hidden?
    pub fn is_hidden(&self, bone: BoneIndex) -> bool {
        self.hidden.get(bone as usize) == Some(&true)
    }

    /// Is any?
    pub fn is_empty(&self) -> bool {
        !self.hidden.contains(&true)
    }

    /// Hides what is selected, which is selected no more.
    pub fn hide(&mut self, selection: &mut BoneSelection) {
        self.hidden.resize(selection.bone_count(), false);
        for &bone in selection.bones() {
            self.hidden[bone as usize] = true;
        }
        selection.clear();
    }

    /// Hides everything but what is selected.
    pub fn hide_others(&mut self, selection: &BoneSelection) {
        self.hidden.clear();
        let others = (0..selection.bone_count()).map(|bone| !selection.contains(bone as BoneIndex));
        self.hidden.extend(others);
    }

    /// Hides these bones, which are selected no more then, or shows them.
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

    /// Shows all again and selects what was hidden, so that one sees what came.
    pub fn show_all(&mut self, selection: &mut BoneSelection) {
        if self.is_empty() {
            return;
        }
        selection.clear();
        let hidden = std::mem::take(&mut self.hidden);
        let was_hidden = hidden.iter().enumerate().filter(|(_, hidden)| **hidden);
        was_hidden.for_each(|(bone, _)| selection.add(bone as BoneIndex));
    }

    /// Takes hidden bones out of a list of hits.
    pub fn retain_shown(&self, bones: &mut Vec<BoneIndex>) {
        bones.retain(|&bone| !self.is_hidden(bone));
    }
}
