//! How far a part of a mesh can reach in a pose, computed from a few boxes rather than from its vertices.
//!
//! A skinned vertex is a sum of images of one point `m`, one per bone:
//!
//! ```text
//! p = Σ weight_i * final_i * m = P * (a mean of images with weight_i > 0) - N * (a mean of those with weight_i < 0)
//! P = Σ of the positive weights, N = Σ of the negative ones, both ≥ 0
//! ```
//!
//! A mean is inside every box that contains the values it is the mean of. So it is enough to keep, for each joint, one
//! box of the `m` that it moves: the boxes moved by the final poses contain every image, a box around those contains
//! every mean, and `[P] * box - [N] * box`, with the smallest and largest sums that occur, contains every vertex. With
//! weights that sum to 1 and are not negative that is the box itself.
//!
//! Morph targets add `Σ weight_t * difference_t` to `m`; a box of each target's differences, times its weight, is added
//! to the joint's box. Vertices that no bone moves stay in place and have a box of their own.
//!
//! Each box is aligned with the axes of the bind space or of the bone, whichever makes it smaller; its rotation is part
//! of the matrix that moves it, so any choice is correct.

use super::axis_box::{AxisBox, ROUNDING, widening};
use crate::skin::Movement;
use glam::{Mat3, Mat4, Vec3};

/// A box of the unmoved vertices that one joint moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointBox {
    /// Position in the skin's list; 0 for a mesh without skin.
    pub(super) joint: u16,
    /// Axes of the box → mesh space.
    pub(super) turn: Mat3,
    /// Extent along those axes.
    pub(super) extent: AxisBox,
    /// Range of [`Reaches::deltas`]: first, and count.
    pub(super) deltas: (u32, u32),
}

/// The range in which one morph target with weight 1 moves the vertices of a joint's box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Delta {
    pub(super) target: u32,
    /// Box around the target's differences and the origin, along the axes of the joint's box.
    pub(super) by: AxisBox,
}

/// One part of a mesh: a range of boxes, and sums of weights.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartReach {
    pub(super) boxes: (u32, u32),
    /// Box of the vertices that do not move.
    pub(super) still: AxisBox,
    /// Smallest and largest sum of a vertex's positive weights; `negative` is the same for the sizes of its negative
    /// ones.
    pub(super) positive: [f32; 2],
    pub(super) negative: [f32; 2],
}

/// Any number of parts, in flat lists.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reaches {
    pub(super) parts: Vec<PartReach>,
    pub(super) boxes: Vec<JointBox>,
    pub(super) deltas: Vec<Delta>,
}

impl Reaches {
    /// Returns the number of parts.
    pub(crate) fn len(&self) -> usize {
        self.parts.len()
    }

    /// Returns the boxes of part number `part`.
    fn boxes(&self, part: usize) -> &[JointBox] {
        let (first, count) = self.parts.get(part).map_or((0, 0), |part| part.boxes);
        self.boxes.get(first as usize..(first + count) as usize).unwrap_or(&[])
    }

    /// Returns a box around part number `part` when `movement` moves it and its morph targets have `weights`.
    ///
    /// Empty for a part without vertices. Allocates nothing.
    pub(crate) fn fit(&self, part: usize, movement: Movement<'_>, weights: &[f32]) -> AxisBox {
        let Some(reach) = self.parts.get(part) else { return AxisBox::EMPTY };
        let mut hull = AxisBox::EMPTY;
        for joint in self.boxes(part) {
            let extent = self.extent(joint, weights);
            if extent == AxisBox::WHOLE {
                // If the sum cannot be computed, skinning leaves the vertex at its stored position, wherever that is.
                return extent;
            }
            hull = hull.union(extent.moved(&placed(joint, movement)));
        }
        weighted(hull, reach).union(reach.still)
    }

    /// Returns the distance from `center` that the part can reach, never too small. `within` is the result of
    /// [`Self::fit`].
    pub(crate) fn radius(
        &self,
        part: usize,
        movement: Movement<'_>,
        weights: &[f32],
        center: Vec3,
        within: AxisBox,
    ) -> f64 {
        let Some(reach) = self.parts.get(part).filter(|_| !within.is_empty()) else { return 0.0 };
        let outer = furthest(center, within);
        // The corners below bound means, so they do not bound a part whose weights do not form means.
        if reach.negative[1] > 0.0 || !reach.still.is_empty() || within == AxisBox::WHOLE {
            return outer;
        }
        let mut inner = 0.0_f64;
        for joint in self.boxes(part) {
            inner = inner.max(corner(&self.extent(joint, weights), &placed(joint, movement), center));
        }
        let off = (1.0 - reach.positive[0]).abs().max((reach.positive[1] - 1.0).abs());
        let size = within.min.abs().max(within.max.abs()).as_dvec3().length();
        let inner = inner + f64::from(off + ROUNDING) * size;
        if inner.is_finite() { inner.min(outer) } else { outer }
    }

    /// Returns the joint's box, grown by the movement of the morph targets.
    fn extent(&self, joint: &JointBox, weights: &[f32]) -> AxisBox {
        let (first, count) = joint.deltas;
        let deltas = self.deltas.get(first as usize..(first + count) as usize).unwrap_or(&[]);
        let mut extent = joint.extent;
        let mut added = 0;
        for delta in deltas {
            let weight = weights.get(delta.target as usize).copied().unwrap_or(0.0);
            if weight != 0.0 {
                let (a, b) = (delta.by.min * weight, delta.by.max * weight);
                (extent.min, extent.max) = (extent.min + a.min(b), extent.max + a.max(b));
                added += 1;
            }
        }
        if added > 0 {
            // Each addition may round once more. The absolute coordinates of the grown box bound all numbers involved.
            let slack = widening(extent.min.abs().max(extent.max.abs())) * (added as f32 + 1.0);
            (extent.min, extent.max) = (extent.min - slack, extent.max + slack);
        }
        extent.or_whole()
    }
}

/// Returns the matrix that moves the joint's box: its axes → scene space.
fn placed(joint: &JointBox, movement: Movement<'_>) -> Mat4 {
    let matrix = match movement {
        Movement::Rigid(matrix) => matrix,
        Movement::Skin(finals) => finals.get(usize::from(joint.joint)).copied().unwrap_or(Mat4::IDENTITY),
    };
    if joint.turn == Mat3::IDENTITY { matrix } else { matrix * Mat4::from_mat3(joint.turn) }
}

/// Returns `[P] * hull - [N] * hull`.
fn weighted(hull: AxisBox, reach: &PartReach) -> AxisBox {
    if hull.is_empty() {
        return hull;
    }
    let ([p0, p1], [n0, n1]) = (reach.positive, reach.negative);
    let mut min = (hull.min * p0).min(hull.min * p1);
    let mut max = (hull.max * p0).max(hull.max * p1);
    if n1 > 0.0 {
        min -= (hull.max * n0).max(hull.max * n1);
        max -= (hull.min * n0).min(hull.min * n1);
    }
    let slack = widening(hull.min.abs().max(hull.max.abs()) * (p1 + n1));
    AxisBox { min: min - slack, max: max + slack }.or_whole()
}

/// Returns the distance from `center` to the furthest corner of `extent`.
fn furthest(center: Vec3, extent: AxisBox) -> f64 {
    let center = center.as_dvec3();
    (extent.min.as_dvec3() - center).abs().max((extent.max.as_dvec3() - center).abs()).length()
}

/// Returns the distance from `center` to the furthest corner of `extent` moved by `matrix`.
fn corner(extent: &AxisBox, matrix: &Mat4, center: Vec3) -> f64 {
    let (middle, half) = (extent.center(), extent.half().as_dvec3());
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().as_dvec3());
    let [x, y, z] = [axes[0] * half.x, axes[1] * half.y, axes[2] * half.z];
    let from = matrix.transform_point3(middle).as_dvec3() - center.as_dvec3();
    let mut furthest = 0.0_f64;
    for corner in [x + y + z, x + y - z, x - y + z, y + z - x] {
        // `from + corner` and `from - corner` are opposite corners.
        furthest = furthest.max((from + corner).length_squared()).max((from - corner).length_squared());
    }
    let sizes = (middle.abs() + extent.half()).as_dvec3();
    let summed = axes[0].abs() * sizes.x + axes[1].abs() * sizes.y + axes[2].abs() * sizes.z;
    let summed = summed.length() + matrix.w_axis.truncate().as_dvec3().length();
    furthest.sqrt() + summed * f64::from(ROUNDING)
}
