//! In-between tools: blends of keys with their neighbors, filters of curves compared with SciPy, noise.

use dragonfly_anim::inbetween::{
    BlendTarget, Butterworth, KeyFilter, KeyValue, UniformTimes, blend_keys, butterworth, extended,
    filter_keys, gaussian, noise_at, remove_peaks,
};
use dragonfly_anim::trig::rotation_about;
use dragonfly_kit::random::{Random, seed};
use glam::{DVec3, Quat, Vec3};
use serde_json::Value;

/// A curve, and what SciPy's filters return for it.
struct FilteredCurve {
    name: String,
    values: Vec<f64>,
    filtered: Value,
}

impl FilteredCurve {
    /// Returns the settings of a filter and what it returned, each time that it was used.
    fn by(&self, filter: &str) -> Vec<(Vec<f64>, Vec<f64>)> {
        let runs = self.filtered[filter].as_array().expect("a list");
        let run = |run: &Value| {
            let (values, settings) = run.as_array().expect("a list").split_last().expect("values");
            (settings.iter().map(number).collect(), numbers(values))
        };
        runs.iter().map(run).collect()
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn numbers(values: &Value) -> Vec<f64> {
    values.as_array().expect("a list").iter().map(number).collect()
}

/// Returns what `tests/data/inbetween/expected.py` wrote.
fn expected() -> Vec<FilteredCurve> {
    let all: Value = serde_json::from_str(include_str!("../data/inbetween/expected.json"))
        .expect("written by expected.py");
    let of = |curve: &Value| FilteredCurve {
        name: curve["name"].to_string(),
        values: numbers(&curve["values"]),
        filtered: curve.clone(),
    };
    all["curves"].as_array().expect("a list").iter().map(of).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn turn(axis: DVec3, degrees: f64) -> Quat {
    rotation_about(axis.normalize(), degrees.to_radians()).as_quat()
}

/// Returns the angle between two rotations, degrees.
fn apart(a: Quat, b: Quat) -> f64 {
    let between = a.as_dquat().conjugate() * b.as_dquat();
    let sine = DVec3::new(between.x, between.y, between.z).length();
    (2.0 * sine.atan2(between.w.abs())).to_degrees()
}

/// Returns the number of values that a filter of SciPy returned, and the largest difference from `ours`, which gets a curve and the
/// settings.
fn compared_with_scipy(filter: &str, ours: impl Fn(&[f64], &[f64]) -> Vec<f64>) -> (usize, f64) {
    let (mut count, mut worst) = (0, 0.0_f64);
    for curve in expected() {
        for (settings, values) in curve.by(filter) {
            let off = largest_difference(&ours(&curve.values, &settings), &values);
            println!("{} {filter} {settings:?}: {off:e}", curve.name);
            (count, worst) = (count + values.len(), worst.max(off));
        }
    }
    (count, worst)
}

pub(crate) fn gaussian_beside_scipy() -> (usize, f64) {
    compared_with_scipy("gaussian", |curve, settings| gaussian(curve, settings[0]))
}

pub(crate) fn butterworth_beside_scipy() -> (usize, f64) {
    compared_with_scipy("butterworth", |curve, settings| {
        let filter = Butterworth::low_pass(settings[0] as usize, settings[1]).expect("in range");
        butterworth(curve, &filter)
    })
}

/// Without the ends, where SciPy counts zeros.
pub(crate) fn median_beside_scipy() -> (usize, f64) {
    compared_with_scipy("median", |curve, settings| {
        let window = settings[0] as usize;
        let (filtered, half) = (remove_peaks(curve, window, 0.0), window / 2);
        filtered[half..filtered.len() - half].to_vec()
    })
}

#[test]
fn a_gaussian_returns_what_scipy_returns() {
    assert!(gaussian_beside_scipy().1 < 1e-12);
}

#[test]
fn a_butterworth_filter_returns_what_scipy_returns() {
    assert!(butterworth_beside_scipy().1 < 1e-9);
}

#[test]
fn a_threshold_of_zero_returns_the_median_of_scipy() {
    assert!(median_beside_scipy().1 < 1e-5);
}

#[test]
fn a_peak_is_removed_and_every_other_value_stays_bit_for_bit() {
    let mut values: Vec<f64> = (0..60).map(|at| (f64::from(at) * 0.1).sin()).collect();
    let smooth = values.clone();
    (values[20], values[41]) = (5.0, -3.0);
    let filtered = remove_peaks(&values, 5, 4.0);
    for at in 0..60 {
        if [20, 41].contains(&at) {
            assert!((filtered[at] - smooth[at]).abs() < 0.2, "{at}: {}", filtered[at]);
        } else {
            assert_eq!(filtered[at].to_bits(), values[at].to_bits(), "{at}");
        }
    }
}

#[test]
fn filters_keep_the_ends_and_straight_lines() {
    let line: Vec<f64> = (0..40).map(|at| 3.0 - 0.25 * f64::from(at)).collect();
    let filter = Butterworth::low_pass(4, 0.2).expect("in range");
    assert!(largest_difference(&gaussian(&line, 3.0), &line) < 1e-12);
    // The filter starts with a state that is constant, not a line; the margin leaves little of that.
    let off = largest_difference(&butterworth(&line, &filter), &line);
    assert!(off < 0.05, "{off}");
    let mut random = Random::new(seed(61));
    let jitter: Vec<f64> = (0..40).map(|_| f64::from(random.between(-1.0, 1.0))).collect();
    let smooth = gaussian(&jitter, 2.0);
    assert!((smooth[0] - jitter[0]).abs() < 1e-12 && (smooth[39] - jitter[39]).abs() < 1e-12);
}

#[test]
fn a_margin_longer_than_the_curve_reflects_it_again_and_again() {
    // A line continues as a line, however far.
    let line = extended(&[1.0_f64, 2.0, 3.0], 9);
    let expected: Vec<f64> = (-8..=12).map(f64::from).collect();
    assert_eq!(line, expected);
    assert_eq!(extended(&[4.0_f64], 2), [4.0; 5]);
    assert!(extended::<f64>(&[], 3).is_empty());
}

#[test]
fn turns_at_constant_speed_stay_as_they_are_also_beyond_a_full_turn() {
    let axis = DVec3::new(0.3, 1.0, -0.2);
    let spin: Vec<Quat> = (0..80).map(|at| turn(axis, f64::from(at) * 20.0)).collect();
    let filter = Butterworth::low_pass(2, 0.3).expect("in range");
    for (name, filtered) in [("gaussian", gaussian(&spin, 2.0)), ("butterworth", butterworth(&spin, &filter))]
    {
        for (at, (before, after)) in spin.iter().zip(&filtered).enumerate() {
            assert!(apart(*before, *after) < 0.02, "{name} {at}: {}°", apart(*before, *after));
            assert!((after.length() - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn the_signs_of_quaternions_do_not_matter_to_filters() {
    let mut random = Random::new(seed(62));
    let turns: Vec<Quat> = (0..50)
        .map(|at| turn(DVec3::new(1.0, 0.2, 0.0), f64::from(at) * 6.0 + f64::from(random.between(-4.0, 4.0))))
        .collect();
    let mixed: Vec<Quat> =
        turns.iter().map(|&turn| if random.below(2) == 0 { turn } else { -turn }).collect();
    for (a, b) in gaussian(&turns, 1.5).iter().zip(gaussian(&mixed, 1.5)) {
        assert!(apart(*a, b) < 1e-4);
    }
    for (a, b) in remove_peaks(&turns, 5, 0.0).iter().zip(remove_peaks(&mixed, 5, 0.0)) {
        assert!(apart(*a, b) < 1e-4);
    }
}

#[test]
fn a_smoothed_rotation_lies_where_the_smoothed_angle_does() {
    let angles: Vec<f64> = (0..60).map(|at| 30.0 * (f64::from(at) * 0.3).sin()).collect();
    let turns: Vec<Quat> = angles.iter().map(|&angle| turn(DVec3::Y, angle)).collect();
    for (angle, smooth) in gaussian(&angles, 2.0).into_iter().zip(gaussian(&turns, 2.0)) {
        assert!(apart(turn(DVec3::Y, angle), smooth) < 0.2, "{angle}");
    }
}

/// Returns channels of numbers with chosen keys: random, of all lengths.
fn channels(count: u64) -> impl Iterator<Item = (Vec<f32>, Vec<Vec3>, Vec<Quat>, Vec<u32>)> {
    let first = seed(63);
    (first..first + count).map(|number| {
        let mut random = Random::new(number);
        let keys = 1 + random.below(12);
        let mut time = 0.0;
        let times = (0..keys)
            .map(|_| {
                time += random.between(0.01, 0.5);
                time
            })
            .collect();
        let mut three = || Vec3::from_array([0; 3].map(|_| random.between(-2.0, 2.0)));
        let vectors: Vec<Vec3> = (0..keys).map(|_| three()).collect();
        let turns = (0..keys)
            .map(|_| turn(three().as_dvec3() + DVec3::X * 1e-3, f64::from(three().x) * 90.0))
            .collect();
        let chosen = (0..keys as u32).filter(|_| random.below(2) == 0).collect();
        (times, vectors, turns, chosen)
    })
}

const TARGETS: [BlendTarget<'_, Vec3>; 7] = [
    BlendTarget::Between(0.5),
    BlendTarget::AwayFromLine,
    BlendTarget::Average,
    BlendTarget::Previous,
    BlendTarget::Next,
    BlendTarget::SlowStart,
    BlendTarget::SlowEnd,
];

fn of_turns(target: BlendTarget<'_, Vec3>) -> BlendTarget<'_, Quat> {
    match target {
        BlendTarget::Between(part) => BlendTarget::Between(part),
        BlendTarget::AwayFromLine => BlendTarget::AwayFromLine,
        BlendTarget::Average => BlendTarget::Average,
        BlendTarget::Previous => BlendTarget::Previous,
        BlendTarget::Next => BlendTarget::Next,
        BlendTarget::SlowStart => BlendTarget::SlowStart,
        BlendTarget::SlowEnd => BlendTarget::SlowEnd,
        BlendTarget::Values(_) => BlendTarget::Values(&[]),
    }
}

#[test]
fn a_factor_of_zero_changes_no_bit() {
    for (times, vectors, turns, chosen) in channels(200) {
        for target in TARGETS {
            let blended = blend_keys(&times, &vectors, &chosen, target, 0.0);
            let before: Vec<Vec3> = chosen.iter().map(|&key| vectors[key as usize]).collect();
            assert_eq!(blended, before, "{target:?}");
            let blended = blend_keys(&times, &turns, &chosen, of_turns(target), 0.0);
            let before: Vec<Quat> = chosen.iter().map(|&key| turns[key as usize]).collect();
            assert_eq!(blended, before, "{target:?}");
        }
    }
}

#[test]
fn every_blend_returns_a_finite_value_for_each_chosen_key() {
    for (times, vectors, turns, chosen) in channels(200) {
        for target in TARGETS {
            for factor in [-1.0, 0.3, 1.0, 1.5] {
                let blended = blend_keys(&times, &vectors, &chosen, target, factor);
                assert_eq!(blended.len(), chosen.len());
                assert!(blended.iter().all(|value| value.is_finite()));
                let blended = blend_keys(&times, &turns, &chosen, of_turns(target), factor);
                assert_eq!(blended.len(), chosen.len());
                assert!(blended.iter().all(|value| (value.length() - 1.0).abs() < 1e-5));
            }
        }
    }
}

#[test]
fn keys_move_between_and_beyond_the_neighbors_of_their_row() {
    let times = [0.0, 1.0, 2.0, 4.0, 5.0];
    let values = [0.0_f64, 3.0, 9.0, 8.0, 7.0];
    let blend = |chosen: &[u32], target, factor| blend_keys(&times, &values, chosen, target, factor);
    // The row 1, 2 is between the keys 0 (value 0, at 0 s) and 3 (value 8, at 4 s).
    assert_eq!(blend(&[1, 2], BlendTarget::Between(0.25), 1.0), [2.0, 2.0]);
    assert_eq!(blend(&[1, 2], BlendTarget::Between(1.5), 1.0), [12.0, 12.0]);
    assert_eq!(blend(&[1, 2], BlendTarget::Between(0.5), 0.5), [3.5, 6.5]);
    assert_eq!(blend(&[1, 2], BlendTarget::Previous, 0.5), [1.5, 4.5]);
    assert_eq!(blend(&[1, 2], BlendTarget::Next, 1.0), [8.0, 8.0]);
    // The line is at 2 and 4 there.
    assert_eq!(blend(&[1, 2], BlendTarget::AwayFromLine, 1.0), [4.0, 14.0]);
    assert_eq!(blend(&[1, 2], BlendTarget::AwayFromLine, -1.0), [2.0, 4.0]);
    // Directly before and after key 1 are the values 0 and 9, before and after key 2 the values 3 and 8 at a third of the way.
    let relaxed = blend(&[1, 2], BlendTarget::Average, 1.0);
    assert_eq!(relaxed[0], 4.5);
    assert!((relaxed[1] - (3.0 + 5.0 / 3.0)).abs() < 1e-12);
    assert_eq!(blend(&[1, 2], BlendTarget::SlowStart, 1.0), [8.0 / 64.0, 1.0]);
    assert_eq!(blend(&[1, 2], BlendTarget::SlowEnd, 1.0), [8.0 * (1.0 - 27.0 / 64.0), 7.0]);
    assert_eq!(blend(&[0, 4], BlendTarget::Values(&[1.0, 2.0]), 0.5), [0.5, 4.5]);
    // At the ends of a channel a row is its own neighbor.
    assert_eq!(blend(&[0], BlendTarget::Previous, 1.0), [0.0]);
    assert_eq!(blend(&[0], BlendTarget::Next, 1.0), [3.0]);
    assert_eq!(blend(&[0, 1, 2, 3, 4], BlendTarget::AwayFromLine, -1.0)[4], 7.0);
    assert_eq!(blend(&[0, 4], BlendTarget::Average, 1.0), [0.0, 7.0]);
}

#[test]
fn a_rotation_is_blended_along_the_arc_and_beyond_it() {
    let (a, b) = (turn(DVec3::Z, 10.0), turn(DVec3::Z, 50.0));
    for (amount, degrees) in [(0.25, 20.0), (1.0, 50.0), (1.5, 70.0), (-1.0, -30.0)] {
        assert!(apart(Quat::mix(a, b, amount), turn(DVec3::Z, degrees)) < 1e-4, "{amount}");
        assert!(apart(Quat::mix(a, -b, amount), turn(DVec3::Z, degrees)) < 1e-4, "{amount}");
    }
}

#[test]
fn evenly_set_keys_are_the_samples_of_their_filter() {
    let mut random = Random::new(seed(64));
    let times: Vec<f32> = (0..50).map(|at| 0.4 + at as f32 / 24.0).collect();
    let values: Vec<f64> = (0..50).map(|_| f64::from(random.between(-1.0, 1.0))).collect();
    let sample = |time: f32| values[((time - 0.4) * 24.0).round() as usize];
    let uniform = UniformTimes::over(&times, None).expect("many keys");
    assert!((uniform.rate() - 24.0).abs() < 0.01 && uniform.count() == 50, "{uniform:?}");
    let uniform = UniformTimes::over(&times, Some(24.0)).expect("many keys");
    let filter = KeyFilter::Gaussian { sigma: 2.0 / 24.0 };
    let filtered = filter_keys(&times, &values, filter, Some(uniform), sample).expect("a filter");
    assert!(largest_difference(&filtered, &gaussian(&values, 2.0)) < 1e-9);
}

#[test]
fn a_filter_that_does_nothing_says_so() {
    let (times, values) = ([0.0, 0.1, 0.2, 0.3], [0.0_f64, 1.0, 0.0, 2.0]);
    let uniform = UniformTimes::over(&times, None);
    let sample = |time: f32| values[(time * 10.0).round() as usize];
    for filter in [KeyFilter::Gaussian { sigma: 0.0 }, KeyFilter::Butterworth { cutoff: 5.1, order: 2 }] {
        assert_eq!(filter_keys(&times, &values, filter, uniform, sample), None, "{filter:?}");
    }
    assert_eq!(UniformTimes::over(&times[..1], None), None);
    assert_eq!(UniformTimes::over(&[0.0, 86_400.0], Some(30.0)), None);
}

#[test]
fn noise_is_reproducible_smooth_and_between_minus_one_and_one() {
    let (mut largest, mut sum) = (0.0_f64, 0.0);
    for at in 0..20_000 {
        let time = f64::from(at) * 0.01 - 50.0;
        let value = noise_at(7, time);
        assert!((-1.0..=1.0).contains(&value));
        assert!((noise_at(7, time + 1e-4) - value).abs() < 1e-3);
        largest = largest.max(value.abs());
        sum += value;
    }
    assert!(largest > 0.9 && (sum / 20_000.0).abs() < 0.1, "{largest} {sum}");
    assert_ne!(noise_at(7, 0.0).to_bits(), noise_at(8, 0.0).to_bits());
    // The same on every system.
    assert_eq!(noise_at(1, 0.25).to_bits(), NOISE);
}

/// Bits of the noise with seed 1 at 0.25.
const NOISE: u64 = 0xBFD1_B03D_B5FA_F7B3;
