//! VRM files: parts of the body and facial expressions are read, everything else in them is kept.

use crate::fixture::{Fixture, glb};
use crate::save_support::{OpenedFile, json_of, take_mut};
use crate::soundness::faults;
use crate::support::{animation_data, bone};
use dragonfly_anim::data::{Avatar, ExpressionBind, HumanBone, ModelData};
use dragonfly_anim::format::{EditedTake, Formats, Imported, NoFiles, ReadOptions, gltf, read};
use dragonfly_anim::retarget::BindingGuess;
use dragonfly_anim::root_bone::with_root_bone;
use dragonfly_kit::mutate::{Mutator, mutants};
use dragonfly_kit::random::seed;
use glam::{Quat, Vec3};
use serde_json::{Value, json};
use std::sync::Arc;

/// Returns the fixture as a VRM 1.0, with what no program but its own understands.
fn vrm_1() -> Fixture {
    let mut fixture = Fixture::new();
    let happy = json!({"isBinary": false, "overrideBlink": "block",
        "morphTargetBinds": [{"node": 3, "index": 0, "weight": 0.5}],
        "materialColorBinds": [{"material": 0, "type": "color", "targetValue": [1.0, 0.10, 0, 1]}]});
    fixture.set("/extensionsUsed", json!(["VRMC_vrm", "VRMC_springBone"]));
    fixture.set(
        "/extensions",
        json!({
            "VRMC_vrm": {
                "specVersion": "1.0", "meta": {"name": "Fixture", "licenseUrl": "https://vrm.dev/licenses/1.0/"},
                "humanoid": {"humanBones": {"hips": {"node": 0}, "spine": {"node": 1}}},
                "expressions": {"preset": {"happy": happy}, "custom": {"grin": {"morphTargetBinds": []}}},
                "lookAt": {"type": "bone"}},
            "VRMC_springBone": {"specVersion": "1.0", "springs": [{"joints": [{"node": 1, "stiffness": 1.0e-1}]}]}
        }),
    );
    fixture
}

/// Returns the fixture as a VRM 0.x.
fn vrm_0() -> Fixture {
    let mut fixture = Fixture::new();
    fixture.set("/extensionsUsed", json!(["VRM"]));
    fixture.set(
        "/extensions/VRM",
        json!({
            "exporterVersion": "UniVRM-0.99",
            "humanoid": {"humanBones": [{"bone": "hips", "node": 0, "useDefaultValues": true},
                                        {"bone": "leftThumbProximal", "node": 1}]},
            "blendShapeMaster": {"blendShapeGroups": [
                {"name": "Joy", "presetName": "joy", "binds": [{"mesh": 0, "index": 0, "weight": 50}]},
                {"name": "Grin", "presetName": "unknown", "binds": []}]},
            "secondaryAnimation": {"boneGroups": []}
        }),
    );
    fixture
}

fn imported(fixture: &Fixture) -> Imported {
    read("a.vrm", &fixture.glb(), &NoFiles, &ReadOptions::default()).unwrap()
}

fn node_of(model: &ModelData, bone: u32) -> Option<u32> {
    model.animation.skeleton.bones[bone as usize].node
}

#[test]
fn humanoid_bones_and_expressions_of_vrm_1_are_read() {
    let Imported { model, format, warnings, .. } = imported(&vrm_1());
    assert_eq!(format, gltf::GLB);
    let avatar = &model.avatar;
    assert_eq!(avatar.bones.len(), 2);
    assert_eq!(avatar.bone("hips").and_then(|bone| node_of(&model, bone)), Some(0));
    assert_eq!(avatar.bone("spine").and_then(|bone| node_of(&model, bone)), Some(1));
    assert!(!avatar.faces_minus_z);
    let names: Vec<&str> = avatar.expressions.iter().map(|expression| &*expression.name).collect();
    assert_eq!(names, ["happy", "grin"]);
    assert_eq!(avatar.expressions[0].binds, [ExpressionBind { instance: 0, target: 0, weight: 0.5 }]);
    assert!(avatar.expressions.iter().all(|expression| expression.weight_bone.is_none()));
    // Spring bones are not simulated.
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].text.contains("VRMC_springBone"));
    assert_eq!(imported(&Fixture::new()).model.avatar, Avatar::default());
}

#[test]
fn humanoid_bones_and_blend_shape_groups_of_vrm_0_get_the_names_of_vrm_1() {
    let Imported { model, warnings, .. } = imported(&vrm_0());
    assert_eq!(warnings, []);
    let names: Vec<&str> = model.avatar.bones.iter().map(|bone| &*bone.name).collect();
    assert_eq!(names, ["hips", "leftThumbMetacarpal"]);
    let names: Vec<&str> = model.avatar.expressions.iter().map(|expression| &*expression.name).collect();
    assert_eq!(names, ["happy", "Grin"]);
    assert_eq!(model.avatar.expressions[0].binds, [ExpressionBind { instance: 0, target: 0, weight: 0.5 }]);
    assert!(model.avatar.faces_minus_z);
    // Nothing is turned: the rest is the same as without the extension.
    assert_eq!(ModelData { avatar: Avatar::default(), ..model }, imported(&Fixture::new()).model);
}

#[test]
fn a_save_of_a_vrm_changes_nothing_but_the_edited_rotation() {
    for fixture in [vrm_0(), vrm_1()] {
        let file = fixture.glb();
        let opened = OpenedFile::alone("a.vrm", &file);
        let mut takes = opened.takes();
        assert!(opened.saved(&takes, &NoFiles).bytes() == file, "nothing was edited");
        let track =
            take_mut(&mut takes, 0).tracks.iter_mut().find(|track| !track.rotation.is_empty()).unwrap();
        let turned =
            track.rotation.values.iter().map(|value| (*value * Quat::from_rotation_y(0.2)).normalize());
        track.rotation.values = turned.collect();
        // Compares all bytes but the announced ones.
        let saved = opened.saved(&takes, &NoFiles);
        assert_eq!((saved.changes.channels.len(), saved.changes.channels[0].path), (1, "rotation"));
        let places: Vec<&str> = saved.changes.tokens.iter().map(|token| &*token.pointer).collect();
        println!("{places:?}");
        let concerned = ["/animations/0/samplers/1", "/accessors", "/bufferViews", "/buffers/0/byteLength"];
        assert!(
            places.iter().all(|place| concerned.iter().any(|start| place.starts_with(start))),
            "{places:?}"
        );
        assert_eq!(json_of(saved.bytes())["extensions"], fixture.json["extensions"]);
        assert_eq!(saved.opened.model.avatar, opened.model.avatar);
    }
}

#[test]
fn a_vrm_that_names_what_is_not_there_is_read_with_warnings() {
    type Change = (&'static str, Value, usize);
    let changes_of_1: [Change; 8] = [
        ("/extensions/VRMC_vrm/humanoid/humanBones/head", json!({"node": 99}), 1),
        ("/extensions/VRMC_vrm/humanoid/humanBones/head", json!({"node": -1}), 1),
        ("/extensions/VRMC_vrm/humanoid/humanBones/head", json!({"node": 0}), 1),
        ("/extensions/VRMC_vrm/humanoid/humanBones/head", json!(null), 1),
        ("/extensions/VRMC_vrm/humanoid", json!([1, 2]), 0),
        ("/extensions/VRMC_vrm/expressions/preset/happy/morphTargetBinds/0/index", json!(7), 1),
        ("/extensions/VRMC_vrm/expressions/preset/happy/morphTargetBinds/0/node", json!(1), 1),
        ("/extensions/VRMC_vrm/expressions/preset/happy/morphTargetBinds/0/weight", json!("much"), 0),
    ];
    let changes_of_0: [Change; 5] = [
        ("/extensions/VRM/humanoid/humanBones/2", json!({"bone": "head", "node": 4_294_967_295_u32}), 1),
        ("/extensions/VRM/humanoid/humanBones/2", json!({"bone": 3, "node": 2}), 1),
        ("/extensions/VRM/blendShapeMaster/blendShapeGroups/0/binds/0/mesh", json!(5), 1),
        ("/extensions/VRM/blendShapeMaster/blendShapeGroups/0/binds/0/index", json!(-1), 1),
        ("/extensions/VRM/blendShapeMaster", json!("none"), 0),
    ];
    let cases = changes_of_1.into_iter().map(|change| (vrm_1(), change));
    for (mut fixture, (pointer, value, expected)) in cases.chain(changes_of_0.map(|change| (vrm_0(), change)))
    {
        fixture.set(pointer, value.clone());
        let got = imported(&fixture);
        let count = got.warnings.iter().filter(|warning| warning.code == "VRM_INVALID").count();
        assert_eq!(count, expected, "{pointer} {value}: {:?}", got.warnings);
        assert_eq!(faults(&got.model), [""; 0]);
        let bones = got.model.animation.skeleton.len() as u32;
        assert!(got.model.avatar.bones.iter().all(|human| human.bone < bones));
    }
}

#[test]
fn no_damaged_vrm_panics() {
    let first = seed(8_802);
    println!("DRAGONFLY_SEED={first}");
    let files: Vec<Vec<u8>> = [vrm_0(), vrm_1()].map(|fixture| fixture.json.to_string().into_bytes()).into();
    let mut mutator = Mutator::new(first, &[b"{}", b"[]", b"null", b"-1", b"\"node\":3,", b"99999999999"]);
    for _ in 0..mutants() {
        let file = glb(&mutator.mutant(&files), Some(&vrm_0().bin));
        if let Ok(imported) = read("a.vrm", &file, &NoFiles, &ReadOptions::default()) {
            assert_eq!(faults(&imported.model), [""; 0]);
        }
    }
}

#[test]
fn a_vrm_is_opened_as_gltf_and_only_edits_are_written_to_it() {
    let formats = Formats::builtin();
    assert_eq!(formats.by_extension("VRM"), Some(&gltf::GLB));
    let export = gltf::GLB.export.unwrap();
    let error = export(&ModelData::default(), "new.VRM").unwrap_err();
    assert!(error.to_string().contains(".vrma"), "{error}");
    let plan = export(&imported(&vrm_0()).model, "new.glb").unwrap();
    assert!(plan.lost.iter().any(|lost| lost.text.contains("facial expressions")), "{:?}", plan.lost);
}

/// Returns a figure whose bones have names without a meaning, and a figure with names of the convention of Mixamo.
fn two_figures() -> (ModelData, ModelData) {
    let parts = [
        ("hips", "mixamorig:Hips", None, Vec3::Y),
        ("spine", "mixamorig:Spine", Some(0), Vec3::Y * 0.2),
        ("neck", "mixamorig:Neck", Some(1), Vec3::Y * 0.3),
        ("head", "mixamorig:Head", Some(2), Vec3::Y * 0.1),
        ("leftUpperArm", "mixamorig:LeftArm", Some(1), Vec3::X * 0.2),
        ("leftLowerArm", "mixamorig:LeftForeArm", Some(4), Vec3::X * 0.3),
        ("leftHand", "mixamorig:LeftHand", Some(5), Vec3::X * 0.3),
        ("leftUpperLeg", "mixamorig:LeftUpLeg", Some(0), Vec3::new(0.1, -0.1, 0.0)),
    ];
    let bones = |name: &dyn Fn(usize) -> String| {
        let bone = |(index, (_, _, parent, at)): (usize, &(&str, &str, Option<u32>, Vec3))| {
            bone(&name(index), *parent, *at)
        };
        let animation = animation_data(parts.iter().enumerate().map(bone).collect(), Vec::new());
        ModelData { animation, ..ModelData::default() }
    };
    let mut named = bones(&|index| format!("b{}", index * 7 % 8));
    let humans = parts.iter().zip(0..).map(|((name, ..), bone)| HumanBone { name: (*name).to_owned(), bone });
    named.avatar.bones = humans.collect();
    (named, bones(&|index| parts[index].1.to_owned()))
}

#[test]
fn the_parts_that_a_file_names_are_bound_whatever_the_names_of_its_bones() {
    let (named, mixamo) = two_figures();
    let guess = BindingGuess::of_models(&named, &mixamo);
    assert_eq!(guess.binding.source_of, (0..8).map(Some).collect::<Vec<_>>());
    assert_eq!(BindingGuess::of_models(&mixamo, &named).binding.bound(), 8);
    let blind = BindingGuess::of(&named.animation.skeleton, &mixamo.animation.skeleton);
    assert_eq!(blind.binding.bound(), 0);
}

#[test]
fn a_new_root_bone_moves_the_parts_of_the_body_along() {
    let (named, _) = two_figures();
    let rooted = with_root_bone(&named, "root").unwrap();
    assert_eq!(rooted.avatar.bone("hips"), Some(1));
    assert_eq!(rooted.avatar.bones.len(), named.avatar.bones.len());
}

#[test]
fn a_take_that_no_longer_moves_a_humanoid_bone_does_not_lose_the_bone() {
    // The toe is no joint of a skin.
    let channel = json!({"sampler": 0, "target": {"node": 2, "path": "translation"}});
    let mut fixture = vrm_1();
    fixture.set("/animations/0/channels/5", channel);
    fixture.set("/extensions/VRMC_vrm/humanoid/humanBones/leftToes", json!({"node": 2}));
    let opened = OpenedFile::alone("a.vrm", &fixture.glb());
    let mut takes: Vec<EditedTake> = opened.takes();
    let toe = opened.model.avatar.bone("leftToes").unwrap() as usize;
    Arc::make_mut(&mut takes[0].take).tracks[toe].translation = Default::default();
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(saved.changes.bones_lost, []);
    assert_eq!(saved.opened.model.avatar, opened.model.avatar);
}
