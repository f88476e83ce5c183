//! Weights of single bones, one number per lane.

use super::pose::blocks_of;
use super::simd::LANES;

/// Weights of bones, 0..=1 each, in the layout of poses. Bones past the end have weight 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneMask {
    lanes: Vec<[f32; LANES]>,
}

impl LaneMask {
    /// Creates a mask from one weight per bone, in bone order; below zero and NaN count as 0, above one as 1.
    pub fn new(weights: impl IntoIterator<Item = f32>) -> Self {
        let weights: Vec<f32> = weights.into_iter().map(usable).map(|weight| weight.min(1.0)).collect();
        let mut lanes = vec![[0.0; LANES]; blocks_of(weights.len())];
        for (bone, weight) in weights.into_iter().enumerate() {
            lanes[bone / LANES][bone % LANES] = weight;
        }
        Self { lanes }
    }

    /// Returns the weights of block `block`; all 0 past the end.
    #[inline(always)]
    pub(super) fn block(&self, block: usize) -> &[f32; LANES] {
        self.lanes.get(block).unwrap_or(&[0.0; LANES])
    }
}

/// Returns a usable weight: 0 or more, and small enough that sums of weights stay finite.
#[inline(always)]
pub(super) fn usable(weight: f32) -> f32 {
    // NaN fails the comparison.
    if weight > 0.0 { weight.min(1e30) } else { 0.0 }
}
