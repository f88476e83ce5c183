//! Offset of keys: the same change in parent space for many keys, for example "the arm 20° higher in the whole take".
//!
//! ```text
//! translation   key' = key + d
//! rotation      key' = d * key            the same rotation about the axes of the parent, after that of the key
//! scale         key' = key * d            per component
//! ```
//!
//! These are the rules of additive layers ([`crate::blend::add`]), written into the keys.
//!
//! # Tangents
//!
//! Each rule is affine in the key, so a tangent of a cubic spline is mapped by its linear part: that of a translation stays, that
//! of a rotation is multiplied by the quaternion `d` from the left, that of a scale by the factors.
//!
//! # Between keys
//!
//! Where both keys around a time get the whole offset, the curve between them gets exactly that offset as well, within
//! rounding. For translation and scale, linear and cubic interpolation are affine in the keys. For rotation, multiplying unit
//! quaternions by `d` from the left keeps all angles between them, so the great arc of `slerp` is turned as a whole; the Hermite
//! spline is linear in keys and tangents, and normalizing it commutes with the product.
//!
//! Where the keys get different parts of it ([`KeyOffset::part`]), the curve still goes through the new keys. Between two linear keys
//! a translation and a scale then get the linearly interpolated part, exactly. A rotation follows the great arc between the
//! two new keys, which is only near to the interpolated part, and tangents do not follow the slope of the parts: they are mapped
//! as if the part were constant.
//!
//! # Sign
//!
//! `q` and `-q` are the same rotation, and a spline from one to the other turns the long way. The factor `d` is the same
//! for all keys, so keys with the same sign keep the same sign: no key is flipped on its own.

mod falloff;

pub use falloff::{Falloff, FalloffShape, KeyWeight, weights_of_keys, weights_of_range};

use crate::data::{Channel, Interpolation};
use crate::sample::Value;
use crate::sample::mix::slerp;
use glam::{Quat, Vec3};

/// An offset of the keys of a channel.
pub trait KeyOffset: Copy + PartialEq {
    /// The value of a key.
    type Value: Value + PartialEq;
    /// The offset that changes nothing.
    const IDENTITY: Self;

    /// Returns the offset that turns `from` into `to`; the identity where they are equal. `None` where there is none.
    fn between(from: Self::Value, to: Self::Value) -> Option<Self>;

    /// Returns a part of the offset: nothing of it for 0, all of it, to the bit, for 1. Other weights count as the nearer of
    /// both, NaN as 0.
    fn part(self, weight: f32) -> Self;

    /// Returns the offset of a value.
    fn value(self, value: Self::Value) -> Self::Value;

    /// Returns the tangent that a tangent is mapped to.
    fn tangent(self, tangent: Self::Value) -> Self::Value;

    /// Returns the offset that undoes this one; `None` for a scale by 0.
    fn inverse(self) -> Option<Self>;
}

/// Adds a vector to translations, in parent space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedTranslation(pub Vec3);

/// Rotates about the axes of the parent. The quaternion has unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParentRotation(pub Quat);

/// Multiplies scales, per component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleFactors(pub Vec3);

/// Returns the weight, between 0 and 1.
fn clamped(weight: f32) -> f32 {
    if weight > 0.0 { weight.min(1.0) } else { 0.0 }
}

impl KeyOffset for AddedTranslation {
    type Value = Vec3;
    const IDENTITY: Self = Self(Vec3::ZERO);

    fn between(from: Vec3, to: Vec3) -> Option<Self> {
        let by = to - from;
        by.is_finite().then_some(Self(by))
    }

    fn part(self, weight: f32) -> Self {
        Self(self.0 * clamped(weight))
    }

    fn value(self, value: Vec3) -> Vec3 {
        value + self.0
    }

    fn tangent(self, tangent: Vec3) -> Vec3 {
        tangent
    }

    fn inverse(self) -> Option<Self> {
        Some(Self(-self.0))
    }
}

impl KeyOffset for ParentRotation {
    type Value = Quat;
    const IDENTITY: Self = Self(Quat::IDENTITY);

    fn between(from: Quat, to: Quat) -> Option<Self> {
        if from == to || from == -to {
            return Some(Self::IDENTITY);
        }
        let turn = to.as_dquat() * from.as_dquat().conjugate();
        let length = turn.length();
        // The short way round: a part of it is a part of the smaller angle.
        let turn = if turn.w < 0.0 { -turn } else { turn };
        (length > 1e-12 && length.is_finite()).then(|| Self((turn / length).as_quat()))
    }

    fn part(self, weight: f32) -> Self {
        match clamped(weight) {
            0.0 => Self::IDENTITY,
            1.0 => self,
            weight => Self(slerp(Quat::IDENTITY, self.0, weight)),
        }
    }

    fn value(self, value: Quat) -> Quat {
        if self == Self::IDENTITY {
            return value;
        }
        (self.0.as_dquat() * value.as_dquat()).normalize().as_quat()
    }

    fn tangent(self, tangent: Quat) -> Quat {
        if self == Self::IDENTITY { tangent } else { self.0 * tangent }
    }

    fn inverse(self) -> Option<Self> {
        Some(Self(self.0.conjugate()))
    }
}

impl KeyOffset for ScaleFactors {
    type Value = Vec3;
    const IDENTITY: Self = Self(Vec3::ONE);

    fn between(from: Vec3, to: Vec3) -> Option<Self> {
        let mut factors = Vec3::ONE;
        for axis in 0..3 {
            if from[axis] != to[axis] {
                factors[axis] = to[axis] / from[axis];
            }
        }
        factors.is_finite().then_some(Self(factors))
    }

    fn part(self, weight: f32) -> Self {
        match clamped(weight) {
            1.0 => self,
            weight => Self(Vec3::ONE + (self.0 - Vec3::ONE) * weight),
        }
    }

    fn value(self, value: Vec3) -> Vec3 {
        value * self.0
    }

    fn tangent(self, tangent: Vec3) -> Vec3 {
        tangent * self.0
    }

    fn inverse(self) -> Option<Self> {
        let factors = self.0.recip();
        factors.is_finite().then_some(Self(factors))
    }
}

/// Returns a channel whose keys have their parts of an offset. A key that is not in `weights`, or whose part is the identity, stays as
/// it is to the bit.
pub fn offset_keys<O: KeyOffset>(
    channel: &Channel<O::Value>,
    offset: O,
    weights: &[KeyWeight],
) -> Channel<O::Value> {
    let mut values = channel.values.to_vec();
    for &KeyWeight { key, weight } in weights {
        let part = offset.part(weight);
        if part == O::IDENTITY {
            continue;
        }
        let key = key as usize;
        if channel.interpolation == Interpolation::CubicSpline {
            if let Some([arrive, value, leave]) = values.get_mut(key * 3..key * 3 + 3) {
                *arrive = part.tangent(*arrive);
                *value = part.value(*value);
                *leave = part.tangent(*leave);
            }
        } else if let Some(value) = values.get_mut(key) {
            *value = part.value(*value);
        }
    }
    Channel { values: values.into(), ..channel.clone() }
}
