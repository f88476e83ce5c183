//! Retargeting: one take on other skeletons.

use crate::ik::{started, turn, vector};
use crate::motion::models;
use crate::support::{angle_between, bone, take};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_anim::retarget::{
    BindError, RetargetOptions, SkeletonBinding, height_ratio, leg_ratio, rebind, retarget,
};
use dragonfly_anim::sample::sample_take;
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec3};

pub(crate) fn matrices(skeleton: &Skeleton, take: &Take, time: f32) -> Vec<Mat4> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    let mut out = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &poses, &mut out);
    out
}

pub(crate) fn places(skeleton: &Skeleton, take: &Take, time: f32) -> Vec<Vec3> {
    matrices(skeleton, take, time).into_iter().map(|matrix| matrix.w_axis.truncate()).collect()
}

pub(crate) fn moments(take: &Take) -> impl Iterator<Item = f32> + '_ {
    (-2..=42).map(|step| take.start + take.length * step as f32 / 40.0)
}

/// Returns hips, two legs, a spine, two arms; all bones rotated at random at rest.
pub(crate) fn person(random: &mut Random) -> Skeleton {
    let parts: [(&str, Option<u32>, [f32; 3]); 14] = [
        ("Root", None, [0.0, 0.0, 0.0]),
        ("Hips", Some(0), [0.0, 1.0, 0.0]),
        ("LeftUpLeg", Some(1), [0.1, -0.05, 0.0]),
        ("LeftLeg", Some(2), [0.0, -0.45, 0.02]),
        ("LeftFoot", Some(3), [0.0, -0.45, -0.02]),
        ("RightUpLeg", Some(1), [-0.1, -0.05, 0.0]),
        ("RightLeg", Some(5), [0.0, -0.45, 0.02]),
        ("RightFoot", Some(6), [0.0, -0.45, -0.02]),
        ("Spine", Some(1), [0.0, 0.3, 0.05]),
        ("Neck", Some(8), [0.0, 0.3, -0.05]),
        ("LeftArm", Some(8), [0.2, 0.2, 0.0]),
        ("LeftHand", Some(10), [0.5, 0.0, 0.0]),
        ("RightArm", Some(8), [-0.2, 0.2, 0.0]),
        ("RightHand", Some(12), [-0.5, 0.0, 0.0]),
    ];
    let bones = parts.map(|(name, parent, offset)| bone(name, parent, Vec3::from_array(offset)));
    let mut skeleton = Skeleton { bones: bones.to_vec() };
    pose_rest(&mut skeleton, |_, _| turn(random));
    skeleton
}

/// Rotates bones at rest without moving any origin: only their axes change.
fn pose_rest(skeleton: &mut Skeleton, mut own: impl FnMut(usize, Quat) -> Quat) {
    let straight = Take::default();
    let old = places(skeleton, &straight, 0.0);
    let mut turned: Vec<Quat> = Vec::new();
    for index in 0..skeleton.len() {
        let parent = skeleton.bones[index].parent.map(|parent| parent as usize);
        let above = parent.map_or(Quat::IDENTITY, |parent| turned[parent]);
        let rotation = own(index, above);
        let offset = old[index] - parent.map_or(Vec3::ZERO, |parent| old[parent]);
        skeleton.bones[index].rest.translation = above.inverse() * offset;
        skeleton.bones[index].rest.rotation = rotation;
        turned.push((above * rotation).normalize());
    }
}

pub(crate) fn keys(random: &mut Random) -> Vec<f32> {
    let mut time = 0.2;
    (0..2 + random.below(5))
        .map(|_| {
            time += random.between(0.05, 0.4);
            time
        })
        .collect()
}

pub(crate) fn turns(random: &mut Random, rest: Quat) -> Channel<Quat> {
    let kind = random.choice(&[Interpolation::Linear, Interpolation::Step, Interpolation::CubicSpline]);
    let times = keys(random);
    let mut values = Vec::new();
    for _ in &times {
        let value = (Quat::from_scaled_axis(vector(random)) * rest).normalize();
        if kind == Interpolation::CubicSpline {
            values.extend([turn(random) * 0.5, value, turn(random) * 0.5]);
        } else {
            values.push(value);
        }
    }
    Channel::new(times, values, kind)
}

/// Returns a take that rotates most bones and moves the hips.
pub(crate) fn dance(random: &mut Random, skeleton: &Skeleton) -> Take {
    let mut tracks: Vec<Track> = Vec::new();
    for bone in &skeleton.bones {
        let mut track = Track::default();
        if random.below(4) > 0 {
            track.rotation = turns(random, bone.rest.rotation);
        }
        tracks.push(track);
    }
    let times = keys(random);
    let values: Vec<Vec3> =
        times.iter().map(|_| skeleton.bones[1].rest.translation + vector(random)).collect();
    tracks[1].translation = Channel::new(times, values, Interpolation::Linear);
    take(tracks)
}

#[test]
fn a_take_on_its_own_skeleton_is_the_take() {
    let mut random = started(51);
    for round in 0..200 {
        let skeleton = person(&mut random);
        let take = dance(&mut random, &skeleton);
        let binding = SkeletonBinding::by_name(&skeleton, &skeleton);
        assert!(binding.unbound_source.is_empty() && binding.unbound_target.is_empty());
        let result = retarget(&take, &skeleton, &skeleton, &binding, &RetargetOptions::default());
        for time in moments(&take) {
            for (a, b) in matrices(&skeleton, &take, time).iter().zip(matrices(&skeleton, &result, time)) {
                assert!(a.abs_diff_eq(b, 1e-5), "{round} {time}: {a} {b}");
            }
        }
        for (a, b) in take.tracks.iter().zip(&result.tracks) {
            assert_eq!(
                (&a.rotation.times, a.rotation.interpolation),
                (&b.rotation.times, b.rotation.interpolation)
            );
        }
    }
}

#[test]
fn real_takes_on_their_own_skeletons_are_the_takes() {
    for model in models() {
        let skeleton = &model.animation.skeleton;
        let binding = SkeletonBinding::by_name(skeleton, skeleton);
        let options = RetargetOptions { stretch: true, ..RetargetOptions::default() };
        for take in &model.animation.takes {
            let result = retarget(take, skeleton, skeleton, &binding, &options);
            let (mut worst, mut size) = (0.0_f32, 1.0_f32);
            for time in moments(take) {
                for (a, b) in places(skeleton, take, time).iter().zip(places(skeleton, &result, time)) {
                    (worst, size) = (worst.max(a.distance(b)), size.max(a.length()));
                }
            }
            println!("{} {}: {}", model.name, take.name, worst / size);
            assert!(worst < 1e-5 * size, "{}: {worst} of {size}", take.name);
        }
    }
}

#[test]
fn on_a_skeleton_of_another_size_all_positions_are_scaled() {
    let mut random = started(52);
    for round in 0..200 {
        let source = person(&mut random);
        let take = dance(&mut random, &source);
        let factor = random.between(0.01, 30.0);
        let mut target = source.clone();
        for bone in &mut target.bones {
            bone.rest.translation *= factor;
        }
        let binding = SkeletonBinding::by_name(&source, &target);
        assert!((height_ratio(&source, &target, &binding, 1, Vec3::Y) / factor - 1.0).abs() < 1e-4);
        assert!((leg_ratio(&source, &target, &binding, 2, 4).unwrap() / factor - 1.0).abs() < 1e-4);
        let result = retarget(&take, &source, &target, &binding, &RetargetOptions::default());
        for time in moments(&take) {
            for (a, b) in places(&source, &take, time).into_iter().zip(places(&target, &result, time)) {
                assert!((a * factor).distance(b) < 3e-5 * factor * (1.0 + a.length()), "{round} {a} {b}");
            }
        }
    }
    // The same if the size is the scale of the root, as in files in centimeters.
    let source = person(&mut random);
    let take = dance(&mut random, &source);
    let mut target = source.clone();
    target.bones[0].rest.scale = Vec3::splat(0.01);
    let binding = SkeletonBinding::by_name(&source, &target);
    let result = retarget(&take, &source, &target, &binding, &RetargetOptions::default());
    for time in moments(&take) {
        for (a, b) in places(&source, &take, time).into_iter().zip(places(&target, &result, time)) {
            assert!((a * 0.01).distance(b) < 1e-6, "{a} {b}");
        }
    }
}

#[test]
fn on_a_skeleton_with_another_rest_pose_bones_point_in_the_same_direction() {
    let mut random = started(53);
    for round in 0..200 {
        let source = person(&mut random);
        let take = dance(&mut random, &source);
        // The same shape in another rest pose (arms down, legs apart, or anything else), with other axes.
        let mut target = source.clone();
        for bone in &mut target.bones[1..] {
            bone.rest.rotation =
                (bone.rest.rotation * Quat::from_scaled_axis(vector(&mut random))).normalize();
        }
        let other: Vec<Quat> = (0..target.len()).map(|_| turn(&mut random)).collect();
        pose_rest(&mut target, |index, _| other[index]);
        let binding = SkeletonBinding::by_name(&source, &target);
        let result = retarget(&take, &source, &target, &binding, &RetargetOptions::default());
        for time in moments(&take) {
            let (old, new) = (places(&source, &take, time), places(&target, &result, time));
            for (index, bone) in source.bones.iter().enumerate().skip(2) {
                let parent = bone.parent.unwrap() as usize;
                let [a, b] = [&old, &new].map(|places| (places[index] - places[parent]).normalize());
                assert!(a.distance(b) < 2e-5, "{round} {} at {time}: {a} {b}", bone.name);
            }
        }
    }
}

#[test]
fn a_bone_that_only_one_skeleton_has_does_not_disturb_the_poses_of_the_others() {
    let mut random = started(54);
    for round in 0..100 {
        let source = person(&mut random);
        let take = dance(&mut random, &source);
        // The target has a twist bone in its left arm that is not animated; the arm is its child.
        let mut target = source.clone();
        target.bones.push(bone("twist", Some(10), Vec3::ZERO));
        target.bones.swap(11, 14);
        target.bones[14].parent = Some(11);
        target.bones[11].rest.rotation = turn(&mut random);
        target.bones[14].rest.translation =
            target.bones[11].rest.rotation.inverse() * target.bones[14].rest.translation;
        target.bones[14].rest.rotation =
            target.bones[11].rest.rotation.inverse() * target.bones[14].rest.rotation;
        let binding = SkeletonBinding::by_name(&source, &target);
        assert_eq!((&binding.unbound_target[..], &binding.unbound_source[..]), (&[11][..], &[][..]));
        let result = retarget(&take, &source, &target, &binding, &RetargetOptions::default());
        assert!(result.tracks[11].is_empty());
        // And back: the take's twist bone, now animated, is missing in the plain skeleton.
        let mut twisted = result.clone();
        twisted.tracks[11].rotation = turns(&mut random, target.bones[11].rest.rotation);
        twisted.tracks[11].rotation.interpolation = Interpolation::Linear;
        let times = keys(&mut random);
        let values: Vec<Quat> = times.iter().map(|_| turn(&mut random)).collect();
        twisted.tracks[11].rotation = Channel::new(times, values, Interpolation::Linear);
        let binding = SkeletonBinding::by_name(&target, &source);
        let back = retarget(&twisted, &target, &source, &binding, &RetargetOptions::default());
        for time in moments(&take) {
            let (old, new) = (matrices(&source, &take, time), matrices(&target, &result, time));
            for (index, bone) in source.bones.iter().enumerate() {
                let at = binding.source_of[index].unwrap() as usize;
                assert!(old[index].abs_diff_eq(new[at], 3e-5), "{round} {} {time}", bone.name);
            }
        }
        for &time in back.tracks[11].rotation.times.iter() {
            let (old, new) = (matrices(&target, &twisted, time)[14], matrices(&source, &back, time)[11]);
            let [old, new] = [old, new].map(|matrix| matrix.to_scale_rotation_translation().1);
            assert!(angle_between(old, new) < 1e-4, "{round} {time}");
        }
    }
}

#[test]
fn names_are_matched_exactly_first_and_then_without_common_affixes() {
    let bones =
        |names: &[&str]| Skeleton { bones: names.iter().map(|name| bone(name, None, Vec3::ZERO)).collect() };
    let source = bones(&[
        "mixamorig:Hips",
        "mixamorig:LeftArm",
        "arm_l",
        "twin",
        "twin",
        "tail",
        "",
        "Eye L",
        "Eye_L",
    ]);
    let target = bones(&["arm_l", "hips", "Arm.L", "twin", "twin", "twin", "", "TAIL", "eye.L"]);
    let binding = SkeletonBinding::by_name(&source, &target);
    assert_eq!(
        binding.source_of,
        [Some(2), Some(0), Some(1), Some(3), Some(4), None, None, Some(5), None],
        "a name that two remaining bones share matches neither"
    );
    assert_eq!(binding.unbound_source, [6, 7, 8]);
    assert_eq!(binding.unbound_target, [5, 6, 8]);
    assert_eq!(binding.bound(), 6);
    let map = SkeletonBinding::from_map(&source, &target, &[(0, 1), (0, 2)]).unwrap();
    assert_eq!((map.source_of[1], map.source_of[2], map.bound()), (Some(0), Some(0), 2));
    let fails = |pairs: &[(u32, u32)]| SkeletonBinding::from_map(&source, &target, pairs).unwrap_err();
    assert_eq!(fails(&[(9, 0)]), BindError::NoSourceBone { bone: 9 });
    assert_eq!(fails(&[(0, 9)]), BindError::NoTargetBone { bone: 9 });
    assert_eq!(fails(&[(0, 1), (1, 1)]), BindError::BoundTwice { bone: 1 });
}

#[test]
fn a_take_bound_by_name_is_copied_unchanged_to_the_bones_of_that_name() {
    let mut random = started(55);
    let source = person(&mut random);
    let take = dance(&mut random, &source);
    let target = Skeleton {
        bones: ["Spine", "extra", "left_hand", "Hips"]
            .iter()
            .map(|name| bone(name, None, Vec3::ZERO))
            .collect(),
    };
    let result = rebind(&take, &SkeletonBinding::by_name(&source, &target));
    assert_eq!((result.start, result.length, result.tracks.len()), (take.start, take.length, 4));
    for (index, from) in [(0, Some(8)), (1, None), (2, Some(11)), (3, Some(1))] {
        let expected = from.map_or_else(Track::default, |from: usize| take.tracks[from].clone());
        assert_eq!(result.tracks[index], Track { bone: index as u32, ..expected });
    }
}

#[test]
fn retargeted_poses_are_always_finite() {
    let mut random = started(56);
    let hostile = [f32::NAN, f32::INFINITY, 0.0, 1e-45, 1e38, f32::MAX, -1.0];
    for _ in 0..500 {
        let (mut source, mut target) = (person(&mut random), person(&mut random));
        let mut take = dance(&mut random, &source);
        for skeleton in [&mut source, &mut target] {
            let bone = random.below(14);
            let rest = &mut skeleton.bones[bone].rest;
            match random.below(3) {
                0 => rest.translation.y = random.choice(&hostile),
                1 => rest.scale.z = random.choice(&hostile),
                _ => rest.rotation.w = random.choice(&hostile),
            }
            if random.below(4) == 0 {
                skeleton.bones[bone].parent = Some(random.below(20) as u32);
            }
        }
        take.tracks.truncate(random.below(16));
        let mut binding = SkeletonBinding::by_name(&source, &target);
        binding.source_of[random.below(14)] = Some(random.below(20) as u32);
        binding.source_of.truncate(10 + random.below(5));
        let options = RetargetOptions {
            up: Vec3::Y * random.choice(&hostile),
            ratio: Some(random.choice(&hostile)),
            trunk: (random.below(2) == 0).then(|| vec![1, 99]),
            stretch: random.below(2) == 0,
        };
        let result = retarget(&take, &source, &target, &binding, &options);
        assert_eq!(result.tracks.len(), target.len());
        for time in [0.0, 0.5, 1.0] {
            assert!(matrices(&target, &result, time).iter().all(|matrix| matrix.is_finite()));
        }
    }
}
