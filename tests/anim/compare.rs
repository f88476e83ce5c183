//! The distance between two takes, compared with distances and angles computed by hand.

use dragonfly_anim::compare::{
    LONGEST_GAP, MOST_SAMPLES, compare_at, compare_takes, pair_bones, sample_times,
};
use dragonfly_anim::data::{Bone, Channel, Interpolation, MorphTrack, Skeleton, Take, Track, Transform};
use glam::{Mat4, Quat, Vec3};

fn skeleton(names: &[&str]) -> Skeleton {
    let bone = |(index, name): (usize, &&str)| Bone {
        name: (*name).to_owned(),
        parent: index.checked_sub(1).map(|parent| parent as u32),
        rest: Transform { translation: Vec3::Y, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    };
    Skeleton { bones: names.iter().enumerate().map(bone).collect() }
}

/// A take of two keys that turns bone 0 about z from 0 to `angle` radians within a second.
fn turn(bones: usize, angle: f32) -> Take {
    let mut tracks: Vec<Track> = (0..bones as u32).map(|bone| Track { bone, ..Track::default() }).collect();
    let rotations = vec![Quat::IDENTITY, Quat::from_rotation_z(angle)];
    tracks[0].rotation = Channel::new(vec![0.0, 1.0], rotations, Interpolation::Linear);
    Take { name: "turn".to_owned(), start: 0.0, length: 1.0, tracks, ..Take::default() }
}

#[test]
fn equal_takes_have_differences_of_exactly_zero() {
    let skeleton = skeleton(&["root", "arm", "hand"]);
    let take = turn(3, 1.0);
    let difference = compare_takes((&skeleton, &take), (&skeleton, &take));
    assert_eq!(difference.bones.len(), 3);
    for bone in &difference.bones {
        assert_eq!((bone.distance.value, bone.angle.value), (0.0, 0.0));
    }
    assert_eq!(difference.range, [0.0, 1.0]);
}

#[test]
fn a_turned_parent_moves_its_children_along_the_chord_and_turns_them_by_the_angle() {
    let skeleton = skeleton(&["root", "arm", "hand"]);
    let (still, turned) = (turn(3, 0.0), turn(3, 0.5));
    let difference = compare_takes((&skeleton, &still), (&skeleton, &turned));
    for (bone, radius) in difference.bones.iter().zip([0.0_f32, 1.0, 2.0]) {
        let chord = 2.0 * radius * 0.25_f32.sin();
        assert!((bone.distance.value - chord).abs() < 1e-6, "{bone:?}");
        assert!((bone.angle.value - 0.5).abs() < 1e-6, "{bone:?}");
        assert_eq!(bone.angle.time, 1.0);
    }
    assert_eq!(difference.farthest().map(|bone| bone.first), Some(2));
}

#[test]
fn a_small_angle_does_not_vanish_by_rounding() {
    let skeleton = skeleton(&["root"]);
    let difference = compare_takes((&skeleton, &turn(1, 0.0)), (&skeleton, &turn(1, 1e-5)));
    let angle = difference.bones[0].angle.value;
    assert!((angle / 1e-5 - 1.0).abs() < 0.02, "{angle}");
}

#[test]
fn bones_are_paired_by_name_wherever_they_are() {
    let (first, second) = (skeleton(&["root", "arm", "tail"]), skeleton(&["hips", "root", "arm"]));
    let pairs = pair_bones(&first, &second);
    assert_eq!(pairs.both, [(0, 1), (1, 2)]);
    assert_eq!((pairs.only_first, pairs.only_second), (vec![2], vec![0]));
    let repeated = pair_bones(&skeleton(&["", "", "x"]), &skeleton(&["", "x", "", ""]));
    assert_eq!(repeated.both, [(0, 0), (1, 2), (2, 1)]);
    assert_eq!(repeated.only_second, [3]);
}

#[test]
fn a_difference_between_two_keys_is_found() {
    let skeleton = skeleton(&["root"]);
    let channel = |values: Vec<Vec3>| Channel::new(vec![0.0, 1.0], values, Interpolation::CubicSpline);
    let mut takes = [turn(1, 0.0), turn(1, 0.0)];
    // Equal values at both keys; the second bulges between them by its tangents.
    let flat = vec![Vec3::ZERO; 6];
    let mut bulge = flat.clone();
    bulge[2] = Vec3::X * 4.0;
    bulge[3] = Vec3::X * -4.0;
    takes[0].tracks[0].translation = channel(flat);
    takes[1].tracks[0].translation = channel(bulge);
    let difference = compare_takes((&skeleton, &takes[0]), (&skeleton, &takes[1]));
    // Both tangents of 4 units a second lift the middle by 4 / 8 + 4 / 8.
    let peak = difference.bones[0].distance;
    assert!((peak.value - 1.0).abs() < 1e-3 && (peak.time - 0.5).abs() < 0.01, "{peak:?}");
}

#[test]
fn morph_weights_are_compared() {
    let skeleton = skeleton(&["root"]);
    let with = |weight: f32| {
        let morph = MorphTrack {
            instance: 0,
            targets: 2,
            times: vec![0.0, 1.0].into(),
            weights: vec![0.0, 0.0, 0.0, weight].into(),
            interpolation: Interpolation::Linear,
        };
        Take { morphs: vec![morph], ..turn(1, 0.0) }
    };
    let difference = compare_takes((&skeleton, &with(0.0)), (&skeleton, &with(0.75)));
    assert_eq!((difference.weight.value, difference.weight.time), (0.75, 1.0));
}

#[test]
fn samples_are_dense_and_bounded() {
    let take = turn(1, 1.0);
    let times = sample_times(&take, &take, 1);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1] && pair[1] - pair[0] <= LONGEST_GAP * 1.001));
    let long = Take { length: 1e6, ..turn(1, 1.0) };
    for bones in [1, 1000, MOST_SAMPLES * 2] {
        let times = sample_times(&long, &take, bones);
        assert!(times.len().saturating_mul(bones) <= MOST_SAMPLES.max(bones * 3), "{} times", times.len());
        assert_eq!((times[0], times[times.len() - 1]), (0.0, 1e6));
    }
    let empty = Take::default();
    assert_eq!(sample_times(&empty, &empty, 0), [0.0]);
}

#[test]
fn the_difference_over_time_is_the_chord_at_each_time() {
    let skeleton = skeleton(&["root", "arm", "hand"]);
    let (still, turned) = (turn(3, 0.0), turn(3, 0.8));
    let profile = compare_at((&skeleton, &still), (&skeleton, &turned), vec![0.0, 0.25, 0.5, 1.0]);
    assert_eq!(profile.times, [0.0, 0.25, 0.5, 1.0]);
    for (at, angle) in [0.0_f32, 0.2, 0.4, 0.8].into_iter().enumerate() {
        // The hand is 2 from the root.
        let chord = 4.0 * (angle / 2.0).sin();
        assert!((profile.distances[at] - chord).abs() < 1e-5, "{at}: {}", profile.distances[at]);
        assert!((profile.angles[at] - angle).abs() < 1e-5, "{at}: {}", profile.angles[at]);
    }
    assert_eq!(profile.bones[2].distance.time, 1.0);
    assert!(compare_at((&skeleton, &still), (&skeleton, &turned), Vec::new()).distances.is_empty());
}
