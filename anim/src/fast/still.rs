//! The part of a take that does not move.
//!
//! Many bones keep their translation and scale during a take, and some do not move at all. A pose that plays one take
//! again and again ([`super::Scratch`]) receives this part once, and from then on only what moves.

use super::pose::{Pose, PoseBlock};
use super::simd::{Float8, LANES, Simd};

/// The poses of what does not move during a take, by blocks of eight bones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StillPose {
    /// Translations of every block; those that move are overwritten.
    translations: Vec<[[f32; LANES]; 3]>,
    /// Scales of the blocks in which not all are 1.
    scales: Vec<(u32, [[f32; LANES]; 3])>,
    /// Rotations of the blocks whose rotations the take does not write all at once.
    rotations: Vec<(u32, [[f32; LANES]; 4])>,
    /// Whether nothing of a block moves.
    is_still: Vec<bool>,
}

impl StillPose {
    /// Creates the part that does not move from a pose with the values of all bones. `moves` returns whether any
    /// property of a bone moves.
    pub fn new(pose: &Pose, moves: impl Fn(usize) -> bool) -> Self {
        Self::of_blocks(pose.blocks(), moves, |_| false)
    }

    /// Creates the part that does not move. `turns` returns whether the take writes all rotations of a block.
    pub(crate) fn of_blocks(
        base: &[PoseBlock],
        moves: impl Fn(usize) -> bool,
        turns: impl Fn(u32) -> bool,
    ) -> Self {
        let blocks = || (0..).zip(base);
        let scales = blocks().filter(|(_, base)| base.scale != PoseBlock::IDENTITY.scale);
        Self {
            translations: base.iter().map(|base| base.translation).collect(),
            scales: scales.map(|(block, base)| (block, base.scale)).collect(),
            rotations: blocks()
                .filter(|(block, _)| !turns(*block))
                .map(|(block, base)| (block, base.rotation))
                .collect(),
            is_still: (0..base.len())
                .map(|block| !(0..LANES).any(|lane| moves(block * LANES + lane)))
                .collect(),
        }
    }

    /// Writes these poses to the blocks that `out` and the take both have.
    #[inline(always)]
    pub fn put<S: Simd>(&self, out: &mut [PoseBlock]) {
        let [x, y, z] = PoseBlock::IDENTITY.scale.map(|ones| S::F8::load(&ones));
        for (out, still) in out.iter_mut().zip(&self.translations) {
            S::F8::store_three(S::F8::load_three(still), &mut out.translation);
            S::F8::store_three([x, y, z], &mut out.scale);
        }
        for (block, still) in &self.scales {
            if let Some(out) = out.get_mut(*block as usize) {
                S::F8::store_three(S::F8::load_three(still), &mut out.scale);
            }
        }
        for (block, still) in &self.rotations {
            if let Some(out) = out.get_mut(*block as usize) {
                S::F8::store_four(S::F8::load_four(still), &mut out.rotation);
            }
        }
    }

    /// Returns the number of blocks.
    pub(super) fn blocks(&self) -> usize {
        self.translations.len()
    }

    /// Returns the blocks of which nothing moves.
    pub(super) fn still_blocks(&self) -> impl Iterator<Item = usize> {
        self.is_still.iter().enumerate().filter(|(_, is_still)| **is_still).map(|(block, _)| block)
    }

    /// Returns the translations of a block of the take.
    pub(crate) fn translation(&self, block: usize) -> [[f32; LANES]; 3] {
        self.translations.get(block).copied().unwrap_or_default()
    }

    /// Returns the scales of a block.
    pub(crate) fn scale(&self, block: usize) -> [[f32; LANES]; 3] {
        let still = self.scales.iter().find(|(at, _)| *at as usize == block);
        still.map_or(PoseBlock::IDENTITY.scale, |still| still.1)
    }

    /// Returns the rotations of a block; `None` where the take writes all of them.
    pub(crate) fn rotation(&self, block: usize) -> Option<[[f32; LANES]; 4]> {
        self.rotations.iter().find(|(at, _)| *at as usize == block).map(|still| still.1)
    }

    /// Returns the size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.translations.as_slice())
            + size_of_val(self.scales.as_slice())
            + size_of_val(self.rotations.as_slice())
            + size_of_val(self.is_still.as_slice())
    }
}
