//! Skinning on the CPU, compared with sums written out by hand.

use dragonfly_anim::data::{Influence, MeshInstance, MorphTarget, Primitive, Vertices};
use dragonfly_anim::skin::{Movement, rigid, skin_normals, skin_positions, skin_tangents};
use glam::{Mat4, Quat, Vec3, Vec4};

fn skinned(positions: Vec<Vec3>, influences: &[[(u16, f32); 4]]) -> Primitive {
    let influences =
        influences.iter().flatten().map(|&(joint, weight)| Influence { joint, weight }).collect();
    let vertices = Vertices { positions, influences, influences_per_vertex: 4, ..Vertices::default() };
    Primitive { vertices, ..Primitive::default() }
}

fn positions(primitive: &Primitive, movement: Movement<'_>, weights: &[f32]) -> Vec<Vec3> {
    let mut out = vec![Vec3::NAN; primitive.vertices.len()];
    assert_eq!(skin_positions(primitive, movement, weights, &mut out), out.len());
    out
}

#[test]
fn a_position_is_the_weighted_sum_over_its_bones() {
    let finals = [
        Mat4::from_translation(Vec3::new(10.0, 0.0, 0.0)),
        Mat4::from_scale(Vec3::splat(2.0)),
        Mat4::from_rotation_z(std::f32::consts::FRAC_PI_2),
    ];
    let primitive = skinned(
        vec![Vec3::new(1.0, 2.0, 3.0); 3],
        &[
            [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)],
            [(0, 0.5), (1, 0.5), (0, 0.0), (0, 0.0)],
            [(2, 0.5), (1, 0.25), (0, 0.25), (7, 0.0)],
        ],
    );
    let got = positions(&primitive, Movement::Skin(&finals), &[]);
    let expected = [
        Vec3::new(11.0, 2.0, 3.0),
        Vec3::new(6.5, 3.0, 4.5),
        // 0.5 · (−2, 1, 3) + 0.25 · (2, 4, 6) + 0.25 · (11, 2, 3)
        Vec3::new(2.25, 2.0, 3.75),
    ];
    for (got, expected) in got.into_iter().zip(expected) {
        assert!((got - expected).length() < 1e-6, "{got} {expected}");
    }
}

#[test]
fn identity_poses_leave_every_vertex_bit_for_bit() {
    let primitive = skinned(vec![Vec3::new(0.1, -0.2, 0.3)], &[[(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]]);
    assert_eq!(positions(&primitive, Movement::Skin(&[Mat4::IDENTITY]), &[]), primitive.vertices.positions);
    assert_eq!(positions(&primitive, Movement::Rigid(Mat4::IDENTITY), &[]), primitive.vertices.positions);
}

#[test]
fn eight_influences_are_summed_like_four() {
    let finals: Vec<Mat4> = (0..8).map(|x| Mat4::from_translation(Vec3::new(x as f32, 0.0, 0.0))).collect();
    let influences = (0..8).map(|joint| Influence { joint, weight: 0.125 }).collect();
    let vertices =
        Vertices { positions: vec![Vec3::Y], influences, influences_per_vertex: 8, ..Vertices::default() };
    let primitive = Primitive { vertices, ..Primitive::default() };
    assert_eq!(positions(&primitive, Movement::Skin(&finals), &[]), [Vec3::new(3.5, 1.0, 0.0)]);
}

#[test]
fn morph_targets_come_before_the_skin() {
    let mut primitive = skinned(vec![Vec3::X, Vec3::Y], &[[(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]; 2]);
    primitive.vertices.normals = vec![Vec3::Z; 2];
    primitive.morph_targets = vec![
        MorphTarget {
            positions: vec![Vec3::X, Vec3::ZERO],
            normals: vec![Vec3::X; 2],
            ..MorphTarget::default()
        },
        MorphTarget { positions: vec![Vec3::ZERO, Vec3::Z], ..MorphTarget::default() },
    ];
    let double = [Mat4::from_scale(Vec3::splat(2.0))];
    let got = positions(&primitive, Movement::Skin(&double), &[0.5, 2.0]);
    assert_eq!(got, [Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 2.0, 4.0)]);
    // Fewer weights than targets: the others count as zero.
    assert_eq!(positions(&primitive, Movement::Skin(&double), &[])[0], Vec3::new(2.0, 0.0, 0.0));
    let mut normals = [Vec3::NAN; 2];
    skin_normals(&primitive, Movement::Skin(&double), &[1.0, 0.0], &mut normals);
    assert!((normals[0] - Vec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-6, "{}", normals[0]);
}

#[test]
fn a_mesh_without_skin_is_carried_by_its_bone() {
    let to_root = [Mat4::from_translation(Vec3::X), Mat4::from_rotation_z(std::f32::consts::FRAC_PI_2)];
    let mut instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: Some(1),
        to_bone: Mat4::from_translation(Vec3::X),
        morph_weights: vec![],
    };
    let primitive = Primitive {
        vertices: Vertices { positions: vec![Vec3::X], ..Vertices::default() },
        ..Primitive::default()
    };
    let got = positions(&primitive, Movement::of(&instance, &primitive, &to_root, &[]), &[]);
    assert!((got[0] - Vec3::new(0.0, 2.0, 0.0)).length() < 1e-6, "{}", got[0]);
    instance.bone = None;
    assert_eq!(rigid(&instance, &to_root), instance.to_bone, "nothing animates it");
    // A primitive without influences under a skin is not moved by the skin.
    instance.skin = Some(0);
    assert_eq!(Movement::of(&instance, &primitive, &to_root, &to_root), Movement::Rigid(instance.to_bone));
    let influenced = skinned(vec![Vec3::X], &[[(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]]);
    assert_eq!(Movement::of(&instance, &influenced, &to_root, &to_root), Movement::Skin(&to_root));
}

/// Moves a plane through three points of `primitive` together with its normals and tangents, and checks that they still
/// fit.
#[test]
fn normals_stay_at_right_angles_and_tangents_in_the_surface() {
    let corners = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.2, 0.0), Vec3::new(0.3, 1.0, 0.4)];
    let edge = corners[1] - corners[0];
    let normal = edge.cross(corners[2] - corners[0]).normalize();
    let vertices = Vertices {
        positions: corners.to_vec(),
        normals: vec![normal; 3],
        tangents: vec![edge.normalize().extend(1.0); 3],
        ..Vertices::default()
    };
    let primitive = Primitive { vertices, ..Primitive::default() };
    let turn = Quat::from_xyzw(0.3, -0.5, 0.2, 0.8).normalize();
    for scale in [Vec3::ONE, Vec3::new(3.0, 1.0, 0.2), Vec3::new(-1.0, 1.0, 1.0), Vec3::splat(-2.0)] {
        let movement = Movement::Rigid(Mat4::from_scale_rotation_translation(scale, turn, Vec3::ONE));
        let moved = positions(&primitive, movement, &[]);
        let (mut normals, mut tangents) = ([Vec3::ZERO; 3], [Vec4::ZERO; 3]);
        assert_eq!(skin_normals(&primitive, movement, &[], &mut normals), 3);
        assert_eq!(skin_tangents(&primitive, movement, &[], &mut tangents), 3);
        let expected = (moved[1] - moved[0]).cross(moved[2] - moved[0]).normalize();
        // Mirrored, the triangle has the opposite winding; the outside stays outside.
        let mirrored = scale.x * scale.y * scale.z < 0.0;
        let expected = if mirrored { -expected } else { expected };
        assert!((normals[0] - expected).length() < 1e-5, "{scale}: {} {expected}", normals[0]);
        let tangent = tangents[0].truncate();
        assert!((tangent - (moved[1] - moved[0]).normalize()).length() < 1e-5, "{scale}");
        // The bitangent computed from both, as in a shader, is the moved bitangent.
        let bitangent = Mat4::from_scale_rotation_translation(scale, turn, Vec3::ONE)
            .transform_vector3(normal.cross(edge.normalize()));
        assert!(normals[0].cross(tangent).dot(bitangent) * tangents[0].w > 0.0, "{scale}");
    }
}

#[test]
fn the_length_of_the_output_limits_the_number_of_moved_vertices() {
    let primitive = skinned(vec![Vec3::X; 3], &[[(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]; 3]);
    let mut two = [Vec3::NAN; 2];
    assert_eq!(skin_positions(&primitive, Movement::Skin(&[Mat4::IDENTITY]), &[], &mut two), 2);
    let mut five = [Vec3::NAN; 5];
    assert_eq!(skin_positions(&primitive, Movement::Skin(&[Mat4::IDENTITY]), &[], &mut five), 3);
    assert!(five[3].is_nan(), "the rest is unchanged");
    assert_eq!(skin_normals(&primitive, Movement::Skin(&[]), &[], &mut five), 0, "no normals");
}
