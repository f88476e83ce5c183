//! Random parts of edits, for property tests.

use super::{BonePose, BoneRef, EDITS, Edit, KeySet, LayerRef, Property, TakeRef};

/// Name of the kind of edit that changes texts.
const TEXT_EDIT: &str = "script";

/// A source of random edits for a model with a number of takes and some bones.
pub struct Arbitrary<'a> {
    bits: &'a mut dyn FnMut() -> u64,
    takes: usize,
    bones: &'a [BoneRef],
    /// Whether a third of the numbers is out of the ordinary.
    extreme: bool,
}

impl std::fmt::Debug for Arbitrary<'_> {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_struct("Arbitrary").field("takes", &self.takes).field("bones", &self.bones).finish()
    }
}

impl<'a> Arbitrary<'a> {
    /// A source that draws from `bits`, which returns 64 random bits each time. There is at least one bone.
    pub fn new(bits: &'a mut dyn FnMut() -> u64, takes: usize, bones: &'a [BoneRef]) -> Self {
        Self { bits, takes, bones, extreme: false }
    }

    /// As [`Self::new`], but with times before 0 s, single instants, and the largest and smallest numbers.
    pub fn extreme(bits: &'a mut dyn FnMut() -> u64, takes: usize, bones: &'a [BoneRef]) -> Self {
        Self { extreme: true, ..Self::new(bits, takes, bones) }
    }

    /// Returns any edit of any kind of a model, whether it can be applied or not.
    pub fn edit(&mut self) -> Edit {
        // A model has no text, so that edits of texts are always refused.
        let mut kinds = EDITS.iter().filter(|kind| kind.name != TEXT_EDIT);
        let kind = kinds.nth(self.below(EDITS.len() - 1)).unwrap_or(&EDITS[0]);
        (kind.arbitrary)(self)
    }

    /// A number in `0..end`; 0 where `end` is 0.
    pub(super) fn below(&mut self, end: usize) -> usize {
        if end == 0 { 0 } else { ((self.bits)() % end as u64) as usize }
    }

    /// True in one of two cases.
    pub(super) fn flag(&mut self) -> bool {
        self.below(2) == 0
    }

    /// A number in `low..high`.
    pub(super) fn between(&mut self, low: f32, high: f32) -> f32 {
        if self.extreme && self.below(3) == 0 {
            return self
                .choice([0.0, -1.0, 1e-6, -1e-5, 1e-4, 1e4, 43_200.0, -86_400.0, 86_400.0, 1e18, 1e-30]);
        }
        let unit = ((self.bits)() >> 40) as f32 / (1u64 << 24) as f32;
        low + (high - low) * unit
    }

    /// One of some choices.
    pub(super) fn choice<T: Copy, const N: usize>(&mut self, choices: [T; N]) -> T {
        choices[self.below(N)]
    }

    /// Any numbers from -1 to 1, `count` of them.
    pub(super) fn numbers(&mut self, count: usize) -> Vec<f32> {
        (0..count).map(|_| self.between(-1.0, 1.0)).collect()
    }

    /// Either nothing, or what `make` makes.
    pub(super) fn optional<T>(&mut self, make: impl FnOnce(&mut Self) -> T) -> Option<T> {
        if self.flag() { Some(make(self)) } else { None }
    }

    /// One of the takes, or a layer that it may have.
    pub(super) fn take(&mut self) -> TakeRef {
        if self.below(4) == 0 {
            return self.layer();
        }
        TakeRef::Index(self.below(self.takes))
    }

    /// A layer that a take may or may not have.
    pub(super) fn layer(&mut self) -> TakeRef {
        let take = Box::new(TakeRef::Index(self.below(self.takes)));
        TakeRef::Layer { take, layer: LayerRef::Index(self.below(2)) }
    }

    /// A name that a take may or may not have already.
    pub(super) fn name(&mut self) -> String {
        format!("take {}", self.below(100))
    }

    /// Seconds, at which there often is a key.
    pub(super) fn time(&mut self) -> f32 {
        if self.extreme && self.below(3) == 0 {
            return self.choice([-1.0, -0.5, -1e-5, 4e-5, 86_399.99, 86_400.0, 86_401.0, 1e9, f32::NAN]);
        }
        self.choice([0.0, 0.125, 0.3, 0.5, 0.77, 1.0, 1.3])
    }

    /// One of the bones.
    pub(super) fn bone(&mut self) -> BoneRef {
        self.bones[self.below(self.bones.len())].clone()
    }

    /// One bone, or none, which means all of them.
    pub(super) fn bones(&mut self) -> Vec<BoneRef> {
        if self.below(3) == 0 { Vec::new() } else { vec![self.bone()] }
    }

    /// One bone that is held, or mostly none.
    pub(super) fn feet(&mut self) -> Vec<BoneRef> {
        if self.below(4) == 0 { vec![self.bone()] } else { Vec::new() }
    }

    /// One of the channels.
    pub(super) fn property(&mut self) -> Property {
        self.choice(Property::ALL)
    }

    /// One channel, or none, which means all of them.
    pub(super) fn properties(&mut self) -> Vec<Property> {
        if self.flag() { Vec::new() } else { vec![self.property()] }
    }

    /// A pose of one bone; any of its parts may be missing.
    pub(super) fn poses(&mut self) -> Vec<BonePose> {
        let three = |from: &mut Self| [0; 3].map(|_| from.between(-2.0, 2.0));
        vec![BonePose {
            bone: self.bone(),
            translation: self.optional(three),
            rotation: self.optional(|from| [0; 4].map(|_| from.between(-1.0, 1.0))),
            scale: self.optional(three),
        }]
    }

    /// Keys in half a second.
    pub(super) fn keys(&mut self) -> Vec<KeySet> {
        let time = self.time();
        let (from, to) = (Some(time - 0.3), Some(time + 0.2));
        vec![KeySet { bones: self.bones(), properties: self.properties(), from, to, ..KeySet::default() }]
    }

    /// Stretches of time for keys of morph targets, often none.
    pub(super) fn shapes(&mut self) -> Vec<[f32; 2]> {
        let time = self.time();
        if self.flag() { vec![[time - 0.2, time + 0.3]] } else { Vec::new() }
    }
}
