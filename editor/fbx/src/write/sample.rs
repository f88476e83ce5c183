//! Channels sampled in double precision.

use super::euler::settled;
use dragonfly_anim::data::{Channel, Interpolation};
use glam::{DQuat, DVec3, DVec4, Quat, Vec3};

/// A value of a channel, as four numbers at most.
pub(super) trait SampledValue: Copy {
    /// Returns the numbers.
    fn numbers(self) -> DVec4;
    /// Returns the numbers between two values.
    fn between(start: DVec4, end: DVec4, part: f64) -> DVec4;
}

impl SampledValue for Vec3 {
    fn numbers(self) -> DVec4 {
        self.as_dvec3().extend(0.0)
    }

    fn between(start: DVec4, end: DVec4, part: f64) -> DVec4 {
        start * (1.0 - part) + end * part
    }
}

impl SampledValue for Quat {
    fn numbers(self) -> DVec4 {
        self.as_dquat().into()
    }

    fn between(start: DVec4, end: DVec4, part: f64) -> DVec4 {
        let end = if start.dot(end) < 0.0 { -end } else { end };
        let angle = 2.0 * libm::atan2((start - end).length(), (start + end).length());
        if angle < 1e-6 {
            return start * (1.0 - part) + end * part;
        }
        (start * libm::sin((1.0 - part) * angle) + end * libm::sin(part * angle)) / libm::sin(angle)
    }
}

/// Returns the value of a channel at a time in seconds, clamped outside its keys; `None` without keys.
pub(super) fn sample<T: SampledValue>(channel: &Channel<T>, at: f64) -> Option<DVec4> {
    let times = &channel.times;
    let next = times.partition_point(|&time| f64::from(time) <= at);
    let value = |key: usize| channel.value(key).map(T::numbers);
    let Some(before) = next.checked_sub(1) else { return value(0) };
    let (Some(&start), Some(&end)) = (times.get(before), times.get(next)) else { return value(before) };
    let seconds = f64::from(end) - f64::from(start);
    let part = (at - f64::from(start)) / seconds;
    let (from, to) = (value(before)?, value(next)?);
    Some(match channel.interpolation {
        Interpolation::Step => from,
        Interpolation::Closest => {
            if part < 0.5 {
                from
            } else {
                to
            }
        }
        Interpolation::Linear => T::between(from, to, part),
        Interpolation::CubicSpline => {
            let tangent = |at: usize| channel.values.get(at).map_or(DVec4::ZERO, |value| value.numbers());
            let (leaves, arrives) = (tangent(3 * before + 2) * seconds, tangent(3 * next) * seconds);
            let (square, cube) = (part * part, part * part * part);
            from * (2.0 * cube - 3.0 * square + 1.0)
                + leaves * (cube - 2.0 * square + part)
                + to * (3.0 * square - 2.0 * cube)
                + arrives * (cube - square)
        }
    })
}

/// Returns a vector of a channel at a time, `rest` without keys.
pub(super) fn vector(channel: &Channel<Vec3>, rest: Vec3, at: f64) -> DVec3 {
    sample(channel, at).unwrap_or_else(|| rest.numbers()).truncate()
}

/// Returns a rotation of a channel at a time, `rest` without keys.
pub(super) fn rotation(channel: &Channel<Quat>, rest: Quat, at: f64) -> DQuat {
    settled(DQuat::from_vec4(sample(channel, at).unwrap_or_else(|| rest.numbers())))
}
