//! Hidden bones: they cannot be picked, and commands that select neighbors skip them.

use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::root_bone::BoneShift;

/// The set of hidden bones. A bone below a hidden one is shown nevertheless.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HiddenBones {
    pub(super) hidden: Vec<bool>,
}

impl HiddenBones {
    /// Returns whether this bone is hidden.
    pub fn is_hidden(&self, bone: BoneIndex) -> bool {
        self.hidden.get(bone as usize) == Some(&true)
    }

    /// Follows the bones to another skeleton.
    pub fn shift(&mut self, shift: BoneShift) {
        if !self.hidden.is_empty() {
            let kept = self.hidden.iter().skip(shift.removed()).copied();
            self.hidden = std::iter::repeat_n(false, shift.added()).chain(kept).collect();
        }
    }

    /// Returns whether no bone is hidden.
    pub fn is_empty(&self) -> bool {
        !self.hidden.contains(&true)
    }

    /// Removes hidden bones from a list of hits.
    pub fn retain_shown(&self, bones: &mut Vec<BoneIndex>) {
        bones.retain(|&bone| !self.is_hidden(bone));
    }
}
