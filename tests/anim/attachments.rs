//! Sockets and grips: a sword follows the hand, and the other hand is placed on it.

use crate::blending::{a_pose, a_pose_with_size, hostile};
use crate::support::{angle_between, assert_near, bone};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::attach::{Grip, ScaleOf, Socket, attached_root, carry};
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{Mat3, Mat4, Quat, Vec3};
use proptest::prelude::*;

const REST: Transform = Transform::IDENTITY;

fn offset() -> Transform {
    Transform { translation: Vec3::new(0.0, 2.0, 0.0), rotation: Quat::from_rotation_z(0.5), ..REST }
}

proptest! {
    #[test]
    fn a_socket_follows_its_bone(bone in a_pose(), offset in a_pose()) {
        let socket = Socket { offset, ..Socket::at(1) };
        let expected = bone.to_matrix() * offset.to_matrix();
        assert_near(socket.to_root(&[Mat4::IDENTITY, bone.to_matrix()]), expected, 1e-6);
    }

    #[test]
    fn an_object_with_its_own_scale_keeps_its_size(bone in a_pose_with_size(), offset in a_pose()) {
        let offset = Transform { scale: Vec3::ONE, ..offset };
        let socket = Socket { offset, scale: ScaleOf::Object, ..Socket::at(0) };
        let got = socket.to_root(&[bone.to_matrix()]);
        // The position is that of the scaled bone; the axes are of unit length and rotated with the bone.
        let place = bone.to_matrix().transform_point3(offset.translation);
        prop_assert!(got.w_axis.truncate().distance(place) < 1e-3);
        let axes = Mat3::from_mat4(got);
        prop_assert!((axes * axes.transpose()).abs_diff_eq(Mat3::IDENTITY, 1e-5));
        prop_assert!(axes.determinant() > 0.0, "an object is not mirrored by its bone");
        let signs = Mat3::from_diagonal(bone.scale.signum());
        let right_handed = Mat3::from_diagonal(Vec3::new(1.0, 1.0, signs.determinant()));
        let expected = Mat3::from_quat(bone.rotation) * signs * right_handed * Mat3::from_quat(offset.rotation);
        prop_assert!(axes.abs_diff_eq(expected, 1e-4), "{axes}\n{expected}");
    }

    #[test]
    fn the_handle_of_an_attached_object_is_at_its_socket(socket in a_pose(), handle in a_pose_with_size()) {
        let root = attached_root(socket.to_matrix(), handle.to_matrix());
        prop_assert!((root * handle.to_matrix()).abs_diff_eq(socket.to_matrix(), 0.02));
    }

    #[test]
    fn the_palm_of_the_other_arm_meets_the_grip(
        object in a_pose(), on_object in a_pose(), in_hand in a_pose(), scale in 0.1_f32..3.0,
    ) {
        let object = Transform { scale: Vec3::splat(scale), ..object };
        let grip = Grip { on_object, in_hand };
        let target = grip.target(object.to_matrix());
        prop_assert!((target.rotation.length() - 1.0).abs() < 1e-5);
        let palm = target.position + target.rotation * in_hand.translation;
        let place = object.to_matrix().transform_point3(on_object.translation);
        prop_assert!(palm.distance(place) < 1e-3, "{palm} {place}");
        let turned = target.rotation * in_hand.rotation;
        prop_assert!(angle_between(turned, object.rotation * on_object.rotation) < 1e-5);
    }
}

#[test]
fn a_sword_with_its_own_bones_follows_its_socket() {
    let bones = vec![bone("shoulder", None, Vec3::Y), bone("hand", Some(0), Vec3::X)];
    let (arm, sword) = (
        Skeleton { bones },
        Skeleton { bones: vec![bone("hilt", None, Vec3::new(0.0, 0.5, 0.0)), bone("tip", Some(0), Vec3::Y)] },
    );
    let poses = [
        Transform {
            translation: Vec3::Y,
            rotation: Quat::from_rotation_z(std::f32::consts::FRAC_PI_2),
            ..REST
        },
        Transform { translation: Vec3::X, ..REST },
    ];
    let mut of_arm = [Mat4::IDENTITY; 2];
    to_root(&arm, &poses, &mut of_arm);
    let mut of_sword = [Mat4::IDENTITY; 2];
    to_root(&sword, &[], &mut of_sword);
    let socket = Socket::on(&arm, "hand").unwrap();
    // Held at its hilt bone.
    let root = attached_root(socket.to_root(&of_arm), of_sword[0]);
    carry(root, &mut of_sword);
    // Arm raised: the hand is at (0, 2, 0), its y axis points to -x.
    assert!(of_sword[0].w_axis.truncate().distance(Vec3::new(0.0, 2.0, 0.0)) < 1e-6);
    assert!(of_sword[1].w_axis.truncate().distance(Vec3::new(-1.0, 2.0, 0.0)) < 1e-6);
}

#[test]
fn a_socket_on_a_missing_bone_is_an_error_with_its_name() {
    let skeleton = Skeleton { bones: vec![bone("hip", None, Vec3::ZERO)] };
    assert_eq!(Socket::on(&skeleton, "hip").unwrap(), Socket::at(0));
    let error = Socket::on(&skeleton, "hand").unwrap_err();
    assert_eq!(error.to_string(), "the socket needs a bone called \"hand\"; the skeleton (1 bones) has none");
    // By number: the origin of the scene.
    let socket = Socket { offset: offset(), ..Socket::at(7) };
    assert_eq!(socket.to_root(&[Mat4::IDENTITY]), offset().to_matrix());
}

#[test]
fn bones_of_scale_zero_and_numbers_that_are_not_finite_have_defined_results() {
    let flat = Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0)) * Mat4::from_translation(Vec3::X);
    let socket = Socket { offset: offset(), scale: ScaleOf::Object, ..Socket::at(0) };
    let expected = Mat4::from_translation(Vec3::X) * Mat4::from_quat(offset().rotation);
    assert_near(socket.to_root(&[flat]), expected, 1e-6);
    assert_near(socket.to_root(&[Mat4::NAN]), offset().to_matrix(), 1e-6);
    // A grip that cannot be inverted counts as the origin.
    assert_eq!(attached_root(flat, Mat4::ZERO), flat);
    let mut matrices = [Mat4::NAN, Mat4::IDENTITY];
    carry(flat, &mut matrices);
    assert_eq!(matrices, [flat, flat]);
}

#[test]
fn invalid_offsets_give_finite_results() {
    let seed = seed(17);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..20_000 {
        let (a, b, c) = (hostile(&mut random), hostile(&mut random), hostile(&mut random));
        for scale in [ScaleOf::Bone, ScaleOf::Object] {
            let socket = Socket { offset: b, scale, ..Socket::at(0) };
            let to_root = socket.to_root(&[a.to_matrix()]);
            assert!(to_root.is_finite(), "{round}: {to_root}");
            assert!(attached_root(to_root, c.to_matrix()).is_finite(), "{round}");
            let target = Grip { on_object: b, in_hand: c }.target(a.to_matrix());
            assert!(target.position.is_finite() && target.rotation.is_normalized(), "{round}: {target:?}");
        }
    }
}

#[test]
fn attaching_allocates_nothing() {
    let mut matrices = [Mat4::IDENTITY; 4];
    let socket = Socket { offset: offset(), scale: ScaleOf::Object, ..Socket::at(2) };
    let (count, _) = count(|| {
        let root = attached_root(socket.to_root(&matrices), Mat4::IDENTITY);
        carry(root, &mut matrices);
        Grip { on_object: offset(), in_hand: REST }.target(root)
    });
    assert_eq!(count.allocations, 0);
}
