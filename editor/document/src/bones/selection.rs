//! Which bones are selected, in the order in which they were; the last is the active one.

use super::{HiddenBones, MirrorPairs};
use dragonfly_anim::data::{BoneIndex, Skeleton};

/// What a click or a region does with what is selected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// This, and nothing else.
    #[default]
    Replace,
    /// This too; what is selected already becomes the active one.
    Add,
    /// This, if it is not selected; else not this any more.
    Toggle,
}

/// See the module. Made for one skeleton; bones that it does not have are left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoneSelection {
    bones: Vec<BoneIndex>,
    selected: Vec<bool>,
}

impl BoneSelection {
    /// Nothing, of so many bones.
    pub fn new(bone_count: usize) -> Self {
        Self { bones: Vec::new(), selected: vec![false; bone_count] }
    }

    /// In the order of selection.
    pub fn bones(&self) -> &[BoneIndex] {
        &self.bones
    }

    /// The one selected last.
    pub fn active(&self) -> Option<BoneIndex> {
        self.bones.last().copied()
    }

    /// How many bones there are to select.
    pub fn bone_count(&self) -> usize {
        self.selected.len()
    }

    /// Is this bone selected?
    pub fn contains(&self, bone: BoneIndex) -> bool {
        self.selected.get(bone as usize) == Some(&true)
    }

    /// Nothing.
    pub fn clear(&mut self) {
        self.bones.drain(..).for_each(|bone| self.selected[bone as usize] = false);
    }

    /// This one too.
    pub fn add(&mut self, bone: BoneIndex) {
        if let Some(selected @ false) = self.selected.get_mut(bone as usize) {
            *selected = true;
            self.bones.push(bone);
        }
    }

    /// A click on a bone, or beside all of them: that clears, unless it would add or toggle.
    pub fn click(&mut self, bone: Option<BoneIndex>, choice: Choice) {
        match bone {
            Some(bone) if choice == Choice::Add && self.contains(bone) => {
                self.bones.retain(|&other| other != bone);
                self.bones.push(bone);
            }
            bone => self.choose(bone.as_slice(), choice),
        }
    }

    /// What a box or lasso holds.
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

    /// All that are shown; the active one stays that.
    pub fn all(&mut self, hidden: &HiddenBones) {
        let active = self.active().filter(|&active| !hidden.is_hidden(active));
        self.set(|_, bone| !hidden.is_hidden(bone));
        self.click(active, Choice::Add);
    }

    /// Those that are shown and were not selected.
    pub fn invert(&mut self, hidden: &HiddenBones) {
        self.set(|selected, bone| !selected[bone as usize] && !hidden.is_hidden(bone));
    }

    /// The nearest shown bone above each; with `extend` besides what is selected. Bones with nothing above stay.
    pub fn parents(&mut self, skeleton: &Skeleton, hidden: &HiddenBones, extend: bool) {
        let above = |bone: BoneIndex| shown_parent(skeleton, hidden, bone).unwrap_or(bone);
        self.replace_each(extend, |bone, add| add(above(bone)));
    }

    /// The shown bones directly below each, all of them; with `extend` besides what is selected. Bones with nothing below
    /// stay.
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

    /// All shown bones below what is selected, at any depth, besides it.
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

    /// The bones next to what is selected, above and below, besides it.
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

    /// Without the bones that are next to one that is not selected.
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

    /// The other side of each; with `extend` besides what is selected. Bones without another side, or with a hidden one,
    /// stay.
    pub fn mirror(&mut self, pairs: &MirrorPairs, hidden: &HiddenBones, extend: bool) {
        let other = |bone: BoneIndex| pairs.partner(bone).filter(|&other| !hidden.is_hidden(other));
        self.replace_each(extend, |bone, add| add(other(bone).unwrap_or(bone)));
    }

    /// Without bones that are hidden.
    pub fn retain_shown(&mut self, hidden: &HiddenBones) {
        self.set_off(|bone| hidden.is_hidden(bone));
    }

    /// Every shown bone that has a shown bone above it.
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

    /// What each leads to, in the same order, so that the active one leads to the active one.
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

    /// Exactly those, in the order of the skeleton.
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

    /// Takes those out of the list that are not marked any more, and what is there twice.
    fn sweep(&mut self) {
        let selected = &mut self.selected;
        self.bones.retain(|&bone| std::mem::take(&mut selected[bone as usize]));
        self.bones.iter().for_each(|&bone| selected[bone as usize] = true);
    }
}

/// The next bone above that is shown.
fn shown_parent(skeleton: &Skeleton, hidden: &HiddenBones, bone: BoneIndex) -> Option<BoneIndex> {
    let parent = |bone: BoneIndex| {
        let parent = skeleton.bones.get(bone as usize)?.parent;
        // Above means before: so there is an end, whatever the numbers say.
        parent.filter(|&parent| parent < bone)
    };
    std::iter::successors(parent(bone), |&bone| parent(bone)).find(|&bone| !hidden.is_hidden(bone))
}
