//! Blends of two takes of a real animal, compared with a second implementation of the formulas in f64.

use crate::doors::{TestFolder, data};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::blend::{CrossFade, Cycle, FadeCurve, Layer, Mask, add, blend, blend_two, difference};
use dragonfly_anim::data::{ModelData, Transform};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_anim::sample::sample_take;
use glam::{DMat4, DQuat, DVec3, Mat4};

fn fox() -> ModelData {
    let folder = data().join("gltf");
    let bytes = std::fs::read(folder.join("Fox.glb")).unwrap();
    read("Fox.glb", &bytes, &TestFolder(folder), &ReadOptions::default()).unwrap().model
}

fn sampled(model: &ModelData, take: Option<&str>, time: f32) -> Vec<Transform> {
    let takes = &model.animation.takes;
    let take = take.map(|name| takes.iter().find(|take| take.name == name).expect("a take of the fox"));
    let mut poses = vec![Transform::IDENTITY; model.animation.skeleton.len()];
    sample_take(take.map(AsRef::as_ref), &model.animation.skeleton, time, &mut poses);
    poses
}

/// A quaternion `xyzw`, without the library's quaternions.
type Quaternion64 = [f64; 4];

fn numbers(pose: &Transform) -> Quaternion64 {
    pose.rotation.to_array().map(f64::from)
}

fn dot(a: Quaternion64, b: Quaternion64) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn unit(a: Quaternion64) -> Quaternion64 {
    a.map(|number| number / dot(a, a).sqrt())
}

/// Returns the sum of two in one hemisphere, normalized.
fn straight(a: Quaternion64, b: Quaternion64, mix: f64) -> Quaternion64 {
    let sign = dot(a, b).signum();
    unit(std::array::from_fn(|at| (1.0 - mix) * a[at] + mix * sign * b[at]))
}

/// The textbook slerp.
fn spherical(a: Quaternion64, b: Quaternion64, mix: f64) -> Quaternion64 {
    let (a, b) = (unit(a), unit(b));
    let cosine = dot(a, b);
    let angle = cosine.abs().min(1.0).acos();
    if angle < 1e-9 {
        return a;
    }
    let [from, to] = [(1.0 - mix) * angle, mix * angle].map(|part| part.sin() / angle.sin());
    std::array::from_fn(|at| from * a[at] + to * cosine.signum() * b[at])
}

/// Returns to-root of every bone in f64, from poses interpolated by `rotation` with one weight per bone in `mix`.
fn chained(
    model: &ModelData,
    a: &[Transform],
    b: &[Transform],
    mix: impl Fn(usize) -> f64,
    rotation: fn(Quaternion64, Quaternion64, f64) -> Quaternion64,
) -> Vec<DMat4> {
    let mut out: Vec<DMat4> = Vec::new();
    for (index, bone) in model.animation.skeleton.bones.iter().enumerate() {
        let (a, b, mix) = (&a[index], &b[index], mix(index));
        let vector = |a: glam::Vec3, b: glam::Vec3| -> DVec3 { a.as_dvec3().lerp(b.as_dvec3(), mix) };
        let turn = DQuat::from_array(rotation(numbers(a), numbers(b), mix));
        let (scale, place) = (vector(a.scale, b.scale), vector(a.translation, b.translation));
        let to_parent = DMat4::from_scale_rotation_translation(scale, turn, place);
        out.push(bone.parent.map_or(to_parent, |parent| out[parent as usize] * to_parent));
    }
    out
}

#[track_caller]
fn assert_chained(model: &ModelData, poses: &[Transform], expected: &[DMat4]) {
    let mut got = vec![Mat4::IDENTITY; poses.len()];
    to_root(&model.animation.skeleton, poses, &mut got);
    for ((got, expected), bone) in got.iter().zip(expected).zip(&model.animation.skeleton.bones) {
        let expected = expected.as_mat4();
        let largest = expected.to_cols_array().into_iter().map(f32::abs).fold(1.0, f32::max);
        assert!(got.abs_diff_eq(expected, 1e-5 * largest), "{}: {got}\n{expected}", bone.name);
    }
}

#[test]
fn walking_and_running_blend_according_to_the_formula() {
    let model = fox();
    for (walk, run) in [(0.1, 0.2), (0.35, 0.9), (0.7, 0.0)] {
        let (a, b) = (sampled(&model, Some("Walk"), walk), sampled(&model, Some("Run"), run));
        let mut out = sampled(&model, None, 0.0);
        let rest = out.clone();
        for mix in [0.0_f32, 0.25, 0.5, 0.8, 1.0] {
            blend(&rest, &[Layer::new(&a, 1.0 - mix), Layer::new(&b, mix)], &mut out);
            assert_chained(&model, &out, &chained(&model, &a, &b, |_| mix.into(), straight));
            blend_two(&a, &b, mix, None, &mut out);
            assert_chained(&model, &out, &chained(&model, &a, &b, |_| mix.into(), spherical));
        }
        // The rest pose gets the weight that a single layer leaves.
        blend(&rest, &[Layer::new(&b, 0.3)], &mut out);
        assert_chained(&model, &out, &chained(&model, &rest, &b, |_| f64::from(0.3_f32), straight));
    }
}

#[test]
fn the_head_looks_around_while_the_legs_run() {
    let model = fox();
    let skeleton = &model.animation.skeleton;
    let neck = skeleton.find("b_Neck_04").unwrap();
    let mask = Mask::of_branch(skeleton, neck).feathered(skeleton, 1);
    assert_eq!(mask.weights().iter().filter(|weight| **weight > 0.0).count(), 2, "neck and head");
    let (run, survey) = (sampled(&model, Some("Run"), 0.4), sampled(&model, Some("Survey"), 1.7));
    let mut out = run.clone();
    blend(&run, &[Layer::new(&survey, 1.0).masked(&mask)], &mut out);
    let expected = chained(&model, &run, &survey, |bone| f64::from(mask.weight(bone)), straight);
    assert_chained(&model, &out, &expected);
    // Nothing else moved, not by a bit.
    let changed = out.iter().zip(&run).filter(|(out, run)| out != run).count();
    assert_eq!(changed, 2);
}

#[test]
fn a_take_applied_as_a_difference_gives_the_take() {
    let model = fox();
    let (run, survey) = (sampled(&model, Some("Run"), 0.4), sampled(&model, Some("Survey"), 1.7));
    let (mut more, mut out) = (run.clone(), run.clone());
    difference(&survey, &run, &mut more);
    add(&run, &more, 1.0, None, &mut out);
    assert_chained(&model, &out, &chained(&model, &survey, &survey, |_| 0.0, straight));
}

#[test]
fn the_fox_changes_from_walk_to_run_in_phase() {
    let model = fox();
    let cycle = |name: &str| {
        let take = model.animation.takes.iter().find(|take| take.name == name).unwrap();
        (Cycle::of(take), take.start, take.length)
    };
    let ((walk, walk_start, walk_length), (run, run_start, run_length)) = (cycle("Walk"), cycle("Run"));
    let mut fade = CrossFade::new(walk, run, 0.4, FadeCurve::SmoothStep).starting_at(0.3);
    let mut poses = sampled(&model, None, 0.0);
    let mut frames = 0;
    while !fade.is_done() {
        let now = fade.advance(1.0 / 60.0);
        let phases = ((now.from_time - walk_start) / walk_length, (now.to_time - run_start) / run_length);
        assert!((phases.0 - phases.1).abs() < 1e-5, "{now:?}");
        let (a, b) =
            (sampled(&model, Some("Walk"), now.from_time), sampled(&model, Some("Run"), now.to_time));
        blend_two(&a, &b, now.weight, None, &mut poses);
        assert!(poses.iter().all(Transform::is_finite));
        frames += 1;
    }
    assert!((24..=25).contains(&frames), "{frames} frames of a sixtieth are 0.4 s");
    assert_eq!(poses, sampled(&model, Some("Run"), fade.now().to_time));
}
