//! How much each bone takes part, one number a lane.

use super::pose::blocks_of;
use super::simd::LANES;

/// Weights of bones, 0..=1 each, laid out as the poses are. Bones past the end take no part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneMask {
    lanes: Vec<[f32; LANES]>,
}

impl LaneMask {
    /// One weight a bone, in bone order; below zero and NaN count as 0, above one as 1.
    pub fn new(weights: impl IntoIterator<Item = f32>) -> Self {
        let weights: Vec<f32> = weights.into_iter().map(usable).map(|weight| weight.min(1.0)).collect();
        let mut lanes = vec![[0.0; LANES]; blocks_of(weights.len())];
        for (bone, weight) in weights.into_iter().enumerate() {
            lanes[bone / LANES][bone % LANES] = weight;
        }
        Self { lanes }
    }

    /// The weights of block `block`; all 0 past the end.
    #[inline(always)]
    pub(super) fn block(&self, block: usize) -> &[f32; LANES] {
        self.lanes.get(block).unwrap_or(&[0.0; LANES])
    }
}

/// A weight as it may be used: 0 or more; so far from the end of `f32` that sums of weights stay finite.
#[inline(always)]
pub(super) fn usable(weight: f32) -> f32 {
    // NaN fails the comparison.
    if weight > 0.0 { weight.min(1e30) } else { 0.0 }
}
