//! Additional transforms of single bones on top of an animation.

use crate::blending::{a_pose, a_rotation, assert_sound, bits, hostile};
use crate::support::{angle_between, assert_near, bone};
use dragonfly_anim::additional::{Additional, AdditionalMode, PoseParts, Space, apply};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{Mat3, Mat4, Quat, Vec3};
use proptest::prelude::*;

const REST: Transform = Transform::IDENTITY;

fn chain(count: usize) -> Skeleton {
    let bones = (0..count).map(|index| bone("", (index as u32).checked_sub(1), Vec3::Y));
    Skeleton { bones: bones.collect() }
}

fn matrices(skeleton: &Skeleton, poses: &[Transform]) -> Vec<Mat4> {
    let mut out = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, poses, &mut out);
    out
}

fn entry(bone: u32, transform: Transform, space: Space, mode: AdditionalMode) -> Additional {
    Additional { bone, transform, space, mode, parts: PoseParts::ALL, weight: 1.0 }
}

/// A pose with a uniform scale, perhaps mirrored: for these, rotations in other spaces are exact.
fn a_uniform_pose() -> impl Strategy<Value = Transform> {
    (a_pose(), 0.2_f32..2.0, any::<bool>()).prop_map(|(pose, scale, mirrored)| {
        let scale = Vec3::new(if mirrored { -scale } else { scale }, scale, scale);
        Transform { scale, ..pose }
    })
}

proptest! {
    #[test]
    fn weight_zero_and_adding_the_identity_leave_the_pose_unchanged(
        pose in prop::collection::vec(a_pose(), 3), by in a_pose(), space in 0_usize..3,
    ) {
        let (skeleton, space) = (chain(3), [Space::Bone, Space::Parent, Space::Root][space]);
        for (transform, weight) in [(by, 0.0), (by, -1.0), (by, f32::NAN), (REST, 1.0), (REST, 0.5)] {
            let mut poses = pose.clone();
            let mode = AdditionalMode::Add;
            apply(&skeleton, &[Additional { weight, ..entry(2, transform, space, mode) }], &mut poses);
            prop_assert_eq!(bits(poses[2]), bits(pose[2]), "{} {:?}", weight, transform);
        }
    }

    #[test]
    fn a_rotation_in_root_space_turns_the_bone_about_its_origin_and_the_axes_of_the_scene(
        pose in prop::collection::vec(a_uniform_pose(), 4), turn in a_rotation(), by in prop::array::uniform3(-1.0_f32..1.0),
    ) {
        let skeleton = chain(4);
        let transform = Transform { rotation: turn, translation: Vec3::from_array(by), ..REST };
        let mut poses = pose.clone();
        apply(&skeleton, &[entry(3, transform, Space::Root, AdditionalMode::Add)], &mut poses);
        let (before, after) = (matrices(&skeleton, &pose)[3], matrices(&skeleton, &poses)[3]);
        let place = before.w_axis.truncate();
        let expected = Mat4::from_translation(place + Vec3::from_array(by))
            * Mat4::from_quat(turn)
            * Mat4::from_mat3(Mat3::from_mat4(before));
        let size = after.to_cols_array().into_iter().map(f32::abs).fold(1.0, f32::max);
        prop_assert!(after.abs_diff_eq(expected, 2e-5 * size), "{after}\n{expected}");
    }

    #[test]
    fn a_replacement_in_root_space_gives_the_bone_that_pose_in_the_scene(
        pose in prop::collection::vec(a_uniform_pose(), 3), there in a_uniform_pose(),
    ) {
        let skeleton = chain(3);
        let mut poses = pose;
        apply(&skeleton, &[entry(2, there, Space::Root, AdditionalMode::Replace)], &mut poses);
        let (got, expected) = (matrices(&skeleton, &poses)[2], there.to_matrix());
        // The rounding error grows with the scales of the parents.
        prop_assert!(got.abs_diff_eq(expected, 5e-3), "{got}\n{expected}");
    }

    #[test]
    fn adding_in_the_bones_space_is_the_product_of_matrices(pose in a_uniform_pose(), by in a_uniform_pose()) {
        let skeleton = chain(1);
        let by = Transform { scale: Vec3::splat(by.scale.y), ..by };
        let pose = Transform { scale: Vec3::splat(pose.scale.y), ..pose };
        let mut poses = [pose];
        apply(&skeleton, &[entry(0, by, Space::Bone, AdditionalMode::Add)], &mut poses);
        assert_near(poses[0].to_matrix(), pose.to_matrix() * by.to_matrix(), 1e-5);
    }
}

#[test]
fn aiming_while_running_turns_the_spine_and_its_descendants() {
    let skeleton = chain(3);
    let running = [
        Transform { rotation: Quat::from_rotation_y(0.3), translation: Vec3::Z, ..REST },
        Transform { rotation: Quat::from_rotation_x(-0.2), translation: Vec3::Y, ..REST },
        Transform { translation: Vec3::Y, ..REST },
    ];
    let aim = Quat::from_rotation_y(0.8);
    let mut poses = running;
    apply(&skeleton, &[Additional::turn(1, aim, Space::Root)], &mut poses);
    let (before, after) = (matrices(&skeleton, &running), matrices(&skeleton, &poses));
    assert_eq!(after[0], before[0], "the hips keep the running pose");
    for bone in [1, 2] {
        let axes = |matrix: Mat4| Mat3::from_mat4(matrix);
        assert!(axes(after[bone]).abs_diff_eq(Mat3::from_quat(aim) * axes(before[bone]), 1e-6));
    }
    assert_near(
        Mat4::from_translation(after[1].w_axis.truncate()),
        Mat4::from_translation(before[1].w_axis.truncate()),
        1e-6,
    );
}

#[test]
fn the_same_rotation_turns_about_a_different_axis_in_each_space() {
    let skeleton = chain(2);
    let tilted = Quat::from_rotation_x(0.7);
    let running =
        [Transform { rotation: Quat::from_rotation_z(0.5), ..REST }, Transform { rotation: tilted, ..REST }];
    let turn = Quat::from_rotation_y(0.4);
    for (space, expected) in [
        (Space::Bone, tilted * turn),
        (Space::Parent, turn * tilted),
        (Space::Root, running[0].rotation.conjugate() * turn * running[0].rotation * tilted),
    ] {
        let mut poses = running;
        apply(&skeleton, &[Additional::turn(1, turn, space)], &mut poses);
        assert!(angle_between(poses[1].rotation, expected) < 1e-6, "{space:?}");
        // Half the weight gives half the angle.
        let mut half = running;
        apply(&skeleton, &[Additional { weight: 0.5, ..Additional::turn(1, turn, space) }], &mut half);
        assert!((angle_between(half[1].rotation, tilted) - 0.2).abs() < 1e-6, "{space:?}");
    }
}

#[test]
fn entries_are_applied_in_order() {
    let skeleton = chain(1);
    let (x, y) = (Quat::from_rotation_x(0.5), Quat::from_rotation_y(0.5));
    let mut poses = [REST];
    let turns = [Additional::turn(0, x, Space::Parent), Additional::turn(0, y, Space::Parent)];
    apply(&skeleton, &turns, &mut poses);
    assert!(angle_between(poses[0].rotation, y * x) < 1e-6);
    // A replacement discards what came before it.
    let still = entry(0, REST, Space::Parent, AdditionalMode::Replace);
    apply(&skeleton, &[turns[0], still], &mut poses);
    assert_eq!(poses[0], REST);
}

#[test]
fn a_replacement_in_the_space_of_the_bone_starts_from_its_rest_pose() {
    let mut skeleton = chain(1);
    skeleton.bones[0].rest.rotation = Quat::from_rotation_x(0.3);
    let mut poses = [Transform { rotation: Quat::from_rotation_z(2.0), translation: Vec3::X, ..REST }];
    let turn = Transform { rotation: Quat::from_rotation_y(0.4), ..REST };
    apply(&skeleton, &[entry(0, turn, Space::Bone, AdditionalMode::Replace)], &mut poses);
    assert!(angle_between(poses[0].rotation, Quat::from_rotation_x(0.3) * turn.rotation) < 1e-6);
    assert_eq!(poses[0].translation, Vec3::Y);
}

#[test]
fn only_the_selected_components_change() {
    let skeleton = chain(1);
    let running =
        Transform { translation: Vec3::new(0.1, -0.0, 0.3), scale: Vec3::new(1.0, 2.0, -1.0), ..REST };
    let there =
        Transform { translation: Vec3::ONE, rotation: Quat::from_rotation_y(0.4), scale: Vec3::splat(9.0) };
    let mut poses = [running];
    let replace = entry(0, there, Space::Parent, AdditionalMode::Replace);
    apply(&skeleton, &[Additional { parts: PoseParts::ROTATION, ..replace }], &mut poses);
    assert_eq!(bits(poses[0]), bits(Transform { rotation: there.rotation, ..running }));
}

#[test]
fn entries_that_cannot_be_applied_are_skipped() {
    let skeleton = chain(2);
    let turn = Quat::from_rotation_y(0.4);
    let bent = Transform { translation: Vec3::Y, rotation: Quat::from_rotation_x(1.0), scale: Vec3::X };
    let running = [Transform { scale: Vec3::ZERO, ..REST }, bent];
    let nan = Transform { translation: Vec3::NAN, ..REST };
    let mut poses = running;
    apply(
        &skeleton,
        &[
            Additional::turn(2, turn, Space::Bone),
            Additional::turn(u32::MAX, turn, Space::Root),
            entry(1, nan, Space::Parent, AdditionalMode::Replace),
            // The parent has a scale of zero: its space cannot be inverted.
            entry(
                1,
                Transform { translation: Vec3::X, rotation: turn, ..REST },
                Space::Root,
                AdditionalMode::Add,
            ),
            entry(
                1,
                Transform { translation: Vec3::X, rotation: turn, ..REST },
                Space::Root,
                AdditionalMode::Add,
            ),
            entry(
                1,
                Transform { translation: Vec3::X, rotation: turn, ..REST },
                Space::Root,
                AdditionalMode::Replace,
            ),
        ],
        &mut poses,
    );
    assert_eq!(poses, running);
    apply(&skeleton, &[Additional::turn(1, turn, Space::Bone)], &mut poses[..1]);
    assert_eq!(poses, running);
}

#[test]
fn invalid_poses_and_entries_give_finite_results() {
    let seed = seed(60);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut skeleton = chain(3);
    for round in 0..20_000 {
        skeleton.bones[1].rest = hostile(&mut random);
        skeleton.bones[2].parent = random.choice(&[None, Some(1), Some(2), Some(9)]);
        let mut poses = [hostile(&mut random), hostile(&mut random), hostile(&mut random)];
        let touched = random.below(3);
        let entry = Additional {
            bone: touched as u32,
            // Every second transform is valid.
            transform: if round % 2 == 0 {
                hostile(&mut random)
            } else {
                Transform { translation: Vec3::X, ..REST }
            },
            space: random.choice(&[Space::Bone, Space::Parent, Space::Root]),
            mode: random.choice(&[AdditionalMode::Add, AdditionalMode::Replace]),
            parts: random.choice(&[PoseParts::ALL, PoseParts::ROTATION]),
            weight: random.choice(&[0.3, 1.0, f32::INFINITY]),
        };
        apply(&skeleton, &[entry], &mut poses);
        if entry.transform.is_finite() {
            assert_sound(poses[touched], &format!("{round}: {entry:?}"));
        }
    }
}

#[test]
fn applying_allocates_nothing() {
    let skeleton = chain(5);
    let mut poses = [REST; 5];
    let turns = [Space::Bone, Space::Parent, Space::Root]
        .map(|space| Additional::turn(4, Quat::from_rotation_x(0.1), space));
    let (count, ()) = count(|| apply(&skeleton, &turns, &mut poses));
    assert_eq!(count.allocations, 0);
}
