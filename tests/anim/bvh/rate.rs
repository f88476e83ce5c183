//! The frame rate of a written file follows the keys and the curves between them.

use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{Conventions, NoFiles, ReadOptions, bvh};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Returns an arm of two meters whose first bone has these keys.
pub(crate) fn arm(rotation: Channel<Quat>) -> ModelData {
    let bone = |name: &str, parent: Option<u32>| Bone {
        parent,
        rest: Transform {
            translation: Vec3::new(0.0, f32::from(u8::from(parent.is_some())), 0.0),
            ..Transform::IDENTITY
        },
        ..Bone::root(name)
    };
    let skeleton = Skeleton { bones: vec![bone("a", None), bone("b", Some(0)), bone("c", Some(1))] };
    let tracks = (0..3).map(|bone| Track { bone, ..Track::default() });
    let mut take = Take { tracks: tracks.collect(), ..Take::default() };
    take.length = rotation.times.last().copied().unwrap_or_default();
    take.tracks[0].rotation = rotation;
    let animation = AnimationData { skeleton: Arc::new(skeleton), takes: vec![Arc::new(take)] };
    ModelData { animation, ..ModelData::default() }
}

/// Returns the frame rate of the written file, the largest distance in millimeters from the model at many times, and the
/// line about curves.
fn written(model: &ModelData) -> (f32, f32, Option<String>) {
    let file = bvh::write(model).unwrap();
    let conventions = Conventions { meters_per_unit: Some(0.01), ..Conventions::default() };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let again = bvh::BVH.import(&file.bytes, &NoFiles, &options).unwrap();
    let rate = again.conversion.frame_rate.unwrap().value;
    let [mut ours, mut theirs] = [model.clone(), again.model].map(|model| Evaluator::new(Arc::new(model)));
    let end = model.animation.takes[0].length;
    let mut worst = 0.0_f32;
    for step in 0..=2000 {
        let time = end * step as f32 / 2000.0;
        ours.pose(Some(0), time);
        theirs.pose(Some(0), time);
        for (a, b) in ours.to_root().iter().zip(theirs.to_root()) {
            worst = worst.max(a.w_axis.truncate().distance(b.w_axis.truncate()));
        }
    }
    let line = file.lost.iter().find(|lost| lost.code == bvh::check::INTERPOLATION_NOT_STORED);
    (rate, worst * 1e3, line.map(ToString::to_string))
}

/// Returns a swing through these angles about x, in radians, with keys at these times.
pub(crate) fn swing(times: &[f32], angles: &[f32], interpolation: Interpolation) -> Channel<Quat> {
    let turn = |angle: &f32| Quat::from_rotation_x(*angle);
    let values: Vec<Quat> = match interpolation {
        Interpolation::CubicSpline => {
            let still = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
            angles.iter().flat_map(|angle| [still, turn(angle), still]).collect()
        }
        _ => angles.iter().map(turn).collect(),
    };
    Channel::new(times, values, interpolation)
}

#[test]
fn curves_get_as_many_frames_as_bones_need_to_be_within_a_thousandth_of_the_size() {
    let slow = arm(swing(&[0.0, 2.0], &[0.0, 0.5], Interpolation::CubicSpline));
    let fast = arm(swing(&[0.0, 0.1, 0.2], &[0.0, 0.15, 0.0], Interpolation::CubicSpline));
    let (slow_rate, slow_off, line) = written(&slow);
    assert_eq!(slow_rate, 12.0);
    assert!(slow_off > 0.02 && slow_off < 2.0, "{slow_off}");
    // The measured distance is listed.
    let line = line.unwrap();
    let listed: f32 = line.split("up to ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((listed - slow_off).abs() < 0.1 * slow_off, "{line}: {slow_off}");
    assert!(
        line.starts_with("/animation/takes/0: curves become 12 frames per second; between frames"),
        "{line}"
    );
    let (fast_rate, fast_off, _) = written(&fast);
    assert_eq!(fast_rate, 60.0 * 2.0);
    assert!(fast_off < 2.0, "{fast_off}");
}

#[test]
fn lines_between_keys_at_frames_keep_the_rate_of_the_keys() {
    for rate in [12.0_f32, 24.0, 25.0, 29.97, 59.94, 120.0, 144.0, 300.0] {
        let times: Vec<f32> = (0..40).map(|frame| frame as f32 / rate).collect();
        let angles: Vec<f32> = (0..40).map(|frame| ((frame * 7) % 11) as f32 * 0.1).collect();
        let (written_rate, off, line) = written(&arm(swing(&times, &angles, Interpolation::Linear)));
        assert!((written_rate / rate - 1.0).abs() < 1e-4, "{written_rate} for {rate}");
        assert!(off < 0.02, "{rate}: {off}");
        assert_eq!(line, None, "{rate}");
    }
}

#[test]
fn a_take_that_no_rate_follows_gets_240_frames_per_second_and_its_distance_is_listed() {
    let steps = arm(swing(&[0.0, 0.1137, 0.3719], &[0.0, 1.0, 0.0], Interpolation::Step));
    let (rate, off, line) = written(&steps);
    assert_eq!(rate, 240.0);
    assert!(off > 500.0, "{off}");
    let line = line.unwrap();
    let share: f32 = line.split('(').nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(share > 20.0, "{line}");
}
