//! Full turns between two keys.

use super::shortest_way;
use crate::data::{Channel, Interpolation};
use crate::trig::rotation_of_vector;
use glam::{DQuat, DVec3, Quat, Vec3};

/// Angle below which two rotations have no axis between them, radians.
const SAME: f64 = 1e-4;

/// Returns the channel with `turns` more full turns from each key of `chosen` to the next one of `chosen`; see
/// [the module](super). Negative numbers turn the other way.
///
/// `chosen` ascends; between two of its keys other keys are left alone, and nothing is turned. `axis` is used where two keys have the same
/// rotation; it is in the space of the bone. Step and closest channels, zero turns and a channel whose columns do not fit together stay as
/// they are.
pub fn full_turns(channel: &Channel<Quat>, chosen: &[usize], turns: i32, axis: Vec3) -> Channel<Quat> {
    let per_key = channel.values_per_key();
    let is_moving = matches!(channel.interpolation, Interpolation::Linear | Interpolation::CubicSpline);
    if turns == 0 || !is_moving || channel.values.len() != channel.len() * per_key {
        return channel.clone();
    }
    let is_spline = per_key == 3;
    let starts = |key: usize| chosen.binary_search(&key).is_ok() && chosen.binary_search(&(key + 1)).is_ok();
    let (mut times, mut values) = (Vec::new(), Vec::<Quat>::new());
    let mut arrive: Option<DQuat> = None;
    for key in 0..channel.len() {
        let own = &channel.values[key * per_key..(key + 1) * per_key];
        times.push(channel.times[key]);
        let first = values.len();
        values.extend(own);
        if let (true, Some(arrive)) = (is_spline, arrive.take()) {
            values[first] = arrive.as_quat();
        }
        if key + 1 >= channel.len() || !starts(key) {
            continue;
        }
        let [from, to] =
            [key, key + 1].map(|key| channel.value(key).unwrap_or_default().as_dquat().normalize());
        let seconds = f64::from(channel.times[key + 1]) - f64::from(channel.times[key]);
        if !(from.is_finite() && to.is_finite() && seconds > 0.0) {
            continue;
        }
        let turn = whole_turn(from, to, turns, axis);
        let steps = steps_of(turn, is_spline);
        let speed = |at: DQuat| at * DQuat::from_vec4((turn * (0.5 / seconds)).extend(0.0));
        if is_spline {
            values[first + 2] = speed(from).as_quat();
        }
        for step in 1..steps {
            let part = f64::from(step) / f64::from(steps);
            let time = (f64::from(channel.times[key]) + seconds * part) as f32;
            // Keys nearer than a number can tell apart are left out.
            if !(time > *times.last().unwrap_or(&time) && time < channel.times[key + 1]) {
                continue;
            }
            let at = from * rotation_of_vector(turn * part);
            times.push(time);
            let tangent = speed(at).as_quat();
            if is_spline {
                values.extend([tangent, at.as_quat(), tangent]);
            } else {
                values.push(at.as_quat());
            }
        }
        // The next key has the sign in which the turn ends, so its tangent has the sign of the value that it has now.
        let end = from * rotation_of_vector(turn);
        arrive = Some(speed(if end.dot(to) < 0.0 { -end } else { end }));
    }
    let turned = Channel { times: times.into(), values: values.into(), interpolation: channel.interpolation };
    if is_spline { shortest_way(&turned, |_| true) } else { turned }
}

/// Returns the rotation from one key to the next as axis times angle, radians, with this many full turns more.
fn whole_turn(from: DQuat, to: DQuat, turns: i32, axis: Vec3) -> DVec3 {
    let mut by = from.conjugate() * to;
    if by.w < 0.0 {
        by = -by;
    }
    let sine = by.xyz().length();
    let angle = 2.0 * libm::atan2(sine, by.w);
    let given = axis.as_dvec3().normalize_or(DVec3::Y);
    let along = if angle < SAME { given } else { by.xyz() / sine };
    along * (angle + std::f64::consts::TAU * f64::from(turns))
}

/// Returns into how many parts a turn is divided.
fn steps_of(turn: DVec3, is_spline: bool) -> u32 {
    let most = std::f64::consts::FRAC_PI_2 / if is_spline { 2.0 } else { 1.0 };
    // A little more than the angle, so that rounding does not add a step.
    libm::ceil(turn.length() / most - 1e-9).clamp(1.0, 1e6) as u32
}
