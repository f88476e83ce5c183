//! Weights of single bones, one number per lane.

use super::pose::blocks_of;
use super::simd::LANES;

/// Weights of bones, 0..=1 each, in the layout of poses. Bones past the end have weight 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneMask {
    blocks: Vec<MaskBlock>,
}

/// Weights of eight bones.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct MaskBlock {
    pub(super) lanes: [f32; LANES],
    /// Whether all are 0, so that the layer can be skipped.
    pub(super) is_zero: bool,
}

impl MaskBlock {
    pub(super) const ZERO: Self = Self { lanes: [0.0; LANES], is_zero: true };
    pub(super) const WHOLE: Self = Self { lanes: [1.0; LANES], is_zero: false };
}

impl LaneMask {
    /// Creates a mask from one weight per bone, in bone order; below zero and NaN count as 0, above one as 1.
    pub fn new(weights: impl IntoIterator<Item = f32>) -> Self {
        let weights: Vec<f32> = weights.into_iter().map(usable).map(|weight| weight.min(1.0)).collect();
        let mut blocks = vec![MaskBlock::ZERO; blocks_of(weights.len())];
        for (bone, weight) in weights.into_iter().enumerate() {
            let block = &mut blocks[bone / LANES];
            block.lanes[bone % LANES] = weight;
            block.is_zero &= weight == 0.0;
        }
        Self { blocks }
    }

    /// Returns the weights of block `block`; all 0 past the end.
    #[inline(always)]
    pub(super) fn block(&self, block: usize) -> &[f32; LANES] {
        self.blocks.get(block).map_or(&[0.0; LANES], |block| &block.lanes)
    }

    /// Returns the weights of all blocks.
    #[inline(always)]
    pub(super) fn blocks(&self) -> &[MaskBlock] {
        &self.blocks
    }
}

/// Returns a usable weight: 0 or more, and small enough that sums of weights stay finite.
#[inline(always)]
pub(super) fn usable(weight: f32) -> f32 {
    // NaN fails the comparison.
    if weight > 0.0 { weight.min(1e30) } else { 0.0 }
}
