//! Edits of travel: from the hips to the root, out of the take, and back; and takes that are added with their keys.

use dragonfly_anim::data::{Skeleton, Take, Transform};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::retarget::{BindingGuess, FigureOptions};
use dragonfly_anim::sample::sample_take;
use dragonfly_document::adapter::{EditError, ModelAdapter, TakeVersions};
use dragonfly_document::edit::{AddTake, Edit, EditedBones, TRAVEL, TakeRef};
use dragonfly_document::{
    BoneMap, Change, DocumentMessage, DocumentReply, MapFile, RetargetOrder, SaveTo, Source,
};
use dragonfly_kit::document::test_document::{TestDocument, fox, same_takes};
use dragonfly_kit::folder::{Folder, data};
use std::sync::Arc;

fn robot() -> ModelAdapter {
    let bytes = include_bytes!("../data/collection/RobotExpressive.glb");
    let model = read("Robot.glb", bytes, &NoFiles, &ReadOptions::default()).expect("the robot").model;
    ModelAdapter::new(&model.animation)
}

fn result(model: &ModelAdapter, take: &str) -> Arc<Take> {
    Arc::clone(&versions(model, take).result)
}

fn versions<'a>(model: &'a ModelAdapter, take: &str) -> &'a TakeVersions {
    model.take(&TakeRef::Name(take.to_owned())).expect(take)
}

fn edit(json: &str) -> Edit {
    serde_json::from_str(json).expect(json)
}

fn poses(skeleton: &Skeleton, take: &Take, time: f32) -> Vec<Transform> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    poses
}

/// Returns the largest difference of two takes, lengths relative to the largest.
fn apart(skeleton: &Skeleton, a: &Take, b: &Take) -> f32 {
    let mut largest = 0.0_f32;
    for step in 0..=200 {
        let time = a.start + a.length * step as f32 / 200.0;
        for (a, b) in poses(skeleton, a, time).iter().zip(poses(skeleton, b, time)) {
            let turn = (a.rotation - b.rotation).length().min((a.rotation + b.rotation).length());
            let moved = a.translation.distance(b.translation) / (1.0 + a.translation.length());
            largest = largest.max(turn).max(moved).max(a.scale.distance(b.scale));
        }
    }
    largest
}

#[test]
fn removed_travel_is_put_back_within_a_ten_thousandth_also_after_other_edits() {
    let mut model = robot();
    let before = result(&model, "Walking");
    let remove = r#"{"edit":"remove_travel","take":"Walking","bone":"Body","parts":["x","z","height","yaw"],"smooth":3}"#;
    model.apply(&edit(remove)).unwrap();
    let still = result(&model, "Walking");
    assert!(apart(model.skeleton(), &before, &still) > 1e-3);
    assert!(versions(&model, "Walking").original.extras.get(TRAVEL).is_some());
    // Another bone is edited in between.
    let nod = r#"{"edit":"set","take":"Walking","time":0.5,"poses":[{"bone":"Neck","rotation":[0.5,0,0,0.8660254]}]}"#;
    model.apply(&edit(nod)).unwrap();
    model.apply(&edit(r#"{"edit":"restore_travel","take":"Walking"}"#)).unwrap();
    let back = result(&model, "Walking");
    let neck = model.skeleton().find("Neck").unwrap() as usize;
    assert_ne!(before.tracks[neck], back.tracks[neck]);
    let mut back = (*back).clone();
    back.tracks[neck] = before.tracks[neck].clone();
    let difference = apart(model.skeleton(), &before, &back);
    assert!(difference < 1e-4, "{difference}");
    assert!(versions(&model, "Walking").original.extras.get(TRAVEL).is_none());
    let again = model.apply(&edit(r#"{"edit":"restore_travel","take":"Walking"}"#)).unwrap_err();
    assert!(matches!(again, EditError::Nothing(_)), "{again}");
}

#[test]
fn a_moved_travel_changes_only_the_bones_that_the_edit_names() {
    let mut model = robot();
    let skeleton = Arc::clone(model.skeleton());
    let edit = edit(r#"{"edit":"move_travel","take":"Dance","from":"Hips","to":"Bone","parts":["x","z"]}"#);
    let EditedBones::Named(named) = edit.bones(&skeleton) else { panic!("named bones") };
    let before = result(&model, "Dance");
    model.apply(&edit).unwrap();
    model.check().unwrap();
    let after = result(&model, "Dance");
    let mut changed = 0;
    for (bone, (before, after)) in before.tracks.iter().zip(&after.tracks).enumerate() {
        if before != after {
            assert!(named.contains(&(bone as u32)), "{bone}");
            changed += 1;
        }
    }
    assert!(changed >= 2, "{changed}");
}

#[test]
fn travel_without_parts_or_between_branches_is_refused() {
    let mut model = robot();
    for (line, wanted) in [
        (r#"{"edit":"remove_travel","take":"Walking","bone":"Body","parts":[]}"#, "no part of the travel"),
        (r#"{"edit":"move_travel","take":"Walking","from":"Foot.L","to":"Foot.R"}"#, "different branches"),
        (r#"{"edit":"remove_travel","take":"Walking","bone":"Body","smooth":-1}"#, "smoothing"),
        (r#"{"edit":"add_take","name":"a","tracks":[]}"#, "at least one key"),
        (
            r#"{"edit":"add_take","name":"a","tracks":[{"bone":"Head","property":"scale","interpolation":"linear","times":[0,1],"values":[1,1,1]}]}"#,
            "needs 6 numbers",
        ),
        (
            r#"{"edit":"add_take","name":"a","tracks":[{"bone":"Head","property":"scale","interpolation":"linear","times":[1,1],"values":[1,1,1,1,1,1]}]}"#,
            "same time",
        ),
    ] {
        let error = model.apply(&edit(line)).unwrap_err().to_string();
        assert!(error.contains(wanted), "{line}: {error}");
    }
}

#[test]
fn a_take_is_added_with_exactly_the_keys_of_another_and_survives_json() {
    let mut model = robot();
    let take = result(&model, "Jump");
    let add = Edit::AddTake(AddTake::of("Jump again".to_owned(), &take));
    let text = serde_json::to_string(&add).unwrap();
    let again: Edit = serde_json::from_str(&text).unwrap();
    assert_eq!(add, again);
    model.apply(&again).unwrap();
    model.check().unwrap();
    let added = result(&model, "Jump again");
    assert!(apart(model.skeleton(), &take, &added) < 1e-6);
    for (added, track) in added.tracks.iter().zip(&take.tracks) {
        assert_eq!(added.key_times(), track.key_times());
    }
}

#[test]
fn a_bone_map_is_the_same_after_writing_and_reading_and_names_what_is_missing() {
    let model = robot();
    let skeleton = model.skeleton();
    let binding = BindingGuess::of(skeleton, skeleton).binding;
    let map = BoneMap::of(["a \"b\".glb", "c.glb"], skeleton, skeleton, &binding);
    let read = BoneMap::parse(&map.to_text()).unwrap();
    assert_eq!(map, read);
    assert_eq!(read.binding(skeleton, skeleton).unwrap(), (binding, Vec::new()));
    let other = r#"{"bone_map":1,"bones":[["Head","Head"],["Tail","Head"],["Neck","Wing"]]}"#;
    let (binding, missing) = BoneMap::parse(other).unwrap().binding(skeleton, skeleton).unwrap();
    assert_eq!((binding.bound(), missing), (1, vec!["Tail".to_owned(), "Wing".to_owned()]));
    assert!(BoneMap::parse(r#"{"bone_map":2,"bones":[]}"#).unwrap_err().contains("newer"));
    let twice = r#"{"bone_map":1,"bones":[["Head","Head"],["Neck","Head"]]}"#;
    assert!(BoneMap::parse(twice).unwrap().binding(skeleton, skeleton).unwrap_err().contains("two bones"));
}

#[test]
fn a_take_of_another_file_becomes_one_edit_of_the_open_document_and_undo_removes_it() {
    let folder = Folder::new("retarget-document");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let before = document.open(&data("collection/quaternius_Character4skins.glb"));
    document.send(DocumentMessage::ReadSource(Source::File(data("bench/pab.glb"))));
    let source = document.wait_for_reply(|reply| match reply {
        DocumentReply::SourceRead(source) => Some(Arc::clone(source)),
        _ => None,
    });
    let (from, to) = (&source.model.animation.skeleton, &before.loaded.model.animation.skeleton);
    let binding = BindingGuess::of(from, to).binding;
    let pairs: Vec<_> =
        (0..).zip(&binding.source_of).filter_map(|(to, from)| Some((from.as_ref().copied()?, to))).collect();
    let options = FigureOptions::default();
    document.send(DocumentMessage::Retarget(RetargetOrder {
        take: 0,
        layer_of: None,
        pairs: pairs.clone(),
        options,
    }));
    let after = document.wait_for_view(|view| view.takes.len() > before.takes.len());
    assert_eq!((after.takes.last().unwrap().name.as_str(), after.history.done), ("walk", 1));
    document.change(Change::Undo);
    same_takes(&document.view(), &before);
    // The same keys as a layer over a take; its bones move as in the take, and the keys of the take stay.
    let (layer_of, over) = (Some(TakeRef::Index(1)), &before.takes[1]);
    let order = RetargetOrder { take: 0, layer_of, pairs, options };
    document.send(DocumentMessage::Retarget(order.clone()));
    let layered = document.wait_for_view(|view| view.slots[1].layers().len() == 1);
    assert_eq!(layered.slots[1].layers()[0].settings.name, "walk");
    let keys = |take: &Take| take.tracks.iter().map(|track| track.key_times().len()).collect::<Vec<_>>();
    assert_eq!(keys(&layered.slots[1].layers()[0].keys.result), keys(after.takes.last().unwrap()));
    assert!(keys(over).iter().sum::<usize>() > 0 && layered.takes.len() == before.takes.len());
    // A second layer of the same take has a name of its own.
    document.send(DocumentMessage::Retarget(order));
    let twice = document.wait_for_view(|view| view.slots[1].layers().len() == 2);
    let names: Vec<&str> = twice.slots[1].layers().iter().map(|layer| &*layer.settings.name).collect();
    assert!(names.contains(&"walk") && names.contains(&"walk 2"), "{names:?}");
    document.change(Change::Undo);
    document.change(Change::Undo);
    same_takes(&document.view(), &before);
    // The map goes to a file and back.
    let path = folder.join("map.json");
    let map = BoneMap::of(["pab.glb", "quaternius.glb"], from, to, &binding);
    document.send(DocumentMessage::MapFile(MapFile::Write(path.clone(), map.clone())));
    document.wait_for_reply(|reply| {
        matches!(reply, DocumentReply::Notice(text) if text.starts_with("Wrote")).then_some(())
    });
    document.send(DocumentMessage::MapFile(MapFile::Read(path)));
    let read = document.wait_for_reply(|reply| match reply {
        DocumentReply::MapRead(map) => Some(map.clone()),
        _ => None,
    });
    assert_eq!(read, map);
    // A model whose path was typed by mistake is not overwritten.
    let model = folder.join("model.glb");
    std::fs::write(&model, "glTF").unwrap();
    document.send(DocumentMessage::MapFile(MapFile::Write(model.clone(), map)));
    let refused = document.wait_for_reply(|reply| match reply {
        DocumentReply::Refused(reason) => Some(reason.clone()),
        _ => None,
    });
    assert!(refused.contains("is no bone map"), "{refused}");
    assert_eq!(std::fs::read_to_string(model).unwrap(), "glTF");
    document.send(DocumentMessage::MapFile(MapFile::Read(folder.join("no.json"))));
    let refused = document.wait_for_reply(|reply| match reply {
        DocumentReply::Refused(reason) => Some(reason.clone()),
        _ => None,
    });
    assert!(refused.contains("no.json"), "{refused}");
}

#[test]
fn removed_travel_is_saved_with_the_take_and_put_back_after_opening_again() {
    let folder = Folder::new("travel-saved");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    let before = document.open(&path);
    let remove =
        r#"{"edit":"remove_travel","take":"Run","bone":"b_Hip_01","parts":["x","z","height","yaw"]}"#;
    document.edit(edit(remove));
    document.wait_for_view(|view| view.history.done == 1);
    document.save(SaveTo::Own);
    document.end();
    let mut document = TestDocument::new(&folder.join("autosave"));
    let still = document.open(&path);
    let skeleton = Arc::clone(&before.loaded.model.animation.skeleton);
    assert!(apart(&skeleton, &before.takes[2], &still.takes[2]) > 1e-3);
    assert!(still.takes[2].extras.get(TRAVEL).is_some());
    document.edit(edit(r#"{"edit":"restore_travel","take":"Run"}"#));
    let back = document.wait_for_view(|view| view.takes[2].extras.get(TRAVEL).is_none());
    let difference = apart(&skeleton, &before.takes[2], &back.takes[2]);
    assert!(difference < 1e-4, "{difference}");
}
