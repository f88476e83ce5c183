//! Contacts that are stored with a take: found, set, kept by edits of time, used by edits of motion, saved with the file.

use crate::fox_edits::{apply, edit, fox_takes};
use crate::save_and_open::open;
use dragonfly_anim::contact::{Contact, contact_slide};
use dragonfly_anim::data::Take;
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::motion::Axis;
use dragonfly_document::adapter::{CONTACTS, ModelAdapter, stored_contacts};
use dragonfly_document::edit::EditedBones;
use dragonfly_kit::document::test_document::fox;
use dragonfly_kit::folder::Folder;
use std::sync::Arc;

const LEFT: &str = "b_LeftFoot01_017";
const RIGHT: &str = "b_RightFoot01_021";

/// Returns the contacts of a take: foot, start and end.
fn spans(model: &ModelAdapter, take: usize) -> Vec<(&'static str, f32, f32)> {
    let skeleton = model.skeleton();
    let track = stored_contacts(&model.slots()[take].original.extras, skeleton);
    let round = |time: f32| (time * 1e4).round() / 1e4;
    let foot = |contact: &Contact| {
        let name = &skeleton.bones[contact.bone as usize].name;
        [LEFT, RIGHT].into_iter().find(|foot| foot == name).unwrap_or("another bone")
    };
    track.contacts().iter().map(|contact| (foot(contact), round(contact.from), round(contact.to))).collect()
}

fn with_contacts() -> ModelAdapter {
    let mut model = fox_takes();
    let line = format!(
        r#"{{"edit":"set_contacts","take":"Walk","contacts":[{{"bone":"{LEFT}","from":0.1,"to":0.2}},{{"bone":"{RIGHT}","from":0.4,"to":0.6}}]}}"#
    );
    apply(&mut model, &line);
    model
}

#[test]
fn contacts_are_stored_as_readable_json_and_an_undo_removes_them() {
    let mut model = fox_takes();
    let line = format!(
        r#"{{"edit":"set_contacts","take":"Walk","contacts":[{{"bone":"{LEFT}","from":0.25,"to":0.5}}]}}"#
    );
    let undo = model.apply(&edit(&line)).expect("applied");
    let text = model.slots()[1].result.extras.get(CONTACTS).expect("a text").to_string();
    let node =
        model.skeleton().bones[model.skeleton().find(LEFT).expect("a bone") as usize].node.expect("a node");
    let wanted =
        format!(r#"{{"version":1,"bones":[{{"bone":"{LEFT}","node":{node},"spans":[[0.25,0.5]]}}]}}"#);
    assert_eq!(text, wanted);
    assert!(model.apply(&edit(&line)).is_err(), "it has them already");
    assert_eq!(edit(&line).bones(model.skeleton()), EditedBones::WholeTake);
    model.revert(undo);
    assert_eq!(model.slots()[1].result.extras.get(CONTACTS), None);
}

#[test]
fn a_text_that_is_no_record_of_contacts_counts_as_none() {
    let mut model = fox_takes();
    for value in [
        r#""text""#,
        "[1]",
        r#"{"version":2,"bones":[{"bone":"b_Hip_01","spans":[[0,1]]}]}"#,
        r#"{"version":1,"bones":[{"bone":"nobody","spans":[[0,1]]}]}"#,
        r#"{"version":1,"bones":[{"bone":"b_Hip_01","spans":[[1,0],[3,3]]}]}"#,
    ] {
        apply(
            &mut model,
            &format!(r#"{{"edit":"set_extras","take":"Walk","name":"contacts","value":{value}}}"#),
        );
        assert_eq!(spans(&model, 1), [], "{value}");
        apply(&mut model.clone(), r#"{"edit":"reverse_take","take":"Walk"}"#);
    }
}

#[test]
fn contacts_follow_edits_of_time() {
    let length = fox_takes().slots()[1].result.length;
    for (line, wanted) in [
        (
            r#"{"edit":"reverse_take","take":"Walk"}"#.to_owned(),
            [(LEFT, length - 0.2, length - 0.1), (RIGHT, length - 0.6, length - 0.4)],
        ),
        (
            format!(r#"{{"edit":"retime_take","take":"Walk","start":1,"length":{}}}"#, 2.0 * length),
            [(LEFT, 1.2, 1.4), (RIGHT, 1.8, 2.2)],
        ),
        (
            r#"{"edit":"trim_take","take":"Walk","from":0.15,"to":0.5,"to_start":true}"#.to_owned(),
            [(LEFT, 0.0, 0.05), (RIGHT, 0.25, 0.35)],
        ),
        (
            r#"{"edit":"ripple","take":"Walk","from":0.3,"by":0.5}"#.to_owned(),
            [(LEFT, 0.1, 0.2), (RIGHT, 0.9, 1.1)],
        ),
        (r#"{"edit":"mirror_take","take":"Walk"}"#.to_owned(), [(LEFT, 0.4, 0.6), (RIGHT, 0.1, 0.2)]),
    ] {
        let before = with_contacts();
        let mut model = before.clone();
        let undo = model.apply(&edit(&line)).expect(&line);
        for ((name, from, to), wanted) in spans(&model, 1).into_iter().zip(wanted) {
            let near = (from - wanted.1).abs() < 2e-4 && (to - wanted.2).abs() < 2e-4;
            assert!(name == wanted.0 && near, "{line}: {name} {from} {to}, not {wanted:?}");
        }
        assert_eq!(spans(&model, 1).len(), 2, "{line}");
        model.revert(undo);
        assert_eq!(spans(&model, 1), spans(&before, 1), "{line}");
    }
}

#[test]
fn both_parts_of_a_split_take_and_a_copy_have_their_contacts() {
    let mut model = with_contacts();
    apply(&mut model, r#"{"edit":"create_take","name":"Walk 2","copy":"Walk"}"#);
    let copy = model.slots().iter().position(|slot| slot.result.name == "Walk 2").expect("the copy");
    assert_eq!(spans(&model, copy), spans(&model, 1));
    apply(&mut model, r#"{"edit":"split_take","take":"Walk","time":0.5,"name":"End"}"#);
    assert_eq!(spans(&model, 1), [(LEFT, 0.1, 0.2), (RIGHT, 0.4, 0.5)]);
    assert_eq!(spans(&model, 2), [(RIGHT, 0.0, 0.1)]);
}

#[test]
fn contacts_of_named_bones_are_replaced_and_those_of_others_stay() {
    let mut model = with_contacts();
    apply(&mut model, &format!(r#"{{"edit":"set_contacts","take":"Walk","bones":["{LEFT}"]}}"#));
    assert_eq!(spans(&model, 1), [(RIGHT, 0.4, 0.6)]);
    apply(&mut model, r#"{"edit":"set_contacts","take":"Walk"}"#);
    assert_eq!(model.slots()[1].result.extras.get(CONTACTS), None);
    for (line, reason) in [
        (r#"{"edit":"set_contacts","take":"Walk"}"#, "already"),
        (
            r#"{"edit":"set_contacts","take":"Walk","contacts":[{"bone":0,"from":1,"to":0}]}"#,
            "before the start",
        ),
        (r#"{"edit":"set_contacts","take":"Walk","bones":["nobody"]}"#, "no bone"),
        (r#"{"edit":"detect_contacts","take":"Walk","meters_per_unit":0}"#, "unit"),
    ] {
        let error = model.apply(&edit(line)).expect_err(line).to_string();
        assert!(error.contains(reason), "{line}: {error}");
    }
    let many: Vec<String> =
        (0..10_001).map(|index| format!(r#"{{"bone":0,"from":{index},"to":{}.5}}"#, index)).collect();
    let line = format!(r#"{{"edit":"set_contacts","take":"Walk","contacts":[{}]}}"#, many.join(","));
    assert!(model.apply(&edit(&line)).expect_err("too many").to_string().contains("10,000"));
}

/// A fox in centimeters on the spot: its feet slide, so that they are found only with other thresholds than those for meters.
#[test]
fn contacts_are_found_in_the_unit_of_the_model_and_those_of_other_bones_stay() {
    let mut model = with_contacts();
    let line = |bones: &str, unit: f32| {
        format!(r#"{{"edit":"detect_contacts","take":"Survey","bones":[{bones}],"meters_per_unit":{unit}}}"#)
    };
    apply(&mut model, &line(&format!(r#""{LEFT}""#), 0.01));
    let left = spans(&model, 0);
    assert!(!left.is_empty() && left.iter().all(|span| span.0 == LEFT), "{left:?}");
    apply(&mut model, &line(&format!(r#""{RIGHT}""#), 0.01));
    let both = spans(&model, 0);
    assert!(both.len() > left.len() && left.iter().all(|span| both.contains(span)), "{both:?}");
    // The fox looks around, and its feet do not move most of the time.
    let covered: f32 = left.iter().map(|span| span.2 - span.1).sum();
    assert!(covered > 0.8 * model.slots()[0].result.length, "{covered}");
}

/// The fox drifts by 4 cm in 3 s: still in contact, unless its centimeters are taken for meters.
#[test]
fn contacts_are_found_in_the_unit_that_the_size_of_the_model_says_where_it_is_to_be_guessed() {
    let mut model = fox_takes();
    for (time, x) in [(0, 0), (3, 4)] {
        apply(
            &mut model,
            &format!(
                r#"{{"edit":"set","take":"Survey","time":{time},"poses":[{{"bone":"b_Root_00","translation":[{x},0,0]}}]}}"#
            ),
        );
    }
    let found = |unit: &str| {
        let mut model = model.clone();
        let line = format!(r#"{{"edit":"detect_contacts","take":"Survey","bones":["{LEFT}"]{unit}}}"#);
        model.apply(&edit(&line)).map(|_| spans(&model, 0)).unwrap_or_default()
    };
    let covered = |unit: &str| found(unit).iter().map(|span| span.2 - span.1).sum::<f32>();
    let guess = r#","meters_per_unit":"guess""#;
    assert_eq!(found(guess), found(r#","meters_per_unit":0.01"#));
    assert_eq!(found(""), found(r#","meters_per_unit":1"#), "as in journals of earlier versions");
    let (by_size, in_meters) = (covered(guess), covered(r#","meters_per_unit":1"#));
    assert!(by_size > 2.5 && in_meters < 0.6, "{by_size} {in_meters}");
    // Locking finds the same contacts where the take has none stored.
    apply(&mut model, r#"{"edit":"lock_contacts","take":"Survey","ease":2,"meters_per_unit":"guess"}"#);
    let bone = model.skeleton().find(LEFT).expect("a bone");
    let contact = Contact { bone, from: 1.0, to: 2.5 };
    let slide = slide(&model, &model.slots()[0].result, &contact);
    assert!(slide < 2.0, "{slide} mm");
}

fn slide(model: &ModelAdapter, take: &Take, contact: &Contact) -> f32 {
    let frames = TakeFrames::of(take, model.skeleton(), 120.0).expect("frames");
    contact_slide(&frames, contact, Axis::Y, 0.01).millimeters
}

#[test]
fn feet_are_locked_in_the_stored_contacts() {
    let mut model = with_contacts();
    let before = Arc::clone(&model.slots()[1].result);
    apply(&mut model, r#"{"edit":"lock_contacts","take":"Walk","ease":3}"#);
    let after = Arc::clone(&model.slots()[1].result);
    for (name, from, to) in [(LEFT, 0.1, 0.2), (RIGHT, 0.4, 0.6)] {
        let contact = Contact { bone: model.skeleton().find(name).expect("a bone"), from, to };
        let slides = [&before, &after].map(|take| slide(&model, take, &contact));
        assert!(slides[0] > 5.0 && slides[1] < 2.0, "{name}: {slides:?}");
    }
    // Those given with the edit are used instead.
    let mut given = with_contacts();
    let line = format!(
        r#"{{"edit":"lock_contacts","take":"Walk","contacts":[{{"bone":"{LEFT}","from":0.1,"to":0.2}}],"ease":3}}"#
    );
    apply(&mut given, &line);
    let right = given.skeleton().find("b_RightLeg02_020").expect("a bone") as usize;
    assert_eq!(given.slots()[1].result.tracks[right], before.tracks[right]);
}

#[test]
fn a_closed_loop_holds_the_stored_contacts_and_a_reduction_keeps_them() {
    let shifted = r#"{"edit":"offset","take":"Walk","time":0,"poses":[{"bone":"b_Hip_01","rotation":[0,0,0.05,0.9987]}]}"#;
    let contact = |model: &ModelAdapter| {
        let bone = model.skeleton().find(RIGHT).expect("a bone");
        Contact { bone, from: 0.7, to: 0.85 }
    };
    let prepared = || {
        let mut model = fox_takes();
        apply(&mut model, shifted);
        let line = format!(
            r#"{{"edit":"set_contacts","take":"Walk","contacts":[{{"bone":"{RIGHT}","from":0.7,"to":0.85}}]}}"#
        );
        apply(&mut model, &line);
        apply(&mut model, r#"{"edit":"lock_contacts","take":"Walk","ease":3}"#);
        model
    };
    let mut with = prepared();
    let locked = slide(&with, &with.slots()[1].result, &contact(&with));
    apply(&mut with, r#"{"edit":"close_loop","take":"Walk","frames":12}"#);
    let held = slide(&with, &with.slots()[1].result, &contact(&with));
    let mut without = prepared();
    apply(&mut without, r#"{"edit":"set_contacts","take":"Walk"}"#);
    apply(&mut without, r#"{"edit":"close_loop","take":"Walk","frames":12}"#);
    let free = slide(&without, &without.slots()[1].result, &contact(&without));
    assert!(locked < 2.0 && held < 2.0 && free > 3.0 * held.max(0.5), "{locked} {held} {free}");

    // A tolerance of 20 mm lets a foot slide where no contact is known.
    let reduced = |model: &mut ModelAdapter| {
        apply(model, r#"{"edit":"reduce_keys","take":"Walk","keys":[{}],"tolerance":20,"unit":10}"#);
        slide(model, &model.slots()[1].result, &contact(model))
    };
    let mut kept = prepared();
    let slides = reduced(&mut kept);
    assert!(slides < 5.0, "{slides}");
}

#[test]
fn contacts_are_saved_with_the_file_and_read_again() {
    let folder = Folder::new("contacts-saved");
    let path = fox(&folder);
    let mut file = open(&path);
    let mut adapter = ModelAdapter::new(&file.model.animation);
    let line = format!(
        r#"{{"edit":"set_contacts","take":"Walk","contacts":[{{"bone":"{LEFT}","from":0.25,"to":0.5}}]}}"#
    );
    apply(&mut adapter, &line);
    let plan = file.plan(&adapter).expect("a plan");
    file.save(&adapter, &plan, &path).expect("saved");
    let again = ModelAdapter::new(&open(&path).model.animation);
    assert_eq!(spans(&again, 1), [(LEFT, 0.25, 0.5)]);
    assert_eq!(spans(&again, 0), []);
}
