//! Additive layers: the difference between two poses, applied to a third one.

use crate::blending::{a_pose, a_pose_with_size, all_bits, assert_sound, bits, hostile};
use crate::support::angle_between;
use dragonfly_anim::blend::{Mask, add, add_to, difference, difference_of};
use dragonfly_anim::data::Transform;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use proptest::prelude::*;

const REST: Transform = Transform::IDENTITY;

proptest! {
    #[test]
    fn weight_zero_and_an_identity_difference_keep_the_base(
        base in a_pose(), other in a_pose(), weight in 0.0_f32..5.0,
    ) {
        for none in [0.0, -0.0, -weight - 1e-9, f32::NAN] {
            prop_assert_eq!(bits(add_to(base, other, none)), bits(base));
        }
        prop_assert_eq!(bits(add_to(base, REST, weight)), bits(base));
        prop_assert_eq!(difference_of(other, other), REST);
        let flipped = Transform { rotation: -other.rotation, ..other };
        prop_assert_eq!(difference_of(other, flipped), REST);
    }

    #[test]
    fn a_difference_added_to_its_reference_is_the_pose(pose in a_pose(), reference in a_pose_with_size()) {
        let got = add_to(reference, difference_of(pose, reference), 1.0);
        // Relative to the longer of the two translations, which determines the rounding error.
        let size = pose.translation.length().max(reference.translation.length()).max(1.0);
        prop_assert!(got.translation.distance(pose.translation) < 1e-6 * size, "{got:?}");
        prop_assert!(angle_between(got.rotation, pose.rotation) < 1e-6, "{got:?}");
        prop_assert!(got.scale.distance(pose.scale) < 1e-6 * pose.scale.length().max(1.0), "{got:?}");
    }

    #[test]
    fn adding_half_a_difference_twice_is_adding_it_once(pose in a_pose(), reference in a_pose()) {
        let more = difference_of(pose, reference);
        let twice = add_to(add_to(reference, more, 0.5), more, 0.5);
        let once = add_to(reference, more, 1.0);
        prop_assert!(twice.translation.distance(once.translation) < 1e-4);
        prop_assert!(angle_between(twice.rotation, once.rotation) < 4e-6);
    }
}

#[test]
fn an_additive_nod_is_the_same_nod_on_every_base_pose() {
    let nod = Transform { rotation: Quat::from_rotation_x(0.6), ..REST };
    let reference = Transform { rotation: Quat::from_rotation_y(1.0), ..REST };
    let nodding = Transform { rotation: nod.rotation * reference.rotation, ..REST };
    let running = Transform {
        rotation: Quat::from_rotation_z(0.5),
        translation: Vec3::new(1.0, 2.0, 3.0),
        scale: Vec3::new(2.0, -1.0, 0.0),
    };
    let mut differences = [REST];
    difference(&[nodding], &[reference], &mut differences);
    let mut out = [REST];
    for (weight, angle) in [(1.0, 0.6), (0.5, 0.3), (2.0, 1.2)] {
        add(&[running], &differences, weight, None, &mut out);
        let expected = Quat::from_rotation_x(angle) * running.rotation;
        assert!(angle_between(out[0].rotation, expected) < 1e-6, "{weight}");
        assert_eq!((out[0].translation, out[0].scale), (running.translation, running.scale));
    }
}

#[test]
fn translations_are_added_and_scales_multiplied() {
    let (pose, reference) = (
        Transform { translation: Vec3::new(3.0, 2.0, 1.0), scale: Vec3::new(2.0, 3.0, 0.5), ..REST },
        Transform { translation: Vec3::ONE, scale: Vec3::new(1.0, 2.0, 1.0), ..REST },
    );
    let more = difference_of(pose, reference);
    assert_eq!((more.translation, more.scale), (Vec3::new(2.0, 1.0, 0.0), Vec3::new(2.0, 1.5, 0.5)));
    let base = Transform { translation: Vec3::X, scale: Vec3::splat(4.0), ..REST };
    let half = add_to(base, more, 0.5);
    assert_eq!((half.translation, half.scale), (Vec3::new(2.0, 0.5, 0.0), Vec3::new(6.0, 5.0, 3.0)));
}

#[test]
fn the_factor_from_a_reference_scale_of_zero_is_one() {
    let flat = Transform { scale: Vec3::new(0.0, 1.0, -0.0), ..REST };
    assert_eq!(difference_of(REST, flat).scale, Vec3::ONE);
    assert_eq!(difference_of(flat, REST).scale, Vec3::new(0.0, 1.0, 0.0));
    let tiny = Transform { scale: Vec3::splat(1e-45), ..REST };
    assert_eq!(difference_of(Transform { scale: Vec3::splat(1e30), ..REST }, tiny).scale, Vec3::ONE);
}

#[test]
fn parts_without_a_difference_keep_every_bit() {
    let base =
        Transform { translation: Vec3::new(-0.0, 1e-45, 0.1), scale: Vec3::new(-0.0, 0.1, 3.0), ..REST };
    let turn = Transform { rotation: Quat::from_rotation_y(0.5), ..REST };
    for weight in [0.3, 1.0, 2.0] {
        let added = add_to(base, turn, weight);
        assert_eq!(bits(Transform { rotation: base.rotation, ..added }), bits(base), "{weight}");
    }
}

#[test]
fn very_different_scales_are_restored() {
    let (tiny, huge) =
        (Transform { scale: Vec3::splat(1.1e-6), ..REST }, Transform { scale: Vec3::splat(3.3e4), ..REST });
    for (pose, reference) in [(tiny, huge), (huge, tiny)] {
        let got = add_to(reference, difference_of(pose, reference), 1.0).scale.x;
        assert!((got / pose.scale.x - 1.0).abs() < 1e-6, "{got}");
    }
}

#[test]
fn a_mask_weights_the_difference_of_each_bone() {
    let step = [Transform { translation: Vec3::X, ..REST }; 4];
    let mask = Mask::from_weights([0.0, 0.5, 1.0]);
    let mut out = [REST; 5];
    add(&[REST; 5], &step, 2.0, Some(&mask), &mut out);
    assert_eq!(out.map(|pose| pose.translation.x), [0.0, 1.0, 2.0, 0.0, 0.0]);
    // Shorter slices: the base stays, or the identity is used.
    add(&step[..2], &step[..1], 1.0, None, &mut out);
    assert_eq!(out.map(|pose| pose.translation.x), [2.0, 1.0, 0.0, 0.0, 0.0]);
    difference(&step, &[REST; 3], &mut out);
    assert_eq!(out.map(|pose| pose.translation.x), [1.0, 1.0, 1.0, 0.0, 0.0]);
}

#[test]
fn invalid_differences_give_finite_results() {
    let seed = seed(46);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..20_000 {
        let (a, b, c) = (hostile(&mut random), hostile(&mut random), hostile(&mut random));
        assert_sound(difference_of(a, b), &format!("{round}"));
        for weight in [f32::NAN, f32::INFINITY, -1.0, 1e-45, 0.3, 1.0, 1e30] {
            assert_sound(add_to(a, b, weight), &format!("{round} {weight}"));
            assert_sound(add_to(c, difference_of(a, b), weight), &format!("{round} {weight}"));
        }
    }
}

#[test]
fn adding_allocates_nothing() {
    let (mut more, mut out) = ([REST; 9], [REST; 9]);
    let (count, ()) = count(|| {
        difference(&[REST; 9], &[REST; 9], &mut more);
        add(&[REST; 9], &more, 0.5, None, &mut out);
    });
    assert_eq!(count.allocations, 0);
    assert_eq!(all_bits(&out), all_bits(&[REST; 9]));
}
