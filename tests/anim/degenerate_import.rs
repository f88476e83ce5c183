//! Invalid numbers have a defined result: the file is refused, or the number is corrected with a warning that contains
//! the place.

use crate::doors::MemoryFs;
use crate::fixture::{Fixture, accessor};
use dragonfly_anim::data::{Channel, Influence, ModelData, Take};
use dragonfly_anim::format::{Imported, ReadOptions, read};
use glam::{Mat4, Quat, Vec3};
use serde_json::json;

/// Reads the fixture after `edit`; returns the model and the rules of its warnings.
fn import(edit: impl FnOnce(&mut Fixture)) -> (ModelData, Vec<&'static str>) {
    let Imported { model, warnings, .. } = result(edit).unwrap();
    assert_eq!(crate::soundness::faults(&model), [""; 0]);
    (model, warnings.iter().map(|warning| warning.code).collect())
}

fn result(edit: impl FnOnce(&mut Fixture)) -> Result<Imported, String> {
    let mut fixture = Fixture::new();
    edit(&mut fixture);
    read("a.glb", &fixture.glb(), &MemoryFs::default(), &ReadOptions::default())
        .map_err(|error| error.to_string())
}

fn take(model: &ModelData) -> &Take {
    &model.animation.takes[0]
}

/// Returns the rotation keys of the knee.
fn turns(model: &ModelData) -> &Channel<Quat> {
    &take(model).tracks[1].rotation
}

const ROTATION: &str = "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION";

#[test]
fn a_rotation_of_length_zero_is_the_identity() {
    let (model, warnings) = import(|f| _ = f.set("/nodes/1/rotation", json!([0, 0, 0, 0])));
    assert_eq!(model.animation.skeleton.bones[1].rest.rotation, Quat::IDENTITY);
    assert_eq!(warnings, ["ROTATION_NON_UNIT"]);
    let (model, warnings) = import(|f| _ = f.patch(accessor::ROTATIONS, 16, &[0; 16]));
    assert_eq!(turns(&model).value(1), Some(Quat::IDENTITY));
    assert_eq!(warnings, [ROTATION]);
}

#[test]
fn a_rotation_is_normalized_with_a_warning_if_it_is_far_from_unit_length() {
    for (length, warned) in
        [(1.0076_f32, false), (0.9925, false), (1.008, true), (0.5, true), (1e-30, true), (1e30, true)]
    {
        let (model, warnings) = import(|f| _ = f.set("/nodes/1/rotation", json!([0, 0, 0, length])));
        assert_eq!(model.animation.skeleton.bones[1].rest.rotation, Quat::IDENTITY, "{length}");
        assert_eq!(!warnings.is_empty(), warned, "{length}");
        let (model, warnings) = import(|f| _ = f.float(accessor::ROTATIONS, 3, length));
        assert_eq!(turns(&model).value(0), Some(Quat::IDENTITY), "{length}");
        assert_eq!(!warnings.is_empty(), warned, "{length}");
    }
}

#[test]
fn neighboring_rotations_are_brought_into_one_hemisphere() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let flip =
        |f: &mut Fixture| _ = f.float(accessor::ROTATIONS, 6, -half).float(accessor::ROTATIONS, 7, -half);
    let (model, warnings) = import(flip);
    let (whole, _) = import(|_| ());
    assert!(turns(&model).value(1).unwrap().abs_diff_eq(turns(&whole).value(1).unwrap(), 1e-7));
    assert!(turns(&model).values.windows(2).all(|pair| pair[0].dot(pair[1]) >= 0.0));
    assert_eq!(warnings, [""; 0]);
}

#[test]
fn a_spline_of_rotations_keeps_its_signs() {
    let (model, _) = import(|f| {
        let keys: [[f32; 4]; 9] = std::array::from_fn(|n| {
            if n == 4 {
                [0., 0., 0., -1.]
            } else {
                [0., 0., 0.5 * (n % 3 != 1) as u8 as f32, (n % 3 == 1) as u8 as f32]
            }
        });
        let bytes: Vec<u8> = keys.concat().iter().flat_map(|number| number.to_le_bytes()).collect();
        let output = f.accessor("VEC4", 5126, 9, &bytes);
        f.set(
            "/animations/0/samplers/1",
            json!({"input": 10, "output": output, "interpolation": "CUBICSPLINE"}),
        );
    });
    assert_eq!(turns(&model).value(1), Some(Quat::from_xyzw(0., 0., 0., -1.)));
    assert_eq!(turns(&model).values[3], Quat::from_xyzw(0., 0., 0.5, 0.), "a tangent is not normalized");
}

#[test]
fn zero_and_negative_scales_are_kept() {
    for scale in [Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Vec3::new(-1.0, 1.0, 1.0), Vec3::splat(-2.0)] {
        let (model, warnings) = import(|f| _ = f.set("/nodes/0/scale", json!(scale.to_array())));
        assert_eq!(model.animation.skeleton.bones[0].rest.scale, scale);
        assert_eq!(warnings, [""; 0]);
        assert!(model.animation.skeleton.bones.iter().all(|bone| bone.offset.is_finite()));
    }
}

#[test]
fn a_mirrored_matrix_is_decomposed_and_a_sheared_one_kept() {
    let matrix = |columns: [f32; 16]| {
        import(|f| {
            f.remove("/nodes/1/translation").remove("/nodes/1/rotation").remove("/nodes/1/scale");
            f.set("/nodes/1/matrix", json!(columns));
        })
    };
    let mirrored = [0., 2., 0., 0., 2., 0., 0., 0., 0., 0., 2., 0., 5., 6., 7., 1.];
    let (model, warnings) = matrix(mirrored);
    let bone = &model.animation.skeleton.bones[1];
    assert!(bone.rest.to_matrix().abs_diff_eq(Mat4::from_cols_array(&mirrored), 1e-5));
    assert_eq!(bone.rest_matrix, None);
    assert!(!warnings.contains(&"NODE_MATRIX_NON_TRS"));
    let sheared = [1., 0., 0., 0., 0.5, 1., 0., 0., 0., 0., 1., 0., 5., 6., 7., 1.];
    let (model, warnings) = matrix(sheared);
    assert_eq!(model.animation.skeleton.bones[1].rest_matrix, Some(Mat4::from_cols_array(&sheared)));
    assert!(warnings.contains(&"NODE_MATRIX_NON_TRS"));
}

#[test]
fn key_times_are_sorted_and_of_equal_ones_the_last_is_kept() {
    let times = |numbers: [f32; 3]| {
        import(|f| {
            for (index, number) in numbers.into_iter().enumerate() {
                f.float(accessor::TIMES, index, number);
            }
        })
    };
    let x = |model: &ModelData| {
        let channel = &take(model).tracks[0].translation;
        channel
            .times
            .iter()
            .zip(channel.values.iter())
            .map(|(&time, value)| (time, value.x + 2.0 * value.y))
            .collect::<Vec<_>>()
    };
    // The remaining keys are 0, 1 and 3.
    let (model, warnings) = times([1.0, 0.0, 0.5]);
    assert_eq!(x(&model), [(0.0, 1.0), (0.5, 3.0), (1.0, 0.0)]);
    assert_eq!(warnings, ["ACCESSOR_ANIMATION_INPUT_NON_INCREASING"]);
    let (model, _) = times([0.5, 0.5, 0.5]);
    assert_eq!(x(&model), [(0.5, 3.0)]);
    assert_eq!((take(&model).start, take(&model).length), (0.5, 0.0));
    let (model, warnings) = times([-1.0, -0.0, 0.0]);
    assert_eq!(x(&model), [(-1.0, 0.0), (0.0, 3.0)]);
    assert_eq!(warnings, ["ACCESSOR_ANIMATION_INPUT_NEGATIVE", "ACCESSOR_ANIMATION_INPUT_NON_INCREASING"]);
    // The tangents of a spline stay with their key.
    assert_eq!(take(&model).tracks[1].scale.values.len(), 6);
}

#[test]
fn key_times_beyond_a_day_are_refused() {
    assert!(import(|f| _ = f.float(accessor::TIMES, 2, 86_400.0)).1.is_empty());
    let message = result(|f| _ = f.float(accessor::TIMES, 2, 86_500.0)).unwrap_err();
    assert_eq!(message, "/accessors/10: seconds: 86500, at most 86400");
}

#[test]
fn one_key_is_constant_and_no_key_is_no_animation() {
    let keys = |count: usize| {
        import(|f| {
            f.set("/accessors/10/count", json!(count));
            for (output, width) in [
                (accessor::TRANSLATIONS, 1),
                (accessor::ROTATIONS, 1),
                (accessor::MORPH_WEIGHTS, 1),
                (accessor::CUBIC, 3),
            ] {
                f.set(&format!("/accessors/{output}/count"), json!(count * width));
            }
        })
    };
    let (model, warnings) = keys(1);
    assert_eq!((take(&model).start, take(&model).length, take(&model).keys()), (0.0, 0.0, 5));
    assert_eq!(warnings, [""; 0]);
    let (model, warnings) = keys(0);
    assert_eq!((take(&model).start, take(&model).length, take(&model).keys()), (0.0, 0.0, 0));
    assert_eq!(warnings, ["EMPTY_ENTITY"]);
}

#[test]
fn numbers_that_are_not_finite_are_refused_where_they_are_needed() {
    for number in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (accessor, index) in [
            (accessor::POSITION, 1),
            (accessor::NORMAL, 1),
            (accessor::TANGENT, 1),
            (accessor::COLOR, 1),
            (accessor::OFFSETS, 1),
            (accessor::TIMES, 2),
            (accessor::TRANSLATIONS, 1),
            (accessor::ROTATIONS, 1),
            (accessor::MORPH_WEIGHTS, 1),
            (accessor::CUBIC, 4),
        ] {
            let message = result(|f| _ = f.float(accessor, index, number)).unwrap_err();
            assert!(message.starts_with(&format!("/accessors/{accessor}: element ")), "{message}");
        }
    }
}

#[test]
fn tangents_that_are_not_finite_are_zero() {
    let (model, warnings) =
        import(|f| _ = f.float(accessor::CUBIC, 1, f32::NAN).float(accessor::CUBIC, 8, f32::INFINITY));
    let values = &take(&model).tracks[1].scale.values;
    assert_eq!((values[0], values[1], values[2], values[3]), (Vec3::ZERO, Vec3::ONE, Vec3::ZERO, Vec3::ONE));
    assert_eq!(warnings, ["ANIMATION_TANGENT_NOT_FINITE"]);
}

/// Returns the influences of the first vertex after its four weights were set.
fn weighted(weights: [f32; 4]) -> (Vec<Influence>, Vec<&'static str>) {
    let (model, warnings) = import(|f| {
        for (index, weight) in weights.into_iter().enumerate() {
            f.float(accessor::WEIGHTS, index, weight);
        }
    });
    (model.meshes[0].primitives[0].vertices.influences_of(0).to_vec(), warnings)
}

fn influence(joint: u16, weight: f32) -> Influence {
    Influence { joint, weight }
}

#[test]
fn invalid_weights_are_removed_duplicate_joints_merged_and_sums_normalized_with_warnings() {
    let none = influence(0, 0.0);
    let (found, warnings) = weighted([0.25, 0.75, 0.0, 0.0]);
    assert_eq!(found, [influence(1, 0.75), influence(0, 0.25), none, none]);
    assert_eq!(warnings, [""; 0]);
    let (found, warnings) = weighted([-1.0, 0.5, f32::NAN, f32::INFINITY]);
    assert_eq!(found, [influence(1, 1.0), none, none, none]);
    assert_eq!(warnings, ["ACCESSOR_WEIGHTS_NEGATIVE", "ACCESSOR_WEIGHTS_NON_NORMALIZED"]);
    let (found, warnings) = weighted([0.0; 4]);
    assert_eq!(found, [influence(0, 1.0), none, none, none]);
    assert_eq!(warnings, ["ACCESSOR_WEIGHTS_ZERO"]);
    // Joint 0 is in three of the four entries.
    let (found, warnings) = weighted([0.25, 0.25, 0.25, 0.25]);
    assert_eq!(found, [influence(0, 0.75), influence(1, 0.25), none, none]);
    assert_eq!(warnings, ["ACCESSOR_JOINTS_INDEX_DUPLICATE"]);
    let (found, _) = weighted([f32::MAX, 0.0, f32::MAX, 0.0]);
    assert_eq!(found, [influence(0, 1.0), none, none, none]);
    let (found, _) = weighted([f32::MAX, f32::MAX, 0.0, 0.0]);
    assert_eq!(found, [influence(0, 0.5), influence(1, 0.5), none, none]);
}

#[test]
fn the_sum_of_weights_may_differ_from_one_by_their_quantization() {
    assert!(weighted([0.75, 0.250_000_1, 0.0, 0.0]).1.is_empty());
    assert_eq!(weighted([0.75, 0.2501, 0.0, 0.0]).1, ["ACCESSOR_WEIGHTS_NON_NORMALIZED"]);
    let bytes = |weights: [u8; 4]| {
        import(|f| {
            let accessor = f.accessor("VEC4", 5121, 4, &weights.repeat(4));
            f.set(&format!("/accessors/{accessor}/normalized"), json!(true));
            f.set("/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(accessor));
        })
        .1
    };
    assert!(bytes([200, 55, 0, 0]).is_empty());
    assert!(bytes([200, 54, 0, 0]).is_empty());
    assert_eq!(bytes([200, 53, 0, 0]), ["ACCESSOR_WEIGHTS_NON_NORMALIZED"]);
}

/// Returns the influences of the first vertex with these joints and weights, in sets of four, of twelve joints.
fn many(pairs: &[(u8, f32)]) -> (Vec<Influence>, usize) {
    let (model, _) = import(|f| {
        f.set(
            "/nodes",
            json!(
                (0..13)
                    .map(|node| if node == 12 { json!({"mesh": 0, "skin": 0}) } else { json!({}) })
                    .collect::<Vec<_>>()
            ),
        );
        f.set("/scenes/0/nodes", json!([12])).set("/animations", json!([]));
        f.set("/skins/0", json!({"joints": (0..12).collect::<Vec<_>>()}));
        for (set, four) in pairs.chunks(4).enumerate() {
            let joints: Vec<u8> = four.iter().map(|pair| pair.0).collect();
            let weights: Vec<u8> = four.iter().flat_map(|pair| pair.1.to_le_bytes()).collect();
            let joints = f.accessor("VEC4", 5121, 4, &joints.repeat(4));
            let weights = f.accessor("VEC4", 5126, 4, &weights.repeat(4));
            f.set(&format!("/meshes/0/primitives/0/attributes/JOINTS_{set}"), json!(joints));
            f.set(&format!("/meshes/0/primitives/0/attributes/WEIGHTS_{set}"), json!(weights));
        }
    });
    let vertices = &model.meshes[0].primitives[0].vertices;
    (vertices.influences_of(0).to_vec(), vertices.influences_per_vertex)
}

#[test]
fn the_strongest_eight_influences_are_kept() {
    let all: Vec<(u8, f32)> = (0..12).map(|joint| (joint, (joint + 1) as f32 / 78.0)).collect();
    let (found, per_vertex) = many(&all);
    assert_eq!(per_vertex, 8);
    assert_eq!(found.iter().map(|i| i.joint).collect::<Vec<_>>(), [11, 10, 9, 8, 7, 6, 5, 4]);
    assert!((found[0].weight - 12.0 / 68.0).abs() < 1e-6);
    let (_, per_vertex) =
        many(&[(0, 0.5), (1, 0.1), (2, 0.1), (3, 0.1), (4, 0.2), (0, 0.0), (0, 0.0), (0, 0.0)]);
    assert_eq!(per_vertex, 8);
    let (found, per_vertex) =
        many(&[(0, 0.5), (0, 0.0), (2, 0.1), (0, 0.0), (4, 0.4), (9, 0.0), (0, 0.0), (0, 0.0)]);
    assert_eq!(per_vertex, 4);
    assert_eq!(found.iter().map(|i| i.joint).collect::<Vec<_>>(), [0, 4, 2, 0]);
}

#[test]
fn a_joint_that_the_skin_lacks_is_an_error_only_with_a_weight() {
    assert!(import(|f| _ = f.patch(accessor::JOINTS, 2, &[200])).1.is_empty());
    let message = result(|f| _ = f.patch(accessor::JOINTS, 1, &[200])).unwrap_err();
    assert_eq!(message, "/nodes/3/skin: a vertex refers to joint 200, the skin has 2 joints");
}

#[test]
fn an_inverse_bind_matrix_without_inverse_is_the_identity() {
    let (model, warnings) = import(|f| _ = f.patch(accessor::OFFSETS, 64, &[0; 64]));
    assert_eq!(model.skins[0].offsets[1], Mat4::IDENTITY);
    assert_eq!(model.animation.skeleton.bones[1].offset, Mat4::IDENTITY);
    assert_eq!(warnings, ["ACCESSOR_INVALID_IBM"]);
    // Small is not singular.
    let (model, warnings) =
        import(|f| _ = f.float(accessor::OFFSETS, 0, 1e-30).float(accessor::OFFSETS, 5, 1e-15));
    assert_eq!(model.skins[0].offsets[0].x_axis.x, 1e-30);
    assert_eq!(warnings, [""; 0]);
}

#[test]
fn lengths_beyond_single_precision_give_a_warning() {
    assert!(import(|f| _ = f.set("/nodes/2/translation", json!([1e12, 0, 0]))).1.is_empty());
    assert_eq!(import(|f| _ = f.set("/nodes/2/translation", json!([1.1e12, 0, 0]))).1, ["HUGE_TRANSLATION"]);
}

#[test]
fn missing_normals_are_computed() {
    let normals = |model: &ModelData| model.meshes[0].primitives[0].vertices.normals.clone();
    let (model, _) = import(|f| {
        f.remove("/meshes/0/primitives/0/attributes/NORMAL");
        f.remove("/meshes/0/primitives/0/attributes/TANGENT");
    });
    assert_eq!(normals(&model), [Vec3::Z; 4]);
    // One of them with length zero; +Y where there is no triangle to compute it from.
    let (model, warnings) = import(|f| _ = f.float(accessor::NORMAL, 2, 0.0));
    assert_eq!(normals(&model), [Vec3::Z; 4]);
    assert_eq!(warnings, ["ACCESSOR_VECTOR3_NON_UNIT"]);
    let (model, _) =
        import(|f| _ = f.float(accessor::NORMAL, 2, 0.0).set("/meshes/0/primitives/0/mode", json!(0)));
    assert_eq!(normals(&model)[0], Vec3::Y);
    // Positions so large that their products overflow.
    let (model, _) = import(|f| {
        f.remove("/meshes/0/primitives/0/attributes/NORMAL").float(accessor::POSITION, 3, 3e38);
    });
    assert!(normals(&model).iter().all(|normal| normal.is_finite()));
}

#[test]
fn normalized_integers_reach_minus_one_and_one() {
    let normals = |component: u32, bytes: &[u8]| {
        let (model, _) = import(|f| {
            let accessor = f.accessor("VEC3", component, 4, bytes);
            f.set(&format!("/accessors/{accessor}/normalized"), json!(true));
            f.set("/meshes/0/primitives/0/targets/0/POSITION", json!(accessor));
        });
        model.meshes[0].primitives[0].morph_targets[0].positions.iter().map(|v| v.x).collect::<Vec<_>>()
    };
    let spread =
        |numbers: [i16; 4]| numbers.iter().flat_map(|n| [n.to_le_bytes(); 3].concat()).collect::<Vec<u8>>();
    assert_eq!(normals(5120, &[127, 0, 0, 128, 0, 0, 129, 0, 0, 64, 0, 0]), [1.0, -1.0, -1.0, 64.0 / 127.0]);
    assert_eq!(normals(5121, &[255, 0, 0, 0, 0, 0, 51, 0, 0, 1, 0, 0]), [1.0, 0.0, 0.2, 1.0 / 255.0]);
    assert_eq!(normals(5122, &spread([32767, -32768, -32767, 1])), [1.0, -1.0, -1.0, 1.0 / 32767.0]);
    assert_eq!(normals(5123, &spread([-1, 0, 1, 2])), [1.0, 0.0, 1.0 / 65535.0, 2.0 / 65535.0]);
}
