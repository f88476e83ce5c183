//! Edits of many keys of shape keys: weights and tangents of several keys, offsets over a scope, pending weights, pasted keys. The file
//! AnimatedMorphCube has one mesh with two shape keys, and keys of them at every 1/30 s.

use crate::save_and_open::{assert_opens_again, open};
use dragonfly_anim::data::{AnimationData, Interpolation, MorphTrack};
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::Edit;
use dragonfly_kit::folder::{Folder, data};
use std::sync::Arc;

fn edit(line: &str) -> Edit {
    serde_json::from_str(line).expect(line)
}

/// Applies an edit, undoes it, and applies it again.
fn apply(adapter: &mut ModelAdapter, line: &str) {
    let before = state(adapter);
    let undo = adapter.apply(&edit(line)).unwrap_or_else(|error| panic!("{line}: {error}"));
    assert_eq!(adapter.check(), Ok(()), "{line}");
    let after = state(adapter);
    let redo = adapter.revert(undo);
    assert_eq!(state(adapter), before, "{line}: undone");
    adapter.revert(redo);
    assert_eq!(state(adapter), after, "{line}: redone");
}

fn state(adapter: &ModelAdapter) -> String {
    let slots = adapter.slots().iter();
    slots.map(|slot| format!("{:?} {:?}\n", slot.result.morphs, slot.pending())).collect()
}

fn track(adapter: &ModelAdapter) -> MorphTrack {
    adapter.slots()[0].result.morphs[0].clone()
}

/// Returns a model with four linear keys, a second apart, of two shape keys.
fn four_keys(interpolation: Interpolation) -> ModelAdapter {
    let editable = open(&data("gltf/AnimatedMorphCube.glb"));
    let model = ModelAdapter::of(&editable.model);
    let mut take = dragonfly_anim::data::Take::clone(&model.slots()[0].result);
    let values: [[f32; 2]; 4] = [[0.0, 0.5], [0.25, 0.5], [1.0, 0.5], [0.5, 0.5]];
    let key = |value: &[f32; 2]| match interpolation {
        Interpolation::CubicSpline => [[0.0; 2], *value, [0.0; 2]].concat(),
        _ => value.to_vec(),
    };
    take.morphs[0].times = [0.0, 1.0, 2.0, 3.0].into();
    take.morphs[0].weights = values.iter().flat_map(key).collect();
    take.morphs[0].interpolation = interpolation;
    (take.start, take.length) = (0.0, 3.0);
    let skeleton = Arc::clone(model.skeleton());
    let animation = AnimationData { skeleton, takes: vec![Arc::new(take)] };
    ModelAdapter::new(&animation).with_shapes(model.shapes().clone())
}

/// Returns the times with the weights of the first and of the second shape key.
fn keys(adapter: &ModelAdapter) -> Vec<(f32, f32, f32)> {
    let track = track(adapter);
    track
        .times
        .iter()
        .enumerate()
        .map(|(key, &time)| (time, track.weights[2 * key], track.weights[2 * key + 1]))
        .collect()
}

#[test]
fn several_keys_get_weights_in_one_step_and_a_new_key_keeps_the_other_weight() {
    let mut model = four_keys(Interpolation::Linear);
    apply(
        &mut model,
        r#"{"edit":"set_shape_keys","take":0,"keys":[{"time":1,"shape":0,"weight":0.75},{"time":2.5,"shape":1,"weight":0.125}]}"#,
    );
    // At 2.5 s the first weight is in the middle between 1 and 0.5.
    assert_eq!(
        keys(&model),
        [(0.0, 0.0, 0.5), (1.0, 0.75, 0.5), (2.0, 1.0, 0.5), (2.5, 0.75, 0.125), (3.0, 0.5, 0.5)]
    );
}

#[test]
fn only_keys_of_splines_have_tangents() {
    let line = r#"{"edit":"set_shape_keys","take":0,"keys":[{"time":1,"shape":1,"in":2.0,"out":-3.0}]}"#;
    let mut spline = four_keys(Interpolation::CubicSpline);
    apply(&mut spline, line);
    assert_eq!(track(&spline).weights[6..12], [0.0, 2.0, 0.25, 0.5, 0.0, -3.0]);
    let mut linear = four_keys(Interpolation::Linear);
    assert_eq!(
        linear.apply(&edit(line)).map(drop),
        Err(EditError::Nothing("only keys of cubic splines have tangents"))
    );
}

#[test]
fn an_offset_over_the_whole_take_moves_every_key_by_the_same_amount() {
    let mut model = four_keys(Interpolation::Linear);
    // At 0.5 s the first weight is 0.125: all keys rise by a half.
    apply(
        &mut model,
        r#"{"edit":"offset_shapes","take":0,"at":0.5,"shapes":[{"shape":0,"weight":0.625}],"over":"take"}"#,
    );
    assert_eq!(keys(&model), [(0.0, 0.5, 0.5), (1.0, 0.75, 0.5), (2.0, 1.5, 0.5), (3.0, 1.0, 0.5)]);
}

#[test]
fn an_offset_of_selected_keys_leaves_the_others_and_a_falloff_fades_it_out() {
    let mut model = four_keys(Interpolation::Linear);
    apply(
        &mut model,
        r#"{"edit":"offset_shapes","take":0,"shapes":[{"shape":0,"weight":0.5}],"over":{"keys":[[0.9,1.1]]}}"#,
    );
    assert_eq!(keys(&model)[0..3], [(0.0, 0.0, 0.5), (1.0, 0.75, 0.5), (2.0, 1.0, 0.5)]);
    let mut model = four_keys(Interpolation::Linear);
    apply(
        &mut model,
        r#"{"edit":"offset_shapes","take":0,"shapes":[{"shape":1,"weight":1}],"over":{"keys":[[0,0]]},"falloff":{"seconds":2,"shape":"linear"}}"#,
    );
    let second: Vec<f32> = keys(&model).iter().map(|key| key.2).collect();
    assert!((second[1] - 1.0).abs() < 1e-4, "half of it a second away: {second:?}");
    assert_eq!([second[0], second[2], second[3]], [1.5, 0.5, 0.5]);
}

#[test]
fn an_offset_over_a_range_changes_nothing_beyond_its_falloff() {
    let mut model = four_keys(Interpolation::Linear);
    apply(
        &mut model,
        r#"{"edit":"offset_shapes","take":0,"shapes":[{"shape":1,"weight":0.25}],"over":{"range":{"from":1.5,"to":2.5}},"falloff":{"seconds":0.25,"shape":"linear"}}"#,
    );
    let second: Vec<(f32, f32)> = keys(&model).iter().map(|key| (key.0, key.2)).collect();
    assert_eq!(
        second,
        [(0.0, 0.5), (1.0, 0.5), (1.25, 0.5), (1.5, 0.75), (2.0, 0.75), (2.5, 0.75), (2.75, 0.5), (3.0, 0.5)]
    );
}

#[test]
fn pending_weights_are_in_no_key_until_they_are_keyed() {
    let mut model = four_keys(Interpolation::Linear);
    let before = keys(&model);
    apply(&mut model, r#"{"edit":"pend_shapes","take":0,"time":0.5,"shapes":[{"shape":1,"weight":0.875}]}"#);
    assert_eq!((keys(&model), model.pending_poses()), (before.clone(), 1));
    let mut dropped = model.clone();
    apply(&mut dropped, r#"{"edit":"drop_pending","take":0}"#);
    assert_eq!((keys(&dropped), dropped.pending_poses()), (before.clone(), 0));
    apply(&mut model, r#"{"edit":"key_pending","take":0,"time":0.5}"#);
    assert_eq!((keys(&model)[1], model.pending_poses()), ((0.5, 0.125, 0.875), 0));
    // A weight that is set replaces the pending one; a retimed take moves it.
    apply(&mut model, r#"{"edit":"pend_shapes","take":0,"time":1.5,"shapes":[{"shape":0,"weight":2}]}"#);
    apply(&mut model, r#"{"edit":"set_shapes","take":0,"time":1.5,"shapes":[{"shape":0,"weight":1}]}"#);
    assert_eq!(model.pending_poses(), 0);
    apply(&mut model, r#"{"edit":"pend_shapes","take":0,"time":1,"shapes":[{"shape":0,"weight":2}]}"#);
    apply(&mut model, r#"{"edit":"ripple","take":0,"from":0.9,"by":1}"#);
    assert_eq!(model.slots()[0].pending()[0].time, 2.0);
}

#[test]
fn keys_are_pasted_by_the_names_of_the_shape_keys_and_overwrite_keys_at_their_times() {
    let paste = |mesh: &str, shapes: &str| {
        format!(
            r#"{{"edit":"paste_keys","take":0,"time":1,"channels":[],"shapes":[{{"mesh":"{mesh}","shapes":{shapes},"interpolation":"linear","keys":[{{"after":0,"weights":[0.125,2]}},{{"after":0.5,"weights":[0.25,2]}}]}}]}}"#
        )
    };
    // A mesh of another name, and a shape key that this model does not have.
    let mut model = four_keys(Interpolation::Linear);
    apply(&mut model, &paste("Face", r#"["Shape 2","smile"]"#));
    assert_eq!(
        keys(&model),
        [(0.0, 0.0, 0.5), (1.0, 0.25, 0.125), (1.5, 0.625, 0.25), (2.0, 1.0, 0.5), (3.0, 0.5, 0.5)]
    );
    assert!(model.apply(&edit(&paste("Face", r#"["smile","frown"]"#))).is_err());
    // Without tangents, keys of a spline get smooth ones: the slope from the key before to the key after.
    let mut spline = four_keys(Interpolation::CubicSpline);
    apply(&mut spline, &paste("Cube", r#"["Shape 2","Shape 1"]"#));
    let track = track(&spline);
    let slope = (0.5 - 0.125) / 1.0;
    assert_eq!([track.weights[13], track.weights[17]], [slope; 2], "{:?}", track.weights);
}

#[test]
fn edited_shape_keys_are_in_the_saved_file() {
    let folder = Folder::new("shape-key-edits-saved");
    let mut editable = open(&data("gltf/AnimatedMorphCube.glb"));
    let mut model = ModelAdapter::of(&editable.model);
    for line in [
        r#"{"edit":"set_shape_keys","take":0,"keys":[{"time":0.05,"shape":"Shape 1","weight":0.75}]}"#,
        r#"{"edit":"offset_shapes","take":0,"shapes":[{"shape":"Shape 2","weight":0.25}],"over":"take"}"#,
    ] {
        apply(&mut model, line);
    }
    let (before, after) = (editable.model.animation.takes[0].morphs[0].clone(), track(&model));
    assert!((after.weights[1] - before.weights[1] - 0.25).abs() < 1e-6);
    let output = folder.join("saved.glb");
    let plan = editable.plan(&model).expect("glTF has weights");
    editable.save(&model, &plan, &output).unwrap_or_else(|error| panic!("{error}"));
    assert_opens_again(&output, &model, "shape keys");
}
