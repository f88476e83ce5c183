//! The points that a bone must keep in position, and the rotation that does it best.

use super::frames::SampledFrames;
use super::settings::Exactness;
use crate::trig::rotation_of_vector;
use glam::{Affine3A, Mat3, Quat, Vec3};

/// A point rigidly attached to a bone.
#[derive(Clone, Copy, Debug)]
pub(super) struct RigidPoint {
    /// Position in the space of the bone.
    pub(super) local: Vec3,
    /// The bone that it belongs to: the bone itself, or a descendant rigidly attached to it.
    pub(super) owner: usize,
    /// The same point in the owner's space.
    pub(super) of_owner: Vec3,
    /// Allowed distance from its position in the raw take.
    pub(super) limit: f32,
}

impl RigidPoint {
    /// Returns the position in the raw take: scene space.
    pub(super) fn raw(&self, frames: &SampledFrames, frame: usize) -> Vec3 {
        frames.to_root(frame, self.owner).transform_point3(self.of_owner)
    }

    /// Returns the largest distance of `points` from their raw positions, in units of their limits.
    pub(super) fn share(points: &[Self], raw: &[Vec3], to_root: &Affine3A) -> f32 {
        let mut largest = 0.0_f32;
        for (point, raw) in points.iter().zip(raw) {
            let share = to_root.transform_point3(point.local).distance(*raw) / point.limit;
            // NaN counts as the largest.
            if share > largest || share.is_nan() {
                largest = share;
            }
        }
        largest
    }
}

/// Returns the three shell points of a bone, in its space.
pub(super) fn shell(exactness: &Exactness) -> [Vec3; 3] {
    [Vec3::X * exactness.shell, Vec3::Y * exactness.shell, Vec3::Z * exactness.shell]
}

/// Returns the rotation near `rotation` that moves arms closest to their aims, by least squares.
///
/// With `r = rotation * arm` and a small turn `d`: `d × r ≈ aim - r`, so
///
/// ```text
/// Σ w (r·r 1 - r rᵀ) d = Σ w r × (aim - r)
/// ```
///
/// Arms and aims start at the bone's origin and are in its parent's space; the weight is the square of one over the
/// limit. So the error of a parent in this bone's position is corrected at the bone's end, and errors do not add up
/// down the chain.
pub(super) fn aimed(rotation: Quat, arms: impl Iterator<Item = (Vec3, Vec3, f32)>) -> Quat {
    let (mut matrix, mut sum, mut unit) = (Mat3::ZERO, Vec3::ZERO, 0.0);
    for (arm, aim, limit) in arms {
        // The first limit is the unit of the others: their squares could underflow.
        unit = if unit == 0.0 { limit } else { unit };
        let weight = (unit / limit) * (unit / limit);
        let r = rotation * arm;
        let outer = Mat3::from_cols(r * r.x, r * r.y, r * r.z);
        matrix += (Mat3::from_diagonal(Vec3::splat(r.length_squared())) - outer) * weight;
        sum += r.cross(aim - r) * weight;
    }
    let turn = matrix.inverse() * sum;
    // A large turn indicates a pose that no rotation can reach.
    if matrix.determinant() > 0.0 && turn.is_finite() && turn.length() < LARGEST_TURN {
        (rotation_of_vector(turn.as_dvec3()).as_quat() * rotation).normalize()
    } else {
        rotation
    }
}

/// Radians.
const LARGEST_TURN: f32 = 0.1;
