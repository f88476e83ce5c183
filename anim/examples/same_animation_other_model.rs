//! Plays one take on two models: a figure in a T-pose, and a taller one with its arms down and other bone names.
//!
//! `cargo run -p dragonfly-anim --example same_animation_other_model`

use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::{AnimationData, Bone, Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_anim::retarget::{RetargetOptions, SkeletonBinding, retarget};
use glam::{Mat4, Quat, Vec3};
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

fn bone(name: &str, parent: Option<u32>, translation: Vec3, rotation: Quat) -> Bone {
    let rest = Transform { translation, rotation, scale: Vec3::ONE };
    Bone { name: name.to_owned(), parent, rest, rest_matrix: None, offset: Mat4::IDENTITY, node: None }
}

/// Hips at `height` over a foot, an arm of 0.5 m at the shoulder whose rest pose is rotated by `rest` about z.
fn figure(names: [&str; 4], height: f32, rest: f32) -> Skeleton {
    let none = Quat::IDENTITY;
    let bones = vec![
        bone(names[0], None, Vec3::Y * height, none),
        bone(names[1], Some(0), Vec3::NEG_Y * height, none),
        bone(names[2], Some(0), Vec3::new(0.2, 0.5, 0.0), Quat::from_rotation_z(rest)),
        bone(names[3], Some(2), Vec3::X * 0.5, none),
    ];
    Skeleton { bones }
}

pub(crate) fn main() {
    // The source is in T-pose, the target has its arms straight down.
    let source = figure(["Hips", "LeftFoot", "LeftArm", "LeftHand"], 1.0, 0.0);
    let target = figure(["mixamorig:Hips", "foot.L", "arm.L", "hand_l"], 1.5, -FRAC_PI_2);
    let binding = SkeletonBinding::by_name(&source, &target);
    assert_eq!((binding.bound(), &binding.unbound_target[..]), (4, &[][..]));

    // The source takes a step and raises its arm.
    let mut tracks = vec![Track::default(); 4];
    let step = [Vec3::Y, Vec3::new(0.0, 1.0, 0.4)];
    tracks[0].translation = Channel::new([0.0, 1.0], step, Interpolation::Linear);
    let raise = [Quat::IDENTITY, Quat::from_rotation_z(1.0)];
    tracks[2].rotation = Channel::new([0.0, 1.0], raise, Interpolation::Linear);
    let wave = Take { name: "wave".to_owned(), length: 1.0, tracks, ..Take::default() };

    let other = retarget(&wave, &source, &target, &binding, &RetargetOptions::default());
    let arm = |skeleton: Skeleton, take: Take, time: f32| {
        let data = AnimationData { skeleton: Arc::new(skeleton), takes: vec![Arc::new(take)] };
        let mut animation = Animation::new(data);
        let to_root = animation.to_root_bone_poses(Some(0), time);
        (to_root[0].w_axis.truncate(), (to_root[3].w_axis - to_root[2].w_axis).truncate() / 0.5)
    };
    for time in [0.0, 0.5, 1.0] {
        let (hips, way) = arm(source.clone(), wave.clone(), time);
        let (other_hips, other_way) = arm(target.clone(), other.clone(), time);
        println!("{time} s: hips {hips:.2} and {other_hips:.2}, arms point to {way:.2} and {other_way:.2}");
        assert!(way.distance(other_way) < 1e-5 && (hips * 1.5).distance(other_hips) < 1e-5);
    }
}
