//! A character's final matrices in one pass are those of `to_root` and `final_poses`, one after the other.

use crate::fast_path::made;
use dragonfly_anim::data::{AnimationData, Skin};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{
    KeyedTake, Playing, Pose, Rig, RootPoses, Scratch, SkinBinding, final_poses, matrix, pose_character,
    pose_crowd, sample, to_root,
};
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Returns a skin with joints at some of the bones, some at one bone twice, and some at bones that do not exist.
fn skin(random: &mut Random, animation: &AnimationData, joints: usize) -> Skin {
    let bones = animation.skeleton.len();
    let bone = |random: &mut Random| random.below(bones + 2) as u32;
    let bones: Vec<u32> = (0..joints).map(|_| bone(random)).collect();
    let offset =
        |_| Mat4::from_translation(Vec3::new(random.unit(), random.unit(), 2.0)) * Mat4::from_rotation_x(1.0);
    Skin { name: String::new(), offsets: (0..joints).map(offset).collect(), bones }
}

/// Compares one pass with two, for one character and for crowds of it, at every level.
fn compare(animation: &AnimationData, skin: &Skin) {
    let rig = Rig::new(&animation.skeleton);
    let binding = SkinBinding::new(&rig, skin);
    let take = KeyedTake::new(&animation.skeleton, &animation.takes[0]);
    let joints = skin.bones.len();
    let characters: Vec<[Playing<KeyedTake>; 1]> =
        (0..35).map(|at| [Playing::new(&take, at as f32 / 90.0)]).collect();
    for level in SimdLevel::all() {
        let (mut scratch, mut roots) = (Scratch::new(&rig), RootPoses::new(&rig));
        let (mut pose, mut expected) = (Pose::new(rig.bones()), vec![matrix::IDENTITY; joints * 35]);
        for (layers, expected) in characters.iter().zip(expected.chunks_mut(joints)) {
            sample(level, &take, layers[0].time, pose.blocks_mut());
            to_root(level, &rig, pose.blocks(), &mut roots);
            final_poses(level, &binding, &roots, expected);
            let mut one = vec![matrix::IDENTITY; joints];
            pose_character(level, &rig, &binding, layers, &mut scratch, &mut one);
            assert_eq!(one, expected, "{}, {} bones", level.name(), rig.bones());
            assert_eq!(scratch.pose(), &pose);
        }
        let mut crowd = vec![matrix::IDENTITY; joints * 35];
        pose_crowd(level, &rig, &binding, characters.iter().map(|one| &one[..]), &mut scratch, &mut crowd);
        assert_eq!(crowd, expected, "{}, {} bones", level.name(), rig.bones());
    }
}

#[test]
fn every_joint_gets_its_matrix_also_of_a_bone_that_has_two_or_that_is_missing() {
    let seed = seed(77);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    // More bones than a byte can number, too.
    for bones in [1, 7, 8, 9, 40, 67, 300] {
        let animation = made(bones, &mut random);
        for joints in [1, bones.div_ceil(3), bones * 2] {
            compare(&animation, &skin(&mut random, &animation, joints));
        }
    }
}

#[test]
fn a_character_with_numbers_that_overflow_does_not_change_those_beside_it() {
    let mut random = Random::new(8);
    let mut animation = made(20, &mut random);
    for bone in &mut Arc::make_mut(&mut animation.skeleton).bones[10..] {
        bone.rest.scale = Vec3::splat(1e20);
        bone.rest.translation = Vec3::splat(1e30);
    }
    for track in animation.takes.iter_mut().flat_map(|take| &mut Arc::make_mut(take).tracks) {
        track.scale = Default::default();
        track.translation = Default::default();
    }
    compare(&animation, &skin(&mut random, &animation, 40));
}
