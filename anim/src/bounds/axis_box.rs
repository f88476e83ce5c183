//! An axis-aligned box that can be empty, transformed, and widened for rounding.

use glam::{BVec3, Mat4, Vec3};

/// Sixteen units in the last place: an upper bound, with a margin, of the rounding error of a matrix product and a sum
/// of eight influences. Relative to the sizes of the terms, not to the size of the sum.
pub(crate) const ROUNDING: f32 = 16.0 * f32::EPSILON;

/// An axis-aligned box; empty where `min` is not at most `max`. Never NaN when made of finite points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisBox {
    /// The smallest coordinate along each axis.
    pub min: Vec3,
    /// The largest coordinate along each axis.
    pub max: Vec3,
}

impl AxisBox {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box that contains every finite point.
    pub const WHOLE: Self = Self { min: Vec3::MIN, max: Vec3::MAX };

    /// Creates a box of size zero at `point`.
    pub fn at(point: Vec3) -> Self {
        Self { min: point, max: point }
    }

    /// Returns whether the box contains nothing.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Returns whether `point` is inside, the faces included.
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Grows just enough to contain `point`; a point that is not finite is ignored.
    pub fn add(&mut self, point: Vec3) {
        if point.is_finite() {
            *self = self.union(Self::at(point));
        }
    }

    /// Returns the smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the middle; the origin when empty.
    pub fn center(&self) -> Vec3 {
        if self.is_empty() { Vec3::ZERO } else { self.min * 0.5 + self.max * 0.5 }
    }

    /// Returns half the size along each axis; zero when empty.
    pub fn half(&self) -> Vec3 {
        if self.is_empty() { Vec3::ZERO } else { self.max * 0.5 - self.min * 0.5 }
    }

    /// Returns the eight corners; none when empty.
    pub fn corners(&self) -> impl Iterator<Item = Vec3> {
        let Self { min, max } = *self;
        let corner = move |number: u32| {
            Vec3::select(BVec3::new(number & 1 != 0, number & 2 != 0, number & 4 != 0), max, min)
        };
        (0..if self.is_empty() { 0 } else { 8 }).map(corner)
    }

    /// Returns half the surface area, the usual measure of how likely a ray hits the box; zero when empty.
    pub fn half_surface(&self) -> f32 {
        let size = self.half() * 2.0;
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// Returns the box around this box moved by the affine `matrix` (Arvo 1990), widened so that it contains every
    /// moved point in spite of the rounding of `f32`.
    ///
    /// ```text
    /// center' = matrix * center          half' = |linear| * half + rounding
    /// ```
    ///
    /// Empty stays empty; where a number leaves the range of `f32`, the result is [`Self::WHOLE`].
    pub fn moved(&self, matrix: &Mat4) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let (center, half) = (self.center(), self.half());
        let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().abs());
        let sizes = center.abs() + half;
        let summed = x * sizes.x + y * sizes.y + z * sizes.z + matrix.w_axis.truncate().abs();
        let moved_half = x * half.x + y * half.y + z * half.z;
        Self::around(matrix.transform_point3(center), moved_half + widening(summed))
    }

    /// Creates a box from its center and half its size; [`Self::WHOLE`] where that is not finite.
    pub(crate) fn around(center: Vec3, half: Vec3) -> Self {
        Self { min: center - half, max: center + half }.or_whole()
    }

    /// Returns the box where every number is finite, and [`Self::WHOLE`] otherwise.
    pub(crate) fn or_whole(self) -> Self {
        if self.min.is_finite() && self.max.is_finite() { self } else { Self::WHOLE }
    }
}

/// Returns how far rounding can move a sum of terms whose sizes sum to `sizes`; the least normal number where all
/// vanish.
pub(crate) fn widening(sizes: Vec3) -> Vec3 {
    sizes * ROUNDING + Vec3::splat(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    #[test]
    fn a_moved_box_is_the_smallest_box_around_its_moved_corners_within_rounding() {
        let bounds = AxisBox { min: Vec3::new(-1.0, 2.0, 3.0), max: Vec3::new(4.0, 5.0, 9.0) };
        let turned = Quat::from_xyzw(0.3, -0.2, 0.5, 0.7).normalize();
        let matrix = Mat4::from_scale_rotation_translation(Vec3::new(1.0, -2.0, 0.5), turned, Vec3::X);
        let mut exact = AxisBox::EMPTY;
        for corner in 0..8 {
            let pick =
                |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
            exact.add(matrix.transform_point3(Vec3::new(pick(0), pick(1), pick(2))));
        }
        let moved = bounds.moved(&matrix);
        assert!(moved.contains(exact.min) && moved.contains(exact.max));
        assert!((moved.min - exact.min).length() < 1e-3 && (moved.max - exact.max).length() < 1e-3);
    }

    #[test]
    fn an_empty_box_stays_empty_and_a_box_that_overflows_becomes_the_whole_space() {
        assert!(AxisBox::EMPTY.moved(&Mat4::IDENTITY).is_empty());
        let bounds = AxisBox::at(Vec3::splat(1e30));
        assert_eq!(bounds.moved(&Mat4::from_scale(Vec3::splat(1e30))), AxisBox::WHOLE);
        let mut bounds = AxisBox::EMPTY;
        bounds.add(Vec3::NAN);
        assert!(bounds.is_empty());
    }
}
