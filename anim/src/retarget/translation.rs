//! Translations and scales of one bone, relative to the rest pose.

use crate::data::Channel;
use crate::data::Interpolation;
use crate::sample::Value;
use glam::{DMat3, Vec3};

/// Returns `x_t0 + map (x_s - x_s0)` key by key; the linear part alone for a spline's tangents.
///
/// No keys where the source has none, or where `map` is not finite.
pub(super) fn carried(
    channel: &Channel<Vec3>,
    source_rest: Vec3,
    target_rest: Vec3,
    map: DMat3,
) -> Channel<Vec3> {
    if !map.is_finite() {
        return Channel::default();
    }
    changed(
        channel,
        source_rest,
        |value| (map * value.as_dvec3()).as_vec3(),
        |value| (target_rest.as_dvec3() + map * (value.as_dvec3() - source_rest.as_dvec3())).as_vec3(),
    )
}

/// Returns `s_t0 · s_s / s_s0` per axis, key by key; an axis with scale zero in the source's rest pose keeps the
/// target's rest scale.
pub(super) fn scaled(channel: &Channel<Vec3>, source_rest: Vec3, target_rest: Vec3) -> Channel<Vec3> {
    let factor = Vec3::select(source_rest.cmpeq(Vec3::ZERO), Vec3::ZERO, target_rest / source_rest);
    let constant = Vec3::select(source_rest.cmpeq(Vec3::ZERO), target_rest, Vec3::ZERO);
    if !factor.is_finite() {
        return Channel::default();
    }
    changed(channel, source_rest, |value| value * factor, |value| value * factor + constant)
}

fn changed(
    channel: &Channel<Vec3>,
    rest: Vec3,
    tangent: impl Fn(Vec3) -> Vec3,
    value: impl Fn(Vec3) -> Vec3,
) -> Channel<Vec3> {
    let cubic = channel.interpolation == Interpolation::CubicSpline;
    let change = |(index, &stored): (usize, &Vec3)| {
        if cubic && index % 3 != 1 { tangent(stored) } else { value(stored.healed(rest)) }
    };
    Channel {
        times: channel.times.clone(),
        values: channel.values.iter().enumerate().map(change).collect(),
        interpolation: channel.interpolation,
    }
}
