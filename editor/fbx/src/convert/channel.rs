//! Channels of fitted keys.

use crate::fit::{FitKind, FittedKeys};
use dragonfly_anim::data::{Channel, Interpolation};
use glam::{Quat, Vec3};

/// Returns how values between fitted keys are computed.
pub(super) fn interpolation<V>(keys: &FittedKeys<V>, kind: FitKind) -> Interpolation {
    match kind {
        FitKind::Step => Interpolation::Step,
        FitKind::Lines | FitKind::Given => Interpolation::Linear,
        FitKind::Smooth if keys.tangents.is_empty() => Interpolation::Linear,
        FitKind::Smooth => Interpolation::CubicSpline,
    }
}

/// FourNumbers of a value, to compare two.
pub(super) trait FourNumbers: Copy {
    fn components(self) -> [f32; 4];
}

impl FourNumbers for Vec3 {
    fn components(self) -> [f32; 4] {
        self.extend(0.0).to_array()
    }
}

impl FourNumbers for Quat {
    fn components(self) -> [f32; 4] {
        self.to_array()
    }
}

/// Returns whether two values are equal as far as single precision goes.
fn is_same<T: FourNumbers>(a: T, b: T) -> bool {
    let (a, b) = (a.components(), b.components());
    let size = b.iter().fold(1e-3_f32, |size, number| size.max(number.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-6 * size)
}

/// Returns the channel of fitted keys. A motion that is constant has one key, or none if it is the value at rest.
pub(super) fn channel<V, T: FourNumbers>(
    keys: &FittedKeys<V>,
    kind: FitKind,
    rest: &T,
    value: impl Fn(&V) -> T,
    tangent: impl Fn(&V) -> T,
) -> Channel<T> {
    let values: Vec<T> = keys.values.iter().map(value).collect();
    let Some(&first) = values.first() else { return Channel::default() };
    if keys.tangents.is_empty() && values.iter().all(|&value| is_same(value, first)) {
        if is_same(first, *rest) {
            return Channel::default();
        }
        return Channel::new(&keys.times[..1], &values[..1], Interpolation::Linear);
    }
    if keys.tangents.is_empty() {
        return Channel::new(&keys.times[..], values, interpolation(keys, kind));
    }
    let triples = values.iter().zip(&keys.tangents);
    let triples: Vec<T> =
        triples.flat_map(|(&value, [arrives, leaves])| [tangent(arrives), value, tangent(leaves)]).collect();
    Channel::new(&keys.times[..], triples, Interpolation::CubicSpline)
}

/// Replaces a channel of at most one key by two keys of the same value.
pub(super) fn hold<T: Copy>(channel: &mut Channel<T>, rest: T, start: f32, end: f32) {
    let value = channel.value(0).unwrap_or(rest);
    *channel = Channel::new(vec![start, end], vec![value, value], Interpolation::Linear);
}
