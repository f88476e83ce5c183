//! Morph targets of eight vertices at once.
//!
//! ```text
//! morphed = stored + Σ weight_t * difference_t      for positions and normals, before the skin
//! ```
//!
//! The differences of one block of eight vertices are contiguous, target after target, so that a block is read in one
//! go.

use super::simd::{Float8, LANES, Simd};
use crate::data::Primitive;
use glam::Vec3;

/// Positions and normals of eight vertices, or differences of them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(super) struct ShapeBlock {
    pub(super) positions: [[f32; LANES]; 3],
    pub(super) normals: [[f32; LANES]; 3],
}

impl ShapeBlock {
    pub(super) fn set(&mut self, lane: usize, position: Vec3, normal: Vec3) {
        for at in 0..3 {
            (self.positions[at][lane], self.normals[at][lane]) = (position[at], normal[at]);
        }
    }

    pub(super) fn get(&self, lane: usize) -> (Vec3, Vec3) {
        let three = |rows: &[[f32; LANES]; 3]| Vec3::new(rows[0][lane], rows[1][lane], rows[2][lane]);
        (three(&self.positions), three(&self.normals))
    }
}

/// The differences of all morph targets of a primitive.
#[derive(Clone, Debug, Default)]
pub(super) struct Differences {
    targets: usize,
    /// Differences of the first block, one per target; then those of the second.
    shapes: Vec<ShapeBlock>,
}

impl Differences {
    /// Collects the differences of `primitive`; zero where a target has none for a vertex.
    pub(super) fn new(primitive: &Primitive) -> Self {
        let count = primitive.vertices.len();
        let targets = &primitive.morph_targets;
        let mut shapes = Vec::with_capacity(targets.len() * count.div_ceil(LANES));
        for first in (0..count).step_by(LANES) {
            for target in targets {
                let mut shape = ShapeBlock::default();
                for (lane, index) in (first..count).enumerate().take(LANES) {
                    let of = |column: &[Vec3]| column.get(index).copied().unwrap_or(Vec3::ZERO);
                    shape.set(lane, of(&target.positions), of(&target.normals));
                }
                shapes.push(shape);
            }
        }
        Self { targets: targets.len(), shapes }
    }

    /// Returns whether `weights` add anything.
    pub(super) fn are_added(&self, weights: &[f32]) -> bool {
        weights.iter().take(self.targets).any(|&weight| weight != 0.0)
    }

    /// Returns `stored`, block `block`, with all differences times their `weights` added.
    #[inline(always)]
    pub(super) fn added<S: Simd>(&self, block: usize, stored: &ShapeBlock, weights: &[f32]) -> ShapeBlock {
        let [mut x, mut y, mut z] = S::F8::load_three(&stored.positions);
        let [mut a, mut b, mut c] = S::F8::load_three(&stored.normals);
        let first = block * self.targets;
        let shapes = self.shapes.get(first..first + self.targets).unwrap_or(&[]);
        for (shape, &weight) in shapes.iter().zip(weights) {
            // Required for correctness, too: zero times a number that is not finite would be NaN.
            if weight != 0.0 {
                let weight = S::F8::splat(weight);
                let [dx, dy, dz] = S::F8::load_three(&shape.positions);
                (x, y, z) = (dx.mul_add(weight, x), dy.mul_add(weight, y), dz.mul_add(weight, z));
                let [da, db, dc] = S::F8::load_three(&shape.normals);
                (a, b, c) = (da.mul_add(weight, a), db.mul_add(weight, b), dc.mul_add(weight, c));
            }
        }
        let mut morphed = ShapeBlock::default();
        S::F8::store_three([x, y, z], &mut morphed.positions);
        S::F8::store_three([a, b, c], &mut morphed.normals);
        morphed
    }
}
