//! Full turns, the shortest way and cycles of rotations agree with SciPy.

use dragonfly_anim::cycle::CycleValue;
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::sample_channel;
use dragonfly_anim::turns::{full_turns, shortest_way};
use dragonfly_kit::folder::data;
use glam::{Quat, Vec3};
use serde_json::Value;
use std::fs;

fn expected(name: &str) -> Vec<Value> {
    let text = fs::read_to_string(data("turns/expected.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    all[name].as_array().unwrap().clone()
}

fn rotation(value: &Value) -> Quat {
    let number = |at: usize| value[at].as_f64().unwrap() as f32;
    Quat::from_xyzw(number(0), number(1), number(2), number(3))
}

/// Returns the angle between two rotations in degrees.
fn apart(a: Quat, b: Quat) -> f64 {
    let (a, b) = (a.as_dquat().normalize(), b.as_dquat().normalize());
    let between = a.conjugate() * b;
    2.0 * between.xyz().length().atan2(between.w.abs()).to_degrees()
}

/// Returns two keys, two seconds apart.
fn two_keys(from: Quat, to: Quat, interpolation: Interpolation) -> Channel<Quat> {
    let none = Quat::from_array([0.0; 4]);
    let values: Vec<Quat> = match interpolation {
        Interpolation::CubicSpline => vec![none, from, none, none, to, none],
        Interpolation::Step | Interpolation::Linear | Interpolation::Closest => vec![from, to],
    };
    Channel::new([1.0, 3.0], values, interpolation)
}

/// Returns the number of rotations between two keys with full turns, and the largest angle to SciPy's, degrees.
pub(crate) fn full_turns_beside_scipy(interpolation: Interpolation) -> (usize, f64) {
    let (mut count, mut worst) = (0, 0.0_f64);
    for case in expected("turns") {
        let turns = case["turns"].as_i64().unwrap() as i32;
        let before = two_keys(rotation(&case["from"]), rotation(&case["to"]), interpolation);
        let after = full_turns(&before, &[0, 1], turns, Vec3::Y);
        assert!(after.len() > 2 + 3 * (turns.unsigned_abs() as usize - 1), "{} keys", after.len());
        for (part, wanted) in case["parts"].as_array().unwrap().iter().zip(case["at"].as_array().unwrap()) {
            let time = 1.0 + 2.0 * part.as_f64().unwrap() as f32;
            let off = apart(sample_channel(&after, Quat::IDENTITY, time), rotation(wanted));
            println!("{interpolation:?}, {turns} turns at {part}: {off}°");
            (count, worst) = (count + 1, worst.max(off));
        }
    }
    (count, worst)
}

#[test]
fn full_turns_between_two_keys_are_those_of_scipy() {
    assert!(full_turns_beside_scipy(Interpolation::Linear).1 <= 1e-3);
    assert!(full_turns_beside_scipy(Interpolation::CubicSpline).1 <= 0.05);
}

#[test]
fn no_two_keys_of_a_full_turn_are_further_apart_than_a_quarter_and_the_ends_stay() {
    for turns in [-4, -1, 1, 9] {
        let before = two_keys(Quat::from_rotation_x(0.4), Quat::from_rotation_x(0.4), Interpolation::Linear);
        let after = full_turns(&before, &[0, 1], turns, Vec3::Z);
        assert_eq!(after.len(), 4 * turns.unsigned_abs() as usize + 1);
        for key in 1..after.len() {
            let [a, b] = [key - 1, key].map(|key| after.value(key).unwrap());
            assert!((apart(a, b) - 90.0).abs() < 1e-3);
            assert!(after.times[key] > after.times[key - 1]);
        }
        assert_eq!([after.value(0), after.value(after.len() - 1)], [before.value(0), before.value(1)]);
        let quarter = apart(
            Quat::from_rotation_x(0.4)
                * Quat::from_rotation_z(0.5 * turns.signum() as f32 * std::f32::consts::PI),
            after.value(1).unwrap(),
        );
        assert!(quarter < 1e-3, "turned about the given axis: {quarter}");
    }
}

#[test]
fn turns_that_cannot_be_made_change_nothing() {
    let keys = two_keys(Quat::IDENTITY, Quat::from_rotation_x(1.0), Interpolation::Linear);
    let step = Channel { interpolation: Interpolation::Step, ..keys.clone() };
    assert_eq!(full_turns(&keys, &[0, 1], 0, Vec3::Y), keys);
    assert_eq!(full_turns(&keys, &[0], 3, Vec3::Y), keys);
    assert_eq!(full_turns(&step, &[0, 1], 3, Vec3::Y), step);
    let damaged = Channel { times: vec![0.0, 1.0, 2.0].into(), ..keys };
    assert_eq!(full_turns(&damaged, &[0, 1, 2], 3, Vec3::Y), damaged);
    assert_eq!(shortest_way(&damaged, |_| true), damaged);
}

/// Returns the number of rotations between keys of any sign, and the largest angle to SciPy's slerp, degrees.
pub(crate) fn slerps_beside_scipy() -> (usize, f64) {
    let (mut count, mut worst) = (0, 0.0_f64);
    for (number, case) in expected("slerps").iter().enumerate() {
        let list = |name: &str| case[name].as_array().unwrap().clone();
        let times: Vec<f32> = list("times").iter().map(|time| time.as_f64().unwrap() as f32).collect();
        let sign = |key: usize| if (number + key * key).is_multiple_of(3) { -1.0 } else { 1.0 };
        let keys: Vec<Quat> =
            list("keys").iter().enumerate().map(|(key, value)| rotation(value) * sign(key)).collect();
        let channel = shortest_way(&Channel::new(times, keys.clone(), Interpolation::Linear), |_| true);
        for (pair, before) in channel.values.windows(2).zip(&keys) {
            assert!(pair[0].dot(pair[1]) >= 0.0);
            assert!(apart(pair[0], *before) < 1e-3);
        }
        for (time, wanted) in list("at").iter().zip(list("values")) {
            let value = sample_channel(&channel, Quat::IDENTITY, time.as_f64().unwrap() as f32);
            (count, worst) = (count + 1, worst.max(apart(value, rotation(&wanted))));
        }
    }
    (count, worst)
}

#[test]
fn the_shortest_way_between_keys_of_any_sign_is_the_slerp_of_scipy() {
    assert!(slerps_beside_scipy().1 < 1e-3);
}

#[test]
fn a_spline_between_keys_of_opposite_signs_no_longer_flips() {
    let none = Quat::from_array([0.0; 4]);
    let (a, b) = (Quat::from_rotation_y(0.2), Quat::from_rotation_y(0.4));
    let flipping = Channel::new([0.0, 1.0], [none, a, none, none, -b, none], Interpolation::CubicSpline);
    let middle = Quat::from_rotation_y(0.3);
    assert!(apart(sample_channel(&flipping, Quat::IDENTITY, 0.5), middle) > 90.0);
    let fixed = shortest_way(&flipping, |_| true);
    assert!(apart(sample_channel(&fixed, Quat::IDENTITY, 0.5), middle) < 1e-3);
}

/// Returns the number of rotations some cycles later, and the largest angle to SciPy's powers, degrees.
pub(crate) fn powers_beside_scipy() -> (usize, f64) {
    let (mut count, mut worst) = (0, 0.0_f64);
    for case in expected("powers") {
        let [first, last, value, moved] =
            ["first", "last", "value", "moved"].map(|name| rotation(&case[name]));
        let offset = Quat::offset(first, last);
        let found = Quat::moved(value, offset, case["count"].as_i64().unwrap() as i32);
        (count, worst) = (count + 1, worst.max(apart(found, moved)));
    }
    (count, worst)
}

#[test]
fn a_rotation_some_cycles_later_is_the_power_of_scipy() {
    assert!(powers_beside_scipy().1 < 1e-3);
}
