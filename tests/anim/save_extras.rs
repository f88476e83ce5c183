//! Data that a program keeps with a take comes back from the file, and the `extras` of other programs keep their bytes.

use crate::fixture::Fixture;
use crate::save_support::{OpenedFile, json_of, take_mut};
use dragonfly_anim::data::{ModelData, TakeExtras};
use dragonfly_anim::format::gltf::save::{TakeChange, plan};
use dragonfly_anim::format::{ByteBudget, ReadOptions, read};
use dragonfly_anim::format::{EditedTake, Formats, NoFiles};
use serde_json::Value;
use std::sync::Arc;

const LAYERS: &str = r#"{"version": 1, "names": ["Arm \"up\"", "ä"]}"#;

fn text(json: &str) -> Option<Arc<str>> {
    Some(Arc::from(json))
}

/// Returns a model whose animation has these `extras`; without any where the text is empty.
fn with_extras(extras: &str) -> OpenedFile {
    let mut fixture = Fixture::new();
    if !extras.is_empty() {
        fixture.set("/animations/0/extras", serde_json::from_str(extras).unwrap());
    }
    OpenedFile::alone("extras.glb", &fixture.glb())
}

/// Sets the extras of the only take, saves, and returns the reopened file with the `extras` in its text.
fn saved(file: &OpenedFile, extras: &TakeExtras) -> (OpenedFile, Value) {
    let mut takes = file.takes();
    take_mut(&mut takes, 0).extras = extras.clone();
    let saved = file.saved(&takes, &NoFiles);
    let is_changed = file.model.animation.takes[0].extras != *extras;
    let changes: Vec<TakeChange> = saved.changes.takes.iter().map(|(_, change)| *change).collect();
    assert_eq!(changes, if is_changed { vec![TakeChange::Extras] } else { Vec::new() });
    assert_eq!((saved.changes.is_empty(), saved.changes.bytes_appended), (!is_changed, 0));
    let json = saved.json()["animations"][0]["extras"].clone();
    (saved.opened, json)
}

#[test]
fn extras_are_added_changed_and_removed_and_those_of_other_programs_stay() {
    for (before, other) in [
        ("", None),
        ("{}", None),
        (r#"{"rate": 24, "by": {"a": [1, 2]}}"#, Some(r#"{"rate": 24, "by": {"a": [1, 2]}}"#)),
        (r#"{"dragonfly": 3, "rate": 24}"#, Some(r#"{"rate": 24}"#)),
    ] {
        let file = with_extras(before);
        assert!(file.model.animation.takes[0].extras.is_empty(), "{before}");
        let mut extras = TakeExtras::default();
        extras.set("layers", text(LAYERS));
        extras.set("contacts", text("[]"));
        let (file, json) = saved(&file, &extras);
        assert_eq!(json["dragonfly"]["layers"], serde_json::from_str::<Value>(LAYERS).unwrap(), "{before}");
        // The text itself comes back, not only an equal value.
        assert_eq!(&**file.model.animation.takes[0].extras.get("layers").unwrap(), LAYERS);

        assert_eq!(extras.set("layers", text("null")).as_deref(), Some(LAYERS));
        let (file, json) = saved(&file, &extras);
        assert_eq!(json["dragonfly"].to_string(), r#"{"contacts":[],"layers":null}"#, "{before}");

        let (file, json) = saved(&file, &TakeExtras::default());
        let left = other.map_or(Value::Null, |other| serde_json::from_str(other).unwrap());
        assert_eq!(json, left, "{before}");
        saved(&file, &TakeExtras::default());
    }
}

#[test]
fn a_copied_take_has_the_extras_that_it_got_and_the_first_keeps_its_own() {
    let file = with_extras(r#"{"dragonfly": {"layers": 1}, "rate": 24}"#);
    let mut takes = file.takes();
    takes.push(takes[0].clone());
    take_mut(&mut takes, 1).name = "copy".to_owned();
    take_mut(&mut takes, 1).extras.set("layers", text("2"));
    let mut new = EditedTake { origin: None, ..takes[0].clone() };
    Arc::make_mut(&mut new.take).name = "new".to_owned();
    Arc::make_mut(&mut new.take).extras.set("layers", text("3"));
    takes.push(new);
    let json = file.saved(&takes, &NoFiles).json();
    let extras = [0, 1, 2].map(|take: usize| json["animations"][take]["extras"].to_string());
    let with = |layers: u32| format!(r#"{{"dragonfly":{{"layers":{layers}}},"rate":24}}"#);
    assert_eq!(extras, [with(1), with(2), r#"{"dragonfly":{"layers":3}}"#.to_owned()]);
}

#[test]
fn extras_that_are_no_object_stay_and_the_save_says_what_is_not_kept() {
    let file = with_extras(r#""made by hand""#);
    let mut takes = file.takes();
    take_mut(&mut takes, 0).extras.set("layers", text(LAYERS));
    let plan = plan(&file.source, &file.model, &takes).unwrap();
    assert!(plan.changes().is_empty());
    assert_eq!(plan.changes().extras_lost, [takes[0].take.name.clone()]);
    assert_eq!(plan.write()[0].bytes[..], file.source.bytes()[..]);
}

#[test]
fn a_format_without_room_for_extras_says_so() {
    let mut model = ModelData::clone(&with_extras("").model);
    let dfm = *Formats::builtin().by_name("dfm").unwrap();
    let write = |model: &ModelData| {
        let bytes = dfm.edit(
            "a.dfm",
            dragonfly_anim::format::dfm::write(model).unwrap(),
            &NoFiles,
            &ReadOptions::default(),
        );
        let takes =
            model.animation.takes.iter().map(|take| EditedTake { origin: None, take: Arc::clone(take) });
        bytes.unwrap().plan(model, &takes.collect::<Vec<_>>()).unwrap().lost
    };
    assert!(write(&model).is_empty());
    Arc::make_mut(&mut model.animation.takes[0]).extras.set("layers", text(LAYERS));
    let lost = write(&model);
    assert!(lost[0].text.ends_with("this format has no room for its layers"), "{lost:?}");
}

#[test]
fn extras_count_against_the_budget_of_the_import() {
    let long = format!(r#"{{"dragonfly": {{"layers": "{}"}}}}"#, "x".repeat(1 << 20));
    let mut fixture = Fixture::new();
    fixture.set("/animations/0/extras", serde_json::from_str(&long).unwrap());
    let bytes = fixture.glb();
    let needed = |bytes: &[u8]| {
        let options = ReadOptions { budget: ByteBudget::at_most(u64::MAX), ..ReadOptions::default() };
        read("a.glb", bytes, &NoFiles, &options).unwrap();
        options.budget.used()
    };
    let more = needed(&bytes) - needed(&Fixture::new().glb());
    assert!(more >= 1 << 20, "{more} bytes");
    assert_eq!(
        json_of(&bytes)["animations"][0]["extras"]["dragonfly"]["layers"].as_str().unwrap().len(),
        1 << 20
    );
}
