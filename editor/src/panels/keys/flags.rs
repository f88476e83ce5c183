//! Bones that are muted, soloed or locked.

use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::Change;
use dragonfly_document::edit::EditedBones;
use std::collections::BTreeSet;

/// A flag of a bone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoneFlag {
    /// The viewport shows the bone at rest.
    Mute,
    /// The viewport shows all other bones at rest.
    Solo,
    /// The bone is not edited.
    Lock,
}

impl BoneFlag {
    /// All flags, in the order in which they are shown.
    pub const ALL: [Self; 3] = [Self::Mute, Self::Solo, Self::Lock];

    /// Returns its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mute => "Mute",
            Self::Solo => "Solo",
            Self::Lock => "Lock",
        }
    }

    /// Returns its tooltip.
    pub fn help(self) -> &'static str {
        match self {
            Self::Mute => "Shows this bone at rest in the viewport; its keys are unchanged",
            Self::Solo => "Shows all other bones at rest in the viewport",
            Self::Lock => "Locks this bone against editing; edits of the whole take still include it",
        }
    }
}

/// The flags of all bones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoneFlags {
    sets: [BTreeSet<BoneIndex>; 3],
    version: u64,
}

impl BoneFlags {
    /// Returns whether the bone has this flag.
    pub fn has(&self, flag: BoneFlag, bone: BoneIndex) -> bool {
        self.sets[flag as usize].contains(&bone)
    }

    /// Sets or clears a flag of a bone.
    pub fn set(&mut self, flag: BoneFlag, bone: BoneIndex, on: bool) {
        let set = &mut self.sets[flag as usize];
        let changed = if on { set.insert(bone) } else { set.remove(&bone) };
        self.version += u64::from(changed);
    }

    /// Returns the bones that have this flag, ascending.
    pub fn of(&self, flag: BoneFlag) -> impl Iterator<Item = BoneIndex> + '_ {
        self.sets[flag as usize].iter().copied()
    }

    /// Returns flags without any bone, for another model; the version differs from all before.
    pub fn emptied(&self) -> Self {
        Self { sets: Default::default(), version: self.version + 1 }
    }

    /// Returns the same flags of the bones of another skeleton; the version differs from all before.
    pub fn shifted(&self, shift: BoneShift) -> Self {
        let set = |set: &BTreeSet<BoneIndex>| set.iter().filter_map(|&bone| shift.bone(bone)).collect();
        Self { sets: self.sets.each_ref().map(set), version: self.version + 1 }
    }

    /// Returns the version, which grows with every change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Returns whether any bone is locked.
    pub fn any_locked(&self) -> bool {
        !self.sets[BoneFlag::Lock as usize].is_empty()
    }

    /// Returns whether this bone is locked.
    pub fn locked(&self, bone: BoneIndex) -> bool {
        self.has(BoneFlag::Lock, bone)
    }

    /// Returns the bones of `count` that the viewport shows at rest.
    pub fn still(&self, count: usize) -> Vec<BoneIndex> {
        let solo = &self.sets[BoneFlag::Solo as usize];
        let still =
            |&bone: &BoneIndex| self.has(BoneFlag::Mute, bone) || (!solo.is_empty() && !solo.contains(&bone));
        if self.sets[BoneFlag::Mute as usize].is_empty() && solo.is_empty() {
            return Vec::new();
        }
        (0..count as BoneIndex).filter(still).collect()
    }

    /// Returns the bones of `count` that no chain rotates: locked ones, and those shown at rest.
    pub fn fixed(&self, count: usize) -> Vec<BoneIndex> {
        let mut fixed = self.still(count);
        fixed.extend(self.sets[BoneFlag::Lock as usize].iter().filter(|&&bone| (bone as usize) < count));
        fixed.sort_unstable();
        fixed.dedup();
        fixed
    }

    /// Returns a locked bone that `change` would edit, if there is one.
    ///
    /// An edit of a whole take (trim, split, reverse, retime, rename) is not about bones: it includes locked ones, because their
    /// keys would no longer match the others. Commands for several bones leave the locked ones out, unless all of them are
    /// locked.
    pub fn locked_bone_in(&self, change: &Change, skeleton: &Skeleton) -> Option<BoneIndex> {
        let Change::Edit(edit, _) = change else { return None };
        if !self.any_locked() {
            return None;
        }
        match edit.bones(skeleton) {
            EditedBones::WholeTake => None,
            EditedBones::All => self.of(BoneFlag::Lock).next(),
            EditedBones::Named(bones) => bones.into_iter().find(|&bone| self.locked(bone)),
        }
    }
}
