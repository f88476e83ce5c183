//! Smoothing holds feet in the contacts that are stored with the take.

use crate::fox_edits::{apply, edit, fox_takes};
use dragonfly_anim::contact::{Contact, contact_slide};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::motion::Axis;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::EditedBones;
use std::sync::Arc;

const LEFT: &str = "b_LeftFoot01_017";
const RIGHT: &str = "b_RightFoot01_021";
const CONTACTS: [(&str, f32, f32); 2] = [(LEFT, 0.1, 0.2), (RIGHT, 0.4, 0.6)];

/// Returns the fox, whose feet do not move in two contacts of its walk.
fn planted() -> ModelAdapter {
    let mut model = fox_takes();
    let spans: Vec<String> = CONTACTS
        .iter()
        .map(|(bone, from, to)| format!(r#"{{"bone":"{bone}","from":{from},"to":{to}}}"#))
        .collect();
    apply(
        &mut model,
        &format!(r#"{{"edit":"set_contacts","take":"Walk","contacts":[{}]}}"#, spans.join(",")),
    );
    apply(&mut model, r#"{"edit":"lock_contacts","take":"Walk","ease":3}"#);
    model
}

/// Returns the largest slide of a foot in its contact, and its largest distance from where it was planted: millimeters, for a fox in
/// centimeters.
fn slide(model: &ModelAdapter, planted: &ModelAdapter) -> [f32; 2] {
    let frames = |model: &ModelAdapter| {
        TakeFrames::of(&model.slots()[1].result, model.skeleton(), 120.0).expect("frames")
    };
    let (now, was) = (frames(model), frames(planted));
    let (mut slide, mut away) = (0.0_f32, 0.0_f32);
    for (name, from, to) in CONTACTS {
        let bone = model.skeleton().find(name).expect("a bone");
        slide = slide.max(contact_slide(&now, &Contact { bone, from, to }, Axis::Y, 0.01).millimeters);
        for frame in (from * 120.0).ceil() as usize..=(to * 120.0) as usize {
            away = away.max(10.0 * now.position(frame, bone).distance(was.position(frame, bone)));
        }
    }
    [slide, away]
}

#[test]
fn smoothed_feet_stay_where_they_are_planted_and_slide_without_the_option() {
    let before = planted();
    let [slides, _] = slide(&before, &before);
    assert!(slides < 1.0, "{slides}");
    for tool in [
        r#""edit":"filter_keys","filter":{"gaussian":0.1}"#,
        r#""edit":"filter_keys","filter":{"butterworth":{"cutoff":3,"order":2}}"#,
        r#""edit":"filter_keys","filter":{"peaks":{"window":9,"threshold":0}}"#,
        r#""edit":"blend_keys","toward":"average","factor":2"#,
        r#""edit":"noise_keys","rotation":3,"translation":0.5,"frequency":8,"seed":3"#,
    ] {
        let line =
            |hold: &str| format!(r#"{{{tool},"take":"Walk","keys":[{{}}],"shapes":[],"hold":[{hold}]}}"#);
        let mut free = before.clone();
        apply(&mut free, &line(""));
        let mut held = before.clone();
        let both = line(&format!(r#""{LEFT}","{RIGHT}""#));
        let undo = held.apply(&edit(&both)).expect(&both);
        held.check().expect("an invariant");
        let [loose, loose_away] = slide(&free, &before);
        let [kept, kept_away] = slide(&held, &before);
        println!("{tool}: {loose} and {loose_away} mm, held {kept} and {kept_away} mm");
        assert!(kept < 2.0 && kept_away < 2.0, "{tool}: {kept} {kept_away}");
        assert!(loose > 5.0 && loose_away > 5.0, "{tool}: {loose} {loose_away}");
        // The rest of the body moves as without the option.
        let head = held.skeleton().find("b_Head_05").expect("a head") as usize;
        assert_eq!(held.slots()[1].result.tracks[head], free.slots()[1].result.tracks[head]);
        held.revert(undo);
        assert_eq!(held.slots()[1].result, before.slots()[1].result, "{tool}");
        assert_eq!(held.slots()[1].original, before.slots()[1].original, "{tool}");
    }
}

#[test]
fn feet_that_an_edit_does_not_move_keep_their_keys() {
    let before = planted();
    let mut after = before.clone();
    let line = format!(
        r#"{{"edit":"filter_keys","take":"Walk","keys":[{{"bones":["b_Head_05"]}}],"filter":{{"gaussian":0.1}},"hold":["{LEFT}","{RIGHT}"]}}"#
    );
    apply(&mut after, &line);
    let [a, b] = [&before, &after].map(|model| Arc::clone(&model.slots()[1].result));
    for (bone, (a, b)) in a.tracks.iter().zip(&b.tracks).enumerate() {
        let is_head = before.skeleton().find("b_Head_05") == Some(bone as u32);
        assert_eq!(a == b, !is_head, "bone {bone}");
    }
    // The limbs count as changed, so that locks protect them.
    let EditedBones::Named(bones) = edit(&line).bones(before.skeleton()) else { panic!("all bones") };
    assert_eq!(bones.len(), 1 + 3 + 3);
}

#[test]
fn feet_cannot_be_held_in_layers_or_by_unknown_bones() {
    let mut model = planted();
    let line = |take: &str, foot: &str| {
        let line = format!(
            r#"{{"edit":"filter_keys","take":{take},"keys":[{{}}],"filter":{{"gaussian":0.1}},"hold":[{foot}]}}"#
        );
        edit(&line)
    };
    let foot = format!(r#""{LEFT}""#);
    assert!(matches!(model.apply(&line(r#""Walk""#, r#""nobody""#)), Err(EditError::NoBone(_))));
    apply(&mut model, r#"{"edit":"add_layer","take":"Walk","name":"Up"}"#);
    let layered = model.apply(&line(r#""Walk""#, &foot)).expect_err("has layers").to_string();
    let layer = model.apply(&line(r#"{"take":"Walk","layer":0}"#, &foot)).expect_err("a layer").to_string();
    assert!(layered.contains("Hold feet") && layer.contains("Hold feet"), "{layered} {layer}");
    model.apply(&line(r#""Walk""#, "")).expect("without the option");
}
