//! Channels whose target is a JSON pointer (`KHR_animation_pointer`): those of nodes are ordinary channels, all others are
//! listed and kept.

use crate::fixture::{Fixture, glb};
use crate::save_support::{OpenedFile, take_mut};
use dragonfly_anim::format::{Imported, NoFiles, ReadOptions, read};
use glam::Quat;
use serde_json::{Value, json};
use std::sync::Arc;

fn pointer(path: &str) -> Value {
    json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": path}}})
}

/// Returns the fixture with every channel written as a pointer.
fn with_pointers() -> Fixture {
    let mut fixture = Fixture::new();
    fixture.set("/extensionsUsed", json!(["KHR_animation_pointer"]));
    for channel in fixture.json["animations"][0]["channels"].as_array_mut().unwrap() {
        let target = &channel["target"];
        channel["target"] =
            pointer(&format!("/nodes/{}/{}", target["node"], target["path"].as_str().unwrap()));
    }
    fixture
}

fn imported(fixture: &Fixture) -> Imported {
    read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default()).unwrap()
}

#[test]
fn pointers_to_nodes_are_ordinary_channels() {
    let mut fixture = with_pointers();
    fixture.set("/extensionsRequired", json!(["KHR_animation_pointer"]));
    let (plain, pointers) = (imported(&Fixture::new()), imported(&fixture));
    assert_eq!(pointers.warnings, []);
    assert_eq!(pointers.model, plain.model);
    assert!(!pointers.model.animation.takes[0].morphs.is_empty());
}

#[test]
fn channels_with_other_pointers_are_listed_and_the_rest_is_read() {
    let mut fixture = with_pointers();
    let others = [
        "/materials/0/pbrMetallicRoughness/baseColorFactor",
        "/nodes/99/rotation",
        "/nodes/1/extensions/KHR_node_visibility/visible",
        "/nodes/3/weights/0",
        "",
    ];
    for (number, other) in others.iter().enumerate() {
        fixture.set(
            &format!("/animations/0/channels/{}", 5 + number),
            json!({"sampler": 0, "target": pointer(other)}),
        );
    }
    let got = imported(&fixture);
    assert_eq!(got.model, imported(&Fixture::new()).model);
    assert_eq!(got.warnings.len(), others.len());
    for (warning, other) in got.warnings.iter().zip(others) {
        assert_eq!(warning.code, "ANIMATION_CHANNEL_TARGET_UNKNOWN");
        assert!(warning.text.contains(other), "{warning}");
    }
}

#[test]
fn a_channel_that_is_ordinary_and_a_pointer_counts_once() {
    let mut fixture = Fixture::new();
    fixture.set("/animations/0/channels/5", json!({"sampler": 0, "target": pointer("/nodes/1/rotation")}));
    fixture.set("/animations/0/channels/6/sampler", json!(1));
    fixture.set(
        "/animations/0/channels/6/target",
        json!({"node": 0, "path": "rotation", "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/1/scale"}}}),
    );
    let got = imported(&fixture);
    assert_eq!(got.warnings.len(), 1);
    assert_eq!(got.warnings[0].code, "ANIMATION_DUPLICATE_TARGETS");
    // An ordinary target is used although it has a pointer.
    let rotations = got.model.animation.takes[0].tracks.iter().filter(|track| !track.rotation.is_empty());
    assert_eq!(rotations.count(), 2);
}

#[test]
fn a_save_changes_the_sampler_of_a_pointer_and_keeps_every_target() {
    let mut fixture = with_pointers();
    let color = json!({"sampler": 0, "target": pointer("/materials/0/emissiveFactor")});
    fixture.set("/animations/0/channels/5", color);
    let file = fixture.glb();
    let opened = OpenedFile::alone("a.glb", &file);
    let mut takes = opened.takes();
    assert_eq!(opened.saved(&takes, &NoFiles).bytes(), file);
    let track = take_mut(&mut takes, 0).tracks.iter_mut().find(|track| !track.rotation.is_empty()).unwrap();
    let turned = track.rotation.values.iter().map(|value| (*value * Quat::from_rotation_x(0.5)).normalize());
    track.rotation.values = turned.collect();
    // Compares all bytes but the announced ones, and the takes that are read again.
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(saved.changes.channels.len(), 1);
    let (old, new) = (&fixture.json["animations"][0], &saved.json()["animations"][0]);
    let targets = |animation: &Value| -> Vec<Value> {
        animation["channels"].as_array().unwrap().iter().map(|channel| channel["target"].clone()).collect()
    };
    assert_eq!(targets(old), targets(new));
    // Removed channels are removed as pointers too; that of the material stays.
    let take = take_mut(&mut takes, 0);
    take.tracks.iter_mut().for_each(|track| track.rotation = Default::default());
    let saved = opened.saved(&takes, &NoFiles);
    let left = targets(&saved.json()["animations"][0]);
    assert_eq!(left.len(), 5);
    assert!(left.contains(&pointer("/materials/0/emissiveFactor")));
    assert!(!left.contains(&pointer("/nodes/1/rotation")));
    // A copy of the take is written without the pointers that the program does not know.
    let mut copy = take_mut(&mut takes, 0).clone();
    copy.name = "copy".to_owned();
    takes.push(dragonfly_anim::format::EditedTake { origin: None, take: Arc::new(copy) });
    opened.saved(&takes, &NoFiles);
}

#[test]
fn damaged_pointers_are_read_as_nothing_known() {
    let mut fixture = Fixture::new();
    for (number, extension) in [
        json!(null),
        json!(3),
        json!({"pointer": null}),
        json!({"pointer": 7}),
        json!({"pointer": ["/nodes/0/scale"]}),
        json!({"pointer": "/nodes/18446744073709551616/scale"}),
        json!({}),
    ]
    .into_iter()
    .enumerate()
    {
        let target = json!({"path": "pointer", "extensions": {"KHR_animation_pointer": extension}});
        fixture
            .set(&format!("/animations/0/channels/{}", 5 + number), json!({"sampler": 0, "target": target}));
    }
    assert_eq!(imported(&fixture).warnings.len(), 7);
    // An incomplete escape, and an animation that is no list.
    for text in [
        r#"{"asset":{"version":"2.0"},"animations":{"channels":[]}}"#,
        r#"{"asset":{"version":"2.0"},"animations":[{"samplers":[],"channels":[{"sampler":0,"target":{"extensions":{"KHR_animation_pointer":{"pointer":"\u12"#,
    ] {
        assert!(read("a.glb", &glb(text.as_bytes(), None), &NoFiles, &ReadOptions::default()).is_err());
    }
}
