//! Travel moved between bones leaves the figure where it is, and travel put back gives the original take.

use crate::doors::data;
use crate::motion::load;
use crate::support::{bone, take};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{BoneIndex, Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform};
use dragonfly_anim::frames::frame_rate;
use dragonfly_anim::motion::{
    MotionError, RootMotionOptions, TravelOptions, guess_hips, guess_root, move_travel, put_back,
    take_travel, travel_bones,
};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Quat, Vec3};

/// Figures of different programs with takes.
fn figures() -> Vec<ModelData> {
    let files = [
        "gltf/Fox.glb",
        "bench/pab.glb",
        "collection/RobotExpressive.glb",
        "collection/RiggedFigure.glb",
        "collection/greenman.glb",
        "collection/quaternius_Character4skins.glb",
        "collection/godot_enemy.glb",
    ];
    let models = files.iter().map(|path| load(&data().join(path)));
    models.filter(|model| guess_hips(&model.animation.skeleton).is_some()).collect()
}

fn matrices(skeleton: &Skeleton, take: &Take, time: f32) -> Vec<Mat4> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    let mut out = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &poses, &mut out);
    out
}

/// Returns the keys of a take, at most about 200.
fn key_times(take: &Take) -> Vec<f32> {
    let mut times: Vec<f32> = take.tracks.iter().flat_map(Track::key_times).collect();
    times.sort_by(f32::total_cmp);
    times.dedup();
    let step = times.len().div_ceil(200).max(1);
    times.into_iter().step_by(step).collect()
}

/// Returns times over a take that are not keys.
fn times_between(take: &Take) -> Vec<f32> {
    (0..97).map(|step| take.start + take.length * (step as f32 + 0.5) / 97.0).collect()
}

/// Returns the largest distance of bones in two takes relative to the size of the figure, and the largest angle in radians.
fn apart(
    skeleton: &Skeleton,
    a: &Take,
    b: &Take,
    times: Vec<f32>,
    bones: impl Fn(BoneIndex) -> bool,
) -> [f32; 2] {
    let (mut moved, mut turned, mut size) = (0.0_f32, 0.0_f32, 1e-3_f32);
    for time in times {
        let (a, b) = (matrices(skeleton, a, time), matrices(skeleton, b, time));
        for bone in (0..a.len()).filter(|&bone| bones(bone as BoneIndex)) {
            let (_, turn_a, place_a) = a[bone].to_scale_rotation_translation();
            let (_, turn_b, place_b) = b[bone].to_scale_rotation_translation();
            moved = moved.max(place_a.distance(place_b));
            size = size.max(place_a.length());
            // Differences of unit quaternions: accurate where the angle is small.
            turned = turned.max(2.0 * (turn_a - turn_b).length().min((turn_a + turn_b).length()));
        }
    }
    [moved / size, turned]
}

fn options(take: &Take, yaw: bool, height: bool, smooth: f32) -> TravelOptions {
    let motion = RootMotionOptions { translation: [true, height, true], yaw, ..RootMotionOptions::default() };
    TravelOptions { motion, smooth, rate: frame_rate(take) }
}

#[test]
fn travel_of_real_takes_is_put_back_within_a_ten_thousandth() {
    let mut tried = 0;
    for model in figures() {
        let skeleton = &model.animation.skeleton;
        let hips = guess_hips(skeleton).unwrap();
        for take in &model.animation.takes {
            for (yaw, height, smooth) in
                [(false, false, 0.0), (true, false, 0.0), (true, true, 0.0), (true, false, 6.0)]
            {
                let travel = take_travel(take, skeleton, hips, &options(take, yaw, height, smooth)).unwrap();
                let back = put_back(&travel.take, skeleton, &travel.motion).unwrap();
                let times = [key_times(take), times_between(take)].concat();
                let [moved, turned] = apart(skeleton, take, &back, times, |_| true);
                let name = format!("{} {} yaw {yaw} height {height} smooth {smooth}", model.name, take.name);
                println!("{name}: {moved} of its size, {turned} rad");
                assert!(moved < 1e-4 && turned < 1e-4, "{name}: {moved} {turned}");
                tried += 1;
            }
        }
    }
    assert!(tried > 40, "{tried}");
}

#[test]
fn travel_moves_to_the_root_and_back_and_the_figure_stays_where_it_is() {
    let mut tried = 0;
    for model in figures() {
        let skeleton = &model.animation.skeleton;
        let hips = guess_hips(skeleton).unwrap();
        let Some(root) = guess_root(skeleton, hips) else { continue };
        let changed = travel_bones(skeleton, hips, root);
        let line = |bone: BoneIndex| {
            let above = std::iter::successors(Some(hips), |&bone| skeleton.bones[bone as usize].parent);
            bone != hips && above.into_iter().any(|one| one == bone)
        };
        for take in &model.animation.takes {
            for (yaw, smooth) in [(false, 0.0), (true, 0.0), (true, 8.0)] {
                let name = format!("{} {} yaw {yaw} smooth {smooth}", model.name, take.name);
                let options = options(take, yaw, false, smooth);
                let to_root = move_travel(take, skeleton, hips, root, &options).unwrap();
                // In a somersault the yaw is undefined where the hips are upside down: it jumps from frame to frame.
                let yaws = to_root.motion.rotation.values.windows(2);
                let steady = yaws.map(|pair| pair[0].angle_between(pair[1])).fold(0.0_f32, f32::max) < 0.4;
                // Nothing moves but the bones from the root to the hips: at keys not at all, between them hardly.
                let stays = |other: &Take, what: &str, between: f32| {
                    for (times, limit, known) in
                        [(key_times(take), 1e-4, true), (times_between(take), between, steady)]
                    {
                        let [moved, turned] = apart(skeleton, take, other, times, |bone| !line(bone));
                        println!("{name} {what}: {moved} of its size, {turned} rad");
                        assert!(
                            (moved < limit && turned < limit) || !known,
                            "{name} {what}: {moved} {turned}"
                        );
                    }
                };
                // The robot turns by up to 18° from frame to frame.
                stays(&to_root.take, "to the root", 3e-2);
                for (bone, (before, after)) in take.tracks.iter().zip(&to_root.take.tracks).enumerate() {
                    assert!(before == after || changed.contains(&(bone as BoneIndex)), "{name}: bone {bone}");
                }
                let all = TravelOptions { smooth: 0.0, ..options };
                let back = move_travel(&to_root.take, skeleton, root, hips, &all).unwrap();
                stays(&back.take, "and back", 3e-2);
                tried += 1;
            }
        }
    }
    assert!(tried > 30, "{tried}");
}

/// A root with hips, and a prop on the root; the hips walk a quarter circle around the origin and turn with it.
fn turning_walk() -> (Skeleton, Take) {
    let bones = vec![
        bone("root", None, Vec3::ZERO),
        bone("hips", Some(0), Vec3::new(2.0, 1.0, 0.0)),
        bone("prop", Some(0), Vec3::new(0.5, 0.0, 0.5)),
        bone("head", Some(1), Vec3::Y),
    ];
    let times: Vec<f32> = (0..=30).map(|frame| frame as f32 / 30.0).collect();
    let turn = |time: f32| Quat::from_rotation_y(time * std::f32::consts::FRAC_PI_2);
    let places: Vec<Vec3> = times.iter().map(|&time| turn(time) * Vec3::new(2.0, 1.0, 0.0)).collect();
    let turns: Vec<Quat> = times.iter().map(|&time| turn(time)).collect();
    let hips = Track {
        bone: 1,
        translation: Channel::new(times.clone(), places, Interpolation::Linear),
        rotation: Channel::new(times, turns, Interpolation::Linear),
        ..Track::default()
    };
    let tracks = vec![Track::default(), hips];
    (Skeleton { bones }, take(tracks))
}

#[test]
fn a_turning_walk_leaves_the_hips_at_rest_over_a_root_that_turns() {
    let (skeleton, take) = turning_walk();
    let options = options(&take, true, false, 0.0);
    let moved = move_travel(&take, &skeleton, 1, 0, &options).unwrap().take;
    let end = matrices(&skeleton, &moved, 1.0);
    let before = matrices(&skeleton, &take, 1.0);
    for bone in 1..4 {
        assert!(end[bone].abs_diff_eq(before[bone], 1e-5), "bone {bone}: {} {}", end[bone], before[bone]);
    }
    let root = end[0].to_scale_rotation_translation().1;
    assert!(root.angle_between(Quat::from_rotation_y(std::f32::consts::FRAC_PI_2)) < 1e-3, "{root}");
    // The hips do not move relative to the root, and the prop has keys that keep it in place.
    let hips = &moved.tracks[1];
    assert!(hips.translation.values.iter().all(|value| value.distance(Vec3::new(2.0, 1.0, 0.0)) < 1e-5));
    assert!(hips.rotation.values.iter().all(|value| value.abs_diff_eq(Quat::IDENTITY, 1e-5)));
    assert_eq!(moved.tracks[2].translation.len(), 31);
}

#[test]
fn smoothed_travel_leaves_the_sway_in_the_hips() {
    let skeleton = Skeleton { bones: vec![bone("root", None, Vec3::ZERO), bone("hips", Some(0), Vec3::Y)] };
    let times: Vec<f32> = (0..=120).map(|frame| frame as f32 / 30.0).collect();
    let sway = |time: f32| 0.05 * (time * 2.0 * std::f32::consts::TAU).sin();
    let places: Vec<Vec3> = times.iter().map(|&time| Vec3::new(sway(time), 1.0, time)).collect();
    let track = Track {
        bone: 1,
        translation: Channel::new(times, places, Interpolation::Linear),
        ..Track::default()
    };
    let take = take(vec![Track::default(), track]);
    let moved = move_travel(&take, &skeleton, 1, 0, &options(&take, false, false, 12.0)).unwrap();
    let (mut root, mut hips) = (0.0_f32, 0.0_f32);
    for frame in 30..=90 {
        let time = frame as f32 / 30.0;
        let [below, above] = [&moved.take.tracks[0], &moved.take.tracks[1]]
            .map(|track| dragonfly_anim::sample::sample_channel(&track.translation, Vec3::ZERO, time));
        root = root.max(below.x.abs());
        hips = hips.max(above.x.abs());
        assert!((below.z - time).abs() < 1e-3, "the root walks as fast as the hips did: {}", below.z);
    }
    assert!(root < 0.005 && hips > 0.04, "root sways {root}, hips {hips}");
}

#[test]
fn travel_moves_only_between_a_bone_and_one_above_it_and_needs_a_rate() {
    let (skeleton, take) = turning_walk();
    let options = options(&take, true, false, 0.0);
    assert_eq!(
        move_travel(&take, &skeleton, 1, 2, &options).unwrap_err(),
        MotionError::NotInLine { from: 1, to: 2 }
    );
    assert_eq!(
        move_travel(&take, &skeleton, 1, 9, &options).unwrap_err(),
        MotionError::NoSuchBone { bone: 9 }
    );
    let none = TravelOptions { rate: f32::NAN, ..options };
    assert_eq!(move_travel(&take, &skeleton, 1, 0, &none).unwrap_err(), MotionError::Rate);
}

#[test]
fn hips_and_root_are_found_by_name_or_by_their_branches() {
    let found = |path: &str| {
        let model = load(&data().join(path));
        let skeleton = model.animation.skeleton;
        let name = |bone: BoneIndex| skeleton.bones[bone as usize].name.clone();
        let hips = guess_hips(&skeleton)?;
        Some((name(hips), guess_root(&skeleton, hips).map(name)))
    };
    for path in [
        "gltf/Fox.glb",
        "collection/RobotExpressive.glb",
        "collection/quaternius_Character4skins.glb",
        "bench/pab.glb",
    ] {
        println!("{path}: {:?}", found(path));
    }
    let fox = found("gltf/Fox.glb").unwrap();
    assert_eq!(fox.0, "b_Hip_01");
    assert_eq!(fox.1.as_deref(), Some("b_Root_00"));
}
