//! Layers change what is seen and saved, and never a key of the take below; the file brings them back.

use crate::save_and_open::open;
use dragonfly_anim::data::{Take, Transform};
use dragonfly_anim::sample::sample_take;
use dragonfly_document::Editable;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::Edit;
use dragonfly_document::history::Edited;
use dragonfly_kit::folder::{Folder, data};
use glam::{Quat, Vec3};
use std::path::PathBuf;
use std::sync::Arc;

const HEAD: &str = "b_Head_05";
const WALK: usize = 1;

fn fox(folder: &Folder) -> (PathBuf, Editable, ModelAdapter) {
    let path = folder.join("Fox.glb");
    std::fs::copy(data("gltf/Fox.glb"), &path).unwrap();
    let file = open(&path);
    let adapter = ModelAdapter::new(&file.model.animation);
    (path, file, adapter)
}

fn edit(json: &str) -> Edit {
    serde_json::from_str(json).unwrap_or_else(|error| panic!("{json}: {error}"))
}

#[track_caller]
fn apply(adapter: &mut ModelAdapter, json: &str) {
    adapter.apply(&edit(json)).unwrap_or_else(|error| panic!("{json}: {error}"));
    assert_eq!(adapter.check(), Ok(()), "{json}");
}

/// Adds a layer with three keys of the head.
fn with_nod(adapter: &mut ModelAdapter, kind: &str) {
    apply(adapter, &format!(r#"{{"edit":"add_layer","take":"Walk","name":"Nod","kind":"{kind}"}}"#));
    for (time, turn) in [(0.1, 0.0), (0.3, 0.5), (0.6, 0.1)] {
        nod(adapter, time, turn);
    }
}

/// Turns the head, as it is seen, by an angle about the axis x of its parent.
fn nod(adapter: &mut ModelAdapter, time: f32, turn: f32) {
    let turn = (Quat::from_rotation_x(turn) * seen(adapter, time).rotation).to_array();
    apply(
        adapter,
        &format!(
            r#"{{"edit":"set","take":{{"take":"Walk","layer":"Nod"}},"time":{time},"poses":[{{"bone":"{HEAD}","rotation":{turn:?}}}]}}"#
        ),
    );
}

/// Returns the pose of the head that is seen.
fn seen(adapter: &ModelAdapter, time: f32) -> Transform {
    pose(adapter, adapter.slots()[WALK].shown(), time)
}

fn pose(adapter: &ModelAdapter, take: &Take, time: f32) -> Transform {
    let mut poses = vec![Transform::IDENTITY; adapter.skeleton().len()];
    sample_take(Some(take), adapter.skeleton(), time, &mut poses);
    poses[adapter.skeleton().find(HEAD).unwrap() as usize]
}

fn angle(a: Quat, b: Quat) -> f32 {
    2.0 * (a - b).length().min((a + b).length())
}

#[test]
fn a_pose_that_is_set_in_a_layer_is_seen_and_no_key_of_the_take_changes() {
    for kind in ["additive", "override"] {
        let folder = Folder::new("layers-set");
        let (_, _, mut adapter) = fox(&folder);
        let before = adapter.slots()[WALK].clone();
        with_nod(&mut adapter, kind);
        let wanted = Quat::from_rotation_x(0.7) * seen(&adapter, 0.45).rotation;
        nod(&mut adapter, 0.45, 0.7);
        let got = seen(&adapter, 0.45).rotation;
        assert!(angle(got, wanted) < 1e-4, "{kind}: off by {} rad", angle(got, wanted));
        let slot = &adapter.slots()[WALK];
        assert!(Arc::ptr_eq(&slot.result, &before.result) && Arc::ptr_eq(&slot.original, &before.original));
        assert_eq!(slot.layers()[0].keys.result.keys(), 4, "{kind}");
        // Only the rotation of the head is another channel.
        let head = adapter.skeleton().find(HEAD).unwrap() as usize;
        for (bone, (shown, below)) in slot.shown().tracks.iter().zip(&slot.result.tracks).enumerate() {
            assert!(Arc::ptr_eq(&shown.translation.values, &below.translation.values));
            assert_eq!(
                Arc::ptr_eq(&shown.rotation.values, &below.rotation.values),
                bone != head,
                "bone {bone}"
            );
        }
    }
}

#[test]
fn a_saved_file_shows_the_layers_to_other_programs_and_brings_them_back() {
    for kind in ["additive", "override"] {
        let folder = Folder::new("layers-save");
        let (path, mut file, mut adapter) = fox(&folder);
        with_nod(&mut adapter, kind);
        apply(
            &mut adapter,
            r#"{"edit":"set_layer","take":{"take":"Walk","layer":0},"weight":0.75,"color":[9,8,7],"bones":["b_Head_05","b_Neck_04"]}"#,
        );
        apply(
            &mut adapter,
            r#"{"edit":"key_layer_weight","take":{"take":"Walk","layer":0},"time":0.2,"weight":1}"#,
        );
        apply(&mut adapter, r#"{"edit":"add_layer","take":"Walk","name":"Empty","kind":"override"}"#);
        apply(
            &mut adapter,
            r#"{"edit":"set_layer","take":{"take":"Walk","layer":1},"muted":true,"solo":true}"#,
        );
        let plan = file.plan(&adapter).unwrap();
        file.save(&adapter, &plan, &path).unwrap();

        let again = open(&path);
        assert_eq!(again.warnings, Vec::<String>::new());
        // A program that knows no layers plays what is seen.
        let played = &again.model.animation.takes[WALK];
        for step in 0..30 {
            let time = step as f32 * 0.025;
            assert_eq!(pose(&adapter, played, time), seen(&adapter, time), "{time} s");
        }
        let back = ModelAdapter::new(&again.model.animation);
        let (now, then) = (&adapter.slots()[WALK], &back.slots()[WALK]);
        assert_eq!(back.check(), Ok(()));
        assert!(now.result == then.result, "{kind}: keys of the take");
        for (now, then) in now.layers().iter().zip(then.layers()) {
            assert_eq!(now.settings, then.settings, "{kind}");
            assert!(now.keys.result.tracks == then.keys.result.tracks, "{kind}: keys of the layer");
        }
        assert_eq!(now.layers().len(), then.layers().len());
        // Nothing changes, so the file keeps its bytes.
        let plan = again.plan(&back).unwrap();
        assert_eq!(plan.files.last().unwrap().bytes, std::fs::read(&path).unwrap(), "{kind}");
    }
}

#[test]
fn deleting_the_layer_and_saving_gives_the_keys_of_the_first_file() {
    let folder = Folder::new("layers-delete");
    let (path, mut file, mut adapter) = fox(&folder);
    with_nod(&mut adapter, "additive");
    let plan = file.plan(&adapter).unwrap();
    file.save(&adapter, &plan, &path).unwrap();
    let mut again = open(&path);
    let mut back = ModelAdapter::new(&again.model.animation);
    apply(&mut back, r#"{"edit":"delete_layer","take":{"take":"Walk","layer":"Nod"}}"#);
    let plan = again.plan(&back).unwrap();
    again.save(&back, &plan, &path).unwrap();
    let (_, first, _) = fox(&Folder::new("layers-first"));
    assert!(open(&path).model.animation.takes == first.model.animation.takes);
}

#[test]
fn layers_whose_keys_another_program_has_changed_are_left_out_with_a_warning() {
    let folder = Folder::new("layers-foreign");
    let (path, mut file, mut adapter) = fox(&folder);
    with_nod(&mut adapter, "additive");
    let plan = file.plan(&adapter).unwrap();
    file.save(&adapter, &plan, &path).unwrap();
    // A program that knows no layers moves the head and keeps the extras.
    let mut other = open(&path);
    let mut animation = other.model.animation.clone();
    let text = animation.takes[WALK].extras.get("layers").unwrap().clone();
    Arc::make_mut(&mut animation.takes[WALK]).extras.set("layers", None);
    let mut moved = ModelAdapter::new(&animation);
    apply(
        &mut moved,
        r#"{"edit":"offset","take":"Walk","time":0.3,"poses":[{"bone":"b_Head_05","rotation":[0,0,0.6,0.8]}]}"#,
    );
    animation.takes[WALK] = {
        let mut take = Take::clone(moved.slots()[WALK].shown());
        take.extras.set("layers", Some(Arc::clone(&text)));
        Arc::new(take)
    };
    let foreign = ModelAdapter::new(&animation);
    let plan = other.plan(&foreign).unwrap();
    other.save(&foreign, &plan, &path).unwrap();

    let again = open(&path);
    let back = ModelAdapter::new(&again.model.animation);
    assert!(back.slots()[WALK].layers().is_empty());
    assert_eq!(back.slots()[WALK].original.extras.get("layers"), Some(&text), "the layers stay in the file");
    let model = dragonfly_document::load_model(
        &dragonfly_document::Source::File(path),
        &mut |_| {},
        &Default::default(),
    );
    let warnings = model.unwrap().warnings;
    assert!(warnings.iter().any(|text| text.contains("its layers do not fit its keys")), "{warnings:?}");
}

#[test]
fn merging_shows_the_same_as_before_and_leaves_no_layer() {
    for (kinds, merges) in [
        (["additive", "additive"], vec![r#"{"edit":"merge_layers","take":"Walk"}"#]),
        (["override", "additive"], vec![r#"{"edit":"merge_layers","take":"Walk"}"#]),
        (
            ["additive", "additive"],
            vec![
                r#"{"edit":"merge_layers","take":{"take":"Walk","layer":1}}"#,
                r#"{"edit":"merge_layers","take":{"take":"Walk","layer":0}}"#,
            ],
        ),
        (
            ["override", "override"],
            vec![
                r#"{"edit":"merge_layers","take":{"take":"Walk","layer":1}}"#,
                r#"{"edit":"merge_layers","take":{"take":"Walk","layer":0}}"#,
            ],
        ),
    ] {
        let folder = Folder::new("layers-merge");
        let (_, _, mut adapter) = fox(&folder);
        with_nod(&mut adapter, kinds[0]);
        apply(
            &mut adapter,
            &format!(r#"{{"edit":"add_layer","take":"Walk","name":"Up","kind":"{}"}}"#, kinds[1]),
        );
        // The upper layer of poses has no keys of a rotation, and the lower one none of a translation.
        let rotation = if kinds[0] == "override" { "" } else { r#","rotation":[0.6,0,0,0.8]"# };
        apply(
            &mut adapter,
            &format!(
                r#"{{"edit":"set","take":{{"take":"Walk","layer":"Up"}},"time":0.4,"poses":[{{"bone":"b_Head_05","translation":[1,2,3]{rotation}}}]}}"#
            ),
        );
        let before: Vec<Transform> = (0..60).map(|step| seen(&adapter, step as f32 * 0.0125)).collect();
        for merge in merges {
            apply(&mut adapter, merge);
            for (step, before) in before.iter().enumerate() {
                let now = seen(&adapter, step as f32 * 0.0125);
                let off =
                    angle(now.rotation, before.rotation) + (now.translation - before.translation).length();
                assert!(off < 2e-3, "{kinds:?}, {merge}, step {step}: off by {off}");
            }
        }
        assert!(adapter.slots()[WALK].layers().is_empty());
    }
}

#[test]
fn weight_mute_and_solo_decide_how_much_of_a_layer_is_seen() {
    let folder = Folder::new("layers-weight");
    let (_, _, mut adapter) = fox(&folder);
    let below = seen(&adapter, 0.5);
    apply(&mut adapter, r#"{"edit":"add_layer","take":"Walk","name":"Nod"}"#);
    nod(&mut adapter, 0.2, 0.8);
    let turned = |adapter: &ModelAdapter, time: f32| {
        angle(seen(adapter, time).rotation, pose(adapter, &adapter.slots()[WALK].result, time).rotation)
    };
    // One key is an offset at all times.
    assert!((turned(&adapter, 0.5) - 0.8).abs() < 0.02);
    apply(&mut adapter, r#"{"edit":"set_layer","take":{"take":"Walk","layer":"Nod"},"weight":0.5}"#);
    assert!((turned(&adapter, 0.5) - 0.4).abs() < 0.01);
    apply(
        &mut adapter,
        r#"{"edit":"key_layer_weight","take":{"take":"Walk","layer":"Nod"},"time":0.3,"weight":0}"#,
    );
    apply(
        &mut adapter,
        r#"{"edit":"key_layer_weight","take":{"take":"Walk","layer":"Nod"},"time":0.5,"weight":1}"#,
    );
    assert!(turned(&adapter, 0.3) < 1e-3 && (turned(&adapter, 0.4) - 0.4).abs() < 0.01);
    apply(&mut adapter, r#"{"edit":"set_layer","take":{"take":"Walk","layer":"Nod"},"muted":true}"#);
    assert_eq!(seen(&adapter, 0.5), below);
    apply(&mut adapter, r#"{"edit":"set_layer","take":{"take":"Walk","layer":"Nod"},"muted":false}"#);
    apply(&mut adapter, r#"{"edit":"add_layer","take":"Walk","name":"Other"}"#);
    apply(&mut adapter, r#"{"edit":"set_layer","take":{"take":"Walk","layer":"Other"},"solo":true}"#);
    assert_eq!(seen(&adapter, 0.5), below);
}

#[test]
fn what_no_key_of_a_layer_can_show_is_refused_with_the_reason() {
    let folder = Folder::new("layers-refused");
    let (_, _, mut adapter) = fox(&folder);
    apply(&mut adapter, r#"{"edit":"add_layer","take":"Walk","name":"Nod","bones":["b_Neck_04"]}"#);
    let set = r#"{"edit":"set","take":{"take":"Walk","layer":"Nod"},"time":0.1,"poses":[{"bone":"b_Head_05","translation":[1,2,3]}]}"#;
    let mut refused = |json: &str| adapter.apply(&edit(json)).err();
    assert!(matches!(refused(set), Some(EditError::Masked { .. })));
    assert!(matches!(refused(&set.replace(":\"Nod\"", ":5")), Some(EditError::NoTake(_))));
    assert!(matches!(
        refused(r#"{"edit":"split_take","take":{"take":"Walk","layer":0},"time":0.3,"name":"x"}"#),
        Some(EditError::OnLayer(_))
    ));
    assert!(matches!(refused(r#"{"edit":"delete_layer","take":"Walk"}"#), Some(EditError::NeedsLayer(_))));
    assert!(matches!(refused(r#"{"edit":"mirror_take","take":"Walk"}"#), Some(EditError::HasLayers(_))));
    let adapter = &mut adapter;
    apply(adapter, r#"{"edit":"set_layer","take":{"take":"Walk","layer":"Nod"},"bones":[],"muted":true}"#);
    assert!(matches!(adapter.apply(&edit(set)).err(), Some(EditError::MutedLayer(_))));
    apply(adapter, r#"{"edit":"set_layer","take":{"take":"Walk","layer":"Nod"},"muted":false,"weight":0}"#);
    assert!(matches!(adapter.apply(&edit(set)).err(), Some(EditError::HiddenByLayer(_))));
}

#[test]
fn a_take_that_is_slowed_down_or_trimmed_takes_its_layers_along() {
    let folder = Folder::new("layers-time");
    let (_, _, mut adapter) = fox(&folder);
    with_nod(&mut adapter, "additive");
    apply(
        &mut adapter,
        r#"{"edit":"key_layer_weight","take":{"take":"Walk","layer":0},"time":0.2,"weight":0.5}"#,
    );
    apply(
        &mut adapter,
        r#"{"edit":"key_layer_weight","take":{"take":"Walk","layer":0},"time":0.5,"weight":1}"#,
    );
    let length = adapter.slots()[WALK].original.length;
    let before: Vec<Transform> = (0..20).map(|step| seen(&adapter, step as f32 / 20.0 * length)).collect();
    apply(&mut adapter, &format!(r#"{{"edit":"retime_take","take":"Walk","length":{}}}"#, 2.0 * length));
    for (step, before) in before.iter().enumerate() {
        let now = seen(&adapter, step as f32 / 10.0 * length);
        assert!(angle(now.rotation, before.rotation) < 2e-3, "step {step}");
    }
    let before = seen(&adapter, 0.5);
    apply(&mut adapter, r#"{"edit":"trim_take","take":"Walk","from":0.3,"to":1.0,"to_start":true}"#);
    assert!(angle(seen(&adapter, 0.2).rotation, before.rotation) < 2e-3);
}

#[test]
fn an_edit_of_one_channel_of_a_layer_computes_only_that_channel_again() {
    let folder = Folder::new("layers-cost");
    let (_, _, mut adapter) = fox(&folder);
    with_nod(&mut adapter, "additive");
    apply(
        &mut adapter,
        r#"{"edit":"set","take":{"take":"Walk","layer":"Nod"},"time":0.1,"poses":[{"bone":"b_Neck_04","translation":[0,1,0]},{"bone":"b_Neck_04","rotation":[0,0,0,1]}]}"#,
    );
    apply(
        &mut adapter,
        r#"{"edit":"set","take":{"take":"Walk","layer":"Nod"},"time":0.2,"poses":[{"bone":"b_Neck_04","rotation":[0.6,0,0,0.8]}]}"#,
    );
    let neck = adapter.skeleton().find("b_Neck_04").unwrap() as usize;
    let before = Arc::clone(&adapter.slots()[WALK].shown().tracks[neck].rotation.values);
    nod(&mut adapter, 0.2, 0.1);
    assert!(Arc::ptr_eq(&before, &adapter.slots()[WALK].shown().tracks[neck].rotation.values));
    let mut edited = Edited::new(adapter.clone());
    let place = Vec3::new(0.0, 2.0, 0.0).to_array();
    let moved = edit(&format!(
        r#"{{"edit":"set","take":"Walk","time":0.1,"poses":[{{"bone":"b_Neck_04","translation":{place:?}}}]}}"#
    ));
    edited.apply(moved, None).unwrap();
    assert!(Arc::ptr_eq(&before, &edited.adapter().slots()[WALK].shown().tracks[neck].rotation.values));
}

#[test]
fn all_keys_of_a_weight_are_replaced_by_one_edit_and_wrong_ones_are_refused() {
    let folder = Folder::new("layers-weights");
    let (_, _, mut adapter) = fox(&folder);
    with_nod(&mut adapter, "additive");
    let below = pose(&adapter, &adapter.slots()[WALK].result, 0.3);
    let whole = seen(&adapter, 0.3);
    let set = |keys: &str| {
        edit(&format!(
            r#"{{"edit":"set_layer_weights","take":{{"take":"Walk","layer":"Nod"}},"keys":[{keys}]}}"#
        ))
    };
    let undo = adapter.apply(&set(r#"{"time":0.5,"weight":1},{"time":0.1,"weight":0}"#)).expect("applied");
    let weights = adapter.slots()[WALK].layers()[0].settings.weights.clone();
    assert_eq!(
        weights.iter().map(|key| (key.time, key.weight)).collect::<Vec<_>>(),
        [(0.1, 0.0), (0.5, 1.0)]
    );
    let half = seen(&adapter, 0.3).rotation;
    let parts = [angle(half, below.rotation), angle(half, whole.rotation)];
    assert!((parts[0] - parts[1]).abs() < 1e-3 && parts[0] > 0.1, "half way at half the weight: {parts:?}");
    for (keys, why) in [
        (r#"{"time":0.1,"weight":-1}"#, "weight"),
        (r#"{"time":0.1,"weight":11}"#, "weight"),
        (r#"{"time":1e9,"weight":1}"#, "time"),
        (r#"{"time":0.1,"weight":1},{"time":0.1,"weight":0}"#, "same time"),
        (r#"{"time":0.1,"weight":0},{"time":0.5,"weight":1}"#, "already"),
    ] {
        let error = adapter.apply(&set(keys)).expect_err(keys).to_string();
        assert!(error.contains(why), "{keys}: {error}");
    }
    let many = (0..10_001).map(|key| format!(r#"{{"time":{key},"weight":1}}"#)).collect::<Vec<_>>().join(",");
    let error = adapter.apply(&set(&many)).expect_err("too many").to_string();
    assert!(error.contains("10,000"), "{error}");
    adapter.revert(undo);
    assert_eq!(adapter.slots()[WALK].layers()[0].settings.weights, []);
    assert_eq!(seen(&adapter, 0.3), whole);
}
