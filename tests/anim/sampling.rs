//! Values between two keys, compared with values computed by hand.

use crate::support::{about_z, along_x, angle_between, bone, take};
use dragonfly_anim::data::{Channel, Interpolation, Keyframe, MorphTrack, Skeleton, Take, Track, Transform};
use dragonfly_anim::sample::{
    PlayMode, find_keys, keyframe_at, sample_channel, sample_channel_with, sample_morph_weights, sample_take,
    sample_track,
};
use glam::{Quat, Vec3};

/// The thesis's example (§2.1.5.2): one second, a key every 100 ms. Key k (counted from 1) has k along x as its
/// translation, 2k as its scale, and a rotation by 0.1·k.
fn worked_example() -> Track {
    let keys = |factor: f32| (0..=10).map(|k| (k as f32 * 0.1, (k + 1) as f32 * factor)).collect::<Vec<_>>();
    Track {
        bone: 0,
        translation: along_x(&keys(1.0), Interpolation::Linear),
        rotation: about_z(&keys(0.1), Interpolation::Linear),
        scale: along_x(&keys(2.0), Interpolation::Linear),
    }
}

#[test]
fn the_worked_example_mixes_keys_four_and_five_half_and_half() {
    let track = worked_example();
    let keys = find_keys(&track.translation.times, 0.35).unwrap();
    // Counted from zero here, from one in the thesis.
    assert_eq!((keys.before + 1, keys.after + 1), (4, 5));
    assert!((keys.mix - 0.5).abs() < 1e-6, "{}", keys.mix);

    let pose = sample_track(&track, &bone("only", None, Vec3::ZERO), 0.35);
    assert!((pose.translation.x - (0.5 * 4.0 + 0.5 * 5.0)).abs() < 1e-5, "{pose:?}");
    assert!((pose.scale.x - (0.5 * 8.0 + 0.5 * 10.0)).abs() < 1e-5, "{pose:?}");
    assert!(angle_between(pose.rotation, Quat::from_rotation_z(0.45)) < 1e-6, "{pose:?}");
    assert!((pose.rotation.length() - 1.0).abs() < 1e-6);
}

#[test]
fn the_worked_example_gives_the_preceding_or_the_closest_key_by_the_other_two_methods() {
    let mut track = worked_example();
    let bone = bone("only", None, Vec3::ZERO);
    track.translation.interpolation = Interpolation::Step;
    assert_eq!(sample_track(&track, &bone, 0.35).translation.x, 4.0, "the last, preceding key");
    assert_eq!(sample_track(&track, &bone, 0.399).translation.x, 4.0);
    assert_eq!(sample_track(&track, &bone, 0.4).translation.x, 5.0);
    track.translation.interpolation = Interpolation::Closest;
    assert_eq!(sample_track(&track, &bone, 0.34).translation.x, 4.0, "the closest key");
    assert_eq!(sample_track(&track, &bone, 0.36).translation.x, 5.0);
}

#[test]
fn half_way_the_closest_key_is_the_later_one() {
    let channel = along_x(&[(0.0, 1.0), (2.0, 3.0)], Interpolation::Closest);
    assert_eq!(sample_channel(&channel, Vec3::ZERO, 1.0).x, 3.0);
    assert_eq!(sample_channel(&channel, Vec3::ZERO, 1.0_f32.next_down()).x, 1.0);
}

#[test]
fn the_temporary_key_frame_contains_the_time_and_the_pose() {
    let (track, bone) = (worked_example(), bone("only", None, Vec3::ZERO));
    let pose = sample_track(&track, &bone, 0.35);
    assert_eq!(keyframe_at(&track, &bone, 0.35), Keyframe { time: 0.35, pose });
    assert_eq!(keyframe_at(&track, &bone, f32::NAN).time, 0.0);
}

#[test]
fn a_cubic_spline_follows_its_tangents() {
    // In-tangent, value, out-tangent of each key; two seconds between the keys.
    let x = |value: f32| Vec3::new(value, 0.0, 0.0);
    let channel = Channel::new(
        [1.0, 3.0],
        [x(99.0), x(1.0), x(4.0), x(-2.0), x(5.0), x(99.0)],
        Interpolation::CubicSpline,
    );
    // At m = 1/4 with span 2: value 27/32 · 1 + 5/32 · 5, tangents 2 · (9/64 · 4 − 3/64 · −2).
    let expected = 27.0 / 32.0 + 25.0 / 32.0 + 2.0 * (36.0 / 64.0 + 6.0 / 64.0);
    let got = sample_channel(&channel, Vec3::ZERO, 1.5).x;
    assert!((got - expected).abs() < 1e-6, "{got} {expected}");
    // Half way: (1 + 5)/2 + 2/8 · (4 − −2).
    assert!((sample_channel(&channel, Vec3::ZERO, 2.0).x - 4.5).abs() < 1e-6);
    for (time, value) in [(1.0, 1.0), (3.0, 5.0), (0.0, 1.0), (9.0, 5.0)] {
        assert_eq!(sample_channel(&channel, Vec3::ZERO, time).x, value, "{time}");
    }
}

#[test]
fn a_cubic_rotation_is_normalized() {
    let none = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let (a, b) = (Quat::IDENTITY, Quat::from_rotation_z(2.0));
    let channel = Channel::new([0.0, 1.0], [none, a, none, none, b, none], Interpolation::CubicSpline);
    let half = sample_channel(&channel, Quat::IDENTITY, 0.5);
    assert!((half.length() - 1.0).abs() < 1e-6);
    // Without tangents the middle is the mean by symmetry.
    assert!(angle_between(half, Quat::from_rotation_z(1.0)) < 1e-6, "{half}");
}

#[test]
fn rotations_have_constant_speed_and_take_the_shorter_way() {
    let near = about_z(&[(0.0, 0.0), (1.0, 1.5)], Interpolation::Linear);
    for step in 0..=8 {
        let time = step as f32 / 8.0;
        let got = sample_channel(&near, Quat::IDENTITY, time);
        assert!(angle_between(got, Quat::from_rotation_z(1.5 * time)) < 1e-6, "{time}");
    }
    // From 3 rad to -1 rad is 4 rad one way, and 2.28 rad the other way.
    let far = about_z(&[(0.0, 3.0), (1.0, -1.0)], Interpolation::Linear);
    let half = sample_channel(&far, Quat::IDENTITY, 0.5);
    assert!(angle_between(half, Quat::from_rotation_z(1.0 + std::f32::consts::PI)) < 1e-6, "{half}");
}

#[test]
fn on_a_key_the_value_is_the_keys_bit_for_bit() {
    // One part in a thousand million from round numbers, so that any calculation would show.
    let values: Vec<Vec3> =
        (0..50).map(|k| Vec3::new(0.1 * k as f32, 1.0 / (k + 3) as f32, -1e-41)).collect();
    let turns: Vec<Quat> =
        (0..50).map(|k| Quat::from_xyzw(0.1, k as f32, 1.0 / (k + 1) as f32, 0.3).normalize()).collect();
    let times: Vec<f32> = (0..50).map(|k| k as f32 / 30.0).collect();
    for interpolation in [Interpolation::Step, Interpolation::Linear, Interpolation::Closest] {
        let moves = Channel::new(times.clone(), values.clone(), interpolation);
        let rotates = Channel::new(times.clone(), turns.clone(), interpolation);
        for (key, &time) in times.iter().enumerate() {
            let bits = |vector: Vec3| vector.to_array().map(f32::to_bits);
            assert_eq!(bits(sample_channel(&moves, Vec3::ZERO, time)), bits(values[key]));
            let got = sample_channel(&rotates, Quat::IDENTITY, time).to_array().map(f32::to_bits);
            assert_eq!(got, turns[key].to_array().map(f32::to_bits));
        }
    }
}

#[test]
fn properties_without_keys_keep_the_rest_pose_bit_for_bit() {
    let mut bone = bone("only", None, Vec3::new(0.1, 0.2, 0.3));
    bone.rest.rotation = Quat::from_xyzw(0.1, 0.2, 0.3, 0.9).normalize();
    bone.rest.scale = Vec3::new(1.0, -2.0, 0.0);
    assert_eq!(sample_track(&Track::default(), &bone, 1.0), bone.rest);
    let track = Track { translation: along_x(&[(0.0, 7.0)], Interpolation::Linear), ..Track::default() };
    let expected = Transform { translation: Vec3::new(7.0, 0.0, 0.0), ..bone.rest };
    assert_eq!(sample_track(&track, &bone, 1.0), expected);
}

#[test]
fn a_take_poses_every_bone_and_no_take_is_the_rest_pose() {
    let skeleton = Skeleton { bones: vec![bone("a", None, Vec3::X), bone("b", Some(0), Vec3::Y)] };
    let moving =
        Track { translation: along_x(&[(0.0, 2.0), (1.0, 4.0)], Interpolation::Linear), ..Track::default() };
    // The second track is missing.
    let take = take(vec![moving]);
    let mut poses = [Transform::IDENTITY; 2];
    sample_take(Some(&take), &skeleton, 0.5, &mut poses);
    assert_eq!(poses.map(|pose| pose.translation), [Vec3::new(3.0, 0.0, 0.0), Vec3::Y]);
    sample_take(None, &skeleton, 0.5, &mut poses);
    assert_eq!(poses.map(|pose| pose.translation), [Vec3::X, Vec3::Y]);
}

#[test]
fn before_the_first_and_after_the_last_key_the_pose_stays() {
    let channel = along_x(&[(1.0, 10.0), (2.0, 20.0)], Interpolation::Linear);
    for (time, value) in [(-5.0, 10.0), (0.999, 10.0), (1.0, 10.0), (2.0, 20.0), (2.001, 20.0), (1e30, 20.0)]
    {
        assert_eq!(sample_channel(&channel, Vec3::ZERO, time).x, value, "{time}");
    }
}

#[test]
fn a_looped_clock_starts_the_take_again() {
    let track =
        Track { translation: along_x(&[(1.0, 0.0), (3.0, 2.0)], Interpolation::Linear), ..Track::default() };
    let take = take(vec![track]);
    let bone = bone("only", None, Vec3::ZERO);
    let at = |mode: PlayMode, clock: f32| {
        sample_track(&take.tracks[0], &bone, mode.map(&take, clock)).translation.x
    };
    assert_eq!(at(PlayMode::Loop, 2.5), 1.5);
    assert_eq!(at(PlayMode::Loop, 4.5), 1.5);
    assert_eq!(at(PlayMode::Loop, 3.0), 2.0);
    assert_eq!(at(PlayMode::Loop, 0.0), 1.0);
    assert_eq!(at(PlayMode::Clamp, 4.5), 2.0);
    assert_eq!(at(PlayMode::Clamp, -4.5), 0.0);
}

#[test]
fn morph_weights_are_interpolated_like_any_other_value() {
    let track = |interpolation, weights: &[f32]| Take {
        morphs: vec![MorphTrack {
            instance: 3,
            targets: 2,
            times: [0.0, 2.0].into(),
            weights: weights.into(),
            interpolation,
        }],
        ..Take::default()
    };
    let sampled = |take: &Take, instance: u32, time: f32| {
        let mut out = [f32::NAN; 3];
        sample_morph_weights(Some(take), instance, &[0.25, 0.5], time, &mut out);
        out
    };
    let linear = track(Interpolation::Linear, &[0.0, 1.0, 1.0, 0.0]);
    assert_eq!(sampled(&linear, 3, 0.5), [0.25, 0.75, 0.0]);
    assert_eq!(sampled(&linear, 3, 7.0), [1.0, 0.0, 0.0]);
    assert_eq!(sampled(&linear, 2, 0.5), [0.25, 0.5, 0.0], "another instance keeps its own weights");
    let step = track(Interpolation::Step, &[0.0, 1.0, 1.0, 0.0]);
    assert_eq!(sampled(&step, 3, 1.9), [0.0, 1.0, 0.0]);
    // All in-tangents, all values, all out-tangents of the first key; then of the second.
    let cubic =
        track(Interpolation::CubicSpline, &[9.0, 9.0, 0.0, 1.0, 4.0, 0.0, -4.0, 0.0, 1.0, 0.0, 9.0, 9.0]);
    // Half way: mean of the values + 2/8 · (out-tangent − in-tangent).
    assert_eq!(sampled(&cubic, 3, 1.0), [0.5 + 0.25 * 8.0, 0.5, 0.0]);
    assert_eq!(sampled(&cubic, 3, 2.0), [1.0, 0.0, 0.0]);
}

#[test]
fn a_custom_interpolation_is_called_only_between_keys_and_must_return_a_finite_value() {
    let channel = along_x(&[(1.0, 10.0), (2.0, 20.0), (4.0, 40.0)], Interpolation::Step);
    let x = |value: f32| Vec3::new(value, 0.0, 0.0);
    for (time, value) in [(0.0, 10.0), (1.0, 10.0), (2.0, 20.0), (4.0, 40.0), (9.0, 40.0), (f32::NAN, 10.0)] {
        let got = sample_channel_with(&channel, x(7.0), time, |_| panic!("asked at {time}"));
        assert_eq!(got, x(value), "{time}");
    }
    let got = sample_channel_with(&channel, x(7.0), 2.5, |between| {
        assert_eq!((between.before, between.after, between.seconds), (x(20.0), x(40.0), 2.0));
        assert_eq!((between.keys.before, between.keys.after, between.keys.mix), (1, 2, 0.25));
        x(33.0)
    });
    assert_eq!(got, x(33.0));
    assert_eq!(sample_channel_with(&channel, x(7.0), 2.5, |_| Vec3::NAN), x(20.0), "the previous key");
    let empty = Channel::<Vec3>::default();
    assert_eq!(sample_channel_with(&empty, x(7.0), 2.5, |_| panic!("no key")), x(7.0));
}
