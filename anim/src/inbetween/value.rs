//! Values of keys as the in-between tools calculate with them.

use crate::trig::rotation_of_vector;
use glam::{DQuat, DVec3, Quat, Vec3};

/// A value of a key: a number, a vector or a rotation.
pub trait KeyValue: Copy {
    /// Returns the value `amount` of the way from `a` to `b`: 0 is `a`, 1 is `b`, and other amounts lie before or beyond.
    ///
    /// ```text
    /// numbers, vectors   a + amount * (b - a)
    /// rotations          a * exp(amount * log(a⁻¹ * b)), with the sign of b for which the angle is at most 180°
    /// ```
    ///
    /// An amount of 0 returns `a` bit for bit.
    fn mix(a: Self, b: Self, amount: f64) -> Self;

    /// Returns the value on the opposite side of `center`: `2 * center - value`; for rotations `center * value⁻¹ * center`.
    fn reflected(self, center: Self) -> Self;

    /// Returns the numbers that filters work on; those that the value does not have are zero.
    fn numbers(self) -> [f64; 4];

    /// Returns the value of filtered numbers; `otherwise` where they are not one.
    fn of_numbers(numbers: [f64; 4], otherwise: Self) -> Self;

    /// Returns the same value, as a quaternion with the sign nearer to `to`.
    fn near(self, _to: Self) -> Self {
        self
    }
}

macro_rules! numbers {
    ($type:ty) => {
        impl KeyValue for $type {
            fn mix(a: Self, b: Self, amount: f64) -> Self {
                if amount == 0.0 {
                    return a;
                }
                let (from, to) = (f64::from(a), f64::from(b));
                (from + amount * (to - from)) as Self
            }

            fn reflected(self, center: Self) -> Self {
                2.0 * center - self
            }

            fn numbers(self) -> [f64; 4] {
                [f64::from(self), 0.0, 0.0, 0.0]
            }

            fn of_numbers(numbers: [f64; 4], otherwise: Self) -> Self {
                let value = numbers[0] as Self;
                if value.is_finite() { value } else { otherwise }
            }
        }
    };
}

numbers!(f32);
numbers!(f64);

impl KeyValue for Vec3 {
    fn mix(a: Self, b: Self, amount: f64) -> Self {
        if amount == 0.0 {
            return a;
        }
        let (from, to) = (a.as_dvec3(), b.as_dvec3());
        (from + (to - from) * amount).as_vec3()
    }

    fn reflected(self, center: Self) -> Self {
        2.0 * center - self
    }

    fn numbers(self) -> [f64; 4] {
        let [x, y, z] = self.as_dvec3().to_array();
        [x, y, z, 0.0]
    }

    fn of_numbers([x, y, z, _]: [f64; 4], otherwise: Self) -> Self {
        let value = DVec3::new(x, y, z).as_vec3();
        if value.is_finite() { value } else { otherwise }
    }
}

impl KeyValue for Quat {
    fn mix(a: Self, b: Self, amount: f64) -> Self {
        if amount == 0.0 {
            return a;
        }
        let from = a.as_dquat();
        let turn = rotation_of_vector(log(from.conjugate() * b.as_dquat()) * amount);
        Self::of_numbers((from * turn).to_array(), a)
    }

    fn reflected(self, center: Self) -> Self {
        let center_in_double = center.as_dquat();
        let other = center_in_double * self.as_dquat().conjugate() * center_in_double;
        Self::of_numbers(other.to_array(), center)
    }

    fn numbers(self) -> [f64; 4] {
        self.as_dquat().to_array()
    }

    fn of_numbers(numbers: [f64; 4], otherwise: Self) -> Self {
        let rotation = DQuat::from_array(numbers);
        let length = rotation.length();
        if length > 1e-9 && length.is_finite() { (rotation / length).as_quat() } else { otherwise }
    }

    fn near(self, to: Self) -> Self {
        if self.dot(to) < 0.0 { -self } else { self }
    }
}

/// Returns the rotation vector of a rotation: its axis times its angle in radians, at most 180°.
fn log(rotation: DQuat) -> DVec3 {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    let vector = DVec3::new(rotation.x, rotation.y, rotation.z);
    let sine = vector.length();
    if sine == 0.0 { DVec3::ZERO } else { vector / sine * (2.0 * libm::atan2(sine, rotation.w)) }
}
