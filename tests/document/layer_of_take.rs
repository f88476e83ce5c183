//! A layer of poses gets the keys of another take, such as one that was retargeted, and can be weighted and masked like any layer.

use crate::fox_edits::{apply, edit, fox_takes};
use dragonfly_anim::data::Transform;
use dragonfly_anim::sample::sample_take;
use dragonfly_document::adapter::ModelAdapter;

const SURVEY: usize = 0;
const WALK: usize = 1;

fn poses(model: &ModelAdapter, take: usize, time: f32) -> Vec<Transform> {
    let mut poses = vec![Transform::IDENTITY; model.skeleton().len()];
    sample_take(Some(model.slots()[take].shown()), model.skeleton(), time, &mut poses);
    poses
}

fn apart(a: &Transform, b: &Transform) -> f32 {
    (a.translation - b.translation).length() + a.rotation.angle_between(b.rotation)
}

#[test]
fn a_layer_from_a_take_shows_that_take_where_it_has_keys_and_undo_removes_it() {
    let mut model = fox_takes();
    let before = model.slots()[WALK].result.clone();
    let line = r#"{"edit":"add_layer","take":"Walk","name":"Look","kind":"override","keys_of":"Survey"}"#;
    let undo = model.apply(&edit(line)).expect("a layer");
    assert_eq!(model.check(), Ok(()));
    let moved = |bone: usize| !model.slots()[SURVEY].result.tracks[bone].is_empty();
    for step in 0..20 {
        let time = step as f32 * 0.03;
        let (now, other) = (poses(&model, WALK, time), poses(&model, SURVEY, time));
        for bone in (0..now.len()).filter(|&bone| moved(bone)) {
            assert!(apart(&now[bone], &other[bone]) < 2e-3, "bone {bone} at {time} s");
        }
    }
    assert_eq!(model.slots()[WALK].result, before, "the keys of the take stay");
    model.revert(undo);
    assert!(model.slots()[WALK].layers().is_empty());
    // A mask leaves all other bones to the take.
    apply(
        &mut model,
        r#"{"edit":"add_layer","take":"Walk","name":"Look","kind":"override","bones":["b_Head_05"],"keys_of":"Survey"}"#,
    );
    let head = model.skeleton().find("b_Head_05").expect("a head") as usize;
    let masked = poses(&model, WALK, 0.3);
    let plain = poses(&fox_takes(), WALK, 0.3);
    for bone in 0..masked.len() {
        assert_eq!(apart(&masked[bone], &plain[bone]) > 1e-3, bone == head, "bone {bone}");
    }
}

#[test]
fn offsets_and_the_take_itself_cannot_be_the_keys_of_a_layer() {
    let mut model = fox_takes();
    for (line, reason) in [
        (r#"{"edit":"add_layer","take":"Walk","name":"Look","keys_of":"Survey"}"#, "layer of poses"),
        (
            r#"{"edit":"add_layer","take":"Walk","name":"Look","kind":"override","keys_of":"Walk"}"#,
            "its own take",
        ),
        (r#"{"edit":"add_layer","take":"Walk","name":"Look","kind":"override","keys_of":"Nod"}"#, "no take"),
    ] {
        let error = model.apply(&edit(line)).expect_err(line).to_string();
        assert!(error.contains(reason), "{line}: {error}");
    }
}
