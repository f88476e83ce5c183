//! Each rule of the checks reports a valid model that is broken in its way, and no other rule does.

use crate::dfm::golden;
use crate::doors::{TestFolder, model_files};
use crate::hostile::HostileModels;
use dragonfly_anim::check::{MAX_PER_RULE, PathKind, RULES, Severity, check, check_take};
use dragonfly_anim::data::{
    Bone, Channel, Interpolation, Mesh, MeshInstance, ModelData, MorphTrack, Primitive,
};
use dragonfly_anim::data::{Skeleton, Take, Track, Vertices};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Quat, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A change that breaks one rule.
type Break = fn(&mut ModelData);

fn primitive(model: &mut ModelData) -> &mut Primitive {
    &mut model.meshes[0].primitives[0]
}

fn skeleton(model: &mut ModelData) -> &mut Skeleton {
    Arc::make_mut(&mut model.animation.skeleton)
}

fn bone(model: &mut ModelData) -> &mut Bone {
    &mut skeleton(model).bones[0]
}

fn take(model: &mut ModelData) -> &mut Take {
    Arc::make_mut(&mut model.animation.takes[0])
}

/// Returns the animated track: key-frames of bone 1 at 0 s and 2 s.
fn track(model: &mut ModelData) -> &mut Track {
    &mut take(model).tracks[1]
}

fn rotations(model: &mut ModelData, times: &[f32], values: &[Quat]) {
    track(model).rotation = Channel::new(times, values, Interpolation::Linear);
}

fn scales(model: &mut ModelData, value: Vec3) {
    track(model).scale = Channel::new([0.0, 1.0], [Vec3::ONE, value], Interpolation::Linear);
}

/// Half a turn about x.
const HALF: Quat = Quat::from_xyzw(1.0, 0.0, 0.0, 0.0);

/// For each rule, changes that break it and no other rule.
const BREAKS: &[(&str, Break)] = &[
    ("NOT_FINITE", |model| primitive(model).vertices.positions[1].x = f32::NAN),
    ("NOT_FINITE", |model| primitive(model).vertices.influences[0].weight = f32::INFINITY),
    ("NOT_FINITE", |model| model.materials[0].base_color.x = f32::NAN),
    ("NOT_FINITE", |model| bone(model).rest.rotation.w = f32::NAN),
    ("NOT_FINITE", |model| bone(model).offset.w_axis.x = f32::INFINITY),
    ("NOT_FINITE", |model| model.skins[0].offsets[0].x_axis.x = f32::NAN),
    ("NOT_FINITE", |model| model.instances[0].to_bone.x_axis.x = f32::NAN),
    ("COLUMN_LENGTH", |model| primitive(model).vertices.normals.truncate(2)),
    ("COLUMN_LENGTH", |model| primitive(model).indices.push(0)),
    ("COLUMN_LENGTH", |model| model.instances[0].morph_weights.push(0.0)),
    ("INDEX", |model| primitive(model).indices[1] = 3),
    ("INDEX", |model| primitive(model).material = Some(1)),
    ("INDEX", |model| model.instances[0].bone = Some(2)),
    ("PARENT_ORDER", |model| bone(model).parent = Some(1)),
    ("PARENT_ORDER", |model| bone(model).parent = Some(0)),
    ("JOINT_MISSING", |model| primitive(model).vertices.influences[0].joint = 2),
    ("WEIGHT_NEGATIVE", |model| {
        let influences = &mut primitive(model).vertices.influences;
        (influences[0].weight, influences[1].weight) = (1.25, -0.25);
    }),
    ("WEIGHT_SUM", |model| primitive(model).vertices.influences[0].weight = 0.9),
    ("REST_NOT_UNIT", |model| bone(model).rest.rotation.w = 1.1),
    ("REST_NOT_UNIT", |model| bone(model).rest.rotation = Quat::from_array([0.0; 4])),
    ("OFFSET_SINGULAR", |model| model.skins[0].offsets[0] = Mat4::ZERO),
    ("OFFSET_SINGULAR", |model| bone(model).offset = Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0))),
    ("NORMAL_NOT_UNIT", |model| primitive(model).vertices.normals[2] = Vec3::splat(1.0)),
    ("REST_SCALE_ZERO", |model| bone(model).rest.scale.y = 0.0),
    ("REST_SCALE_ZERO", |model| bone(model).rest.scale.y = 1e-9),
    ("BONE_NAME_TWICE", |model| bone(model).name = "knee".to_owned()),
    ("REST_MIRRORED", |model| bone(model).rest.scale.x = -1.0),
    ("REST_NOT_UNIFORM", |model| bone(model).rest.scale.x = 2.0),
    ("BONE_UNUSED", |model| {
        let toe = Bone { name: "toe".to_owned(), parent: Some(1), ..bone(model).clone() };
        skeleton(model).bones.push(toe);
        take(model).tracks.push(Track { bone: 2, ..Track::default() });
    }),
    ("TRIANGLE_DEGENERATE", |model| primitive(model).vertices.positions[2] = Vec3::X * 3.0),
    ("TRIANGLE_DEGENERATE", |model| primitive(model).indices[1] = 0),
    ("TRACK_OF_NO_BONE", |model| track(model).bone = 2),
    ("TRACK_TWICE", |model| take(model).tracks[0].bone = 1),
    ("TRACK_ORDER", |model| take(model).tracks.swap(0, 1)),
    ("TRACK_ORDER", |model| take(model).tracks.truncate(0)),
    ("KEY_COUNT", |model| track(model).rotation.values = [Quat::IDENTITY].into()),
    ("KEY_NOT_FINITE", |model| rotations(model, &[0.0, 2.0], &[Quat::IDENTITY, HALF * f32::NAN])),
    ("KEY_NOT_FINITE", |model| rotations(model, &[0.0, f32::NAN, 2.0], &[Quat::IDENTITY, HALF, HALF])),
    ("KEY_TIMES_FALL", |model| rotations(model, &[2.0, 0.0], &[Quat::IDENTITY, HALF])),
    ("KEY_TIME_TWICE", |model| rotations(model, &[0.0, 0.0, 2.0], &[HALF, HALF, HALF])),
    ("KEY_NOT_UNIT", |model| rotations(model, &[0.0, 2.0], &[Quat::IDENTITY, HALF * 1.1])),
    ("MORPH_TRACK", |model| {
        let (times, weights) = ([0.0].into(), [].into());
        let interpolation = Interpolation::Linear;
        take(model).morphs.push(MorphTrack { instance: 1, targets: 0, times, weights, interpolation });
    }),
    ("MORPH_TRACK", |model| {
        let (times, weights) = ([0.0].into(), [1.0].into());
        let interpolation = Interpolation::Linear;
        take(model).morphs.push(MorphTrack { instance: 0, targets: 1, times, weights, interpolation });
    }),
    ("TAKE_RANGE", |model| take(model).length = 3.0),
    ("TAKE_RANGE", |model| take(model).start = f32::NAN),
    ("KEY_SCALE_ZERO", |model| scales(model, Vec3::new(1.0, 0.0, 1.0))),
    ("KEY_SCALE_ZERO", |model| scales(model, Vec3::splat(1e-7))),
    ("KEY_MIRRORED", |model| scales(model, Vec3::new(-1.0, 1.0, 1.0))),
    ("ROTATION_FLIP", |model| rotations(model, &[0.0, 2.0], &[HALF, -HALF])),
    ("ROTATION_JUMP", |model| rotations(model, &[0.0, 0.01, 2.0], &[Quat::IDENTITY, HALF, HALF])),
    ("KEY_TIME_NEGATIVE", |model| {
        rotations(model, &[-1.0, 2.0], &[Quat::IDENTITY, HALF]);
        (take(model).start, take(model).length) = (-1.0, 3.0);
    }),
    ("BONE_STRETCHED", |model| track(model).translation.values = [Vec3::Y * 1.1].into()),
    ("TAKE_WITHOUT_LENGTH", |model| {
        rotations(model, &[0.0], &[HALF]);
        take(model).length = 0.0;
    }),
];

#[test]
fn a_good_model_has_no_finding() {
    let findings = check(&golden::model());
    assert!(findings.is_empty(), "{findings:#?}");
    assert!(check(&ModelData::default()).is_empty());
}

#[test]
fn each_broken_model_is_reported_by_its_rule_alone() {
    let mut wrong = Vec::new();
    for (number, (rule, break_it)) in BREAKS.iter().enumerate() {
        let mut model = golden::model();
        break_it(&mut model);
        let fired: BTreeSet<&str> = check(&model).iter().map(|finding| finding.rule).collect();
        if fired != BTreeSet::from([*rule]) {
            wrong.push(format!("break {number}, of {rule}: {fired:?}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), BREAKS.len(), wrong.join("\n"));
}

#[test]
fn every_rule_of_the_list_is_tested_here_and_has_a_description() {
    for (index, rule) in RULES.iter().enumerate() {
        assert!(BREAKS.iter().any(|(id, _)| *id == rule.id), "{} is not tested", rule.id);
        assert!(RULES[..index].iter().all(|other| other.id != rule.id), "{} is listed twice", rule.id);
        assert!(rule.meaning.ends_with('.') && rule.meaning.len() > 20, "{}", rule.id);
    }
    assert!(BREAKS.iter().all(|(id, _)| RULES.iter().any(|rule| rule.id == *id)));
}

#[test]
fn findings_contain_their_place() {
    let told = |break_it: Break| {
        let mut model = golden::model();
        break_it(&mut model);
        check(&model)[0].to_string()
    };
    assert_eq!(
        told(|model| primitive(model).vertices.influences[4].weight = 0.5),
        "error: mesh 0 \"skin\", primitive 0, vertex 1: the weights sum to 0.75"
    );
    assert_eq!(
        told(|model| rotations(model, &[2.0, 0.0], &[Quat::IDENTITY, HALF])),
        "error: take 0 \"bend\", bone 1 \"knee\", rotation, key 1: at 0 s, after one at 2 s"
    );
    assert_eq!(
        told(|model| bone(model).name = "knee".to_owned()),
        "warning: bone 1 \"knee\": bone 0 has the same name"
    );
    assert_eq!(
        told(|model| track(model).translation.values = [Vec3::Y * 1.5].into()),
        "note: take 0 \"bend\", bone 1 \"knee\", translation, key 0: at 0 s: length 1.5, at rest 1"
    );
    let mut model = golden::model();
    primitive(&mut model).indices[2] = 9;
    let findings = check(&model);
    assert_eq!(findings[0].path.number(PathKind::Triangle), Some(0));
    assert_eq!(findings[0].path.number(PathKind::Take), None);
}

#[test]
fn a_take_by_itself_is_checked_by_the_same_rules() {
    for (rule, break_it) in BREAKS {
        let mut model = golden::model();
        break_it(&mut model);
        let skeleton = &model.animation.skeleton;
        let alone = check_take(&model.animation.takes[0], skeleton);
        let of_take = RULES.iter().position(|other| other.id == *rule)
            >= RULES.iter().position(|r| r.id == "TRACK_OF_NO_BONE");
        // Whether an instance exists is unknown without a model.
        if of_take && *rule != "MORPH_TRACK" {
            assert_eq!(alone, check(&model), "{rule}");
        } else {
            assert!(alone.is_empty(), "{rule}: {alone:?}");
        }
    }
}

#[test]
fn many_findings_of_one_rule_are_shortened_to_a_count() {
    let positions = vec![Vec3::NAN; 50_000];
    let vertices = Vertices { positions, ..Vertices::default() };
    let mesh = Mesh { primitives: vec![Primitive { vertices, ..Primitive::default() }], ..Mesh::default() };
    let findings = check(&ModelData { meshes: vec![mesh], ..ModelData::default() });
    assert_eq!(findings.len(), MAX_PER_RULE + 1);
    assert_eq!(findings[MAX_PER_RULE].to_string(), "error: model: and 49900 more of these");
}

#[test]
fn errors_come_before_warnings_and_notes() {
    let mut model = golden::model();
    bone(&mut model).rest.scale.x = -1.0;
    bone(&mut model).name = "knee".to_owned();
    primitive(&mut model).indices[2] = 9;
    let severities: Vec<Severity> = check(&model).iter().map(|finding| finding.severity).collect();
    assert_eq!(severities, [Severity::Error, Severity::Warning, Severity::Note]);
}

#[test]
fn no_model_makes_a_rule_panic() {
    let first = seed(0xC4EC);
    for round in 0..20_000u64 {
        let seed = first.wrapping_add(round);
        let hostile = [0.02, 0.2, 0.6][(round % 3) as usize];
        let tried = std::panic::catch_unwind(|| {
            let model = HostileModels { random: Random::new(seed), hostile }.model();
            check(&model).iter().map(|finding| finding.to_string().len()).sum::<usize>()
        });
        assert!(tried.is_ok(), "DRAGONFLY_SEED={seed}: panicked");
    }
    let lonely = ModelData {
        instances: vec![MeshInstance { mesh: 3, ..golden::model().instances[0].clone() }],
        ..ModelData::default()
    };
    assert!(!check(&lonely).is_empty());
}

#[test]
fn models_of_the_test_data_have_no_errors() {
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let door = TestFolder(path.parent().unwrap().to_owned());
        let imported = read(name, &std::fs::read(&path).unwrap(), &door, &ReadOptions::default()).unwrap();
        let mut rules: BTreeMap<&str, (usize, String)> = BTreeMap::new();
        for finding in check(&imported.model) {
            assert!(finding.severity != Severity::Error, "{name}: {finding}");
            rules.entry(finding.rule).or_insert_with(|| (0, finding.to_string())).0 += 1;
        }
        for (rule, (count, first)) in rules {
            println!("{name}: {rule} × {count}: {first}");
        }
    }
}
