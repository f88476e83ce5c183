//! Weights of shape keys are set at a time, their keys are moved, copied, scaled and snapped, and the saved file has them. The file
//! AnimatedMorphCube has one mesh with two shape keys, and keys of them at every 1/30 s.

use crate::save_and_open::{assert_opens_again, open};
use dragonfly_anim::data::MorphTrack;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::{Edit, ShapeRef};
use dragonfly_document::{Editable, ModelShapes};
use dragonfly_kit::folder::{Folder, data};

fn edit(line: &str) -> Edit {
    serde_json::from_str(line).expect(line)
}

fn apply(adapter: &mut ModelAdapter, line: &str) {
    adapter.apply(&edit(line)).unwrap_or_else(|error| panic!("{line}: {error}"));
    assert_eq!(adapter.check(), Ok(()), "{line}");
}

fn cube() -> (Editable, ModelAdapter) {
    let editable = open(&data("gltf/AnimatedMorphCube.glb"));
    let adapter = ModelAdapter::of(&editable.model);
    (editable, adapter)
}

fn track(adapter: &ModelAdapter) -> MorphTrack {
    adapter.slots()[0].result.morphs[0].clone()
}

#[test]
fn shape_keys_have_the_names_of_the_file() {
    let (editable, _) = cube();
    let shapes = ModelShapes::of(&editable.model);
    let [mesh] = shapes.meshes() else { panic!("{shapes:?}") };
    assert_eq!((mesh.name(), mesh.rest()), ("Cube", &[0.0, 0.0][..]));
    assert_eq!(mesh.shapes(), ["Shape 1", "Shape 2"], "the file has no names");
    let robot = ModelShapes::of(&open(&data("collection/RobotExpressive.glb")).model);
    let named = robot.meshes().iter().find(|mesh| mesh.shapes().len() == 3).expect("a face");
    assert_eq!(named.shapes(), ["Angry", "Surprised", "Sad"]);
}

#[test]
fn a_weight_between_keys_becomes_a_key_that_keeps_the_other_weights() {
    let (_, mut adapter) = cube();
    let before = track(&adapter);
    // Halfway between two keys, the first weight was their mean, the second 0.
    let time = (before.times[1] + before.times[2]) / 2.0;
    apply(
        &mut adapter,
        &format!(
            r#"{{"edit":"set_shapes","take":0,"time":{time},"shapes":[{{"shape":"Shape 2","weight":0.6}}]}}"#
        ),
    );
    let after = track(&adapter);
    assert_eq!(after.times.len(), 128);
    assert!((after.times[2] - time).abs() < 1e-6);
    let mean = (0.001_284 + 0.005_063_657) / 2.0;
    assert!((after.weights[4] - mean).abs() < 1e-6, "{} is not {mean}", after.weights[4]);
    assert_eq!(after.weights[5], 0.6);
    assert_eq!((&after.weights[..4], &after.weights[6..]), (&before.weights[..4], &before.weights[4..]));
    // At a key, only the given weight changes.
    let at = before.times[3];
    apply(
        &mut adapter,
        &format!(
            r#"{{"edit":"set_shapes","take":0,"time":{at},"shapes":[{{"mesh":"Cube","shape":0,"weight":-2}}]}}"#
        ),
    );
    let changed = track(&adapter);
    assert_eq!((changed.times.len(), changed.weights[8], changed.weights[9]), (128, -2.0, after.weights[9]));
}

#[test]
fn a_mesh_that_a_take_does_not_animate_gets_its_first_key_with_its_own_weights() {
    let (_, mut adapter) = cube();
    apply(&mut adapter, r#"{"edit":"create_take","name":"Smile"}"#);
    let take = adapter.slots().len() - 1;
    let set = format!(
        r#"{{"edit":"set_shapes","take":{take},"time":0.5,"shapes":[{{"shape":"Shape 2","weight":1}}]}}"#
    );
    let undo = adapter.apply(&edit(&set)).expect("a shape key");
    let new = &adapter.slots()[take].result.morphs;
    assert_eq!((new[0].targets, &new[0].times[..], &new[0].weights[..]), (2, &[0.5][..], &[0.0, 1.0][..]));
    adapter.revert(undo);
    assert_eq!(adapter.slots()[take].result.morphs, []);
}

#[test]
fn a_key_of_a_spline_between_others_leaves_its_curve_as_it_is() {
    let (_, mut adapter) = cube();
    let mut animation = dragonfly_anim::data::AnimationData {
        skeleton: adapter.skeleton().clone(),
        takes: vec![adapter.slots()[0].result.clone()],
    };
    let take = std::sync::Arc::make_mut(&mut animation.takes[0]);
    take.morphs[0] = MorphTrack {
        instance: 0,
        targets: 2,
        times: [0.0, 1.0].into(),
        // In-tangents, values, out-tangents of two shape keys.
        weights: [0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0].into(),
        interpolation: dragonfly_anim::data::Interpolation::CubicSpline,
    };
    (take.start, take.length) = (0.0, 1.0);
    let shapes = adapter.shapes().clone();
    adapter = ModelAdapter::new(&animation).with_shapes(shapes);
    apply(
        &mut adapter,
        r#"{"edit":"set_shapes","take":0,"time":0.5,"shapes":[{"shape":"Shape 2","weight":0.5}]}"#,
    );
    let after = track(&adapter);
    // Hermite at 1/2: value p0/2 + p1/2 + (m0 - m1)/8 = 0.5 + 0.25; slope 1.5 (p1 - p0) - (m0 + m1)/4 = 1.5 - 0.5.
    assert_eq!(after.weights[6..12], [1.0, 1.5, 0.75, 0.5, 1.0, 1.5]);
}

#[test]
fn keys_of_shape_keys_are_moved_copied_scaled_and_snapped() {
    let (_, mut adapter) = cube();
    let before = track(&adapter);
    let last = before.times[126];
    apply(
        &mut adapter,
        &format!(r#"{{"edit":"move_keys","take":0,"keys":[],"shapes":[[{last},{last}]],"by":0.5}}"#),
    );
    let moved = track(&adapter);
    assert_eq!((moved.times[126], &moved.weights), (last + 0.5, &before.weights));
    apply(&mut adapter, r#"{"edit":"duplicate_keys","take":0,"keys":[],"shapes":[[0.0,0.04]],"by":10}"#);
    let copied = track(&adapter);
    assert_eq!(
        (copied.times.len(), copied.times[127], copied.times[128]),
        (129, 10.0, before.times[1] + 10.0)
    );
    assert_eq!(copied.weights[254..], before.weights[..4]);
    apply(
        &mut adapter,
        r#"{"edit":"scale_keys","take":0,"keys":[],"shapes":[[9.0,11.0]],"about":10,"factor":-3}"#,
    );
    let scaled = track(&adapter);
    assert_eq!((scaled.times[128], &scaled.weights[254..]), (10.0, &[before.weights[2], 0.0, 0.0, 0.0][..]));
    assert!((scaled.times[127] - 9.9).abs() < 1e-4, "{}", scaled.times[127]);
    apply(&mut adapter, r#"{"edit":"snap_keys","take":0,"keys":[],"shapes":[[9.0,9.95]],"rate":4}"#);
    // 9.9 s is nearest to 10 s, where a key is overwritten.
    let snapped = track(&adapter);
    assert_eq!(
        (snapped.times.len(), snapped.times[127], snapped.weights[254]),
        (128, 10.0, before.weights[2])
    );
}

#[test]
fn a_moved_key_overwrites_the_one_at_its_new_time() {
    let (_, mut adapter) = cube();
    let before = track(&adapter);
    let by = before.times[2] - before.times[1];
    apply(
        &mut adapter,
        &format!(r#"{{"edit":"move_keys","take":0,"keys":[],"shapes":[[0.03,0.04]],"by":{by}}}"#),
    );
    let after = track(&adapter);
    assert_eq!(after.times.len(), 126);
    assert_eq!(after.weights[2..4], before.weights[2..4]);
    assert_eq!(after.weights[4..], before.weights[6..]);
}

#[test]
fn a_wrong_edit_of_shape_keys_is_refused_with_the_reason() {
    let (_, mut adapter) = cube();
    let mut refused = |line: &str| adapter.apply(&edit(line)).map(drop).expect_err(line);
    let set = |shape: &str, weight: &str| {
        format!(
            r#"{{"edit":"set_shapes","take":0,"time":0.5,"shapes":[{{"shape":{shape},"weight":{weight}}}]}}"#
        )
    };
    assert_eq!(refused(&set("\"frown\"", "1")), EditError::NoShape(ShapeRef::Name("frown".to_owned())));
    assert_eq!(refused(&set("2", "1")).to_string(), "there is no shape key 2");
    assert_eq!(refused(&set("0", "1e30")).to_string(), "a weight cannot be 1000000000000000000000000000000");
    assert_eq!(
        refused(r#"{"edit":"set_shapes","take":0,"time":-1,"shapes":[{"shape":0,"weight":1}]}"#),
        EditError::BeforeZero(-1.0)
    );
    assert_eq!(
        refused(r#"{"edit":"set_shapes","take":0,"time":1,"shapes":[]}"#),
        EditError::Nothing("no shape key is given")
    );
    assert_eq!(
        refused(r#"{"edit":"move_keys","take":0,"keys":[],"shapes":[[50,60]],"by":1}"#),
        EditError::Nothing("no key is selected")
    );
}

#[test]
fn the_saved_file_has_the_weights_and_every_byte_that_was_not_edited() {
    let folder = Folder::new("shape-keys-saved");
    let (mut editable, mut adapter) = cube();
    for line in [
        r#"{"edit":"set_shapes","take":0,"time":0.05,"shapes":[{"shape":"Shape 1","weight":0.75}]}"#,
        r#"{"edit":"create_take","name":"Smile"}"#,
        r#"{"edit":"set_shapes","take":"Smile","time":0,"shapes":[{"shape":"Shape 2","weight":0.25}]}"#,
        r#"{"edit":"set_shapes","take":"Smile","time":1,"shapes":[{"shape":"Shape 2","weight":1}]}"#,
    ] {
        apply(&mut adapter, line);
    }
    let output = folder.join("saved.glb");
    let plan = editable.plan(&adapter).expect("glTF has weights");
    editable.save(&adapter, &plan, &output).unwrap_or_else(|error| panic!("{error}"));
    assert_opens_again(&output, &adapter, "shape keys");
    let again = open(&output);
    let smile = &again.model.animation.takes[1].morphs[0];
    assert_eq!((&smile.times[..], &smile.weights[..]), (&[0.0, 1.0][..], &[0.0, 0.25, 0.0, 1.0][..]));
    assert_eq!(again.model.animation.takes[0].morphs[0].times.len(), 128);
    // The binary chunk begins with that of the original.
    let binary = |path: &std::path::Path| {
        let bytes = std::fs::read(path).expect("a file");
        let json = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        bytes[20 + json + 8..].to_vec()
    };
    let (old, new) = (binary(&data("gltf/AnimatedMorphCube.glb")), binary(&output));
    assert!(new.len() > old.len() && new[..old.len()] == old[..], "{} {}", old.len(), new.len());
}
