//! The points that a bone must bring to the right place, and the rotation that does it best.

use super::frames::Frames;
use super::settings::Exactness;
use glam::{Affine3A, Mat3, Quat, Vec3};

/// A point that moves with a bone as one body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// In the space of the bone.
    pub(super) local: Vec3,
    /// The bone that it belongs to: the bone itself, or one that hangs on it rigidly.
    pub(super) owner: usize,
    /// The same point in the owner's space.
    pub(super) of_owner: Vec3,
    /// Distance allowed from where the raw take has it.
    pub(super) limit: f32,
}

impl Point {
    /// Where the raw take has it: scene space.
    pub(super) fn raw(&self, frames: &Frames, frame: usize) -> Vec3 {
        frames.to_root(frame, self.owner).transform_point3(self.of_owner)
    }

    /// The largest distance of `points` from where the raw take has them, in units of their limits.
    pub(super) fn share(points: &[Self], raw: &[Vec3], to_root: &Affine3A) -> f32 {
        let mut largest = 0.0_f32;
        for (point, raw) in points.iter().zip(raw) {
            let share = to_root.transform_point3(point.local).distance(*raw) / point.limit;
            // NaN is the largest of all.
            if share > largest || share.is_nan() {
                largest = share;
            }
        }
        largest
    }
}

/// The three points on the shell of a bone, in its space.
pub(super) fn shell(exactness: &Exactness) -> [Vec3; 3] {
    [Vec3::X * exactness.shell, Vec3::Y * exactness.shell, Vec3::Z * exactness.shell]
}

/// The rotation near `rotation` that brings arms to their aims as nearly as one can, by least squares.
///
/// With `r = rotation * arm` and a small turn `d`: `d × r ≈ aim - r`, so
///
/// ```text
/// Σ w (r·r 1 - r rᵀ) d = Σ w r × (aim - r)
/// ```
///
/// Arms and aims start in the bone's origin and are in its parent's space; the weight is the square of one over the
/// limit. An error that a parent made in the place of this bone is taken back at its end this way, so errors do not
/// add up down the chain.
pub(super) fn aimed(rotation: Quat, arms: impl Iterator<Item = (Vec3, Vec3, f32)>) -> Quat {
    let (mut matrix, mut sum, mut unit) = (Mat3::ZERO, Vec3::ZERO, 0.0);
    for (arm, aim, limit) in arms {
        // The first limit is the unit of the others: their squares could be too small for a number.
        unit = if unit == 0.0 { limit } else { unit };
        let weight = (unit / limit) * (unit / limit);
        let r = rotation * arm;
        let outer = Mat3::from_cols(r * r.x, r * r.y, r * r.z);
        matrix += (Mat3::from_diagonal(Vec3::splat(r.length_squared())) - outer) * weight;
        sum += r.cross(aim - r) * weight;
    }
    let turn = matrix.inverse() * sum;
    // A large turn is a sign of a pose that no rotation can reach.
    if matrix.determinant() > 0.0 && turn.is_finite() && turn.length() < LARGEST_TURN {
        (Quat::from_scaled_axis(turn) * rotation).normalize()
    } else {
        rotation
    }
}

/// Radians.
const LARGEST_TURN: f32 = 0.1;
