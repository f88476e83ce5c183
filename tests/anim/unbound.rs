//! The motion of bones without a binding is kept when a take is retargeted.

use crate::ik::{started, turn, vector};
use crate::retarget::{dance, keys, matrices, moments, person, places, turns};
use crate::support::{angle_between, bone, take};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::retarget::{RetargetOptions, SkeletonBinding, retarget};
use dragonfly_kit::random::Random;
use glam::{Quat, Vec3};

/// Returns `skeleton` under a new root with a rest translation and rotation.
fn under_a_root(random: &mut Random, skeleton: &Skeleton) -> Skeleton {
    let mut bones = vec![bone("motion", None, vector(random))];
    bones[0].rest.rotation = turn(random);
    bones.extend(skeleton.bones.iter().cloned());
    for bone in &mut bones[1..] {
        bone.parent = Some(bone.parent.map_or(0, |parent| parent + 1));
    }
    Skeleton { bones }
}

/// Returns a binding of all bones by name, except the source bones `names`.
fn without(source: &Skeleton, target: &Skeleton, names: &[&str]) -> SkeletonBinding {
    let mut binding = SkeletonBinding::by_name(source, target);
    for bound in &mut binding.source_of {
        bound.take_if(|bone| names.contains(&&*source.bones[*bone as usize].name));
    }
    binding
}

#[test]
fn the_motion_of_unbound_ancestors_is_added_to_the_bones_below_them() {
    let mut random = started(57);
    for round in 0..100 {
        // The source walks with a bone above all others that the target does not have, and with its root, which is not
        // bound.
        let plain = person(&mut random);
        let source = under_a_root(&mut random, &plain);
        let mut take = dance(&mut random, &source);
        for moving in [0, 1] {
            let rest = source.bones[moving].rest;
            let times = keys(&mut random);
            let walk: Vec<Vec3> =
                times.iter().map(|_| rest.translation + vector(&mut random) * 3.0).collect();
            take.tracks[moving].translation = Channel::new(times, walk, Interpolation::Linear);
            take.tracks[moving].rotation = match (round + moving) % 3 {
                0 => Channel::default(),
                _ => turns(&mut random, rest.rotation),
            };
        }
        let factor = random.choice(&[1.0, 0.5, 3.0]);
        let mut target = plain.clone();
        target.bones.iter_mut().for_each(|bone| bone.rest.translation *= factor);
        // The root of the target rests at the position of the source's, so that positions can be compared directly.
        let stands = places(&source, &Take::default(), 0.0)[1];
        let turned = source.bones[0].rest.rotation;
        target.bones[0].rest.translation = stands * factor;
        target.bones[0].rest.rotation = (turned * target.bones[0].rest.rotation).normalize();
        let binding = without(&source, &target, &["Root"]);
        assert_eq!(binding.unbound_source.len(), 1, "the others are bound: {binding:?}");
        let options = RetargetOptions { ratio: Some(factor), ..RetargetOptions::default() };
        let result = retarget(&take, &source, &target, &binding, &options);
        let (mut worst, mut size) = (0.0_f32, 0.0_f32);
        let hips = &result.tracks[1];
        for &time in hips.translation.times.iter() {
            let (a, b) = (places(&source, &take, time)[2] * factor, places(&target, &result, time)[1]);
            assert!(a.distance(b) < 1e-4 * factor, "{round} at {time}: {a} {b}");
        }
        for &time in hips.rotation.times.iter() {
            let (old, new) = (matrices(&source, &take, time)[2], matrices(&target, &result, time)[1]);
            let [old, new] = [old, new].map(|matrix| matrix.to_scale_rotation_translation().1);
            assert!(angle_between(old, new) < 1e-3, "{round} at {time}");
        }
        // Between the resampled keys, curves are approximated by short straight pieces. A step becomes a ramp of one
        // sample interval, so the times around steps are not compared.
        let jumps = |time: f32| {
            take.tracks.iter().any(|track| {
                track.rotation.interpolation == Interpolation::Step
                    && track.rotation.times.iter().any(|key| (key - time).abs() < 1e-3)
            })
        };
        for time in moments(&take).filter(|&time| !jumps(time)) {
            for bone in 1..target.len() {
                let (a, b) =
                    (places(&source, &take, time)[bone + 1] * factor, places(&target, &result, time)[bone]);
                (worst, size) = (worst.max(a.distance(b)), size.max(a.length()));
            }
        }
        println!("{round}: {worst} of {size} between keys");
        assert!(worst < 0.02 * size, "{round}: {worst} of {size}");
    }
}

#[test]
fn the_walk_of_an_unbound_root_is_kept_on_any_figure() {
    // Hips one meter above the ground that bob, under a root that moves two meters: keys at other times, both linear.
    let source = Skeleton {
        bones: vec![
            bone("mover", None, Vec3::ZERO),
            bone("Hips", Some(0), Vec3::Y),
            bone("Foot", Some(1), Vec3::NEG_Y),
        ],
    };
    let line = |keys: &[(f32, Vec3)]| {
        let (times, values): (Vec<f32>, Vec<Vec3>) = keys.iter().copied().unzip();
        Channel::new(times, values, Interpolation::Linear)
    };
    let walk = line(&[(0.0, Vec3::ZERO), (2.0, Vec3::Z * 2.0)]);
    let bob = line(&[(0.0, Vec3::Y), (0.5, Vec3::Y * 1.1), (1.0, Vec3::Y), (2.0, Vec3::Y)]);
    let moved = |translation| Track { translation, ..Track::default() };
    let take = take(vec![moved(walk), moved(bob), Track::default()]);
    let target =
        Skeleton { bones: vec![bone("hips", None, Vec3::Y * 2.0), bone("foot", Some(0), Vec3::NEG_Y * 2.0)] };
    let binding = SkeletonBinding::by_name(&source, &target);
    let result = retarget(&take, &source, &target, &binding, &RetargetOptions::default());
    for (time, expected) in
        [(0.0, [0.0, 2.0, 0.0]), (0.25, [0.0, 2.1, 0.5]), (0.5, [0.0, 2.2, 1.0]), (1.5, [0.0, 2.0, 3.0])]
    {
        let hips = places(&target, &result, time)[0];
        assert!(hips.distance(Vec3::from_array(expected)) < 1e-5, "{time}: {hips}");
    }
    assert_eq!(&*result.tracks[0].translation.times, &[0.0, 0.5, 1.0, 2.0], "the keys of both, and no more");
    // A root that rotates also rotates its children around it.
    let mut turning = take.clone();
    turning.tracks[0] = Track {
        rotation: Channel::new(
            [0.0, 2.0],
            [Quat::IDENTITY, Quat::from_rotation_x(std::f32::consts::FRAC_PI_2)],
            Interpolation::Linear,
        ),
        ..Track::default()
    };
    let result = retarget(&turning, &source, &target, &binding, &RetargetOptions::default());
    let end = matrices(&target, &result, 2.0)[0];
    assert!(end.w_axis.truncate().distance(Vec3::Z * 2.0) < 1e-5, "{end}");
    assert!(end.transform_vector3(Vec3::Y).distance(Vec3::Z) < 1e-5, "{end}");
    let arc = places(&target, &result, 1.51)[0];
    assert!((arc.length() - 2.0).abs() < 2e-3, "on the way too: {arc}");
    // Explicitly listed trunk bones replace the default ones.
    let options = RetargetOptions { trunk: Some(Vec::new()), ..RetargetOptions::default() };
    assert!(retarget(&take, &source, &target, &binding, &options).tracks[0].translation.is_empty());
}
