//! Every edit that is accepted can be saved, and the saved file has what was edited: for all kinds of edits and all models, with times
//! below zero, single instants and the largest numbers.

use crate::save_and_open::{assert_opens_again, open};
use dragonfly_anim::data::{AnimationData, Channel, Take};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{Arbitrary, BoneRef, EDITS, Edit};
use dragonfly_document::history::Edited;
use dragonfly_kit::folder::{Folder, data, takes_long};
use dragonfly_kit::random::{Random, seed};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Returns all glTF files below a folder.
fn models_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            models_below(&path, found);
        } else if path.extension().is_some_and(|end| end == "glb" || end == "gltf") {
            found.push(path);
        }
    }
}

/// Returns the take with every time replaced by what `to` returns for it.
fn with_times(take: &Take, to: impl Fn(f32) -> f32) -> Take {
    fn channel<T: Clone>(channel: &Channel<T>, to: &impl Fn(f32) -> f32) -> Channel<T> {
        Channel { times: channel.times.iter().map(|&time| to(time)).collect(), ..channel.clone() }
    }
    let mut take = take.clone();
    for track in &mut take.tracks {
        track.translation = channel(&track.translation, &to);
        track.rotation = channel(&track.rotation, &to);
        track.scale = channel(&track.scale, &to);
    }
    for morph in &mut take.morphs {
        morph.times = morph.times.iter().map(|&time| to(time)).collect();
    }
    let (start, end) = take.range_of_keys().unwrap_or_default();
    (take.start, take.length) = (start, end - start);
    take
}

/// Writes a copy of a model with other times to `output`.
fn write_with_times(model: &Path, output: &Path, to: impl Fn(f32, &Take) -> f32) {
    let mut editable = open(model);
    let old = &editable.model.animation;
    let takes = old.takes.iter().map(|take| Arc::new(with_times(take, |time| to(time, take)))).collect();
    let now = ModelAdapter::new(&AnimationData { takes, ..old.clone() });
    let plan = editable.plan(&now).expect("times can be saved");
    editable.save(&now, &plan, output).expect("a file");
}

/// Applies random edits of every kind to a model. After each accepted one, the model can be saved; after each kind it is saved and
/// opened again. Returns the number of accepted edits.
fn edit_and_save(model: &Path, folder: &Path, number: u64, each: usize) -> usize {
    let mut random = Random::new(number);
    let name = model.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut editable = open(model);
    if editable.model.animation.skeleton.is_empty() {
        return 0;
    }
    let bones: Vec<BoneRef> =
        (0..editable.model.animation.skeleton.len() as u32).map(BoneRef::Index).collect();
    let mut accepted = 0;
    for kind in EDITS {
        let mut edited = Edited::new(ModelAdapter::of(&editable.model));
        let mut changed = false;
        for _ in 0..each {
            let takes = edited.adapter().slots().len().max(1);
            let mut bits = || random.bits();
            // Between the edits of this kind are others, so that it meets what they leave.
            let edits = [
                (kind.arbitrary)(&mut Arbitrary::extreme(&mut bits, takes, &bones)),
                Arbitrary::extreme(&mut bits, takes, &bones).edit(),
            ];
            for edit in edits {
                if edited.ask(edit.clone(), None).is_err() {
                    continue;
                }
                (accepted, changed) = (accepted + 1, true);
                if let Err(error) = editable.plan(edited.adapter()) {
                    panic!("{name}, seed {number}: {error}, after {edit:?}");
                }
            }
        }
        if changed {
            let output = folder.join(&name);
            let plan = editable.plan(edited.adapter()).expect("planned before");
            editable.save(edited.adapter(), &plan, &output).unwrap_or_else(|error| panic!("{error}"));
            let context = format!("{name}, seed {number}, {}", kind.name);
            assert_opens_again(&output, edited.adapter(), &context);
        }
    }
    accepted
}

#[test]
fn every_accepted_edit_of_any_model_can_be_saved() {
    let mut models = Vec::new();
    models_below(&data("gltf"), &mut models);
    models_below(&data("collection"), &mut models);
    if let Some(more) = std::env::var_os("DRAGONFLY_MODELS") {
        models_below(Path::new(&more), &mut models);
    }
    models.sort();
    assert!(models.len() >= 15, "{}", models.len());
    let (first, mut accepted) = (seed(90), 0);
    for (place, model) in models.iter().enumerate() {
        let folder = Folder::new("savable");
        let size = std::fs::metadata(model).expect("a file").len();
        let each = if takes_long() { 40 } else { 3 };
        if size < 2_000_000 || takes_long() {
            accepted += edit_and_save(model, folder.path(), first + place as u64, each);
        }
    }
    println!("{accepted} accepted edits of {} models", models.len());
    assert!(accepted > 300, "{accepted}");
}

#[test]
fn edits_of_takes_below_zero_and_at_the_end_of_time_can_be_saved() {
    let folder = Folder::new("savable-times");
    let (first, mut accepted) = (seed(91), 0);
    for (place, name) in ["Fox.glb", "AnimatedMorphCube.glb", "SimpleMorph_embedded.gltf"].iter().enumerate()
    {
        let below = folder.join(&format!("below-{name}"));
        write_with_times(&data("gltf").join(name), &below, |time, _| time - 1.0);
        let late = folder.join(&format!("late-{name}"));
        // Times so late that neighboring keys would fall together are moved apart.
        write_with_times(&data("gltf").join(name), &late, |time, take| {
            let part = (time - take.start) / take.length;
            43_200.0 + part * 43_200.0
        });
        for (model, starts_below) in [(&below, true), (&late, false)] {
            let takes = open(model).model.animation.takes.clone();
            assert_eq!(takes.iter().any(|take| take.start < 0.0), starts_below, "{}", model.display());
            let saved = Folder::new("savable-again");
            let each = if takes_long() { 100 } else { 8 };
            accepted += edit_and_save(model, saved.path(), first + place as u64, each);
        }
    }
    println!("{accepted} accepted edits");
    assert!(accepted > 200, "{accepted}");
}

/// Applies edits to a model, saves it, and returns whether a warning of the saved file contains `text`.
fn saved_after(model: &Path, output: &Path, lines: &[&str], text: &str) -> bool {
    let mut editable = open(model);
    let mut edited = Edited::new(ModelAdapter::new(&editable.model.animation));
    for line in lines {
        let edit: Edit = serde_json::from_str(line).expect(line);
        edited.ask(edit, None).unwrap_or_else(|error| panic!("{line}: {error}"));
    }
    let plan = editable.plan(edited.adapter()).unwrap_or_else(|error| panic!("{lines:?}: {error}"));
    editable.save(edited.adapter(), &plan, output).expect("a file");
    assert_opens_again(output, edited.adapter(), &format!("{lines:?}"));
    open(output).warnings.iter().any(|warning| warning.contains(text))
}

#[test]
fn a_copy_of_a_take_that_begins_below_zero_is_saved_and_opened_with_a_warning() {
    let folder = Folder::new("savable-copy");
    let below = folder.join("below.glb");
    write_with_times(&data("gltf/Fox.glb"), &below, |time, _| time - 0.5);
    let copy = r#"{"edit":"create_take","name":"copy","copy":0}"#;
    assert!(saved_after(&below, &folder.join("saved.glb"), &[copy], "below zero"));
    // The take may be edited, too.
    let turn = r#"{"edit":"set","take":0,"time":0.3,"poses":[{"bone":3,"rotation":[0,0,0,1]}]}"#;
    assert!(saved_after(&below, &folder.join("turned.glb"), &[turn], "below zero"));
}

/// Checks that the fox refuses each edit of `lines`, with `words` in the message.
fn refused(lines: &[&str], words: &str) {
    let editable = open(&data("gltf/Fox.glb"));
    for line in lines {
        let mut adapter = ModelAdapter::new(&editable.model.animation);
        let error = adapter.apply(&serde_json::from_str(line).expect(line)).expect_err(line);
        assert!(error.to_string().contains(words), "{line}: {error}");
    }
}

#[test]
fn keys_before_zero_are_refused_in_every_way_to_make_them() {
    let lines = [
        r#"{"edit":"add_keys","take":0,"time":-1,"bones":[3]}"#,
        r#"{"edit":"set","take":0,"time":-0.5,"poses":[{"bone":3,"rotation":[0,0,0,1]}]}"#,
        r#"{"edit":"move_keys","take":0,"keys":[{}],"by":-0.25}"#,
        r#"{"edit":"duplicate_keys","take":0,"keys":[{}],"by":-0.013}"#,
        r#"{"edit":"scale_keys","take":0,"keys":[{}],"about":1,"factor":2}"#,
        r#"{"edit":"ripple","take":0,"from":0,"by":-0.25}"#,
        r#"{"edit":"retime_take","take":0,"start":-1}"#,
    ];
    refused(&lines, "before 0 s cannot be saved");
}

#[test]
fn a_take_with_morph_weights_that_is_trimmed_to_one_instant_is_saved() {
    let folder = Folder::new("savable-instant");
    let trim = r#"{"edit":"trim_take","take":0,"from":1.23,"to":1.23}"#;
    saved_after(&data("gltf/AnimatedMorphCube.glb"), &folder.join("saved.glb"), &[trim], "");
}

#[test]
fn keys_after_twenty_four_hours_are_refused_in_every_way_to_make_them() {
    let lines = [
        r#"{"edit":"add_keys","take":0,"time":86401,"bones":[3]}"#,
        r#"{"edit":"set","take":0,"time":90000,"poses":[{"bone":3,"rotation":[0,0,0,1]}]}"#,
        r#"{"edit":"pend","take":0,"time":90000,"poses":[{"bone":3,"rotation":[0,0,0,1]}]}"#,
        r#"{"edit":"move_keys","take":0,"keys":[{}],"by":86400}"#,
        r#"{"edit":"duplicate_keys","take":0,"keys":[{}],"by":86400}"#,
        r#"{"edit":"scale_keys","take":0,"keys":[{}],"about":0,"factor":1e6}"#,
        r#"{"edit":"ripple","take":0,"from":0,"by":86400}"#,
        r#"{"edit":"retime_take","take":0,"length":86401}"#,
        r#"{"edit":"retime_take","take":0,"start":86400}"#,
    ];
    refused(&lines, "after 86400 s cannot be saved");
}
