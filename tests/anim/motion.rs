//! Extracting root motion and restoring it gives the original take.

use crate::doors::{TestFolder, data, shared};
use crate::ik::{direction, started, turn, vector};
use crate::support::{angle_between, bone, take};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_anim::motion::{Axis, MotionError, RootMotion, RootMotionOptions, extract, in_place, restore};
use dragonfly_anim::sample::{PlayMode, Value, sample_take};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec3};
use std::path::Path;

const KINDS: [Interpolation; 4] =
    [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Closest];

/// Returns ascending times with uneven gaps.
fn times(random: &mut Random) -> Vec<f32> {
    let mut time = random.between(0.0, 0.5);
    (0..2 + random.below(8))
        .map(|_| {
            time += random.between(0.02, 0.6);
            time
        })
        .collect()
}

/// Returns a channel with the keys that `key` and the tangents that `tangent` returns.
fn channel<T: Value>(
    random: &mut Random,
    kind: Interpolation,
    mut key: impl FnMut(&mut Random) -> T,
    tangent: impl Fn(&mut Random) -> T,
) -> Channel<T> {
    let times = times(random);
    let mut values = Vec::new();
    for _ in &times {
        let value = key(random);
        if kind == Interpolation::CubicSpline {
            values.extend([tangent(random), value, tangent(random)]);
        } else {
            values.push(value);
        }
    }
    Channel { times: times.into(), values: values.into(), interpolation: kind }
}

fn moving(random: &mut Random, kind: Interpolation) -> Channel<Vec3> {
    channel(random, kind, |random| vector(random) * 3.0, vector)
}

/// Returns rotations in one direction, less than half a turn from key to key.
fn turning(random: &mut Random, kind: Interpolation) -> Channel<Quat> {
    let mut rotation = turn(random);
    let key = |random: &mut Random| {
        rotation =
            (Quat::from_axis_angle(direction(random), random.between(0.0, 1.0)) * rotation).normalize();
        rotation
    };
    channel(random, kind, key, |random| turn(random) * 0.3)
}

/// Returns a figure: a root, the hips below it (bone 1), and a hand that shows the rotation of the hips.
fn figure(random: &mut Random) -> Skeleton {
    let mut bones = vec![
        bone("armature", None, vector(random)),
        bone("hips", Some(0), Vec3::Y + vector(random)),
        bone("hand", Some(1), Vec3::new(1.0, 0.5, 0.2)),
    ];
    bones[0].rest.rotation = turn(random);
    bones[0].rest.scale = random.choice(&[Vec3::ONE, Vec3::splat(0.01), Vec3::new(-2.0, 2.0, 2.0)]);
    bones[1].rest.rotation = turn(random);
    Skeleton { bones }
}

fn options(random: &mut Random) -> RootMotionOptions {
    RootMotionOptions {
        up: random.choice(&[Axis::X, Axis::Y, Axis::Z]),
        translation: [(); 3].map(|()| random.below(3) > 0),
        yaw: random.below(3) > 0,
    }
}

fn origins(skeleton: &Skeleton, take: &Take, time: f32) -> Vec<Mat4> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    let mut out = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &poses, &mut out);
    out
}

/// Returns the keys, times between them, and times outside.
fn moments(take: &Take) -> Vec<f32> {
    let keys = take.tracks.iter().flat_map(Track::key_times);
    let steps = (-5..=105).map(|step| take.start + take.length * step as f32 / 100.0);
    let mut times: Vec<f32> = keys.chain(steps).collect();
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

/// Returns the largest distance between the same bone in two takes, relative to the distance of bones from the origin.
fn difference(skeleton: &Skeleton, a: &Take, b: &Take) -> f32 {
    let (mut worst, mut size) = (0.0_f32, 1.0_f32);
    for time in moments(a) {
        for (a, b) in origins(skeleton, a, time).into_iter().zip(origins(skeleton, b, time)) {
            let [a, b] = [a, b].map(|matrix| matrix.w_axis.truncate());
            (worst, size) = (worst.max(a.distance(b)), size.max(a.length()));
        }
    }
    worst / size
}

#[test]
fn extracted_and_restored_motion_gives_the_take_at_and_between_keys() {
    let mut random = started(41);
    let mut worst = 0.0_f32;
    for round in 0..1_500 {
        let skeleton = figure(&mut random);
        let kinds = [(); 2].map(|()| random.choice(&KINDS));
        let mut hips = Track::default();
        if random.below(5) > 0 {
            hips.translation = moving(&mut random, kinds[0]);
        }
        if random.below(5) > 0 {
            hips.rotation = turning(&mut random, kinds[1]);
        }
        let mut above = Track::default();
        if random.below(3) == 0 {
            above.translation = moving(&mut random, Interpolation::Linear);
            above.rotation = turning(&mut random, Interpolation::Linear);
        }
        let take = take(vec![above, hips]);
        let options = options(&mut random);
        let (motion, still) = extract(&take, &skeleton, 1, options).unwrap();
        let back = restore(&still, &skeleton, &motion).unwrap();
        let off = difference(&skeleton, &take, &back);
        worst = worst.max(off);
        assert!(off < 1e-4, "{round}: {off}\n{options:?} {kinds:?}\n{take:?}");
        assert_eq!(in_place(&take, &skeleton, 1, options).unwrap(), still);
        assert_eq!((still.start, still.length), (take.start, take.length));
    }
    println!("worst: {worst}");
}

#[test]
fn the_take_in_place_has_none_of_the_extracted_motion_and_the_motion_restores_it() {
    let mut random = started(42);
    for round in 0..500 {
        let skeleton = figure(&mut random);
        let kind = random.choice(&[Interpolation::Linear, Interpolation::CubicSpline]);
        let hips = Track {
            translation: moving(&mut random, kind),
            rotation: turning(&mut random, kind),
            ..Track::default()
        };
        let take = take(vec![Track::default(), hips]);
        let options = options(&mut random);
        let (motion, still) = extract(&take, &skeleton, 1, options).unwrap();
        assert!(motion.at(take.start).translation.length() < 1e-4, "{round}");
        let start = origins(&skeleton, &take, take.start);
        let up = options.up.to_vec3();
        let all = (0..3).all(|axis| axis == options.up as usize || options.translation[axis]);
        for &time in take.tracks[1].rotation.times.iter() {
            let (old, new) = (origins(&skeleton, &take, time), origins(&skeleton, &still, time));
            // The motion carries the figure in place to where the take has it.
            let carried = motion.at(time).to_matrix();
            for (old, new) in old.iter().zip(&new).skip(1) {
                let off = (carried * *new).w_axis.truncate().distance(old.w_axis.truncate());
                assert!(off < 2e-4 * (1.0 + old.w_axis.truncate().length()), "{round}: {off} {options:?}");
            }
            let moved = (new[1].w_axis - start[1].w_axis).truncate();
            if all {
                assert!((moved - up * moved.dot(up)).length() < 2e-4, "{round}: {moved}");
            }
            if options.translation[options.up as usize] {
                assert!(moved.dot(up).abs() < 2e-4, "{round}: {moved} {options:?} {kind:?}");
            }
            if options.yaw {
                let turned = new[1] * start[1].inverse();
                let (_, rotation, _) = turned.to_scale_rotation_translation();
                assert!(rotation.xyz().dot(up).abs() < 1e-3, "{round}: {rotation}");
            }
        }
    }
}

#[test]
fn translations_alone_are_carried_exactly_at_all_times() {
    let mut random = started(43);
    for round in 0..300 {
        let skeleton = figure(&mut random);
        let kind = random.choice(&KINDS);
        let hips = Track { translation: moving(&mut random, kind), ..Track::default() };
        let take = take(vec![Track::default(), hips]);
        let options = RootMotionOptions { yaw: false, ..options(&mut random) };
        let (motion, still) = extract(&take, &skeleton, 1, options).unwrap();
        assert!(motion.rotation.is_empty());
        // Keys where the bone has keys, none added; plain channels.
        assert!(
            motion.translation.is_empty() || motion.translation.times == take.tracks[1].translation.times
        );
        for time in moments(&take) {
            let old = origins(&skeleton, &take, time)[2].w_axis.truncate();
            let new = motion.at(time).to_matrix() * origins(&skeleton, &still, time)[2];
            assert!(new.w_axis.truncate().distance(old) < 1e-4 * (1.0 + old.length()), "{round} {kind:?}");
        }
    }
}

#[test]
fn a_root_without_keys_has_no_motion() {
    let skeleton = figure(&mut Random::new(1));
    let hand = Track { rotation: turning(&mut Random::new(2), Interpolation::Linear), ..Track::default() };
    let take = take(vec![Track::default(), Track::default(), hand]);
    let (motion, still) = extract(&take, &skeleton, 1, RootMotionOptions::default()).unwrap();
    assert!(motion.translation.is_empty() && motion.rotation.is_empty());
    assert_eq!(still, take);
    assert_eq!(restore(&still, &skeleton, &motion).unwrap(), take);
    assert_eq!(motion.delta(0.1, 77.7, PlayMode::Loop), Transform::IDENTITY);
    // Fewer tracks than bones.
    let bare = Take { length: 1.0, ..Take::default() };
    assert_eq!(extract(&bare, &skeleton, 1, RootMotionOptions::default()).unwrap().1.moving_tracks(), 0);
}

/// Walks 2 m along z and turns a quarter to the left in 1.5 s, starting at 0.5 s.
fn walk() -> RootMotion {
    RootMotion {
        translation: Channel::new(
            [0.5, 1.0, 2.0],
            [Vec3::ZERO, Vec3::Z, Vec3::Z * 2.0],
            Interpolation::Linear,
        ),
        rotation: Channel::new(
            [0.5, 2.0],
            [Quat::IDENTITY, Quat::from_rotation_y(std::f32::consts::FRAC_PI_2)],
            Interpolation::Linear,
        ),
        pivot: Vec3::new(0.1, 0.0, 0.2),
        start: 0.5,
        length: 1.5,
        ..RootMotion::default()
    }
}

#[test]
fn many_small_deltas_add_up_to_one_delta_over_many_loops() {
    let motion = walk();
    for (from, to) in [(0.5, 2.0), (0.7, 9.3), (0.5, 6.5), (12.1, 0.9), (-3.0, 4.0)] {
        let steps = 997;
        let mut place = Mat4::IDENTITY;
        let at = |step: i32| from + (to - from) * step as f32 / steps as f32;
        for step in 0..steps {
            place *= motion.delta(at(step), at(step + 1), PlayMode::Loop).to_matrix();
        }
        let once = motion.delta(from, to, PlayMode::Loop).to_matrix();
        assert!(place.abs_diff_eq(once, 2e-3), "{from} {to}: {place} {once}");
        let back = motion.delta(to, from, PlayMode::Loop).to_matrix();
        assert!((once * back).abs_diff_eq(Mat4::IDENTITY, 1e-4), "{from} {to}: there and back");
    }
    // Four quarter turns, each 2 m ahead: a square that ends where it started.
    let square = motion.delta(0.5, 0.5 + 4.0 * 1.5, PlayMode::Loop);
    assert!(square.translation.length() < 1e-5 && angle_between(square.rotation, Quat::IDENTITY) < 1e-5);
    // Backwards over the seam: the last quarter of the take before the first one is 1/3 m and 45/3° back.
    let seam = motion.delta(0.5, 0.25, PlayMode::Loop);
    assert!(angle_between(seam.rotation, Quat::from_rotation_y(-std::f32::consts::FRAC_PI_2 / 6.0)) < 1e-5);
    // A million loops of a straight walk are a million times the distance.
    let straight = RootMotion { rotation: Channel::default(), ..motion.clone() };
    let far = straight.delta(0.5, 0.5 + 1.5 * (1 << 20) as f32, PlayMode::Loop).translation;
    assert!((far.z / (2 << 20) as f32 - 1.0).abs() < 1e-6, "{far}");
    assert_eq!(motion.delta(2.0, 50.0, PlayMode::Clamp), Transform::IDENTITY);
    assert_eq!(straight.delta(0.0, 9.0, PlayMode::Clamp).translation, Vec3::Z * 2.0);
}

#[test]
fn a_delta_is_always_finite_and_allocates_nothing() {
    let hostile = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e-45, 0.5, 2.0, 1e9];
    let mut motion = walk();
    for length in [1.5, 0.0, -1.0, 1e-30, f32::NAN, f32::MAX] {
        motion.length = length;
        for from in hostile {
            for to in hostile {
                for mode in [PlayMode::Loop, PlayMode::Clamp] {
                    let (allocated, delta) = count(|| motion.delta(from, to, mode));
                    assert!(
                        delta.is_finite() && allocated.allocations == 0,
                        "{length} {from} {to} {delta:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn an_edited_motion_moves_the_take_as_edited() {
    let skeleton = Skeleton { bones: vec![bone("hips", None, Vec3::Y)] };
    let hips = Track {
        translation: Channel::new([0.0, 1.0], [Vec3::Y, Vec3::new(0.0, 1.0, 2.0)], Interpolation::Linear),
        ..Track::default()
    };
    let take = take(vec![hips]);
    let (mut motion, still) = extract(&take, &skeleton, 0, RootMotionOptions::default()).unwrap();
    assert!(still.tracks[0].translation.values.iter().all(|value| value.distance(Vec3::Y) < 1e-6));
    motion.translation =
        Channel::new([0.0, 0.25, 1.0], [Vec3::ZERO, Vec3::X, Vec3::X * 4.0], Interpolation::Linear);
    motion.rotation =
        Channel::new([0.0, 1.0], [Quat::IDENTITY, Quat::from_rotation_y(1.0)], Interpolation::Linear);
    let moved = restore(&still, &skeleton, &motion).unwrap();
    for time in [0.0, 0.1, 0.25, 0.6, 1.0] {
        let got = origins(&skeleton, &moved, time)[0];
        let expected = motion.at(time).to_matrix() * Mat4::from_translation(Vec3::Y);
        assert!(got.abs_diff_eq(expected, 1e-4), "{time}: {got} {expected}");
    }
    // Also if the bone has no keys at all.
    let none = Take { tracks: vec![], ..take };
    let got = origins(&skeleton, &restore(&none, &skeleton, &motion).unwrap(), 0.6)[0];
    assert!(got.abs_diff_eq(motion.at(0.6).to_matrix() * Mat4::from_translation(Vec3::Y), 1e-4));
}

#[test]
fn a_bone_without_motion_is_an_error_with_its_reason() {
    let mut skeleton = figure(&mut Random::new(3));
    let take = take(vec![]);
    let error = extract(&take, &skeleton, 9, RootMotionOptions::default()).unwrap_err();
    assert_eq!(error, MotionError::NoSuchBone { bone: 9 });
    skeleton.bones[0].rest.scale = Vec3::new(1.0, 0.0, 1.0);
    let error = extract(&take, &skeleton, 1, RootMotionOptions::default()).unwrap_err();
    assert_eq!(error, MotionError::Flat { bone: 1, milliseconds: 0 });
    assert!(error.to_string().contains("a scale of one of its ancestors is zero"));
}

#[test]
fn the_motion_and_the_rest_of_any_take_are_finite() {
    let mut random = started(44);
    let hostile = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, 1e-45, 1e38, f32::MAX, -1.0];
    for _ in 0..1_000 {
        let mut skeleton = figure(&mut random);
        let kind = random.choice(&KINDS);
        let mut hips = Track {
            translation: moving(&mut random, kind),
            rotation: turning(&mut random, kind),
            ..Track::default()
        };
        for _ in 0..1 + random.below(4) {
            let number = random.choice(&hostile);
            let (turns, moves) = (&mut hips.rotation, &mut hips.translation);
            let (key, value) = (random.below(turns.times.len()), random.below(turns.values.len()));
            let (time, place) = (random.below(moves.times.len()), random.below(moves.values.len().max(1)));
            moves.values = if moves.values.is_empty() { [Vec3::X].into() } else { moves.values.clone() };
            match random.below(6) {
                0 => std::sync::Arc::make_mut(&mut turns.times)[key] = number,
                1 => std::sync::Arc::make_mut(&mut turns.values)[value].y = number,
                2 => std::sync::Arc::make_mut(&mut moves.times)[time] = number,
                3 => std::sync::Arc::make_mut(&mut moves.values)[place].z = number,
                4 => moves.values = moves.values[..place].into(),
                _ => skeleton.bones[0].rest.scale.x = number,
            }
        }
        let take = take(vec![Track::default(), hips]);
        let Ok((motion, still)) = extract(&take, &skeleton, 1, options(&mut random)) else { continue };
        let Ok(back) = restore(&still, &skeleton, &motion) else { continue };
        for time in [f32::NAN, -1.0, 0.0, 0.5, 1.0, 3.0] {
            assert!(motion.at(time).is_finite() && motion.delta(0.3, time, PlayMode::Loop).is_finite());
            for take in [&still, &back] {
                assert!(origins(&skeleton, take, time).iter().all(|matrix| matrix.is_finite()));
            }
        }
    }
}

pub(crate) fn load(path: &Path) -> ModelData {
    let bytes = std::fs::read(path).unwrap();
    let door = TestFolder(path.parent().unwrap().to_owned());
    read(path.file_name().unwrap().to_str().unwrap(), &bytes, &door, &ReadOptions::default()).unwrap().model
}

/// Returns the available models with skeletons.
pub(crate) fn models() -> Vec<ModelData> {
    let mut paths = vec![data().join("gltf/Fox.glb")];
    paths.extend(shared("assets/bench").map(|folder| folder.join("pab.glb")));
    paths.iter().map(|path| load(path)).collect()
}

#[test]
fn the_motion_of_real_takes_is_restored_within_a_ten_thousandth() {
    for model in models() {
        let skeleton = &model.animation.skeleton;
        for take in &model.animation.takes {
            for bone in
                (0..skeleton.len() as u32).filter(|&bone| !take.tracks[bone as usize].is_empty()).take(3)
            {
                let all = RootMotionOptions { translation: [true; 3], ..RootMotionOptions::default() };
                for options in [RootMotionOptions::default(), all] {
                    let (motion, still) = extract(take, skeleton, bone, options).unwrap();
                    let back = restore(&still, skeleton, &motion).unwrap();
                    let off = difference(skeleton, take, &back);
                    println!("{} {} bone {bone}: {off}", model.name, take.name);
                    assert!(off < 1e-4, "{} bone {bone}: {off}", take.name);
                }
            }
        }
    }
}
