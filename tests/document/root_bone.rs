//! A root bone that an edit adds: undo, redo, journal, saves before and after it is gone, and the travel that it carries.

use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Skeleton, Take, Transform};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_anim::sample::sample_take;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::{Edit, TRAVEL};
use dragonfly_document::protocol::Session;
use dragonfly_document::{
    Cancel, Change, Decision, DocumentMessage, DocumentReply, Editable, SaveTo, Source, View,
};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill, fox, same_takes, turn};
use dragonfly_kit::folder::Folder;
use glam::Mat4;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn edit(json: &str) -> Edit {
    serde_json::from_str(json).expect(json)
}

fn root(name: &str) -> Edit {
    edit(&format!(r#"{{"edit":"add_root_bone","name":"{name}"}}"#))
}

fn matrices(skeleton: &Skeleton, take: &Take, time: f32) -> Vec<Mat4> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    let mut out = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &poses, &mut out);
    out
}

/// Returns the largest distance between bones of the same index from the last in two models, relative to the largest number.
fn apart(a: (&Skeleton, &Take), b: (&Skeleton, &Take)) -> f32 {
    let mut largest = 0.0_f32;
    for step in 0..=100 {
        let time = a.1.start + a.1.length * step as f32 / 100.0;
        let (a, b) = (matrices(a.0, a.1, time), matrices(b.0, b.1, time));
        for (a, b) in a.iter().rev().zip(b.iter().rev()) {
            let size = a.to_cols_array().into_iter().map(f32::abs).fold(1.0, f32::max);
            largest =
                largest.max((*a - *b).to_cols_array().into_iter().map(f32::abs).fold(0.0, f32::max) / size);
        }
    }
    largest
}

fn skeleton(view: &View) -> &Skeleton {
    &view.loaded.model.animation.skeleton
}

/// Fails if two views have other poses, or other skins.
#[track_caller]
fn same_picture(a: &View, b: &View) {
    assert_eq!(a.takes.len(), b.takes.len());
    for (a_take, b_take) in a.takes.iter().zip(b.takes.iter()) {
        let difference = apart((skeleton(a), a_take), (skeleton(b), b_take));
        assert!(difference <= 1e-6, "{difference}");
    }
    let joints = |view: &View| -> Vec<Vec<String>> {
        let name = |bone: &u32| skeleton(view).bones[*bone as usize].name.clone();
        view.loaded.model.skins.iter().map(|skin| skin.bones.iter().map(name).collect()).collect()
    };
    assert_eq!(joints(a), joints(b));
}

fn nodes(path: &Path) -> Vec<Value> {
    let bytes = std::fs::read(path).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    json["nodes"].as_array().unwrap().clone()
}

#[test]
fn the_view_has_the_new_skeleton_and_undo_gives_the_old_model_itself() {
    let folder = Folder::new("root-view");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let before = document.open(&fox(&folder));
    document.edit(root("Motion"));
    let after = document.wait_for_view(|view| view.history.done == 1);
    assert!(Arc::ptr_eq(&after.opened, &before.loaded) && !Arc::ptr_eq(&after.loaded, &before.loaded));
    assert_eq!(
        (skeleton(&after).len(), &*skeleton(&after).bones[0].name),
        (skeleton(&before).len() + 1, "Motion")
    );
    assert_eq!(after.bones_since(&before.opened, &before.loaded), Some(BoneShift::ROOT_ADDED));
    assert_eq!((after.history.steps[0], &*after.history.about[0]), ("Add root bone", "Motion"));
    assert!(after.slots.iter().all(|slot| slot.original.tracks.len() == skeleton(&after).len()));
    same_picture(&before, &after);
    document.change(Change::Undo);
    let undone = document.view();
    assert!(Arc::ptr_eq(&undone.loaded, &before.loaded));
    same_takes(&undone, &before);
    document.change(Change::Redo);
    let again = document.view();
    same_takes(&again, &after);
    assert_eq!(skeleton(&again), skeleton(&after));
}

#[test]
fn the_edit_is_refused_where_it_makes_no_sense() {
    let folder = Folder::new("root-refused");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&fox(&folder));
    for (name, wanted) in
        [("b_Hip_01", "Another bone has the name \"b_Hip_01\""), (" ", "The root bone needs a name")]
    {
        document.edit(root(name));
        let refused = document.wait_for_reply(|reply| match reply {
            DocumentReply::Refused(reason) => Some(reason.clone()),
            _ => None,
        });
        assert_eq!(refused, wanted);
    }
    let cube = include_bytes!("../data/gltf/AnimatedMorphCube.glb");
    let mut model = read("a.glb", cube, &NoFiles, &ReadOptions::default()).unwrap().model;
    model.animation.skeleton = Arc::default();
    let refused = ModelAdapter::new(&model.animation).apply(&root("Root")).unwrap_err();
    assert!(matches!(refused, EditError::RootBone(_)), "{refused}");
}

#[test]
fn layers_pending_poses_contacts_and_removed_travel_follow_their_bones() {
    let bytes = include_bytes!("../data/gltf/Fox.glb");
    let model = read("Fox.glb", bytes, &NoFiles, &ReadOptions::default()).unwrap().model;
    let mut adapter = ModelAdapter::of(&model);
    let hip = adapter.skeleton().find("b_Hip_01").unwrap();
    for line in [
        r#"{"edit":"set","take":"Walk","time":0.3,"poses":[{"bone":"b_Head_05","rotation":[0,0,0.6,0.8]}]}"#,
        r#"{"edit":"add_layer","take":"Walk","name":"over","kind":"override","bones":["b_Neck_04","b_Head_05"]}"#,
        r#"{"edit":"set","take":{"take":"Walk","layer":"over"},"time":0.2,"poses":[{"bone":"b_Head_05","rotation":[0,0,0.6,0.8]}]}"#,
        r#"{"edit":"pend","take":"Walk","time":0.4,"poses":[{"bone":"b_Tail01_012","translation":[1,2,3]}]}"#,
        r#"{"edit":"set_contacts","take":"Run","bones":["b_LeftFoot01_017"],"contacts":[{"bone":"b_LeftFoot01_017","from":0.2,"to":0.5}]}"#,
        r#"{"edit":"remove_travel","take":"Run","bone":"b_Hip_01","parts":["x","z","height"]}"#,
    ] {
        adapter.apply(&edit(line)).expect(line);
    }
    let before = adapter.clone();
    let undo = adapter.apply(&root("Motion")).unwrap();
    adapter.check().unwrap();
    let shift = BoneShift::ROOT_ADDED;
    for (old, new) in before.slots().iter().zip(adapter.slots()) {
        assert_eq!(shift.take(&old.result).tracks, new.result.tracks);
        assert_eq!(shift.take(old.shown()).tracks, new.shown().tracks);
        let changed = |bone| shift.bone(bone).unwrap();
        assert_eq!(
            old.changed().map(|(bone, property)| (changed(bone), property)).collect::<Vec<_>>(),
            new.changed().collect::<Vec<_>>()
        );
        let pending = |slot: &dragonfly_document::adapter::TakeVersions| -> Vec<u32> {
            slot.pending().iter().flat_map(|at| &at.poses).map(|pose| pose.bone).collect()
        };
        assert_eq!(shift.bones(&pending(old)), pending(new));
        let masks = |slot: &dragonfly_document::adapter::TakeVersions| -> Vec<Vec<u32>> {
            slot.layers().iter().filter_map(|layer| Some(layer.settings.bones.as_ref()?.to_vec())).collect()
        };
        assert_eq!(masks(old).iter().map(|mask| shift.bones(mask)).collect::<Vec<_>>(), masks(new));
    }
    assert!(adapter.slots().iter().any(|slot| slot.pending_poses() == 1 && !slot.layers().is_empty()));
    let run = |adapter: &ModelAdapter| Arc::clone(&adapter.slots()[2].original);
    assert!(run(&adapter).extras.get(TRAVEL).unwrap().contains(&format!(r#""bone":{},"#, hip + 1)));
    let contacts = dragonfly_document::adapter::stored_contacts(&run(&adapter).extras, adapter.skeleton());
    assert_eq!(contacts.bones(), [adapter.skeleton().find("b_LeftFoot01_017").unwrap()]);
    // The removed travel goes back to the hips.
    let mut restored = adapter.clone();
    restored.apply(&edit(r#"{"edit":"restore_travel","take":"Run"}"#)).unwrap();
    let original = (&*model.animation.skeleton, &*model.animation.takes[2]);
    let difference = apart(original, (restored.skeleton(), &run(&restored)));
    assert!(difference < 1e-4, "{difference}");
    let redo = adapter.revert(undo);
    adapter.check().unwrap();
    assert_eq!(adapter.skeleton(), before.skeleton());
    adapter.revert(redo);
    adapter.check().unwrap();
    assert_eq!(adapter.skeleton().len(), before.skeleton().len() + 1);
}

/// Opens a model whose topmost bone is its hips: the fox without the bones above.
fn hips_on_top(folder: &Folder) -> PathBuf {
    let path = folder.join("hips.glb");
    let mut file = Editable::open(&Source::File(fox(folder)), &Cancel::default()).unwrap();
    let bytes = std::fs::read(file.path.take().unwrap()).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut json: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    let names = |node: &Value| node["name"].as_str().unwrap_or_default().to_owned();
    let nodes = json["nodes"].as_array().unwrap().clone();
    let hips = nodes.iter().position(|node| names(node) == "b_Hip_01").unwrap();
    for node in json["nodes"].as_array_mut().unwrap() {
        let is_parent = |child: &Value| child.as_u64() == Some(hips as u64);
        if let Some(children) = node["children"].as_array_mut() {
            children.retain(|child| !is_parent(child));
            if children.is_empty() {
                node.as_object_mut().unwrap().remove("children");
            }
        }
    }
    // Joints and channels above the hips are now those of the hips alone.
    let above = |node: &Value| {
        nodes
            .get(node.as_u64().unwrap() as usize)
            .is_some_and(|node| ["_rootJoint", "b_Root_00"].contains(&names(node).as_str()))
    };
    for animation in json["animations"].as_array_mut().unwrap() {
        animation["channels"].as_array_mut().unwrap().retain(|channel| !above(&channel["target"]["node"]));
    }
    json["skins"][0].as_object_mut().unwrap().remove("skeleton");
    let root = json["scenes"][0]["nodes"].as_array().unwrap()[0].clone();
    json["scenes"][0]["nodes"] = json!([root, hips]);
    let mut text = serde_json::to_vec(&json).unwrap();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut out = bytes[..12].to_vec();
    out.extend((text.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    out.extend(&text);
    out.extend(&bytes[20 + length..]);
    let total = (out.len() as u32).to_le_bytes();
    out[8..12].copy_from_slice(&total);
    std::fs::write(&path, out).unwrap();
    path
}

#[test]
fn travel_moves_from_the_hips_to_a_new_root_and_back() {
    let folder = Folder::new("root-travel");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let before = document.open(&hips_on_top(&folder));
    let hips = skeleton(&before).find("b_Hip_01").unwrap();
    assert_eq!(skeleton(&before).bones[hips as usize].parent, None);
    let motion = |from: &str, to: &str| {
        edit(&format!(
            r#"{{"edit":"move_travel","take":"Run","from":"{from}","to":"{to}","parts":["x","z","height","yaw"],"smooth":0}}"#
        ))
    };
    document.edit(root("Motion"));
    document.edit(motion("b_Hip_01", "Motion"));
    let moved = document.wait_for_view(|view| view.history.done == 2);
    let is_moving = |view: &View, bone: &str| {
        let bone = skeleton(view).find(bone).unwrap() as usize;
        let values = &view.takes[2].tracks[bone].translation.values;
        values.iter().any(|value| value.distance(values[0]) > 1e-3)
    };
    assert!(is_moving(&moved, "Motion") && !is_moving(&moved, "b_Hip_01"));
    let difference = apart((skeleton(&before), &before.takes[2]), (skeleton(&moved), &moved.takes[2]));
    assert!(difference < 1e-4, "{difference}");
    document.edit(motion("Motion", "b_Hip_01"));
    let back = document.wait_for_view(|view| view.history.done == 3);
    assert!(!is_moving(&back, "Motion"));
    let difference = apart((skeleton(&before), &before.takes[2]), (skeleton(&back), &back.takes[2]));
    assert!(difference < 1e-4, "{difference}");
    // In place with the root, and back.
    document.change(Change::Undo);
    document.edit(edit(
        r#"{"edit":"remove_travel","take":"Run","bone":"Motion","parts":["x","z","height","yaw"]}"#,
    ));
    document.edit(edit(r#"{"edit":"restore_travel","take":"Run"}"#));
    let again = document.wait_for_view(|view| view.history.done == 4);
    let difference = apart((skeleton(&moved), &moved.takes[2]), (skeleton(&again), &again.takes[2]));
    assert!(difference < 1e-4, "{difference}");
}

#[test]
fn a_saved_root_bone_is_there_when_the_file_is_opened_again_and_gone_after_undo_and_another_save() {
    let folder = Folder::new("root-saved");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let (bytes, first) = (std::fs::read(&path).unwrap(), nodes(&path));
    let mut document = TestDocument::new(&autosave);
    let opened = document.open(&path);
    document.edit(root("Motion"));
    document.edit(edit(r#"{"edit":"add_keys","take":"Walk","time":0.5,"bones":["Motion"]}"#));
    document.wait_for_view(|view| view.history.done == 2);
    document.save(SaveTo::Own);
    let saved = document.view();
    assert!(saved.history.saved);
    assert_eq!(nodes(&path).len(), first.len() + 1);
    // A second save of the same writes the same; one after another edit keeps the node.
    let once = std::fs::read(&path).unwrap();
    document.save(SaveTo::Own);
    assert!(std::fs::read(&path).unwrap() == once);
    document.edit(turn(0.5));
    document.save(SaveTo::Own);
    assert_eq!(nodes(&path).len(), first.len() + 1);
    let mut other = TestDocument::new(&folder.join("other"));
    let again = other.open(&path);
    assert_eq!(skeleton(&again).bones[0].name, "Motion");
    assert_eq!(skeleton(&again).bones[0].node, Some(first.len() as u32));
    same_picture(&document.view(), &again);
    other.end();
    document.change(Change::GoTo(0));
    document.save(SaveTo::Own);
    same_takes(&document.view(), &opened);
    assert!(nodes(&path) == first);
    let mut other = TestDocument::new(&folder.join("another"));
    same_picture(&other.open(&path), &opened);
    // And once more with the bone.
    document.change(Change::GoTo(2));
    document.save(SaveTo::Own);
    assert_eq!(nodes(&path).len(), first.len() + 1);
    document.change(Change::GoTo(0));
    document.end();
    assert!(std::fs::read(&path).unwrap() != bytes, "undo does not save");
}

/// Opens the file again after its program was killed, and continues with the journal.
fn restored(folder: &Folder, name: &str, path: &Path) -> (TestDocument, View) {
    copy_after_kill(&folder.join("autosave"), &folder.join(name));
    let mut document = TestDocument::new(&folder.join(name));
    let offer = {
        document.open(path);
        document.wait_for_offers().remove(0)
    };
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    let text = document.wait_for_reply(|reply| match reply {
        DocumentReply::Notice(text) | DocumentReply::Warning(text) => Some(text.clone()),
        _ => None,
    });
    assert!(text.starts_with("Restored"), "{text}");
    let view = document.view();
    (document, view)
}

#[test]
fn a_killed_program_has_the_root_bone_again_whatever_the_file_was_saved_with() {
    let folder = Folder::new("root-killed");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    let opened = document.open(&path);
    // Unsaved.
    document.edit(root("Motion"));
    document.edit(turn(0.5));
    let before = document.view();
    let (mut second, view) = restored(&folder, "unsaved", &path);
    same_takes(&view, &before);
    same_picture(&view, &before);
    second.change(Change::GoTo(0));
    same_takes(&second.view(), &opened);
    second.end();
    // The file has the bone, and the present state has another one above it.
    document.save(SaveTo::Own);
    document.edit(root("Top"));
    let before = document.view();
    let (mut second, view) = restored(&folder, "saved", &path);
    same_takes(&view, &before);
    assert_eq!(view.history, before.history);
    second.change(Change::GoTo(0));
    same_takes(&second.view(), &opened);
    second.change(Change::GoTo(3));
    same_takes(&second.view(), &before);
    second.end();
    // The file has the bone, and the present state and the history have not.
    document.change(Change::GoTo(0));
    document.edit(turn(0.7));
    let before = document.view();
    assert_eq!(skeleton(&before).len(), skeleton(&opened).len());
    let (mut second, view) = restored(&folder, "undone", &path);
    same_takes(&view, &before);
    assert_eq!(skeleton(&view), skeleton(&before));
    // A save of the restored work removes the node from the file.
    second.save(SaveTo::Own);
    assert_eq!(
        nodes(&path).len(),
        opened.loaded.model.animation.skeleton.bones.iter().filter_map(|bone| bone.node).max().unwrap()
            as usize
            + 1
    );
    second.change(Change::GoTo(0));
    same_takes(&second.view(), &opened);
}

#[test]
fn a_file_with_history_is_opened_again_with_the_root_bone_of_its_last_save() {
    let folder = Folder::new("root-history");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let mut document = TestDocument::new(&autosave);
    let opened = document.open(&path);
    document.edit(root("Motion"));
    document.save(SaveTo::Own);
    let before = document.view();
    document.end();
    let mut document = TestDocument::new(&autosave);
    let after = document.open(&path);
    assert_eq!((after.history.done, after.history.saved), (1, true));
    same_takes(&after, &before);
    document.change(Change::Undo);
    same_takes(&document.view(), &opened);
    document.save(SaveTo::Own);
    document.end();
    let mut document = TestDocument::new(&autosave);
    let after = document.open(&path);
    assert_eq!((after.history.done, after.history.steps.len()), (0, 1));
    same_takes(&after, &opened);
    document.change(Change::Redo);
    same_takes(&document.view(), &before);
}

#[test]
fn a_program_adds_a_root_bone_over_the_protocol() {
    let folder = Folder::new("root-protocol");
    let path = hips_on_top(&folder);
    let mut session = Session::new(Editable::open(&Source::File(path.clone()), &Cancel::default()).unwrap());
    let mut ask = |request: Value| -> Value {
        let answer: Value = serde_json::from_str(&session.answer(&request.to_string()).unwrap()).unwrap();
        assert!(answer.get("error").is_none(), "{request}: {answer}");
        answer["ok"].clone()
    };
    ask(json!({"edit": "add_root_bone", "name": "Motion"}));
    ask(json!({"edit": "move_travel", "take": "Run", "from": "b_Hip_01", "to": "Motion"}));
    let bones = ask(json!({"query": "bones"}));
    assert_eq!(bones[0]["name"], "Motion");
    let changes = ask(json!({"do": "plan"}));
    assert_eq!(changes["bonesAdded"][0]["bone"], "Motion", "{changes}");
    let output = folder.join("out.glb");
    ask(json!({"do": "save", "to": output}));
    ask(json!({"do": "undo"}));
    ask(json!({"do": "undo"}));
    ask(json!({"do": "save", "to": folder.join("back.glb")}));
    assert_eq!(nodes(&output).len(), nodes(&path).len() + 1);
    assert_eq!(nodes(&folder.join("back.glb")), nodes(&path));
}
