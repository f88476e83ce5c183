//! The rules by which a layer changes a translation, a rotation, a scale.

use crate::data::{Channel, Track};
use crate::sample::Value;
use crate::sample::mix::{lerp, slerp};
use glam::{Quat, Vec3};

/// The effect of one layer at one time.
#[derive(Clone, Copy, Debug)]
pub struct LayerSum<V> {
    /// The value below the layer.
    pub below: V,
    /// The key of the layer at that time.
    pub offset: V,
    /// The weight of the layer, at least 0.
    pub weight: f32,
    /// The part of the offset that is added.
    pub part: V,
}

/// The rule of one channel of a bone; the formulas are in [the module](super).
pub trait LayerRule {
    /// The value of a key.
    type Value: Value + PartialEq;
    /// The offset that changes nothing.
    const IDENTITY: Self::Value;

    /// Returns the channel of a track.
    fn channel(track: &Track) -> &Channel<Self::Value>;

    /// Returns the channel of a track, to be modified.
    fn channel_mut(track: &mut Track) -> &mut Channel<Self::Value>;

    /// Returns the part of an offset that a layer of this weight adds.
    fn part(offset: Self::Value, weight: f32) -> Self::Value;

    /// Adds a part of an offset.
    fn add(below: Self::Value, part: Self::Value) -> Self::Value;

    /// Returns the tangent of the sum of a spline and a part that does not change.
    fn tangent(tangent: Self::Value, part: Self::Value) -> Self::Value;

    /// Returns the value to which adding the part gives `sum`; `None` where there is none.
    fn subtract(sum: Self::Value, part: Self::Value) -> Option<Self::Value>;

    /// Returns a bound of how far the sum of a value and a part is from a line between two times, where either the offset or the
    /// weight goes a straight way and the other stays. `off` is such a bound for the value below.
    fn bend(ends: [LayerSum<Self::Value>; 2], off: f32) -> f32;

    /// Returns the offset that, added to `below` with this weight, gives `sum`; `None` where there is none.
    fn offset(below: Self::Value, sum: Self::Value, weight: f32) -> Option<Self::Value>;

    /// Returns the value on the way from `below` to `value`: the weight 0 is `below`, 1 is `value`, more is beyond it.
    fn mix(below: Self::Value, value: Self::Value, weight: f32) -> Self::Value;

    /// Goes beyond `value`, so that [`Self::mix`] with `weight` leads from `below` back to it; `None` where it would lead another
    /// way, because the rotation would be more than half a turn.
    fn beyond(below: Self::Value, value: Self::Value, weight: f32) -> Option<Self::Value> {
        let beyond = Self::mix(below, value, 1.0 / weight);
        beyond.is_finite().then_some(beyond)
    }

    /// Returns the value in the form that is nearer to a neighbor: the quaternions q and -q are the same rotation.
    fn near(value: Self::Value, _neighbor: Self::Value) -> Self::Value {
        value
    }

    /// Returns how far two values are apart: meters, radians, or factors; the largest of the axes.
    fn distance(a: Self::Value, b: Self::Value) -> f32;
}

/// Translations, meters in parent space.
#[derive(Clone, Copy, Debug)]
pub enum TranslationRule {}

/// Rotations, in parent space.
#[derive(Clone, Copy, Debug)]
pub enum RotationRule {}

/// Scales, factors per axis.
#[derive(Clone, Copy, Debug)]
pub enum ScaleRule {}

impl LayerRule for TranslationRule {
    type Value = Vec3;
    const IDENTITY: Vec3 = Vec3::ZERO;

    fn channel(track: &Track) -> &Channel<Vec3> {
        &track.translation
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Vec3> {
        &mut track.translation
    }

    fn part(offset: Vec3, weight: f32) -> Vec3 {
        offset * weight
    }

    fn add(below: Vec3, part: Vec3) -> Vec3 {
        (below + part).healed(below)
    }

    fn tangent(tangent: Vec3, _part: Vec3) -> Vec3 {
        tangent
    }

    fn subtract(sum: Vec3, part: Vec3) -> Option<Vec3> {
        finite(sum - part)
    }

    /// The sum of two lines is a line.
    fn bend(_: [LayerSum<Vec3>; 2], off: f32) -> f32 {
        off
    }

    fn offset(below: Vec3, sum: Vec3, weight: f32) -> Option<Vec3> {
        finite((sum - below) / weight)
    }

    fn mix(below: Vec3, value: Vec3, weight: f32) -> Vec3 {
        exact_ends(below, value, weight).unwrap_or_else(|| lerp(below, value, weight).healed(below))
    }

    fn distance(a: Vec3, b: Vec3) -> f32 {
        (a - b).abs().max_element()
    }
}

impl LayerRule for RotationRule {
    type Value = Quat;
    const IDENTITY: Quat = Quat::IDENTITY;

    fn channel(track: &Track) -> &Channel<Quat> {
        &track.rotation
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Quat> {
        &mut track.rotation
    }

    fn part(offset: Quat, weight: f32) -> Quat {
        power(offset, weight)
    }

    fn add(below: Quat, part: Quat) -> Quat {
        if part == Quat::IDENTITY { below } else { unit(part * below).healed(below) }
    }

    fn tangent(tangent: Quat, part: Quat) -> Quat {
        part * tangent
    }

    fn subtract(sum: Quat, part: Quat) -> Option<Quat> {
        let value = unit(part.conjugate() * sum);
        value.is_finite().then_some(value)
    }

    /// The product of two turns at constant speed, by the angles x and y, changes its angular velocity by at most x·y, and so is
    /// within about x·y/8 of the turn at constant speed between its ends. The part w of an offset that turns by the angle y, at an
    /// angle below half a turn, is within about w·y²/2 of such a turn. Twice that is safe for the angles that are allowed.
    fn bend([from, to]: [LayerSum<Quat>; 2], off: f32) -> f32 {
        let turned = Self::distance(from.offset, to.offset);
        let (weight, change) = (from.weight.max(to.weight), (to.weight - from.weight).abs());
        let part = weight * turned + change * Self::distance(from.offset, Quat::IDENTITY);
        let below = Self::distance(from.below, to.below);
        let power = if turned == 0.0 || weight == 1.0 { 0.0 } else { weight * turned * turned };
        let is_far = |offset: Quat| offset.w.abs() < 0.1;
        if below + part > 1.0 || power > 0.0 && (turned > 0.1 || is_far(from.offset) || is_far(to.offset)) {
            return f32::INFINITY;
        }
        off + power + below * part / 4.0
    }

    fn offset(below: Quat, sum: Quat, weight: f32) -> Option<Quat> {
        let turn = unit(sum * below.conjugate());
        let turn = Self::near(turn, Quat::IDENTITY);
        is_short(turn, weight).then(|| power(turn, 1.0 / weight)).filter(|whole| whole.is_finite())
    }

    fn mix(below: Quat, value: Quat, weight: f32) -> Quat {
        exact_ends(below, value, weight).unwrap_or_else(|| slerp(below, value, weight).healed(below))
    }

    fn beyond(below: Quat, value: Quat, weight: f32) -> Option<Quat> {
        let turn = Self::near(value * below.conjugate(), Quat::IDENTITY);
        let beyond = Self::mix(below, value, 1.0 / weight);
        (is_short(turn, weight) && beyond.is_finite()).then_some(beyond)
    }

    fn near(value: Quat, neighbor: Quat) -> Quat {
        if value.dot(neighbor) < 0.0 { -value } else { value }
    }

    fn distance(a: Quat, b: Quat) -> f32 {
        let b = if a.dot(b) < 0.0 { -b } else { b };
        // The length of the chord is the sine of a quarter of the angle, twice.
        2.0 * (a - b).length()
    }
}

impl LayerRule for ScaleRule {
    type Value = Vec3;
    const IDENTITY: Vec3 = Vec3::ONE;

    fn channel(track: &Track) -> &Channel<Vec3> {
        &track.scale
    }

    fn channel_mut(track: &mut Track) -> &mut Channel<Vec3> {
        &mut track.scale
    }

    fn part(offset: Vec3, weight: f32) -> Vec3 {
        if weight == 1.0 { offset } else { Vec3::ONE + (offset - Vec3::ONE) * weight }
    }

    fn add(below: Vec3, part: Vec3) -> Vec3 {
        (below * part).healed(below)
    }

    fn tangent(tangent: Vec3, part: Vec3) -> Vec3 {
        tangent * part
    }

    fn subtract(sum: Vec3, part: Vec3) -> Option<Vec3> {
        finite(sum / part)
    }

    /// The product of two lines is a parabola, which is off by a quarter of the product of both ways.
    fn bend([from, to]: [LayerSum<Vec3>; 2], off: f32) -> f32 {
        let largest = from.part.abs().max(to.part.abs()).max_element();
        off * largest + Self::distance(from.below, to.below) * Self::distance(from.part, to.part) / 4.0
    }

    fn offset(below: Vec3, sum: Vec3, weight: f32) -> Option<Vec3> {
        let ratio = |axis: usize| if sum[axis] == below[axis] { 1.0 } else { sum[axis] / below[axis] };
        finite(Vec3::ONE + (Vec3::new(ratio(0), ratio(1), ratio(2)) - Vec3::ONE) / weight)
    }

    fn mix(below: Vec3, value: Vec3, weight: f32) -> Vec3 {
        TranslationRule::mix(below, value, weight)
    }

    fn distance(a: Vec3, b: Vec3) -> f32 {
        TranslationRule::distance(a, b)
    }
}

fn finite(vector: Vec3) -> Option<Vec3> {
    vector.is_finite().then_some(vector)
}

/// Returns the end itself, to the bit, for the weights 0 and 1.
fn exact_ends<T>(from: T, to: T, weight: f32) -> Option<T> {
    match weight {
        0.0 => Some(from),
        1.0 => Some(to),
        _ => None,
    }
}

/// Returns whether the part `weight` of some rotation by less than half a turn is `part`.
fn is_short(part: Quat, weight: f32) -> bool {
    let angle = 2.0 * libm::atan2f(part.xyz().length(), part.w.abs());
    weight >= 1.0 || angle < weight * (std::f32::consts::PI - 1e-3)
}

/// Returns the rotation about the same axis by `exponent` times the angle, the short way.
fn power(rotation: Quat, exponent: f32) -> Quat {
    if exponent == 1.0 {
        rotation
    } else {
        exact_ends(Quat::IDENTITY, rotation, exponent)
            .unwrap_or_else(|| slerp(Quat::IDENTITY, rotation, exponent))
    }
}

/// Normalizes as exactly as single precision allows, so that a saved file needs no correction.
fn unit(rotation: Quat) -> Quat {
    rotation.as_dquat().normalize().as_quat()
}
