//! A take on a rig with other bone axes turns the bones as Blender's constraints do.

use super::support::{angle_between, bone, take};
use crate::retarget::matrices;
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Track};
use dragonfly_anim::retarget::{RetargetOptions, SkeletonBinding, retarget};
use glam::{Quat, Vec3};
use serde_json::Value;

fn numbers<const COUNT: usize>(value: &Value) -> [f32; COUNT] {
    std::array::from_fn(|at| value[at].as_f64().expect("a number") as f32)
}

fn rotation(value: &Value) -> Quat {
    Quat::from_array(numbers(value)).normalize()
}

/// Returns the number of compared rotations, and the largest angle by which one differs from Blender's, degrees.
pub(crate) fn compared_with_blender() -> (usize, f64) {
    let expected: Value =
        serde_json::from_str(include_str!("../data/retarget/expected.json")).expect("written by expected.py");
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let skeleton = |rests: &Value| {
        let bones = list(&expected["bones"]).into_iter().zip(list(rests)).map(|(about, rest)| {
            let parent = about[1].as_u64().map(|parent| parent as u32);
            let mut bone =
                bone(about[0].as_str().expect("a name"), parent, Vec3::from_array(numbers(&rest[0])));
            bone.rest.rotation = rotation(&rest[1]);
            bone
        });
        Skeleton { bones: bones.collect() }
    };
    let (source, target) = (skeleton(&expected["source"]), skeleton(&expected["target"]));
    let frames = list(&expected["frames"]);
    let times: Vec<f32> = (0..frames.len()).map(|frame| frame as f32 / 24.0).collect();
    let tracks = (0..source.len()).map(|bone| {
        let values: Vec<Quat> = frames.iter().map(|frame| rotation(&frame[bone])).collect();
        let rotation = Channel::new(times.clone(), values, Interpolation::Linear);
        Track { bone: bone as u32, rotation, ..Track::default() }
    });
    let motion = take(tracks.collect());
    let binding = SkeletonBinding::by_name(&source, &target);
    assert_eq!(binding.bound(), source.len());
    let result = retarget(&motion, &source, &target, &binding, &RetargetOptions::default());
    let (mut count, mut worst) = (0, 0.0_f64);
    for (time, wanted) in times.iter().zip(list(&expected["expected"])) {
        for (bone, matrix) in matrices(&target, &result, *time).into_iter().enumerate() {
            let found = matrix.to_scale_rotation_translation().1;
            worst = worst.max(f64::from(angle_between(found, rotation(&wanted[bone]))).to_degrees());
            count += 1;
        }
    }
    (count, worst)
}

#[test]
fn bones_with_other_axes_turn_as_with_the_constraints_of_blender() {
    let (count, worst) = compared_with_blender();
    println!("{count} rotations: {worst}°");
    assert!(count > 300 && worst < 0.01, "{worst}°");
}
