//! Offsets of keys: exact at the keys and between them, and undone by their inverses.

use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::offset::{
    AddedTranslation, Falloff, FalloffShape, KeyOffset, KeyWeight, ParentRotation, ScaleFactors, offset_keys,
    weights_of_keys, weights_of_range,
};
use dragonfly_anim::sample::{Value, sample_channel};
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};

const INTERPOLATIONS: [Interpolation; 4] =
    [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Closest];

fn vector(random: &mut Random) -> Vec3 {
    Vec3::from_array([0; 3].map(|_| random.between(-2.0, 2.0)))
}

fn turn(random: &mut Random) -> Quat {
    loop {
        let numbers = [0; 4].map(|_| random.between(-1.0, 1.0));
        let rotation = Quat::from_array(numbers);
        if rotation.length() > 0.1 {
            return rotation.normalize();
        }
    }
}

/// Returns a channel of random keys.
fn channel<T: Value>(
    random: &mut Random,
    interpolation: Interpolation,
    value: impl Fn(&mut Random) -> T,
    tangent: impl Fn(&mut Random) -> T,
) -> Channel<T> {
    let mut time = 0.0;
    let times: Vec<f32> = (0..2 + random.below(6))
        .map(|_| {
            time += random.between(0.05, 0.5);
            time
        })
        .collect();
    let values: Vec<T> = if interpolation == Interpolation::CubicSpline {
        times.iter().flat_map(|_| [tangent(random), value(random), tangent(random)]).collect()
    } else {
        times.iter().map(|_| value(random)).collect()
    };
    Channel::new(times, values, interpolation)
}

fn all<T: Copy>(channel: &Channel<T>) -> Vec<KeyWeight> {
    (0..channel.len() as u32).map(|key| KeyWeight { key, weight: 1.0 }).collect()
}

fn times<T: Copy>(channel: &Channel<T>) -> Vec<f32> {
    let (from, to) = channel.range().expect("it has keys");
    (0..=40).map(|step| from - 0.1 + (to - from + 0.2) * step as f32 / 40.0).collect()
}

/// Angle between two rotations in radians.
fn apart(a: Quat, b: Quat) -> f32 {
    2.0 * (a - b).length().min((a + b).length())
}

/// Asserts what holds for any offset of all keys: `difference` measures how far two values are apart.
fn check<O: KeyOffset>(
    channel: &Channel<O::Value>,
    offset: O,
    difference: impl Fn(O::Value, O::Value) -> f32,
    context: &str,
) where
    O::Value: std::fmt::Debug,
{
    let rest = channel.value(0).expect("it has keys");
    let moved = offset_keys(channel, offset, &all(channel));
    for time in times(channel) {
        let (now, was) = (sample_channel(&moved, rest, time), sample_channel(channel, rest, time));
        let off = difference(now, offset.value(was));
        assert!(off < 2e-5, "{context}: at {time} s: {now:?} is {off} from the offset of {was:?}");
    }
    let back = offset_keys(&moved, offset.inverse().expect("no factor is 0"), &all(channel));
    for (was, now) in channel.values.iter().zip(back.values.iter()) {
        let off = difference(*now, *was);
        assert!(off < 1e-5, "{context}: {now:?} came back as {was:?}, {off} away");
    }
    let same = offset_keys(channel, O::IDENTITY, &all(channel));
    assert_eq!(same.values, channel.values, "{context}: the identity changed a value");
    let none = all(channel).into_iter().map(|key| KeyWeight { weight: 0.0, ..key }).collect::<Vec<_>>();
    assert_eq!(offset_keys(channel, offset, &none).values, channel.values, "{context}: a weight of 0 counts");
}

#[test]
fn an_offset_of_all_keys_is_exact_between_the_keys_and_its_inverse_leads_back() {
    let first = seed(70);
    for number in first..first + 300 {
        let mut random = Random::new(number);
        for interpolation in INTERPOLATIONS {
            let context = format!("seed {number}, {interpolation:?}");
            let vectors = channel(&mut random, interpolation, vector, vector);
            let by = vector(&mut random);
            check(&vectors, AddedTranslation(by), |a, b| (a - b).length(), &context);
            let factors = Vec3::from_array([0; 3].map(|_| random.choice(&[-2.0, -0.5, 0.25, 0.5, 1.0, 3.0])));
            check(&vectors, ScaleFactors(factors), |a, b| (a - b).length(), &context);
            // Keys of a spline that are far apart could lead it near zero, where a rotation has no direction.
            let middle = turn(&mut random);
            let near = |random: &mut Random| (middle * 1.5 + turn(random)).normalize();
            let small = |random: &mut Random| turn(random) * 0.2;
            let turns = channel(&mut random, interpolation, near, small);
            let offset = ParentRotation(turn(&mut random));
            check(
                &turns,
                offset,
                |a, b| {
                    if interpolation == Interpolation::CubicSpline {
                        (a - b).length().min((a + b).length())
                    } else {
                        apart(a, b)
                    }
                },
                &context,
            );
        }
    }
}

#[test]
fn half_a_turn_flips_no_key_on_its_own() {
    let mut random = Random::new(seed(71));
    for _ in 0..200 {
        let keys = channel(&mut random, Interpolation::Linear, |_| Quat::IDENTITY, |_| Quat::IDENTITY);
        let values: Vec<Quat> = keys
            .times
            .iter()
            .map(|time| Quat::from_rotation_x(time * 0.3) * Quat::from_rotation_y(*time))
            .collect();
        let keys = Channel { values: values.into(), ..keys };
        let axis = turn(&mut random).xyz().normalize();
        let half = ParentRotation(Quat::from_xyzw(axis.x, axis.y, axis.z, 0.0));
        let moved = offset_keys(&keys, half, &all(&keys));
        for pair in moved.values.windows(2) {
            assert!(pair[0].dot(pair[1]) > 0.0, "{pair:?}");
        }
    }
}

#[test]
fn twenty_degrees_more_are_twenty_degrees_at_every_time() {
    let turns: Vec<Quat> = (0..5).map(|key| Quat::from_rotation_x(key as f32 * 0.4 - 0.7)).collect();
    let walk = Channel::new([0.0, 0.2, 0.5, 0.9, 1.0], turns, Interpolation::Linear);
    let by = Quat::from_rotation_z(20_f32.to_radians());
    let raised = offset_keys(&walk, ParentRotation(by), &all(&walk));
    for step in 0..=100 {
        let time = step as f32 / 100.0;
        let [was, now] = [&walk, &raised].map(|take| sample_channel(take, Quat::IDENTITY, time));
        assert!(apart(now * was.conjugate(), by) < 1e-6, "{time}");
    }
}

#[test]
fn the_offset_between_two_values_leads_from_one_to_the_other() {
    let mut random = Random::new(seed(72));
    for _ in 0..1000 {
        let (a, b) = (vector(&mut random), vector(&mut random));
        let added = AddedTranslation::between(a, b).expect("finite");
        assert!((added.value(a) - b).length() < 1e-6);
        let factors = ScaleFactors::between(a, b).expect("no component is 0");
        assert!((factors.value(a) - b).length() < 1e-6);
        let (a, b) = (turn(&mut random), turn(&mut random));
        let rotation = ParentRotation::between(a, b).expect("unit length");
        assert!(apart(rotation.value(a), b) < 1e-6 && rotation.0.w >= 0.0);
        assert_eq!(ParentRotation::between(a, a), Some(ParentRotation::IDENTITY));
        assert_eq!(ParentRotation::between(a, -a), Some(ParentRotation::IDENTITY));
    }
    assert_eq!(ScaleFactors::between(Vec3::ZERO, Vec3::ONE), None);
    assert_eq!(ScaleFactors::between(Vec3::ZERO, Vec3::ZERO), Some(ScaleFactors::IDENTITY));
}

#[test]
fn half_of_a_rotation_is_half_of_its_angle_about_the_same_axis() {
    let whole = ParentRotation(Quat::from_rotation_z(1.2));
    assert!(apart(whole.part(0.5).0, Quat::from_rotation_z(0.6)) < 1e-6);
    assert_eq!(whole.part(1.0), whole);
    assert_eq!(whole.part(0.0), ParentRotation::IDENTITY);
    assert_eq!(whole.part(f32::NAN), ParentRotation::IDENTITY);
    assert_eq!(whole.part(7.0), whole);
    assert_eq!(ScaleFactors(Vec3::splat(3.0)).part(0.5), ScaleFactors(Vec3::splat(2.0)));
    assert_eq!(AddedTranslation(Vec3::X).part(0.25), AddedTranslation(Vec3::X * 0.25));
}

#[test]
fn a_falloff_is_whole_at_the_chosen_keys_and_falls_to_nothing_at_its_end() {
    for shape in FalloffShape::ALL {
        assert_eq!((shape.weight(0.0), shape.weight(1.0)), (0.0, 1.0), "{shape:?}");
        let weights: Vec<f32> = (0..=100).map(|step| shape.weight(step as f32 / 100.0)).collect();
        assert!(weights.is_sorted(), "{shape:?}: {weights:?}");
    }
    let half = |shape: FalloffShape| shape.weight(0.5);
    assert_eq!(half(FalloffShape::Linear), 0.5);
    assert_eq!(half(FalloffShape::Smooth), 0.5);
    assert_eq!(half(FalloffShape::Sharp), 0.25);
    assert!((half(FalloffShape::Sphere) - 0.75_f32.sqrt()).abs() < 1e-6);
}

#[test]
fn the_weight_of_a_key_is_that_of_the_nearest_chosen_key() {
    let times = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 9.0];
    let falloff = Falloff { seconds: 2.0, shape: FalloffShape::Linear };
    let weights = |chosen: &[u32], falloff: Option<Falloff>| -> Vec<(u32, f32)> {
        weights_of_keys(&times, chosen, falloff).into_iter().map(|key| (key.key, key.weight)).collect()
    };
    assert_eq!(weights(&[1, 5], None), [(1, 1.0), (5, 1.0)]);
    assert_eq!(weights(&[1, 5], Some(falloff)), [(0, 0.5), (1, 1.0), (2, 0.5), (4, 0.5), (5, 1.0)]);
    assert_eq!(weights(&[], Some(falloff)), []);
    assert_eq!(weights(&[6], Some(Falloff { seconds: 0.0, ..falloff })), [(6, 1.0)]);
}

#[test]
fn the_weights_of_a_range_are_whole_inside_and_fall_off_outside() {
    let times = [0.0, 1.0, 2.0, 3.0, 4.0];
    let weights = |range: [f32; 2], falloff: Option<Falloff>| -> Vec<(u32, f32)> {
        weights_of_range(&times, range, falloff).into_iter().map(|key| (key.key, key.weight)).collect()
    };
    let falloff = Falloff { seconds: 2.0, shape: FalloffShape::Linear };
    assert_eq!(weights([1.0, 2.5], None), [(1, 1.0), (2, 1.0)]);
    assert_eq!(weights([2.0, 2.0], Some(falloff)), [(1, 0.5), (2, 1.0), (3, 0.5)]);
    assert_eq!(weights([1.5, 2.5], Some(falloff)), [(0, 0.25), (1, 0.75), (2, 1.0), (3, 0.75), (4, 0.25)]);
    assert_eq!(weights([7.0, 8.0], None), []);
}
