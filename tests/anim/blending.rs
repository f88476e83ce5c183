//! Blending several poses into one, bone by bone.

use crate::support::angle_between;
use dragonfly_anim::blend::{Layer, Mask, blend, blend_normalized, blend_two, mix_poses, weight_at};
use dragonfly_anim::data::{Channel, Interpolation, Transform};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use proptest::prelude::*;

const REST: Transform = Transform::IDENTITY;

pub(crate) fn bits(pose: Transform) -> [u32; 10] {
    let mut all = [0; 10];
    let parts = pose.translation.to_array().into_iter();
    let parts = parts.chain(pose.rotation.to_array()).chain(pose.scale.to_array());
    for (bits, number) in all.iter_mut().zip(parts) {
        *bits = number.to_bits();
    }
    all
}

pub(crate) fn all_bits(poses: &[Transform]) -> Vec<[u32; 10]> {
    poses.iter().copied().map(bits).collect()
}

/// Any rotation, of unit length.
pub(crate) fn a_rotation() -> impl Strategy<Value = Quat> {
    prop::array::uniform4(-1.0_f32..1.0)
        .prop_filter("some length", |numbers| {
            numbers.iter().map(|number| number * number).sum::<f32>() > 0.01
        })
        .prop_map(|numbers| Quat::from_array(numbers).normalize())
}

/// A pose that a skeleton may have.
pub(crate) fn a_pose() -> impl Strategy<Value = Transform> {
    let vector = |size: f32| prop::array::uniform3(-size..size).prop_map(Vec3::from_array);
    let scale = vector(2.0);
    (vector(100.0), a_rotation(), scale).prop_map(|(translation, rotation, scale)| Transform {
        translation,
        rotation,
        scale,
    })
}

/// The same without axes scaled to nearly zero.
pub(crate) fn a_pose_with_size() -> impl Strategy<Value = Transform> {
    let away = |number: f32| number + 0.05_f32.copysign(number);
    a_pose().prop_map(move |pose| Transform { scale: pose.scale.map(away), ..pose })
}

/// Poses of 1 to 4 layers for 3 bones, each with a weight.
fn some_layers() -> impl Strategy<Value = Vec<(Vec<Transform>, f32)>> {
    prop::collection::vec((prop::collection::vec(a_pose(), 3), 0.01_f32..3.0), 1..5)
}

fn layers(poses: &[(Vec<Transform>, f32)]) -> Vec<Layer<'_>> {
    poses.iter().map(|(poses, weight)| Layer::new(poses, *weight)).collect()
}

proptest! {
    #[test]
    fn a_blend_of_a_pose_with_itself_is_the_pose(
        pose in prop::collection::vec(a_pose(), 4),
        weights in prop::collection::vec(0.0_f32..2.0, 1..6),
        flip: bool,
    ) {
        // The same rotations, some with the other sign.
        let flipped: Vec<Transform> =
            pose.iter().map(|pose| Transform { rotation: -pose.rotation, ..*pose }).collect();
        let layers: Vec<Layer> = weights
            .iter()
            .enumerate()
            .map(|(at, &weight)| Layer::new(if flip && at % 2 == 1 { &flipped } else { &pose }, weight))
            .collect();
        let mut out = vec![REST; 4];
        // The base gets the remaining weight and has the same pose.
        blend(&pose, &layers, &mut out);
        for (out, pose) in out.iter().zip(&pose) {
            let signed = if out.rotation.dot(pose.rotation) < 0.0 { -out.rotation } else { out.rotation };
            prop_assert_eq!(bits(Transform { rotation: signed, ..*out }), bits(*pose));
        }
        blend_two(&pose, &pose, weights[0], None, &mut out);
        prop_assert_eq!(all_bits(&out), all_bits(&pose));
    }

    #[test]
    fn a_common_factor_of_all_weights_changes_nothing(
        poses in some_layers(), factor in 1.0_f32..1e4, doublings in 0_i32..60,
    ) {
        // Scaled to a sum of at least 1, so that the base has no share.
        let sum: f32 = poses.iter().map(|(_, weight)| weight).sum();
        let up = if sum < 1.0 { 1.01 / sum } else { 1.0 };
        let scaled = |factor: f32| -> Vec<_> {
            poses.iter().map(|(pose, weight)| (pose.clone(), weight * up * factor)).collect()
        };
        let (mut once, mut again) = (vec![REST; 3], vec![REST; 3]);
        blend(&[REST; 3], &layers(&scaled(1.0)), &mut once);
        // A power of two does not round the weights.
        blend(&[REST; 3], &layers(&scaled(2.0_f32.powi(doublings))), &mut again);
        prop_assert_eq!(all_bits(&once), all_bits(&again));
        // Without a base, also for small weights.
        blend_normalized(&[REST; 3], &layers(&scaled(2.0_f32.powi(-doublings))), &mut again);
        prop_assert_eq!(all_bits(&once), all_bits(&again));
        blend(&[REST; 3], &layers(&scaled(factor)), &mut again);
        for (a, b) in once.iter().zip(&again) {
            // Relative to the largest numbers that are blended.
            prop_assert!(a.translation.distance(b.translation) < 100.0 * 4e-7);
            prop_assert!(angle_between(a.rotation, b.rotation) < 2e-6 && a.scale.distance(b.scale) < 2e-6);
        }
    }

    #[test]
    fn the_order_of_layers_does_not_matter(
        mut poses in some_layers(), equal: bool, turns in 0_usize..5, swap: bool,
    ) {
        if equal {
            // Equal weights: the choice of the hemisphere must not depend on the order either.
            poses.iter_mut().for_each(|(_, weight)| *weight = 0.4);
        }
        let mut shuffled = poses.clone();
        let count = shuffled.len();
        shuffled.rotate_left(turns % count);
        if swap {
            shuffled.reverse();
        }
        let (mut once, mut again) = (vec![REST; 3], vec![REST; 3]);
        blend(&[REST; 3], &layers(&poses), &mut once);
        blend(&[REST; 3], &layers(&shuffled), &mut again);
        for (a, b) in once.iter().zip(&again) {
            prop_assert!(a.translation.distance(b.translation) < 100.0 * 4e-7);
            prop_assert!(angle_between(a.rotation, b.rotation) < 2e-6 && a.scale.distance(b.scale) < 2e-6);
        }
    }

    #[test]
    fn masks_of_zero_and_one_select_exactly(a in prop::collection::vec(a_pose(), 4),
        b in prop::collection::vec(a_pose(), 4), chosen in prop::collection::vec(any::<bool>(), 4)) {
        let mask = Mask::from_weights(chosen.iter().map(|&chosen| f32::from(u8::from(chosen))));
        let rest = mask.clone().inverted();
        let mut out = vec![REST; 4];
        blend(&[REST; 4], &[Layer::new(&a, 1.0).masked(&mask), Layer::new(&b, 1.0).masked(&rest)], &mut out);
        let expected: Vec<Transform> =
            (0..4).map(|bone| if chosen[bone] { a[bone] } else { b[bone] }).collect();
        prop_assert_eq!(all_bits(&out), all_bits(&expected));
        blend_two(&b, &a, 1.0, Some(&mask), &mut out);
        prop_assert_eq!(all_bits(&out), all_bits(&expected));
        // The base is used where no layer has a weight.
        blend(&b, &[Layer::new(&a, 5.0).masked(&mask)], &mut out);
        prop_assert_eq!(all_bits(&out), all_bits(&expected));
    }
}

#[test]
fn the_base_gets_the_remaining_weight() {
    let pose = |x: f32, angle: f32| Transform {
        translation: Vec3::new(x, 0.0, 0.0),
        rotation: Quat::from_rotation_z(angle),
        scale: Vec3::splat(x),
    };
    let (base, a, b) = ([pose(8.0, 0.0)], [pose(16.0, 0.4)], [pose(32.0, -0.4)]);
    let mut out = [REST];
    let mut blended = |weights: [f32; 2]| {
        blend(&base, &[Layer::new(&a, weights[0]), Layer::new(&b, weights[1])], &mut out);
        out[0]
    };
    // 1/2 · 8 + 1/4 · 16 + 1/4 · 32; the rotations cancel.
    let half = blended([0.25, 0.25]);
    assert_eq!((half.translation.x, half.scale.y), (16.0, 16.0));
    assert!(angle_between(half.rotation, Quat::IDENTITY) < 1e-6);
    // 1/4 · 16 + 3/4 · 32: sums above 1 are normalized.
    assert_eq!(blended([2.0, 6.0]).translation.x, 28.0);
    assert_eq!(bits(blended([0.0, 0.0])), bits(base[0]));
    let mut out = [REST];
    blend_normalized(&base, &[Layer::new(&a, 0.25), Layer::new(&b, 0.25)], &mut out);
    assert_eq!(out[0].translation.x, 24.0);
    blend_normalized(&base, &[Layer::new(&a, 0.0)], &mut out);
    assert_eq!(bits(out[0]), bits(base[0]));
}

#[test]
fn weights_that_sum_to_one_except_for_rounding_leave_nothing_to_the_base() {
    let pose = [Transform { translation: Vec3::new(0.1, 0.2, 0.3), ..REST }];
    let base = [Transform { translation: Vec3::splat(1e6), ..REST }];
    for weights in [&[0.7_f32, 0.2, 0.1][..], &[0.1; 10], &[1.0 / 3.0; 3], &[1.0 / 49.0; 49]] {
        let layers: Vec<Layer> = weights.iter().map(|&weight| Layer::new(&pose, weight)).collect();
        let mut out = [REST];
        blend(&base, &layers, &mut out);
        assert_eq!(bits(out[0]), bits(pose[0]), "{weights:?}");
    }
}

#[test]
fn an_invalid_weight_counts_as_zero() {
    let (a, b) = ([Transform { translation: Vec3::X, ..REST }], [Transform { translation: Vec3::Y, ..REST }]);
    for none in [0.0, -0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
        let mut out = [REST];
        blend(&[REST], &[Layer::new(&a, none), Layer::new(&b, 1.0)], &mut out);
        assert_eq!(bits(out[0]), bits(b[0]), "{none}");
        assert_eq!(bits(mix_poses(a[0], b[0], none)), bits(a[0]), "{none}");
    }
    let mut out = [REST];
    blend(&[REST], &[Layer::new(&a, f32::INFINITY), Layer::new(&b, 1.0)], &mut out);
    assert!(
        out[0].translation.distance(Vec3::X) < 1e-30,
        "the other numbers are negligible relative to the largest one"
    );
    blend(&[REST], &[Layer::new(&a, f32::INFINITY), Layer::new(&b, f32::MAX)], &mut out);
    assert_eq!(out[0].translation, Vec3::new(0.5, 0.5, 0.0));
    blend(&[REST], &[Layer::new(&a, 1e-45), Layer::new(&b, 1e-45)], &mut out);
    assert!(out[0].translation.length() < 1e-40, "the base gets nearly all the weight");
    blend_normalized(&[REST], &[Layer::new(&a, 1e-45), Layer::new(&b, 1e-45)], &mut out);
    assert_eq!(out[0].translation, Vec3::new(0.5, 0.5, 0.0));
    assert_eq!(bits(mix_poses(a[0], b[0], f32::INFINITY)), bits(b[0]));
}

#[test]
fn a_layer_does_not_affect_bones_that_it_lacks() {
    let (short, long) =
        ([Transform { translation: Vec3::X, ..REST }], [Transform { translation: Vec3::Y, ..REST }; 3]);
    let mut out = [Transform { translation: Vec3::NAN, ..REST }; 4];
    blend(&long[..2], &[Layer::new(&short, 1.0), Layer::new(&long, 1.0)], &mut out);
    let half = Vec3::new(0.5, 0.5, 0.0);
    assert_eq!(out.map(|pose| pose.translation), [half, Vec3::Y, Vec3::Y, Vec3::ZERO]);
    blend(&[], &[], &mut out);
    assert_eq!(out, [REST; 4]);
    blend(&long, &[Layer::new(&long, 1.0)], &mut []);
    // Many more layers than bones.
    let many = vec![Layer::new(&short, 0.01); 1_000];
    blend(&[REST], &many, &mut out[..1]);
    assert_eq!(bits(out[0]), bits(short[0]));
    blend_two(&long, &short, 1.0, None, &mut out);
    assert_eq!(out.map(|pose| pose.translation), [Vec3::X, Vec3::Y, Vec3::Y, Vec3::ZERO]);
}

#[test]
fn the_blend_of_three_distant_rotations_depends_on_neither_order_nor_signs() {
    // 120° apart about one axis: the hardest case, no hemisphere contains all of them.
    let turns = [0.0_f32, 2.1, -2.1].map(Quat::from_rotation_y);
    let mut results = Vec::new();
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for signs in 0..8 {
            let poses = order.map(|at: usize| {
                let rotation = turns[at] * if signs >> at & 1 == 1 { -1.0 } else { 1.0 };
                [Transform { rotation, ..REST }]
            });
            let mut out = [REST];
            blend(&[REST], &poses.each_ref().map(|pose| Layer::new(pose, 1.0)), &mut out);
            results.push(out[0].rotation);
        }
    }
    for result in &results {
        assert!(angle_between(*result, results[0]) < 1e-6, "{results:?}");
        assert!((result.length() - 1.0).abs() < 1e-6);
    }
}

/// The largest angle in degrees between the normalized sum of two rotations `apart` and their slerp.
fn worst_of_nlerp(apart: f32) -> f32 {
    let poses =
        [0.0, apart.to_radians()].map(|angle| [Transform { rotation: Quat::from_rotation_x(angle), ..REST }]);
    let mut worst = 0.0_f32;
    for step in 0..=1_000 {
        let mix = step as f32 / 1_000.0;
        let (mut sum, mut two) = ([REST], [REST]);
        blend(&[REST], &[Layer::new(&poses[0], 1.0 - mix), Layer::new(&poses[1], mix)], &mut sum);
        blend_two(&poses[0], &poses[1], mix, None, &mut two);
        let expected = Quat::from_rotation_x(mix * apart.to_radians());
        assert!(angle_between(two[0].rotation, expected) < 2e-6, "slerp rotates at a constant speed: {mix}");
        worst = worst.max(angle_between(sum[0].rotation, expected));
    }
    worst.to_degrees()
}

#[test]
fn the_sum_of_two_rotations_is_within_the_documented_distance_of_the_slerp() {
    for (apart, off) in [(30.0, 0.034), (60.0, 0.27), (90.0, 0.92), (120.0, 2.3), (179.99, 8.2)] {
        let worst = worst_of_nlerp(apart);
        assert!(worst <= off && worst > 0.95 * off, "{apart}°: {worst}°");
    }
}

#[test]
fn a_weight_follows_its_curve_and_stays_within_zero_and_one() {
    let curve = |values: &[f32], interpolation| Channel::new([1.0, 2.0], values.to_vec(), interpolation);
    let linear = curve(&[0.0, 1.0], Interpolation::Linear);
    for (time, weight) in [(0.0, 0.0), (1.25, 0.25), (2.0, 1.0), (9.0, 1.0), (f32::NAN, 0.0)] {
        assert_eq!(weight_at(&linear, 0.5, time), weight, "{time}");
    }
    assert_eq!(weight_at(&curve(&[0.2, 0.8], Interpolation::Step), 0.5, 1.9), 0.2);
    assert_eq!(weight_at(&curve(&[0.2, 0.8], Interpolation::Closest), 0.5, 1.5), 0.8);
    // Half way: mean of the values + 1/8 · (out-tangent − in-tangent), far above 1.
    let spline = curve(&[0.0, 0.5, 16.0, -16.0, 0.5, 0.0], Interpolation::CubicSpline);
    assert_eq!(weight_at(&spline, 0.5, 1.5), 1.0);
    let gentle = curve(&[0.0, 0.5, 1.0, -1.0, 0.5, 0.0], Interpolation::CubicSpline);
    assert_eq!(weight_at(&gentle, 0.5, 1.5), 0.75);
    assert_eq!(weight_at(&Channel::default(), 0.5, 1.0), 0.5, "no key");
    assert_eq!(weight_at(&Channel::default(), f32::NAN, 1.0), 0.0);
    assert_eq!(weight_at(&curve(&[f32::NAN, -3.0], Interpolation::Linear), 0.5, 1.0), 0.5);
    assert_eq!(weight_at(&curve(&[f32::NAN, -3.0], Interpolation::Linear), 0.5, 2.0), 0.0);
}

/// A pose of numbers that break calculations.
pub(crate) fn hostile(random: &mut Random) -> Transform {
    const NUMBERS: [f32; 10] =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 0.0, -0.0, 1e-45, 1e-30, 1.0];
    let mut number = || {
        if random.below(3) == 0 { random.between(-2.0, 2.0) } else { random.choice(&NUMBERS) }
    };
    Transform {
        translation: Vec3::new(number(), number(), number()),
        rotation: Quat::from_xyzw(number(), number(), number(), number()),
        scale: Vec3::new(number(), number(), number()),
    }
}

#[track_caller]
pub(crate) fn assert_sound(pose: Transform, what: &str) {
    assert!(pose.is_finite(), "{what}: {pose:?}");
    assert!((pose.rotation.length() - 1.0).abs() < 2e-4, "{what}: {pose:?}");
}

#[test]
fn invalid_poses_and_weights_give_finite_results() {
    let seed = seed(45);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let weights = [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e-45, 0.3, 1.0, f32::MAX];
    for round in 0..20_000 {
        let poses: Vec<[Transform; 2]> =
            (0..1 + random.below(4)).map(|_| [hostile(&mut random), hostile(&mut random)]).collect();
        let layers: Vec<Layer> = poses.iter().map(|pose| Layer::new(pose, random.choice(&weights))).collect();
        let base = [hostile(&mut random)];
        let mut out = [hostile(&mut random); 2];
        blend(&base, &layers, &mut out);
        out.iter().for_each(|pose| assert_sound(*pose, &format!("{round}")));
        blend_normalized(&base, &layers, &mut out);
        out.iter().for_each(|pose| assert_sound(*pose, &format!("{round}")));
        let mix = random.choice(&weights);
        assert_sound(mix_poses(base[0], poses[0][0], mix), &format!("{round}, two"));
    }
}

#[test]
fn the_largest_floats_blend_to_finite_results() {
    let pose = |x: f32| [Transform { translation: Vec3::splat(x), scale: Vec3::splat(-x), ..REST }];
    let (most, nearly) = (pose(f32::MAX), pose(f32::MAX.next_down()));
    for count in 2..100 {
        let layers: Vec<Layer> =
            (0..count).map(|at| Layer::new(if at % 2 == 0 { &most } else { &nearly }, 1.0)).collect();
        let mut out = [REST];
        blend(&[REST], &layers, &mut out);
        assert!(out[0].is_finite() && out[0].translation.x > 3.4e38, "{count}: {:?}", out[0]);
    }
}

#[test]
fn blending_allocates_nothing() {
    let poses = vec![[REST; 50]; 4];
    let mask = Mask::uniform(50, 0.5);
    let layers: Vec<Layer> = poses.iter().map(|pose| Layer::new(pose, 0.3).masked(&mask)).collect();
    let mut out = [REST; 50];
    let (count, ()) = count(|| {
        blend(&poses[0], &layers, &mut out);
        blend_normalized(&poses[0], &layers, &mut out);
        blend_two(&poses[0], &poses[1], 0.5, Some(&mask), &mut out);
    });
    assert_eq!(count.allocations, 0);
}
