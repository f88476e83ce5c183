//! Chained poses, compared with a recursion that follows the definition, and the matrices prepared for the GPU.

use crate::support::{about_z, along_x, animation_data, assert_near, bone, take};
use dragonfly_anim::animation::{Animation, final_poses, to_root};
use dragonfly_anim::data::{
    AnimationData, Bone, Interpolation, ModelData, Skeleton, Skin, Take, Track, Transform,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::sample::sample_take;
use dragonfly_kit::counting;
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

fn random_pose(random: &mut Random) -> Transform {
    let mut vector = |low, high| Vec3::from_array([(); 3].map(|()| random.between(low, high)));
    let (translation, axis, scale) = (vector(-2.0, 2.0), vector(-1.0, 1.0), vector(0.5, 1.5));
    Transform { translation, rotation: Quat::from_scaled_axis(axis * 3.0), scale }
}

fn random_skeleton(random: &mut Random, bones: usize) -> Skeleton {
    let bones = (0..bones).map(|index| {
        let parent = (index > 0 && random.unit() < 0.9).then(|| random.below(index) as u32);
        Bone {
            rest: random_pose(random),
            offset: random_pose(random).to_matrix(),
            ..bone(&format!("bone {index}"), parent, Vec3::ZERO)
        }
    });
    Skeleton { bones: bones.collect() }
}

/// Thesis §2.1.5.1 word for word.
fn by_recursion(skeleton: &Skeleton, poses: &[Transform], index: usize) -> Mat4 {
    let to_parent = poses[index].to_matrix();
    match skeleton.bones[index].parent {
        Some(parent) => by_recursion(skeleton, poses, parent as usize) * to_parent,
        None => to_parent,
    }
}

#[test]
fn one_forward_pass_gives_the_result_of_the_recursion() {
    let seed = seed(1);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for bones in [0, 1, 2, 3, 10, 100, 300] {
        let skeleton = random_skeleton(&mut random, bones);
        let poses: Vec<Transform> = (0..bones).map(|_| random_pose(&mut random)).collect();
        let mut out = vec![Mat4::NAN; bones];
        to_root(&skeleton, &poses, &mut out);
        for (index, &got) in out.iter().enumerate() {
            // The same products in the same order: the same bits.
            assert_eq!(got, by_recursion(&skeleton, &poses, index), "bone {index} of {bones}");
        }
    }
}

#[test]
fn moving_a_bone_moves_only_its_descendants() {
    // 0 ─ 1 ─ 2, and 3 next to 1.
    let parents = [None, Some(0), Some(1), Some(0)];
    let bones: Vec<Bone> = parents.iter().map(|&parent| bone("", parent, Vec3::X)).collect();
    let mut animation = Animation::new(animation_data(bones, vec![]));
    let rest = animation.to_root().to_vec();
    let turned =
        animation.to_root_bone_poses_with(|poses| poses[1].rotation = Quat::from_rotation_z(1.0)).to_vec();
    let moved: Vec<bool> = rest.iter().zip(&turned).map(|(a, b)| a != b).collect();
    assert_eq!(moved, [false, true, true, false]);
    // The forearm follows the arm: one unit along the rotated x axis.
    let expected = Vec3::new(2.0 + 1.0_f32.cos(), 1.0_f32.sin(), 0.0);
    assert!((turned[2].w_axis.truncate() - expected).length() < 1e-6);
}

#[test]
fn the_identity_changes_nothing() {
    let identity = [Transform::IDENTITY; 5];
    let bones = (0..5).map(|index: u32| bone("", index.checked_sub(1), Vec3::ZERO)).collect();
    let mut out = [Mat4::NAN; 5];
    to_root(&Skeleton { bones }, &identity, &mut out);
    assert_eq!(out, [Mat4::IDENTITY; 5]);
}

#[test]
fn final_pose_is_to_root_times_offset_and_nothing_moves_in_the_bind_pose() {
    let seed = seed(2);
    println!("DRAGONFLY_SEED={seed}");
    let skeleton = random_skeleton(&mut Random::new(seed), 20);
    let poses: Vec<Transform> = skeleton.bones.iter().map(|bone| bone.rest).collect();
    let mut bind = vec![Mat4::IDENTITY; 20];
    to_root(&skeleton, &poses, &mut bind);
    let bones: Vec<Bone> = skeleton
        .bones
        .iter()
        .zip(&bind)
        .map(|(bone, bind)| Bone { offset: bind.inverse(), ..bone.clone() })
        .collect();
    let offsets: Vec<Mat4> = bones.iter().map(|bone| bone.offset).collect();
    let mut animation = Animation::new(animation_data(bones, vec![]));
    for &pose in animation.final_bone_poses(None, 0.0) {
        assert_near(pose, Mat4::IDENTITY, 1e-4);
    }
    assert_eq!(animation.bind_bone_poses(), offsets);
    assert_eq!(animation.output(), offsets);
}

#[test]
fn skins_that_share_bones_have_their_own_offsets_and_order() {
    let data = animation_data(vec![bone("a", None, Vec3::X), bone("b", Some(0), Vec3::Y)], vec![]);
    let mut animation = Animation::new(data);
    let shift = |x: f32| Mat4::from_translation(Vec3::new(x, 0.0, 0.0));
    let skin = Skin {
        name: String::new(),
        bones: vec![1, 0, 1],
        offsets: vec![shift(10.0), shift(20.0), shift(30.0)],
    };
    let origins: Vec<Vec3> = animation.skin_poses(&skin).iter().map(|pose| pose.w_axis.truncate()).collect();
    assert_eq!(origins, [Vec3::new(11.0, 1.0, 0.0), Vec3::new(21.0, 0.0, 0.0), Vec3::new(31.0, 1.0, 0.0)]);
    let mut out = [Mat4::ZERO; 3];
    final_poses(&skin, animation.to_root(), &mut out);
    assert_eq!(animation.output(), out);
}

#[test]
fn a_sheared_rest_keeps_its_exact_matrix_until_something_animates_the_bone() {
    let sheared =
        Mat4::from_rotation_z(0.7) * Mat4::from_scale(Vec3::new(3.0, 1.0, 1.0)) * Mat4::from_rotation_z(0.4);
    let rest = Transform::from_matrix(sheared);
    assert!(!rest.to_matrix().abs_diff_eq(sheared, 0.1), "no pose can represent it");
    let bones = || {
        vec![
            Bone { rest, rest_matrix: Some(sheared), ..bone("", None, Vec3::ZERO) },
            bone("", Some(0), Vec3::X),
        ]
    };
    let moving = Track { translation: along_x(&[(0.0, 5.0)], Interpolation::Linear), ..Track::default() };
    let takes = vec![take(vec![Track::default()]), take(vec![moving])];
    let mut animation = Animation::new(animation_data(bones(), takes));
    assert_eq!(animation.to_root_bone_poses(None, 0.0)[0], sheared);
    let child = sheared * Mat4::from_translation(Vec3::X);
    assert_eq!(animation.to_root_bone_poses(Some(0), 0.0), [sheared, child]);
    let animated = Transform { translation: Vec3::new(5.0, 0.0, 0.0), ..rest };
    assert_eq!(animation.to_root_bone_poses(Some(1), 0.0)[0], animated.to_matrix());
}

fn waving() -> (AnimationData, Take) {
    let bones: Vec<Bone> = (0..60).map(|index: u32| bone("", index.checked_sub(1), Vec3::Y)).collect();
    let track = Track {
        translation: along_x(&[(0.0, 0.0), (0.5, 0.1), (1.0, 0.0)], Interpolation::Linear),
        rotation: about_z(&[(0.0, 0.0), (0.3, 0.2), (0.6, -0.2), (1.0, 0.0)], Interpolation::Linear),
        ..Track::default()
    };
    let take = take(vec![track; 60]);
    (animation_data(bones, vec![take.clone()]), take)
}

#[test]
fn an_animation_finds_its_takes_by_number_and_can_replace_them() {
    let (data, original) = waving();
    let mut animation = Animation::new(data);
    let at_half = animation.to_root_bone_poses(Some(0), 0.5).to_vec();
    let rest = animation.to_root_bone_poses(None, 0.5).to_vec();
    assert_ne!(at_half, rest);
    assert_eq!(animation.to_root_bone_poses(Some(7), 0.5), rest, "no such take: the rest pose");
    assert_eq!(animation.to_root_bone_poses_of(&original, 0.5), at_half);
    let old = animation.replace_take(0, Arc::new(Take::default())).unwrap();
    assert_eq!(*old, original);
    assert_eq!(animation.to_root_bone_poses(Some(0), 0.5), rest);
    assert_eq!(animation.replace_take(7, old), None);
}

#[test]
fn posing_allocates_nothing() {
    let (data, original) = waving();
    // More joints than bones, so that the capacity for a model's skins is not sufficient by chance.
    let skin = Skin {
        name: String::new(),
        bones: (0..60).chain(0..60).collect(),
        offsets: vec![Mat4::IDENTITY; 120],
    };
    let model = ModelData { animation: data, skins: vec![skin.clone()], ..ModelData::default() };
    let mut animation = Animation::of(&model);
    let mut poses = vec![Transform::IDENTITY; 60];
    let mut evaluator = Evaluator::new(Arc::new(model));
    let (count, ()) = counting::count(|| {
        for frame in 0..1_000 {
            let time = frame as f32 * 0.016;
            animation.to_root_bone_poses(Some(0), time);
            animation.skin_poses(&skin);
            animation.final_bone_poses(Some(0), time);
            animation.bind_bone_poses();
            sample_take(Some(&original), &animation.data().skeleton, time, &mut poses);
            evaluator.pose(Some(0), time);
        }
    });
    assert_eq!(count, counting::Count::default());
    let (count, _) = counting::count(|| vec![0_u8; 100]);
    assert_eq!(count, counting::Count { allocations: 1, bytes: 100 }, "the allocator counts");
}
