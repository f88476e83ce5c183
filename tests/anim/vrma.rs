//! VRM animations: read with their parts of the body and expressions, and written from any figure.

use crate::doors::data;
use crate::save_judges::issues;
use crate::save_support::{OpenedFile, json_of, take_mut};
use crate::soundness::faults;
use crate::support::{animation_data, bone, take};
use dragonfly_anim::data::{
    Channel, ExpressionBind, FaceExpression, HumanBone, Interpolation, ModelData, MorphTrack, Skeleton, Take,
    Track,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{Formats, NoFiles, ReadOptions, SavePlan, gltf, read};
use dragonfly_kit::skip;
use glam::{Mat4, Quat, Vec3};
use serde_json::json;
use std::sync::Arc;

fn stored() -> Vec<u8> {
    std::fs::read(data().join("gltf/wave.vrma")).unwrap()
}

fn opened(bytes: &[u8]) -> ModelData {
    let imported = read("a.vrma", bytes, &NoFiles, &ReadOptions::default()).unwrap();
    assert_eq!((imported.format, imported.warnings), (gltf::VRMA, Vec::new()));
    assert_eq!(faults(&imported.model), [""; 0]);
    imported.model
}

fn exported(model: &ModelData) -> (ModelData, SavePlan) {
    let plan = gltf::VRMA.export.unwrap()(model, "a.vrma").unwrap();
    (opened(&plan.files[0].bytes), plan)
}

/// Returns the transforms of all bones to the scene, in a take at a time.
fn pose(model: &ModelData, index: usize, time: f32) -> Vec<Mat4> {
    let mut evaluator = Evaluator::new(Arc::new(model.clone()));
    evaluator.pose(Some(index), time);
    evaluator.to_root().to_vec()
}

/// Returns the place of a part of the body in a pose.
fn place(model: &ModelData, pose: &[Mat4], part: &str) -> Vec3 {
    pose[model.avatar.bone(part).unwrap() as usize].w_axis.truncate()
}

#[test]
fn the_parts_and_expressions_of_a_vrm_animation_are_read() {
    let model = opened(&stored());
    let bones = &model.animation.skeleton.bones;
    assert_eq!(model.avatar.bones.len(), 17);
    for human in &model.avatar.bones {
        assert_eq!(bones[human.bone as usize].name, format!("J_{}", human.name));
    }
    let names: Vec<&str> = model.avatar.expressions.iter().map(|expression| &*expression.name).collect();
    assert_eq!(names, ["blinkLeft", "happy", "wink"]);
    for expression in &model.avatar.expressions {
        assert_eq!(bones[expression.weight_bone.unwrap() as usize].name, expression.name);
    }
    for name in ["a.vrma", "a.glb", "a"] {
        assert_eq!(Formats::builtin().detect(name, &stored()), Some(&gltf::VRMA));
    }
}

#[test]
fn a_save_of_a_vrm_animation_keeps_its_extension() {
    let opened = OpenedFile::alone("wave.vrma", &stored());
    let mut takes = opened.takes();
    assert!(opened.saved(&takes, &NoFiles).bytes() == stored());
    let track = take_mut(&mut takes, 0).tracks.iter_mut().find(|track| !track.rotation.is_empty()).unwrap();
    track.rotation.values = track.rotation.values.iter().map(|value| value.conjugate()).collect();
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(saved.json()["extensions"], json_of(&stored())["extensions"]);
}

#[test]
fn a_written_vrm_animation_is_the_same_animation() {
    let model = opened(&stored());
    let (again, plan) = exported(&model);
    assert_eq!(plan.lost, []);
    assert_eq!(again.avatar.bones.len(), 17);
    for time in [0.0, 0.25, 0.5, 0.8, 1.0] {
        let poses = [pose(&model, 0, time), pose(&again, 0, time)];
        for human in &model.avatar.bones {
            let [a, b] = [(&model, &poses[0]), (&again, &poses[1])]
                .map(|(model, pose)| place(model, pose, &human.name));
            assert!(a.abs_diff_eq(b, 1e-5), "{} at {time}: {a} {b}", human.name);
        }
    }
    // The weights are limited to 0..1.
    let weights = |name: &str| -> Vec<f32> {
        let expression = again.avatar.expressions.iter().find(|it| it.name == name).unwrap();
        let track = &again.animation.takes[0].tracks[expression.weight_bone.unwrap() as usize];
        track.translation.values.iter().map(|value| value.x).collect()
    };
    assert_eq!(weights("happy"), [0.0, 1.0, 0.25]);
    assert_eq!(weights("wink"), [0.0, 0.5, 1.0]);
    let json = json_of(&plan.files[0].bytes);
    let expressions = &json["extensions"]["VRMC_vrm_animation"]["expressions"];
    assert!(expressions["preset"]["happy"].is_object() && expressions["custom"]["wink"].is_object());
    assert_eq!(json["extensions"]["VRMC_vrm_animation"]["specVersion"], "1.0");
}

/// Returns a figure in an A-pose that looks along +Z or, with `turn`, elsewhere; its bones have odd rest rotations.
fn figure(turn: Quat) -> ModelData {
    let down = Quat::from_rotation_z(-0.7) * Vec3::X;
    let mirrored = Vec3::new(-down.x, down.y, 0.0);
    let parts = [
        ("pelvis", None, Vec3::Y),
        ("spine_01", Some(0), Vec3::Y * 1.2),
        ("head", Some(1), Vec3::Y * 1.6),
        ("upperarm_l", Some(1), Vec3::new(0.2, 1.5, 0.0)),
        ("lowerarm_l", Some(3), Vec3::new(0.2, 1.5, 0.0) + down * 0.3),
        ("hand_l", Some(4), Vec3::new(0.2, 1.5, 0.0) + down * 0.6),
        ("upperarm_r", Some(1), Vec3::new(-0.2, 1.5, 0.0)),
        ("lowerarm_r", Some(6), Vec3::new(-0.2, 1.5, 0.0) + mirrored * 0.3),
        ("hand_r", Some(7), Vec3::new(-0.2, 1.5, 0.0) + mirrored * 0.6),
        ("thigh_l", Some(0), Vec3::new(0.1, 0.9, 0.0)),
        ("calf_l", Some(9), Vec3::new(0.1, 0.5, 0.0)),
        ("foot_l", Some(10), Vec3::new(0.1, 0.1, 0.0)),
        ("thigh_r", Some(0), Vec3::new(-0.1, 0.9, 0.0)),
        ("calf_r", Some(12), Vec3::new(-0.1, 0.5, 0.0)),
        ("foot_r", Some(13), Vec3::new(-0.1, 0.1, 0.0)),
    ];
    // To-root rotations at rest that are different for each bone.
    let turned: Vec<Quat> =
        (0..parts.len()).map(|bone| turn * Quat::from_rotation_x(bone as f32 * 0.4)).collect();
    let mut bones = Vec::new();
    for (index, (name, parent, at)) in parts.iter().enumerate() {
        let (above, from) = parent.map_or((Quat::IDENTITY, Vec3::ZERO), |parent: u32| {
            (turned[parent as usize], turn * parts[parent as usize].2)
        });
        let mut bone = bone(name, *parent, above.conjugate() * (turn * *at - from));
        bone.rest.rotation = (above.conjugate() * turned[index]).normalize();
        bones.push(bone);
    }
    let rest: Vec<_> = bones.iter().map(|bone| bone.rest).collect();
    let times = [0.0, 1.0];
    let mut tracks: Vec<Track> = vec![Track::default(); parts.len()];
    let turning = |bone: usize, by: Quat| {
        let before = rest[bone].rotation;
        Channel::new(times, [before, (before * by).normalize()], Interpolation::Linear)
    };
    tracks[0].translation =
        Channel::new(times, [rest[0].translation, turn * Vec3::new(0.3, 1.1, 0.5)], Interpolation::Linear);
    tracks[3].rotation = turning(3, Quat::from_rotation_y(0.8));
    tracks[4].rotation = turning(4, Quat::from_rotation_z(0.5));
    tracks[10].rotation = turning(10, Quat::from_rotation_x(0.6));
    tracks[10].scale = Channel::new(times, [Vec3::ONE, Vec3::ONE], Interpolation::Linear);
    ModelData { animation: animation_data(bones, vec![take(tracks)]), ..ModelData::default() }
}

const PAIRS: [(usize, &str); 6] = [
    (5, "leftHand"),
    (4, "leftLowerArm"),
    (8, "rightHand"),
    (11, "leftFoot"),
    (14, "rightFoot"),
    (2, "head"),
];

#[test]
fn a_figure_in_any_rest_pose_is_written_in_a_t_pose_and_moves_the_same() {
    for turn in [0.0, std::f32::consts::PI, 1.1, -2.0].map(Quat::from_rotation_y) {
        let model = figure(turn);
        let (written, plan) = exported(&model);
        let node =
            |part: &str| &written.animation.skeleton.bones[written.avatar.bone(part).unwrap() as usize];
        for bone in &written.animation.skeleton.bones {
            assert_eq!((bone.rest.rotation, bone.rest.scale), (Quat::IDENTITY, Vec3::ONE), "{}", bone.name);
        }
        assert!(node("leftHand").rest.translation.abs_diff_eq(Vec3::X * 0.3, 1e-5));
        assert!(node("rightHand").rest.translation.abs_diff_eq(Vec3::NEG_X * 0.3, 1e-5));
        let hips = written.avatar.bone("hips");
        for track in &written.animation.takes[0].tracks {
            assert!(track.scale.is_empty() && (track.translation.is_empty() || Some(track.bone) == hips));
        }
        for time in [0.0, 0.5, 1.0] {
            let (before, after) = (pose(&model, 0, time), pose(&written, 0, time));
            for (bone, part) in PAIRS {
                let expected = turn.conjugate() * before[bone].w_axis.truncate();
                let got = place(&written, &after, part);
                assert!(got.abs_diff_eq(expected, 1e-4), "{part} at {time}: {got}, expected {expected}");
            }
        }
        assert!(plan.lost.iter().any(|lost| lost.text.contains("not scaled")), "{:?}", plan.lost);
    }
}

#[test]
fn morph_weights_of_expressions_become_tracks_and_all_others_are_listed() {
    let mut model = figure(Quat::IDENTITY);
    let bind = |target, weight| ExpressionBind { instance: 0, target, weight };
    let expression = |name: &str, binds: Vec<ExpressionBind>| FaceExpression {
        name: name.to_owned(),
        binds,
        weight_bone: None,
    };
    model.avatar.expressions = vec![
        expression("happy", vec![bind(0, 0.5)]),
        expression("mine", vec![bind(1, 1.0), bind(2, 1.0)]),
        expression("lookUp", vec![bind(3, 1.0)]),
    ];
    let weights: Vec<f32> = vec![0.25, 0.5, 0.0, 0.0, 0.5, 1.0, 0.0, 1.0];
    let take = Arc::make_mut(&mut model.animation.takes[0]);
    take.morphs.push(MorphTrack {
        instance: 0,
        targets: 4,
        times: [0.0, 1.0].into(),
        weights: weights.into(),
        interpolation: Interpolation::Linear,
    });
    let (written, plan) = exported(&model);
    let names: Vec<&str> = written.avatar.expressions.iter().map(|it| &*it.name).collect();
    assert_eq!(names, ["happy", "mine"]);
    let values = |index: usize| -> Vec<f32> {
        let bone = written.avatar.expressions[index].weight_bone.unwrap();
        written.animation.takes[0].tracks[bone as usize]
            .translation
            .values
            .iter()
            .map(|value| value.x)
            .collect()
    };
    assert_eq!((values(0), values(1)), (vec![0.5, 1.0], vec![0.5, 1.0]));
    // The gaze has no track.
    assert!(plan.lost.iter().any(|lost| lost.text.starts_with("1 morph target")), "{:?}", plan.lost);
}

#[test]
fn a_model_that_is_no_figure_is_refused_and_missing_parts_are_listed() {
    let export = gltf::VRMA.export.unwrap();
    let error = export(&ModelData::default(), "a.vrma").unwrap_err();
    assert!(error.to_string().contains("hips"), "{error}");
    let mut model = figure(Quat::IDENTITY);
    model.avatar.bones =
        vec![HumanBone { name: "hips".to_owned(), bone: 0 }, HumanBone { name: "x".to_owned(), bone: 99 }];
    let (written, plan) = exported(&model);
    assert_eq!(written.avatar.bones.len(), 1);
    assert!(plan.lost.iter().any(|lost| lost.text.contains("leftUpperArm")), "{:?}", plan.lost);
    assert!(plan.lost.iter().any(|lost| lost.text.contains("no parts of the body")), "{:?}", plan.lost);
    // Without takes and with an empty take it is a figure at rest.
    model.animation.takes = vec![Arc::new(Take::default())];
    exported(&model);
    model.animation.takes.clear();
    let (written, _) = exported(&model);
    assert_ne!(*written.animation.skeleton, Skeleton::default());
}

#[test]
fn the_validator_finds_no_error_in_written_vrm_animations() {
    let Some(evaluators) = skip::evaluators() else { return };
    let folder = std::env::temp_dir().join(format!("dragonfly-vrma-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let models = [opened(&stored()), figure(Quat::IDENTITY)];
    let mut paths = Vec::new();
    for (index, model) in models.iter().enumerate() {
        let path = folder.join(format!("{index}.glb"));
        std::fs::write(&path, &exported(model).1.files[0].bytes).unwrap();
        paths.push(path);
    }
    let found = issues(&evaluators, &paths);
    std::fs::remove_dir_all(&folder).unwrap();
    for issues in found {
        assert!(issues.is_empty() || json!(issues) == json!({"NODE_EMPTY": 1}), "{issues:?}");
    }
}
