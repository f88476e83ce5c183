//! An explanation contains the values that are played, and every step of it can be computed by hand.

use crate::doors::data;
use crate::support::{about_z, along_x, animation_data, bone, take};
use crate::textbook;
use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::{
    Channel, Influence, Interpolation, Mesh, MeshInstance, ModelData, MorphTarget, MorphTrack, Primitive,
    Skin, Track, Vertices,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::explain::{
    BoneStep, ChannelStep, ExplainError, ExplainTarget, Explanation, MovementStep, Subject, VertexResult,
    explain,
};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

fn wide<const N: usize>(numbers: [f32; N]) -> [f64; N] {
    numbers.map(f64::from)
}

#[track_caller]
fn near<const N: usize>(got: [f32; N], expected: [f64; N], what: &str) {
    let largest = expected.iter().copied().map(f64::abs).fold(1.0, f64::max);
    near_for(largest, got, expected, what);
}

/// Compares within single precision of numbers as large as `largest`: the terms of a sum, not its result.
#[track_caller]
fn near_for<const N: usize>(largest: f64, got: [f32; N], expected: [f64; N], what: &str) {
    for (got, expected) in got.into_iter().zip(expected) {
        assert!((f64::from(got) - expected).abs() < 2e-5 * largest, "{what}: {got} is not {expected}");
    }
}

#[track_caller]
fn near_matrix(got: Mat4, expected: textbook::Matrix, what: &str) {
    near(got.to_cols_array(), expected.concat().try_into().expect("16 numbers"), what);
}

/// Checks that `got` is `a * b`.
#[track_caller]
fn near_product(got: Mat4, a: textbook::Matrix, b: textbook::Matrix, what: &str) -> textbook::Matrix {
    let largest = |matrix: textbook::Matrix| matrix.concat().into_iter().map(f64::abs).fold(1.0, f64::max);
    let expected = textbook::product(a, b);
    let numbers = expected.concat().try_into().expect("16 numbers");
    near_for(largest(a) * largest(b), got.to_cols_array(), numbers, what);
    expected
}

/// Returns a channel's value from its keys alone; `rotation` interpolates two values.
fn channel<T: Copy, const N: usize>(
    step: &ChannelStep<T>,
    time: f32,
    numbers: impl Fn(T) -> [f32; N],
    between: impl Fn([f64; N], [f64; N], f64) -> [f64; N],
) -> [f64; N] {
    let Some(keys) = &step.keys else { return wide(numbers(step.rest)) };
    let [before, after] = [&keys.before, &keys.after];
    let span = f64::from(after.time) - f64::from(before.time);
    let inside = f64::from(time) > f64::from(before.time) && span > 0.0;
    let mix = if inside { ((f64::from(time) - f64::from(before.time)) / span).min(1.0) } else { 0.0 };
    near([keys.mix], [mix], "mix");
    let value = |key: &dragonfly_anim::explain::KeyStep<T>| wide(numbers(key.value));
    match keys.interpolation {
        Interpolation::Step => value(before),
        Interpolation::Closest if mix < 0.5 => value(before),
        Interpolation::Closest => value(after),
        Interpolation::Linear => between(value(before), value(after), mix),
        Interpolation::CubicSpline => {
            let tangent = |key: &dragonfly_anim::explain::KeyStep<T>| wide(numbers(key.tangent.unwrap()));
            textbook::hermite([value(before), tangent(before), tangent(after), value(after)], span, mix)
        }
    }
}

/// Checks every step of every bone of the chain; returns the `to_root` of each.
fn check_bones(explanation: &Explanation) -> Vec<(u32, textbook::Matrix)> {
    let mut found: Vec<(u32, textbook::Matrix)> = Vec::new();
    for step in &explanation.bones {
        let BoneStep { translation, rotation, scale, pose, .. } = step;
        let time = explanation.time;
        let place = format!("bone {} at {time}", step.bone);
        let t = channel(translation, time, |v| v.to_array(), textbook::lerp);
        let r = textbook::unit(channel(rotation, time, |q| q.to_array(), textbook::slerp));
        let s = channel(scale, time, |v| v.to_array(), textbook::lerp);
        near(pose.translation.to_array(), t, &place);
        near(pose.scale.to_array(), s, &place);
        near(pose.rotation.to_array(), r, &place);
        let to_parent = textbook::to_parent(t, r, s);
        near_matrix(step.to_parent, to_parent, &place);
        let parent = step.parent.map(|parent| found.iter().find(|(bone, _)| *bone == parent).unwrap().1);
        let to_root = parent.map_or(to_parent, |parent| textbook::product(parent, to_parent));
        near_matrix(step.to_root, to_root, &place);
        found.push((step.bone, to_root));
    }
    found
}

/// Computes the position of the vertex from the explanation's own steps.
fn check_vertex(explanation: &Explanation, vertex: &VertexResult) {
    let to_roots = check_bones(explanation);
    let to_root = |bone: u32| to_roots.iter().find(|(found, _)| *found == bone).unwrap().1;
    let mut position = wide(vertex.position.to_array());
    for morph in &vertex.morphs {
        for (k, difference) in wide(morph.difference.to_array()).into_iter().enumerate() {
            position[k] += difference * f64::from(morph.weight);
        }
    }
    near(vertex.morphed_position.to_array(), position, "morphed");
    let mut sum = [0.0; 3];
    match &vertex.movement {
        MovementStep::Skin { influences, .. } => {
            for influence in influences {
                let to_root = to_root(influence.bone.unwrap());
                let offset = textbook::matrix(influence.offset);
                let final_pose = near_product(influence.final_pose, to_root, offset, "final");
                let moved = textbook::point(final_pose, position);
                near(influence.moved.to_array(), moved, "moved");
                let adds = moved.map(|n| n * f64::from(influence.weight));
                near(influence.contribution.to_array(), adds, "contribution");
                for (sum, adds) in sum.iter_mut().zip(adds) {
                    *sum += adds;
                }
            }
        }
        MovementStep::Rigid { bone, to_bone } => {
            let to_bone = textbook::matrix(*to_bone);
            let matrix = bone.map_or(to_bone, |bone| textbook::product(to_root(bone), to_bone));
            near_matrix(vertex.matrix, matrix, "matrix");
            sum = textbook::point(matrix, position);
        }
    }
    near(vertex.final_position.to_array(), sum, "final position");
    check_normal(vertex);
}

/// Checks that the normal stays perpendicular to the tangent plane.
fn check_normal(vertex: &VertexResult) {
    let (Some(normal), Some(got)) = (vertex.morphed_normal, vertex.final_normal) else { return };
    assert!((got.length() - 1.0).abs() < 1e-5);
    let matrix = vertex.matrix.as_dmat4();
    for tangent in [normal.any_orthogonal_vector(), normal.cross(normal.any_orthogonal_vector())] {
        let moved = matrix.transform_vector3(tangent.as_dvec3());
        assert!(moved.normalize_or_zero().dot(got.as_dvec3()).abs() < 1e-4, "{vertex:?}");
    }
}

pub(crate) fn vertex_of(explanation: &Explanation) -> &VertexResult {
    match &explanation.subject {
        Subject::Vertex(vertex) => vertex,
        Subject::Bone(_) => panic!("a bone was explained"),
    }
}

fn fox() -> Arc<ModelData> {
    let bytes = std::fs::read(data().join("gltf/Fox.glb")).unwrap();
    Arc::new(read("Fox.glb", &bytes, &NoFiles, &ReadOptions::default()).unwrap().model)
}

/// Two bones, each property with another interpolation; a skinned vertex that a morph target moves, one carried by a
/// bone, one without motion.
pub(crate) fn made() -> Arc<ModelData> {
    let x = |number: f32| Vec3::new(number, 0.5, -number);
    let splined = Channel::new(
        [0.0, 2.0],
        [x(9.0), x(1.0), x(0.5), x(-0.25), x(2.0), x(9.0)],
        Interpolation::CubicSpline,
    );
    let tracks = vec![
        Track {
            translation: splined,
            rotation: about_z(&[(0.0, 0.2), (0.7, 1.4), (2.0, -0.3)], Interpolation::Linear),
            scale: Channel::new(
                [0.0, 1.0],
                [Vec3::new(1.0, 2.0, 0.5), Vec3::new(3.0, 1.0, -1.0)],
                Interpolation::Closest,
            ),
            ..Track::default()
        },
        Track {
            translation: along_x(&[(0.5, 1.0), (1.5, 4.0)], Interpolation::Step),
            rotation: about_z(&[(1.0, 0.4)], Interpolation::Linear),
            ..Track::default()
        },
    ];
    let mut take = take(tracks);
    let (times, weights) = ([0.0, 2.0].into(), [0.0, 1.0].into());
    let interpolation = Interpolation::Linear;
    take.morphs.push(MorphTrack { instance: 0, targets: 1, times, weights, interpolation });
    let mut bones = vec![bone("upper", None, Vec3::Y), bone("lower", Some(0), Vec3::X)];
    bones[1].offset = Mat4::from_translation(Vec3::new(-1.0, -1.0, 0.5));
    let influences = [(1, 0.75), (0, 0.25), (0, 0.0), (0, 0.0)];
    let influences = influences.map(|(joint, weight)| Influence { joint, weight }).to_vec();
    let target = MorphTarget { name: "lift".into(), positions: vec![Vec3::Z], ..MorphTarget::default() };
    let vertices = |influences: Vec<Influence>| Vertices {
        positions: vec![Vec3::new(1.5, 0.25, 0.125)],
        normals: vec![Vec3::new(1.0, 2.0, -0.5).normalize()],
        influences_per_vertex: influences.len(),
        influences,
        ..Vertices::default()
    };
    let mesh = |vertices, morph_targets| Mesh {
        name: "patch".into(),
        primitives: vec![Primitive { vertices, morph_targets, ..Primitive::default() }],
        ..Mesh::default()
    };
    let to_bone = Mat4::from_scale_rotation_translation(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY, Vec3::X);
    let instance =
        |mesh, skin, bone| MeshInstance { mesh, node: None, skin, bone, to_bone, morph_weights: vec![] };
    let offsets = vec![Mat4::from_rotation_x(0.3), bones[1].offset];
    Arc::new(ModelData {
        meshes: vec![mesh(vertices(influences), vec![target]), mesh(vertices(vec![]), vec![])],
        instances: vec![instance(0, Some(0), None), instance(1, None, Some(1)), instance(1, None, None)],
        skins: vec![Skin { name: String::new(), bones: vec![0, 1], offsets }],
        animation: animation_data(bones, vec![take]),
        ..ModelData::default()
    })
}

const TIMES: [f32; 8] = [-1.0, 0.0, 0.3, 0.5, 0.75, 1.0, 1.75, 9.0];

#[test]
fn every_step_of_a_bone_agrees_with_the_formulas() {
    for (model, takes) in [(made(), 1), (fox(), 3)] {
        for take in 0..takes {
            for bone in 0..model.animation.skeleton.len() as u32 {
                for time in TIMES {
                    let explanation = explain(&model, Some(take), time, ExplainTarget::Bone(bone)).unwrap();
                    let to_root = check_bones(&explanation).last().unwrap().1;
                    let Subject::Bone(result) = explanation.subject else { panic!("a bone was asked for") };
                    let offset = textbook::matrix(result.offset);
                    near_product(result.final_pose, to_root, offset, "final");
                }
            }
        }
    }
}

#[test]
fn every_step_of_a_vertex_agrees_with_the_formulas() {
    let explained = |model: &ModelData, time, instance, vertex| {
        let what = ExplainTarget::Vertex { instance, primitive: 0, vertex };
        let explanation = explain(model, Some(0), time, what).unwrap();
        check_vertex(&explanation, vertex_of(&explanation));
    };
    for time in TIMES {
        (0..3).for_each(|instance| explained(&made(), time, instance, 0));
        (0..1728).step_by(97).for_each(|vertex| explained(&fox(), time, 0, vertex));
    }
}

#[test]
fn an_explanation_contains_the_played_values_bit_for_bit() {
    for model in [made(), fox()] {
        let mut evaluator = Evaluator::new(Arc::clone(&model));
        let mut animation = Animation::of(&model);
        for time in TIMES {
            evaluator.pose(Some(0), time);
            let finals = animation.final_bone_poses(Some(0), time).to_vec();
            for (bone, &final_pose) in finals.iter().enumerate() {
                let explanation = explain(&model, Some(0), time, ExplainTarget::Bone(bone as u32)).unwrap();
                let step = explanation.bone(bone as u32).unwrap();
                assert_eq!(step.to_root, evaluator.to_root()[bone]);
                assert_eq!(step.pose, animation.poses()[bone]);
                let Subject::Bone(result) = &explanation.subject else { panic!("a bone was asked for") };
                assert_eq!(result.final_pose, final_pose);
            }
            for instance in 0..model.instances.len() {
                let mut positions = vec![Vec3::ZERO; 300];
                let count = evaluator.positions(instance, 0, &mut positions);
                let mut normals = vec![Vec3::ZERO; count];
                evaluator.normals(instance, 0, &mut normals);
                for vertex in (0..count).step_by(41) {
                    let what = ExplainTarget::Vertex {
                        instance: instance as u32,
                        primitive: 0,
                        vertex: vertex as u32,
                    };
                    let explanation = explain(&model, Some(0), time, what).unwrap();
                    let result = vertex_of(&explanation);
                    assert_eq!(result.final_position, positions[vertex]);
                    assert_eq!(result.final_normal, Some(normals[vertex]));
                }
            }
        }
    }
}

#[test]
fn the_worked_example_is_explained_with_keys_four_and_five() {
    let keys: Vec<(f32, f32)> = (0..=10).map(|k| (k as f32 * 0.1, (k + 1) as f32)).collect();
    let track = Track { translation: along_x(&keys, Interpolation::Linear), ..Track::default() };
    let animation = animation_data(vec![bone("only", None, Vec3::ZERO)], vec![take(vec![track])]);
    let model = ModelData { animation, ..ModelData::default() };
    let explanation = explain(&model, Some(0), 0.35, ExplainTarget::Bone(0)).unwrap();
    let keys = explanation.bones[0].translation.keys.as_ref().unwrap();
    // Counted from zero here, from one in the thesis.
    assert_eq!((keys.before.index + 1, keys.after.index + 1, keys.count), (4, 5, 11));
    assert!((keys.mix - 0.5).abs() < 1e-6);
    assert_eq!((keys.before.value.x, keys.after.value.x), (4.0, 5.0));
    assert!((explanation.bones[0].translation.value.x - 4.5).abs() < 1e-5);
    assert!(explanation.bones[0].rotation.keys.is_none());
}

#[test]
fn the_text_contains_each_section_and_its_columns_are_aligned() {
    let text = explain(&fox(), Some(1), 0.35, ExplainTarget::Vertex { instance: 0, primitive: 0, vertex: 9 })
        .unwrap()
        .to_string();
    println!("{text}");
    for word in ["§2.1.5.2", "§2.1.5.1", "§2.1.4", "to_parent", "to_root", "offset", "before", "after", "mix"]
    {
        assert!(text.contains(word), "{word} is missing");
    }
    // Each step under its own section, not only somewhere.
    for heading in [
        "  Keys around the time, and the temporary key-frame (§2.1.5.2)",
        "  To-root (§2.1.5.1) = to_parent, because a root has no parent",
        "The vertex as stored (§2.1.2.1)",
        "Skin 0: contribution of each bone (§2.1.4)",
        "Result, scene space",
    ] {
        assert!(text.lines().any(|line| line == heading), "the heading \"{heading}\" is missing");
    }
    assert!(text.lines().all(|line| line == line.trim_end()), "blanks at the end of a line");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "a line too long for a terminal");
    let rows: Vec<usize> =
        text.lines().filter(|line| line.contains("]    [")).map(|line| line.chars().count()).collect();
    assert!(rows.len() > 20 && rows.iter().all(|&length| length == rows[0]), "{rows:?}");
}

#[test]
fn a_missing_item_is_an_error_with_its_number() {
    let model = made();
    let error = |take, what| explain(&model, take, 0.0, what).unwrap_err();
    let vertex = |instance, primitive, vertex| ExplainTarget::Vertex { instance, primitive, vertex };
    assert_eq!(error(Some(1), ExplainTarget::Bone(0)), ExplainError::NoTake { take: 1, takes: 1 });
    assert_eq!(error(None, ExplainTarget::Bone(2)), ExplainError::NoBone { bone: 2, bones: 2 });
    assert_eq!(error(None, vertex(3, 0, 0)), ExplainError::NoInstance { instance: 3, instances: 3 });
    assert_eq!(error(None, vertex(0, 1, 0)).to_string(), "instance 0 has no primitive 1; it has 1");
    let text = "primitive 0 of instance 1 has no vertex 7; it has 1";
    assert_eq!(error(None, vertex(1, 0, 7)).to_string(), text);
    let none = ExplainError::NoVertex { instance: 1, primitive: 0, vertex: 1, vertices: 1 };
    assert_eq!(error(None, vertex(1, 0, 1)), none, "the first that is not there");
}

#[test]
fn the_keys_of_morph_weights_are_those_of_the_instance() {
    let mut model = (*made()).clone();
    let mut take = (*model.animation.takes[0]).clone();
    let (times, weights) = ([0.0, 9.0].into(), [0.5, 0.5].into());
    let other = MorphTrack { instance: 1, targets: 1, times, weights, interpolation: Interpolation::Step };
    take.morphs.insert(0, other);
    model.animation.takes[0] = Arc::new(take);
    let explained = |instance, time| {
        let what = ExplainTarget::Vertex { instance, primitive: 0, vertex: 0 };
        vertex_of(&explain(&model, Some(0), time, what).unwrap()).clone()
    };
    let vertex = explained(0, 0.5);
    let keys = vertex.morph_keys.unwrap();
    assert_eq!((keys.count, keys.interpolation), (2, Interpolation::Linear));
    assert_eq!((keys.before, keys.after, keys.mix), ((0, 0.0), (1, 2.0), 0.25));
    let [lift] = &vertex.morphs[..] else { panic!("one target has a weight: {:?}", vertex.morphs) };
    assert_eq!((lift.target, &*lift.name, lift.weight), (0, "lift", 0.25));
    assert_eq!((lift.difference, lift.contribution), (Vec3::Z, Vec3::Z * 0.25));
    assert!(explained(0, 0.0).morphs.is_empty(), "a target without a weight adds nothing");
    assert_eq!(explained(1, 0.5).morph_keys.unwrap().interpolation, Interpolation::Step);
    assert_eq!(explained(2, 0.5).morph_keys, None);
}

#[test]
fn bones_without_a_weight_are_not_part_of_a_vertex() {
    let what = ExplainTarget::Vertex { instance: 0, primitive: 0, vertex: 0 };
    let explanation = explain(&made(), Some(0), 0.5, what).unwrap();
    let MovementStep::Skin { influences, .. } = &vertex_of(&explanation).movement else { panic!("a skin") };
    let shares: Vec<(Option<u32>, f32)> =
        influences.iter().map(|influence| (influence.bone, influence.weight)).collect();
    assert_eq!(shares, [(Some(1), 0.75), (Some(0), 0.25)]);
}
