//! The selected bones in the order of selection; the last one is the active bone.

use super::{HiddenBones, MirrorPairs};
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::root_bone::BoneShift;

/// How a click or a region changes the selection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// Selects only these bones.
    #[default]
    Replace,
    /// Adds these bones; a bone that is already selected becomes the active one.
    Add,
    /// Toggles these bones.
    Toggle,
}

/// The selected bones of one skeleton. Bones that it does not have are ignored.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoneSelection {
    bones: Vec<BoneIndex>,
    selected: Vec<bool>,
}

impl BoneSelection {
    /// An empty selection of a skeleton with `bone_count` bones.
    pub fn new(bone_count: usize) -> Self {
        Self { bones: Vec::new(), selected: vec![false; bone_count] }
    }

    /// Follows the bones to another skeleton with `bone_count` bones. Those that it does not have are deselected.
    pub fn shift(&mut self, shift: BoneShift, bone_count: usize) {
        let bones = shift.bones(&self.bones);
        *self = Self::new(bone_count);
        bones.into_iter().for_each(|bone| self.add(bone));
    }

    /// Returns the selected bones in the order of selection.
    pub fn bones(&self) -> &[BoneIndex] {
        &self.bones
    }

    /// Returns the active bone: the one selected last.
    pub fn active(&self) -> Option<BoneIndex> {
        self.bones.last().copied()
    }

    /// Returns the number of bones of the skeleton.
    pub fn bone_count(&self) -> usize {
        self.selected.len()
    }

    /// Returns whether this bone is selected.
    pub fn contains(&self, bone: BoneIndex) -> bool {
        self.selected.get(bone as usize) == Some(&true)
    }

    /// Deselects all bones.
    pub fn clear(&mut self) {
        self.bones.drain(..).for_each(|bone| self.selected[bone as usize] = false);
    }

    /// Adds a bone.
    pub fn add(&mut self, bone: BoneIndex) {
        if let Some(selected @ false) = self.selected.get_mut(bone as usize) {
            *selected = true;
            self.bones.push(bone);
        }
    }

    /// Applies a click on a bone, or on no bone: that clears the selection, unless it would add or toggle.
    pub fn click(&mut self, bone: Option<BoneIndex>, choice: Choice) {
        match bone {
            Some(bone) if choice == Choice::Add && self.contains(bone) => {
                self.bones.retain(|&other| other != bone);
                self.bones.push(bone);
            }
            bone => self.choose(bone.as_slice(), choice),
        }
    }

    /// Applies a box or lasso selection.
    pub fn choose(&mut self, bones: &[BoneIndex], choice: Choice) {
        if choice == Choice::Replace {
            self.clear();
        }
        for &bone in bones {
            if choice == Choice::Toggle && self.contains(bone) {
                self.selected[bone as usize] = false;
            } else {
                self.add(bone);
            }
        }
        self.sweep();
    }

    /// Selects all visible bones; the active bone stays active.
    pub fn all(&mut self, hidden: &HiddenBones) {
        let active = self.active().filter(|&active| !hidden.is_hidden(active));
        self.set(|_, bone| !hidden.is_hidden(bone));
        self.click(active, Choice::Add);
    }

    /// Inverts the selection of visible bones.
    pub fn invert(&mut self, hidden: &HiddenBones) {
        self.set(|selected, bone| !selected[bone as usize] && !hidden.is_hidden(bone));
    }

    /// Selects the nearest visible ancestor of each selected bone; with `extend` in addition to the selection. Bones
    /// without such an ancestor stay selected.
    pub fn parents(&mut self, skeleton: &Skeleton, hidden: &HiddenBones, extend: bool) {
        let above = |bone: BoneIndex| shown_parent(skeleton, hidden, bone).unwrap_or(bone);
        self.replace_each(extend, |bone, add| add(above(bone)));
    }

    /// Selects all visible children of each selected bone; with `extend` in addition to the selection. Bones without
    /// children stay selected.
    pub fn children(&mut self, skeleton: &Skeleton, hidden: &HiddenBones, extend: bool) {
        let before = self.selected.clone();
        let mut has_child = vec![false; before.len()];
        let mut found = Vec::new();
        for bone in (0..before.len() as BoneIndex).filter(|&bone| !hidden.is_hidden(bone)) {
            let Some(parent) = shown_parent(skeleton, hidden, bone) else { continue };
            if before.get(parent as usize) == Some(&true) {
                has_child[parent as usize] = true;
                found.push(bone);
            }
        }
        if !extend {
            self.bones.retain(|&bone| !has_child[bone as usize]);
            self.selected.iter_mut().zip(&has_child).for_each(|(selected, has)| *selected &= !has);
        }
        found.into_iter().for_each(|bone| self.add(bone));
    }

    /// Adds all visible descendants.
    pub fn descendants(&mut self, skeleton: &Skeleton, hidden: &HiddenBones) {
        let mut below = self.selected.clone();
        // Parents come before children.
        for (bone, of) in skeleton.bones.iter().enumerate().take(below.len()) {
            let inherits = of.parent.is_some_and(|parent| below.get(parent as usize) == Some(&true));
            below[bone] |= inherits;
            if inherits && !hidden.is_hidden(bone as BoneIndex) {
                self.add(bone as BoneIndex);
            }
        }
    }

    /// Adds the visible parents and children.
    pub fn grow(&mut self, skeleton: &Skeleton, hidden: &HiddenBones) {
        let before = self.selected.clone();
        self.for_each_joint(skeleton, hidden, |selection, bone, parent| {
            if before[bone as usize] {
                selection.add(parent);
            }
            if before[parent as usize] {
                selection.add(bone);
            }
        });
    }

    /// Deselects bones that are next to an unselected one.
    pub fn shrink(&mut self, skeleton: &Skeleton, hidden: &HiddenBones) {
        let before = self.selected.clone();
        self.for_each_joint(skeleton, hidden, |selection, bone, parent| {
            if before[bone as usize] != before[parent as usize] {
                selection.selected[bone as usize] = false;
                selection.selected[parent as usize] = false;
            }
        });
        self.sweep();
    }

    /// Selects the mirror bone of each selected bone; with `extend` in addition to the selection. Bones without a
    /// visible mirror bone stay selected.
    pub fn mirror(&mut self, pairs: &MirrorPairs, hidden: &HiddenBones, extend: bool) {
        let other = |bone: BoneIndex| pairs.partner(bone).filter(|&other| !hidden.is_hidden(other));
        self.replace_each(extend, |bone, add| add(other(bone).unwrap_or(bone)));
    }

    /// Deselects hidden bones.
    pub fn retain_shown(&mut self, hidden: &HiddenBones) {
        self.set_off(|bone| hidden.is_hidden(bone));
    }

    /// Calls `act` with each visible bone that has a visible ancestor, and with the nearest such ancestor.
    fn for_each_joint(
        &mut self,
        skeleton: &Skeleton,
        hidden: &HiddenBones,
        mut act: impl FnMut(&mut Self, BoneIndex, BoneIndex),
    ) {
        for bone in 0..self.selected.len() as BoneIndex {
            let parent = shown_parent(skeleton, hidden, bone).filter(|_| !hidden.is_hidden(bone));
            if let Some(parent) = parent.filter(|&parent| (parent as usize) < self.selected.len()) {
                act(self, bone, parent);
            }
        }
    }

    /// Replaces each bone by the bones to which `each` leads, in the same order, so that the active bone leads to the
    /// active bone.
    fn replace_each(&mut self, extend: bool, each: impl Fn(BoneIndex, &mut dyn FnMut(BoneIndex))) {
        let before = std::mem::take(&mut self.bones);
        if extend {
            self.bones.clone_from(&before);
        } else {
            self.selected.fill(false);
        }
        let active = before.last().copied();
        for bone in before {
            each(bone, &mut |other| self.add(other));
        }
        if let Some(active) = active {
            each(active, &mut |other| self.click(Some(other), Choice::Add));
        }
    }

    /// Selects exactly the bones for which `keep` returns `true`, in the order of the skeleton.
    fn set(&mut self, keep: impl Fn(&[bool], BoneIndex) -> bool) {
        let before = self.selected.clone();
        self.clear();
        (0..before.len() as BoneIndex).filter(|&bone| keep(&before, bone)).for_each(|bone| self.add(bone));
    }

    fn set_off(&mut self, off: impl Fn(BoneIndex) -> bool) {
        for (bone, selected) in self.selected.iter_mut().enumerate() {
            *selected &= !off(bone as BoneIndex);
        }
        self.sweep();
    }

    /// Removes bones from the list that are no longer marked, and duplicates.
    fn sweep(&mut self) {
        let selected = &mut self.selected;
        self.bones.retain(|&bone| std::mem::take(&mut selected[bone as usize]));
        self.bones.iter().for_each(|&bone| selected[bone as usize] = true);
    }
}

/// Returns the nearest visible ancestor.
fn shown_parent(skeleton: &Skeleton, hidden: &HiddenBones, bone: BoneIndex) -> Option<BoneIndex> {
    skeleton.ancestors(bone).find(|&bone| !hidden.is_hidden(bone))
}
