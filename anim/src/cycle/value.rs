//! Values that can be moved on from cycle to cycle.

use crate::trig::rotation_of_vector;
use glam::{DQuat, Quat, Vec3};

/// A value of a key that cycles can offset.
pub trait CycleValue: Copy + std::ops::Mul<f32, Output = Self> {
    /// The difference from the start of a cycle to its end.
    type Offset: Copy;

    /// Returns the difference from `first` to `last`.
    fn offset(first: Self, last: Self) -> Self::Offset;

    /// Returns a value `count` cycles later; negative numbers are earlier.
    fn moved(value: Self, offset: Self::Offset, count: i32) -> Self;

    /// Returns a tangent `count` cycles later.
    fn moved_tangent(tangent: Self, offset: Self::Offset, count: i32) -> Self;
}

impl CycleValue for Vec3 {
    type Offset = Vec3;

    fn offset(first: Self, last: Self) -> Vec3 {
        last - first
    }

    fn moved(value: Self, offset: Vec3, count: i32) -> Self {
        (value.as_dvec3() + offset.as_dvec3() * f64::from(count)).as_vec3()
    }

    fn moved_tangent(tangent: Self, _offset: Vec3, _count: i32) -> Self {
        tangent
    }
}

impl CycleValue for Quat {
    /// The rotation in the space of the parent.
    type Offset = DQuat;

    fn offset(first: Self, last: Self) -> DQuat {
        let by = last.as_dquat().normalize() * first.as_dquat().normalize().conjugate();
        let by = if by.w < 0.0 { -by } else { by };
        if by.is_finite() { by } else { DQuat::IDENTITY }
    }

    fn moved(value: Self, offset: DQuat, count: i32) -> Self {
        let moved = (power(offset, count) * value.as_dquat()).as_quat();
        if moved.length_squared() > 1e-12 { moved.normalize() } else { value }
    }

    fn moved_tangent(tangent: Self, offset: DQuat, count: i32) -> Self {
        (power(offset, count) * tangent.as_dquat()).as_quat()
    }
}

/// Returns a rotation by the angle of `by` times `count`.
fn power(by: DQuat, count: i32) -> DQuat {
    let sine = by.xyz().length();
    if sine == 0.0 {
        return DQuat::IDENTITY;
    }
    rotation_of_vector(by.xyz() / sine * (2.0 * libm::atan2(sine, by.w) * f64::from(count)))
}

/// A scale, which is moved on by factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleValue(pub Vec3);

impl std::ops::Mul<f32> for ScaleValue {
    type Output = Self;

    fn mul(self, by: f32) -> Self {
        Self(self.0 * by)
    }
}

impl CycleValue for ScaleValue {
    type Offset = Vec3;

    fn offset(first: Self, last: Self) -> Vec3 {
        let factor = |first: f32, last: f32| if first.abs() > 1e-6 { last / first } else { 1.0 };
        Vec3::new(factor(first.0.x, last.0.x), factor(first.0.y, last.0.y), factor(first.0.z, last.0.z))
    }

    fn moved(value: Self, offset: Vec3, count: i32) -> Self {
        let scaled = value.0.as_dvec3() * offset.as_dvec3().map(|factor| integer_power(factor, count));
        let scaled = scaled.as_vec3();
        if scaled.is_finite() { Self(scaled) } else { value }
    }

    fn moved_tangent(tangent: Self, offset: Vec3, count: i32) -> Self {
        Self::moved(tangent, offset, count)
    }
}

/// Returns the same power on every system.
fn integer_power(factor: f64, count: i32) -> f64 {
    let mut power = 1.0;
    for _ in 0..count.unsigned_abs().min(100_000) {
        power *= factor;
    }
    if count < 0 { 1.0 / power } else { power }
}
