//! Events that are stored with a take: set, kept by edits of time, saved with the file.

use crate::fox_edits::{apply, edit, fox_takes};
use crate::save_and_open::open;
use dragonfly_document::adapter::{EVENTS, ModelAdapter, stored_events};
use dragonfly_kit::document::test_document::fox;
use dragonfly_kit::folder::Folder;

/// Returns names and times in milliseconds of the events of a take.
fn events(model: &ModelAdapter, take: usize) -> Vec<(String, i32)> {
    let events = stored_events(&model.slots()[take].result.extras);
    events.into_iter().map(|event| (event.name, (event.time * 1000.0).round() as i32)).collect()
}

const TWO: &str = r#"{"edit":"set_events","take":"Walk","events":[{"time":0.5,"name":"right"},{"time":0.1,"name":"left","payload":{"strength":0.5}}]}"#;

fn with_events() -> ModelAdapter {
    let mut model = fox_takes();
    apply(&mut model, TWO);
    model
}

fn named(expected: &[(&str, i32)]) -> Vec<(String, i32)> {
    expected.iter().map(|&(name, time)| (name.to_owned(), time)).collect()
}

#[test]
fn events_are_stored_as_readable_json_in_order_of_time_and_an_undo_removes_them() {
    let mut model = fox_takes();
    let undo = model.apply(&edit(TWO)).expect("applied");
    let text = model.slots()[1].result.extras.get(EVENTS).expect("a text").to_string();
    let wanted = r#"{"version":1,"events":[{"time":0.1,"name":"left","payload":{"strength":0.5}},{"time":0.5,"name":"right"}]}"#;
    assert_eq!(text, wanted);
    assert!(model.apply(&edit(TWO)).is_err(), "it has them already");
    model.revert(undo);
    assert_eq!(model.slots()[1].result.extras.get(EVENTS), None);
}

#[test]
fn events_follow_when_the_take_is_retimed_reversed_trimmed_split_and_rippled() {
    // The take is 0.708 s long.
    let mut model = with_events();
    apply(&mut model, r#"{"edit":"reverse_take","take":"Walk"}"#);
    assert_eq!(events(&model, 1), named(&[("right", 208), ("left", 608)]));
    let mut model = with_events();
    apply(&mut model, r#"{"edit":"trim_take","take":"Walk","from":0.3,"to":0.6}"#);
    assert_eq!(events(&model, 1).iter().map(|event| event.0.as_str()).collect::<Vec<_>>(), ["right"]);
    let mut model = with_events();
    apply(&mut model, r#"{"edit":"ripple","take":"Walk","from":0.3,"by":0.25}"#);
    assert_eq!(events(&model, 1), named(&[("left", 100), ("right", 750)]));
    let mut model = with_events();
    apply(&mut model, r#"{"edit":"shift_loop","take":"Walk","by":0.3}"#);
    let (names, times): (Vec<_>, Vec<_>) = events(&model, 1).into_iter().unzip();
    assert_eq!(names, ["right", "left"]);
    // 0.5 + 0.3 − 0.708 and 0.1 + 0.3.
    assert!((times[0] - 92).abs() <= 1 && (times[1] - 400).abs() <= 1, "{times:?}");
    let mut model = with_events();
    apply(&mut model, r#"{"edit":"split_take","take":"Walk","time":0.3,"name":"Walk, end"}"#);
    let first = events(&model, 1);
    let second = model.slots().iter().position(|slot| slot.result.name == "Walk, end").expect("a take");
    assert_eq!(first, named(&[("left", 100)]));
    assert_eq!(events(&model, second), named(&[("right", 200)]));
}

#[test]
fn events_without_a_name_with_a_large_payload_or_too_many_are_refused() {
    let mut model = fox_takes();
    let mut refused = |events: String| {
        let json = format!(r#"{{"edit":"set_events","take":"Walk","events":[{events}]}}"#);
        model.apply(&edit(&json)).expect_err("refused").to_string()
    };
    assert!(refused(r#"{"time":0,"name":""}"#.to_owned()).contains("name"));
    let large = "x".repeat(20_000);
    assert!(refused(format!(r#"{{"time":0,"name":"a","payload":"{large}"}}"#)).contains("payload"));
    let many = vec![r#"{"time":0,"name":"a"}"#; 1001].join(",");
    assert!(refused(many).contains("1,000"));
}

#[test]
fn a_text_that_is_no_record_of_events_counts_as_none_and_stays() {
    let mut model = fox_takes();
    for value in [r#""text""#, "[1]", r#"{"version":2,"events":[{"time":0,"name":"a"}]}"#] {
        let line = serde_json::json!({"edit": "set_extras", "take": "Walk", "name": EVENTS, "value": serde_json::from_str::<serde_json::Value>(value).expect("JSON")});
        apply(&mut model, &line.to_string());
        assert!(events(&model, 1).is_empty(), "{value}");
        apply(&mut model, r#"{"edit":"reverse_take","take":"Walk"}"#);
        assert!(model.slots()[1].result.extras.get(EVENTS).is_some());
    }
}

#[test]
fn events_are_saved_with_the_file_and_come_back() {
    let folder = Folder::new("events-saved");
    let path = fox(&folder);
    let mut file = open(&path);
    let mut adapter = ModelAdapter::new(&file.model.animation);
    apply(&mut adapter, TWO);
    let plan = file.plan(&adapter).expect("a plan");
    file.save(&adapter, &plan, &path).expect("saved");
    let again = ModelAdapter::new(&open(&path).model.animation);
    assert_eq!(events(&again, 1), named(&[("left", 100), ("right", 500)]));
    assert_eq!(events(&again, 0), []);
    let first = stored_events(&again.slots()[1].result.extras).swap_remove(0);
    assert_eq!(first.payload, Some(serde_json::json!({"strength": 0.5})));
}

#[test]
fn events_of_another_program_follow_edits_of_time_or_stay_and_refuse_none() {
    let record = |count: usize, name: &str| {
        let events: Vec<_> = (0..count).map(|_| serde_json::json!({"time": 0.1, "name": name})).collect();
        serde_json::json!({"edit": "set_extras", "take": "Walk", "name": EVENTS, "value": {"version": 1, "events": events}})
    };
    let long = "n".repeat(201);
    for (name, count) in [("", 2), (long.as_str(), 1)] {
        let mut model = fox_takes();
        apply(&mut model, &record(count, name).to_string());
        apply(&mut model, r#"{"edit":"retime_take","take":"Walk","start":0.1}"#);
        assert_eq!(events(&model, 1), vec![(name.to_owned(), 200); count]);
    }
    let mut model = fox_takes();
    apply(&mut model, &record(1001, "a").to_string());
    let text = model.slots()[1].result.extras.get(EVENTS).cloned();
    apply(&mut model, r#"{"edit":"retime_take","take":"Walk","start":0.1}"#);
    assert_eq!(events(&model, 1), [], "too many to edit");
    assert_eq!(model.slots()[1].result.extras.get(EVENTS).cloned(), text, "but none is lost");
}
