//! Every degenerate case has a defined result. One test per case, or the module of its test.
//!
//! | case | result | tested |
//! |---|---|---|
//! | rotation of length zero | identity | here; importer warns |
//! | rotation not of unit length | normalized | here; importer warns |
//! | NaN or infinity in a key, a tangent, a rest pose, a matrix | rest value, zero, identity | here; importer refuses |
//! | mixed rotation not of unit length | normalized | here |
//! | keys q and −q | constant | here |
//! | rotations 180° apart | axis of the later key as stored | here |
//! | scale zero | positions flat, normals fall back | here |
//! | scale negative | kept | here, `skinning` |
//! | sheared matrix | kept until animated | `poses` |
//! | take without duration | constant, no division | here |
//! | key times negative, unsorted, at one time | defined key, no NaN | here; importer sorts |
//! | one key | constant | here |
//! | no key | rest pose | here |
//! | time outside, time NaN | clamp or loop | here, `sampling` |
//! | tangents NaN | zero | here |
//! | columns of different lengths | rest value | here; importer refuses |
//! | weights that are not finite | vertex stays | here; importer cleans |
//! | weights that do not sum to 1 | used as stored | here; importer normalizes |
//! | joint past the end of the skin | identity | here; importer refuses |
//! | the same joint twice in a vertex | weights add up | here; importer merges |
//! | offset that is not finite or missing | identity | here; importer warns |
//! | huge translation | finite, or the position of the parent | here; importer warns |
//! | frame rate zero, NaN, huge | defined by each importer of a format that has a frame rate | in its tests |
//! | parent after its child, joint without bone | counts as none | here; importer refuses |

use crate::support::{about_z, along_x, angle_between, animation_data, bone, take};
use dragonfly_anim::animation::{Animation, final_pose, final_poses, to_root};
use dragonfly_anim::data::{
    Bone, Channel, Influence, Interpolation, Primitive, Skeleton, Skin, Track, Transform, Vertices,
};
use dragonfly_anim::sample::{loop_time, rest_pose, sample_channel, sample_track};
use dragonfly_anim::skin::{Movement, skin_normals, skin_positions};
use glam::{Mat4, Quat, Vec3};
use std::f32::consts::PI;

const INTERPOLATIONS: [Interpolation; 4] =
    [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Closest];

fn rotations(values: &[Quat], interpolation: Interpolation) -> Channel<Quat> {
    let times: Vec<f32> = (0..values.len()).map(|key| key as f32).collect();
    Channel::new(times, values.to_vec(), interpolation)
}

#[test]
fn a_rotation_of_length_zero_is_the_identity() {
    let zero = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let turned = Quat::from_rotation_z(1.0);
    let channel = rotations(&[zero, turned], Interpolation::Linear);
    let rest = Quat::from_rotation_x(0.5);
    assert_eq!(sample_channel(&channel, rest, 0.0), Quat::IDENTITY);
    let half = sample_channel(&channel, rest, 0.5);
    assert!(angle_between(half, Quat::from_rotation_z(0.5)) < 1e-6);
    let mut resting = bone("", None, Vec3::ZERO);
    resting.rest.rotation = zero;
    assert_eq!(rest_pose(&resting).rotation, Quat::IDENTITY);
}

#[test]
fn a_rotation_of_another_length_is_normalized() {
    let turned = Quat::from_rotation_z(1.0);
    let channel = rotations(&[turned * 3.0, turned * 1e-3], Interpolation::Linear);
    for time in [0.0, 0.3, 1.0] {
        let got = sample_channel(&channel, Quat::IDENTITY, time);
        assert!((got - turned).length() < 1e-6, "{time} {got}");
    }
}

#[test]
fn a_key_that_is_not_finite_is_the_rest_value() {
    let rest = Vec3::new(7.0, 0.0, 0.0);
    for hostile in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let channel = along_x(&[(0.0, 1.0), (1.0, hostile), (2.0, 3.0)], Interpolation::Linear);
        let at = |time| sample_channel(&channel, rest, time).x;
        assert_eq!([0.0, 0.5, 1.0, 1.5, 2.0].map(at), [1.0, 4.0, 7.0, 5.0, 3.0], "{hostile}");
    }
    let turned = Quat::from_rotation_z(1.0);
    let channel = rotations(&[Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)], Interpolation::Linear);
    assert_eq!(sample_channel(&channel, turned, 0.0), turned);
}

#[test]
fn a_rest_pose_that_is_not_finite_is_the_identity() {
    let mut resting = bone("", None, Vec3::new(1.0, f32::NAN, 0.0));
    resting.rest.scale = Vec3::splat(f32::INFINITY);
    resting.rest.rotation = Quat::from_xyzw(f32::NAN, 0.0, 0.0, 0.0);
    assert_eq!(rest_pose(&resting), Transform::IDENTITY);
    resting.rest_matrix = Some(Mat4::NAN);
    let mut out = [Mat4::NAN];
    to_root(&Skeleton { bones: vec![resting] }, &[], &mut out);
    assert_eq!(out, [Mat4::IDENTITY]);
}

#[test]
fn a_mixed_rotation_has_unit_length() {
    for angle in [1e-7_f32, 1e-4, 1e-3, 0.1, 1.0, 3.0, PI.next_down(), PI, PI.next_up(), 6.0] {
        for interpolation in INTERPOLATIONS {
            let (a, b) = (Quat::from_rotation_y(0.4), Quat::from_rotation_y(0.4 + angle));
            let keys = match interpolation {
                Interpolation::CubicSpline => vec![a, a, b, b, b, a],
                _ => vec![a, b],
            };
            let channel = Channel::new([0.0, 1.0], keys, interpolation);
            for step in 0..=20 {
                let got = sample_channel(&channel, Quat::IDENTITY, step as f32 / 20.0);
                assert!((got.length() - 1.0).abs() < 1e-6, "{angle} {interpolation:?} {step} {got}");
            }
        }
    }
}

#[test]
fn a_rotation_and_its_negative_are_one_rotation() {
    let turned = Quat::from_xyzw(0.1, 0.7, -0.1, 0.7).normalize();
    let channel = rotations(&[turned, -turned], Interpolation::Linear);
    for step in 0..=10 {
        let got = sample_channel(&channel, Quat::IDENTITY, step as f32 / 10.0);
        assert!(angle_between(got, turned) < 1e-6, "{step} {got}");
    }
}

#[test]
fn half_a_turn_is_about_the_axis_of_the_later_key() {
    let about_y = Quat::from_xyzw(0.0, 1.0, 0.0, 0.0);
    for (key, expected) in [(about_y, 1.0_f32), (-about_y, -1.0)] {
        let channel = rotations(&[Quat::IDENTITY, key], Interpolation::Linear);
        let quarter = sample_channel(&channel, Quat::IDENTITY, 0.5);
        let expected = Quat::from_rotation_y(expected * std::f32::consts::FRAC_PI_2);
        assert!(angle_between(quarter, expected) < 1e-6, "{quarter}");
    }
}

fn one_vertex(influences: &[(u16, f32)]) -> Primitive {
    let mut influences: Vec<Influence> =
        influences.iter().map(|&(joint, weight)| Influence { joint, weight }).collect();
    influences.resize(4, Influence::default());
    let vertices = Vertices {
        positions: vec![Vec3::new(1.0, 2.0, 3.0)],
        normals: vec![Vec3::new(1.0, 2.0, 2.0) / 3.0],
        influences,
        influences_per_vertex: 4,
        ..Vertices::default()
    };
    Primitive { vertices, ..Primitive::default() }
}

fn moved(primitive: &Primitive, finals: &[Mat4]) -> (Vec3, Vec3) {
    let (mut position, mut normal) = ([Vec3::NAN], [Vec3::NAN]);
    skin_positions(primitive, Movement::Skin(finals), &[], &mut position);
    skin_normals(primitive, Movement::Skin(finals), &[], &mut normal);
    (position[0], normal[0])
}

#[test]
fn a_scale_of_zero_flattens_and_the_normal_falls_back() {
    let primitive = one_vertex(&[(0, 1.0)]);
    let stored = primitive.vertices.normals[0];
    let scaled = |x, y, z| moved(&primitive, &[Mat4::from_scale(Vec3::new(x, y, z))]);
    assert_eq!(scaled(1.0, 0.0, 1.0), (Vec3::new(1.0, 0.0, 3.0), Vec3::Y), "the normal of the plane");
    assert_eq!(scaled(0.0, 0.0, 1.0), (Vec3::new(0.0, 0.0, 3.0), Vec3::Z), "moved like a tangent");
    let (position, normal) = scaled(0.0, 0.0, 0.0);
    assert_eq!(position, Vec3::ZERO);
    assert!((normal - stored).length() < 1e-6, "kept");
}

#[test]
fn a_negative_scale_is_kept() {
    let mut mirrored = bone("", None, Vec3::ZERO);
    mirrored.rest.scale = Vec3::new(-1.0, 2.0, 1.0);
    assert_eq!(rest_pose(&mirrored).scale, Vec3::new(-1.0, 2.0, 1.0));
    let mut out = [Mat4::NAN];
    to_root(&Skeleton { bones: vec![mirrored] }, &[], &mut out);
    assert_eq!(out[0].determinant(), -2.0);
}

#[test]
fn a_take_without_duration_is_a_constant_pose() {
    let track = Track { translation: along_x(&[(2.0, 5.0)], Interpolation::Linear), ..Track::default() };
    let take = take(vec![track]);
    assert_eq!((take.start, take.length), (2.0, 0.0));
    let mut animation = Animation::new(animation_data(vec![bone("", None, Vec3::ZERO)], vec![take]));
    for clock in [-1.0, 0.0, 2.0, 100.0, f32::NAN, f32::INFINITY] {
        let time = loop_time(clock, 2.0, 0.0);
        assert_eq!(time, 2.0);
        assert_eq!(animation.to_root_bone_poses(Some(0), time)[0].w_axis.x, 5.0);
    }
}

#[test]
fn key_times_at_one_time_unsorted_or_negative_give_a_defined_value() {
    let at =
        |keys: &[(f32, f32)], time| sample_channel(&along_x(keys, Interpolation::Linear), Vec3::ZERO, time).x;
    // The last of several keys at one time is used.
    assert_eq!(at(&[(0.0, 0.0), (1.0, 1.0), (1.0, 5.0), (2.0, 7.0)], 1.0), 5.0);
    assert_eq!(at(&[(0.0, 0.0), (1.0, 1.0), (1.0, 5.0), (2.0, 7.0)], 1.5), 6.0);
    assert_eq!(at(&[(1.0, 3.0), (1.0, 4.0)], 1.0), 3.0);
    assert_eq!(at(&[(-2.0, 1.0), (-1.0, 3.0)], -1.5), 2.0);
    for interpolation in INTERPOLATIONS {
        for times in [[3.0, 1.0, 2.0, 0.0], [f32::NAN, 0.0, 1.0, f32::NAN], [0.0, f32::INFINITY, 1.0, 2.0]] {
            let values = vec![Vec3::ONE; if interpolation == Interpolation::CubicSpline { 12 } else { 4 }];
            let channel = Channel::new(times, values, interpolation);
            for step in -5..=40 {
                assert!(sample_channel(&channel, Vec3::ZERO, step as f32 * 0.1).is_finite(), "{times:?}");
            }
        }
    }
}

#[test]
fn one_key_is_constant_and_no_key_the_rest_pose() {
    for interpolation in INTERPOLATIONS {
        let values = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let one = Channel::new([1.0], vec![Vec3::X; values], interpolation);
        let none: Channel<Vec3> = Channel::new([], [], interpolation);
        for time in [-1.0, 0.0, 1.0, 2.0, f32::NAN, f32::INFINITY] {
            assert_eq!(sample_channel(&one, Vec3::Y, time), Vec3::X);
            assert_eq!(sample_channel(&none, Vec3::Y, time), Vec3::Y);
        }
    }
}

#[test]
fn a_time_of_nan_is_the_first_key() {
    let track =
        Track { rotation: about_z(&[(0.0, 0.5), (1.0, 1.0)], Interpolation::Linear), ..Track::default() };
    let bone = bone("", None, Vec3::ZERO);
    assert_eq!(sample_track(&track, &bone, f32::NAN), sample_track(&track, &bone, 0.0));
    assert_eq!(sample_track(&track, &bone, f32::NEG_INFINITY), sample_track(&track, &bone, 0.0));
    assert_eq!(sample_track(&track, &bone, f32::INFINITY), sample_track(&track, &bone, 1.0));
}

#[test]
fn a_tangent_that_is_not_finite_is_zero() {
    let x = |value: f32| Vec3::new(value, 0.0, 0.0);
    let spline = |tangent: f32, end: f32| {
        let values = [x(tangent), x(0.0), x(tangent), x(tangent), x(8.0), x(tangent)];
        let channel = Channel::new([0.0, end], values, Interpolation::CubicSpline);
        sample_channel(&channel, Vec3::ZERO, end / 4.0).x
    };
    for hostile in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(spline(hostile, 1.0), spline(0.0, 1.0), "{hostile}");
    }
    assert!(spline(f32::MAX, 1.0) > 1e37, "huge values are valid");
    assert_eq!(spline(f32::MAX, 100.0), 0.0, "on overflow the previous key is used");
}

#[test]
fn a_column_that_is_too_short_counts_as_rest_values() {
    let channel =
        Channel { times: [0.0, 1.0].into(), values: [Vec3::X].into(), interpolation: Interpolation::Linear };
    assert_eq!(sample_channel(&channel, Vec3::Y, 1.0), Vec3::Y);
    assert_eq!(sample_channel(&channel, Vec3::Y, 0.5), Vec3::new(0.5, 0.5, 0.0));
}

#[test]
fn a_weight_that_is_not_finite_does_not_move_the_vertex() {
    let finals = [Mat4::from_translation(Vec3::X)];
    for hostile in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let primitive = one_vertex(&[(0, hostile)]);
        let (position, normal) = moved(&primitive, &finals);
        assert_eq!(position, primitive.vertices.positions[0]);
        assert!((normal - primitive.vertices.normals[0]).length() < 1e-6);
    }
}

#[test]
fn weights_are_used_as_stored_and_those_of_one_joint_add_up() {
    let finals = [Mat4::from_scale(Vec3::splat(2.0)), Mat4::IDENTITY];
    let stored = Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(moved(&one_vertex(&[(0, 0.5)]), &finals).0, stored);
    assert_eq!(moved(&one_vertex(&[(0, 0.25), (1, 0.5), (0, 0.25)]), &finals).0, stored * 1.5);
    assert_eq!(moved(&one_vertex(&[]), &finals).0, Vec3::ZERO, "no weight at all");
}

#[test]
fn an_influence_without_weight_is_ignored_even_if_its_product_overflows() {
    let finals = [Mat4::IDENTITY, Mat4::from_scale(Vec3::splat(f32::MAX))];
    assert_eq!(moved(&one_vertex(&[(0, 0.5), (1, 0.0), (0, 0.25)]), &finals).0, Vec3::new(0.75, 1.5, 2.25));
}

#[test]
fn a_joint_past_the_end_of_the_skin_is_the_identity() {
    assert_eq!(moved(&one_vertex(&[(9, 1.0)]), &[]).0, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn an_offset_that_is_missing_or_not_finite_is_the_identity() {
    let to_root = [Mat4::from_translation(Vec3::X)];
    assert_eq!(final_pose(to_root[0], Mat4::NAN), to_root[0]);
    let skin = Skin {
        name: String::new(),
        bones: vec![0, 0, 5],
        offsets: vec![Mat4::from_cols_array(&[f32::INFINITY; 16])],
    };
    let mut out = [Mat4::NAN; 3];
    final_poses(&skin, &to_root, &mut out);
    assert_eq!(out, [to_root[0], to_root[0], Mat4::IDENTITY], "a joint without a bone is the identity too");
    let broken = Bone { offset: Mat4::NAN, ..bone("", None, Vec3::ZERO) };
    assert_eq!(Animation::new(animation_data(vec![broken], vec![])).bind_bone_poses(), [Mat4::IDENTITY]);
}

#[test]
fn a_pose_that_overflows_gets_the_position_of_its_parent() {
    let huge = |parent| Bone {
        rest: Transform { scale: Vec3::splat(1e30), ..Transform::IDENTITY },
        ..bone("", parent, Vec3::ZERO)
    };
    let bones =
        vec![huge(None), huge(Some(0)), bone("", Some(1), Vec3::X), bone("", None, Vec3::splat(3e38))];
    let mut out = [Mat4::NAN; 4];
    to_root(&Skeleton { bones }, &[], &mut out);
    assert_eq!(out[1], out[0], "1e60 is not an f32");
    assert_eq!(out[2], out[0] * Mat4::from_translation(Vec3::X), "its child is relative to that");
    assert_eq!(out[3].w_axis.x, 3e38, "huge values alone are valid");
}

#[test]
fn a_parent_after_its_child_counts_as_none() {
    let bones = vec![bone("", Some(1), Vec3::X), bone("", Some(1), Vec3::Y), bone("", Some(77), Vec3::Z)];
    let mut out = [Mat4::NAN; 3];
    to_root(&Skeleton { bones }, &[], &mut out);
    let origins = out.map(|to_root| to_root.w_axis.truncate());
    assert_eq!(origins, [Vec3::X, Vec3::Y, Vec3::Z]);
}
