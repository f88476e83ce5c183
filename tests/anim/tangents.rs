//! Tangents agree with NumPy and SciPy, and a clamped curve stays between its keys.

use dragonfly_anim::tangents::{NeighborKey, TangentKind, tangents};
use dragonfly_kit::folder::data;
use dragonfly_kit::random::{Random, seed};
use serde_json::Value;
use std::fs;

const NONE: [[f32; 4]; 2] = [[0.0; 4]; 2];

/// Returns in-tangent and out-tangent of the keys of a curve of one number.
fn of_curve(kind: TangentKind, times: &[f32], values: &[f32]) -> Vec<[f32; 2]> {
    let value = |key: usize| [values[key], 0.0, 0.0, 0.0];
    let neighbor = |key: usize, other: Option<usize>| {
        let other = other.filter(|&other| other < times.len())?;
        Some(NeighborKey { seconds: (times[other] - times[key]).abs(), value: value(other) })
    };
    let of_key = |key: usize| {
        let (before, after) = (neighbor(key, key.checked_sub(1)), neighbor(key, Some(key + 1)));
        tangents(kind, before, value(key), after, NONE).map(|tangent| tangent[0])
    };
    (0..times.len()).map(of_key).collect()
}

fn numbers(value: &Value) -> Vec<f32> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap() as f32).collect()
}

/// Returns the number of tangents at keys between others, and the largest difference from those of NumPy or SciPy as a part of the
/// steepest line between two keys.
pub(crate) fn tangents_beside_scipy(kind: TangentKind, name: &str) -> (usize, f64) {
    let text = fs::read_to_string(data("tangents/expected.json")).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    let cases = expected["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 40);
    let (mut count, mut worst) = (0, 0.0_f64);
    for case in cases {
        let (times, values) = (numbers(&case["times"]), numbers(&case["values"]));
        let steepest =
            times.windows(2).zip(values.windows(2)).map(|(t, v)| ((v[1] - v[0]) / (t[1] - t[0])).abs());
        let steepest = steepest.fold(0.0, f32::max);
        let expected = numbers(&case[name]);
        let found = of_curve(kind, &times, &values);
        // The ends have their own rules.
        for key in 1..times.len() - 1 {
            assert_eq!(found[key][0], found[key][1]);
            let apart = (found[key][0] - expected[key]).abs();
            (count, worst) = (count + 1, worst.max(f64::from(apart / steepest)));
        }
    }
    (count, worst)
}

#[test]
fn tangents_of_keys_at_uneven_times_are_those_of_numpy_and_scipy() {
    for (kind, name) in [(TangentKind::Auto, "auto"), (TangentKind::Clamped, "clamped")] {
        let (count, worst) = tangents_beside_scipy(kind, name);
        assert!(count > 100 && worst <= 1e-4, "{name}: {worst}");
    }
}

/// Returns the value of a cubic Hermite curve at a part of the time between two keys.
fn hermite(part: f32, seconds: f32, [a, b]: [f32; 2], [leave, arrive]: [f32; 2]) -> f32 {
    let (p, q) = (part, 1.0 - part);
    (1.0 + 2.0 * p) * q * q * a + p * q * q * seconds * leave + p * p * (3.0 - 2.0 * p) * b
        - p * p * q * seconds * arrive
}

#[test]
fn a_clamped_curve_stays_between_the_values_of_its_keys() {
    let seed = seed(5);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut auto_leaves = 0;
    for _ in 0..500 {
        let mut time = 0.0;
        let times: Vec<f32> = (0..6)
            .map(|_| {
                time += random.between(0.01, 2.0);
                time
            })
            .collect();
        let any = random.unit();
        let values: Vec<f32> = times.iter().map(|_| random.choice(&[0.0, 1.0, any, -any])).collect();
        for kind in [TangentKind::Clamped, TangentKind::Auto] {
            let slopes = of_curve(kind, &times, &values);
            for key in 0..times.len() - 1 {
                let ends = [values[key], values[key + 1]];
                let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                for step in 1..50 {
                    let seconds = times[key + 1] - times[key];
                    let value =
                        hermite(step as f32 / 50.0, seconds, ends, [slopes[key][1], slopes[key + 1][0]]);
                    let is_outside = value < low - 1e-5 || value > high + 1e-5;
                    assert!(!is_outside || kind == TangentKind::Auto, "{value} {ends:?}");
                    auto_leaves += usize::from(is_outside);
                }
            }
        }
    }
    assert!(auto_leaves > 1000, "auto tangents overshoot: {auto_leaves}");
}

#[test]
fn flat_linear_and_unified_tangents_are_what_their_names_say() {
    let before = NeighborKey { seconds: 0.5, value: [1.0, 0.0, 0.0, 0.0] };
    let after = NeighborKey { seconds: 2.0, value: [7.0, 0.0, 0.0, 0.0] };
    let here = [3.0, 0.0, 0.0, 0.0];
    let x = |kind, before, after, now| tangents(kind, before, here, after, now).map(|tangent| tangent[0]);
    assert_eq!(x(TangentKind::Flat, Some(before), Some(after), [[9.0; 4]; 2]), [0.0, 0.0]);
    assert_eq!(x(TangentKind::Linear, Some(before), Some(after), NONE), [4.0, 2.0]);
    assert_eq!(x(TangentKind::Linear, None, Some(after), NONE), [2.0, 2.0]);
    assert_eq!(x(TangentKind::Linear, None, None, NONE), [0.0, 0.0]);
    assert_eq!(x(TangentKind::Unified, Some(before), None, [[1.0; 4], [5.0; 4]]), [3.0, 3.0]);
    assert_eq!(x(TangentKind::Auto, Some(before), None, NONE), [4.0, 4.0]);
    assert_eq!(x(TangentKind::Clamped, Some(before), None, NONE), [0.0, 0.0]);
    let nowhere = NeighborKey { seconds: 0.0, ..after };
    assert_eq!(
        x(TangentKind::Auto, Some(before), Some(nowhere), NONE),
        [4.0, 4.0],
        "a neighbor at the same time"
    );
}
