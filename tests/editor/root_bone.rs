//! A root bone that is added in the window or by the command line: the dialog for root motion proposes it, and everything that belongs
//! to bones follows them to their new numbers and back.

use crate::program::run;
use crate::stdio::StdioSession;
use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly::panels::selection_sets::SetAction;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BoneRef, Edit, Property};
use dragonfly_kit::document::fixture;
use dragonfly_kit::folder::{Folder, data};
use egui_kittest::kittest::Queryable;
use serde_json::json;

/// Clicks the button with this label.
fn click(animator: &mut Animator, label: &str) {
    animator.steps(2);
    let at = animator.harness.get_by_label(label).rect().center();
    animator.click(at);
    animator.steps(2);
}

fn has(animator: &Animator, label: &str) -> bool {
    animator.harness.query_by_label(label).is_some()
}

#[test]
fn the_dialog_makes_a_root_bone_and_moves_the_travel_of_the_hips_to_it() {
    let mut animator = Animator::new(fixture::hips_on_top());
    animator.request(Request::Command(Id::RootMotion));
    animator.steps(2);
    assert!(has(&animator, "hips travels"));
    click(&mut animator, "Make a root bone");
    let Some(Edit::AddRootBone(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!(edit.name, "Root");
    assert!(!has(&animator, "Make a root bone"));
    // The new bone is the proposed root.
    click(&mut animator, "Height");
    click(&mut animator, "Move to root");
    let Some(Edit::MoveTravel(edit)) = animator.edits().last().copied() else {
        panic!("no edit: {}", animator.said())
    };
    assert_eq!((&edit.from, &edit.to), (&BoneRef::Index(1), &BoneRef::Index(0)));
    animator.steps(2);
    assert!(has(&animator, "Root travels"));
    // Undo of both: the dialog offers a root bone again.
    animator.request(Request::Command(Id::Undo));
    animator.request(Request::Command(Id::Undo));
    animator.steps(2);
    assert!(has(&animator, "Make a root bone") && has(&animator, "hips travels"));
}

#[test]
fn the_command_finds_a_name_that_no_bone_has() {
    let mut animator = Animator::new(fixture::hips_on_top());
    for _ in 0..3 {
        animator.request(Request::Command(Id::AddRootBone));
    }
    let bones = animator.edited.adapter().skeleton();
    let names: Vec<&str> = bones.bones[..4].iter().map(|bone| bone.name.as_str()).collect();
    assert_eq!(names, ["Root 3", "Root 2", "Root", "hips"]);
    assert!(animator.said().contains("Add root bone"), "{}", animator.said());
}

/// Everything that the panels keep about bones, by the names of the bones.
#[derive(Debug, PartialEq)]
struct KeptBones {
    selected: Vec<String>,
    keys: Vec<(String, Property)>,
    hidden: Vec<String>,
    pins: Vec<String>,
    pole: Option<String>,
    flags: Vec<Vec<String>>,
    sets: Vec<Vec<String>>,
    /// Rows of the tree.
    rows: Vec<bool>,
}

fn kept(animator: &Animator) -> KeptBones {
    let context = animator.harness.state().state.read();
    let name = |bone: u32| context.bone_name(bone);
    let names = |bones: &[u32]| bones.iter().map(|&bone| name(bone)).collect::<Vec<_>>();
    let count = context.loaded().unwrap().model.animation.skeleton.len() as u32;
    let hidden: Vec<u32> = (0..count).filter(|&bone| context.hidden.is_hidden(bone)).collect();
    let flags = |flag| names(&context.keys.flags().of(flag).collect::<Vec<_>>());
    let keys = context.keys.selection().channels().map(|((bone, property), _)| (name(bone), property));
    let row = |bone: &str| animator.harness.query_by_label(&format!("Hide {bone}")).is_some();
    KeptBones {
        selected: names(context.selection.bones()),
        keys: keys.collect(),
        hidden: names(&hidden),
        pins: names(context.pins),
        pole: context.ik.pole.map(name),
        flags: BoneFlag::ALL.map(flags).to_vec(),
        sets: context.sets.list().iter().map(|set| names(&set.bones)).collect(),
        rows: ["rib_00_left_inner", "rib_00_left_middle"].map(row).to_vec(),
    }
}

#[test]
fn what_belongs_to_bones_follows_them_when_a_root_bone_is_added_undone_and_redone() {
    let mut animator = Animator::new(fixture::full());
    click(&mut animator, "Collapse rib_00_left_inner");
    animator.request(Request::Hide { bones: vec![40, 41], hide: true });
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Mute, 30, true)));
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 31, true)));
    animator.request(Request::SelectBones(vec![5, 6, 7], Choice::Replace));
    animator.request(Request::Sets(SetAction::Save));
    animator.request(Request::SelectBones(vec![5, 7], Choice::Replace));
    animator.request(Request::Command(Id::Pin));
    animator.request(Request::Select(Some(8)));
    animator.request(Request::Command(Id::IkPole));
    animator.request(Request::Select(Some(6)));
    let channels = [(6, Property::Rotation)].into();
    let stretch = [0.0, 1.0];
    animator.request(Request::Timeline(KeysRequest::Select {
        channels,
        shapes: false,
        stretch,
        choice: Choice::Replace,
    }));
    animator.steps(3);
    let before = kept(&animator);
    let full = (before.selected.len(), before.keys.len(), before.hidden.len(), before.pins.len());
    assert_eq!(full, (1, 1, 2, 2), "{before:?}");
    assert!(
        before.pole.is_some()
            && before.sets == [["rib_00_right_inner", "rib_00_right_middle", "rib_00_right_tip"]]
    );
    assert_eq!(before.rows, [true, false], "a collapsed row");
    animator.request(Request::Command(Id::AddRootBone));
    animator.steps(3);
    assert_eq!(animator.edited.adapter().skeleton().bones[0].name, "Root");
    assert_eq!(kept(&animator), before);
    animator.request(Request::Select(Some(3)));
    animator.steps(2);
    let selected = kept(&animator).selected;
    animator.request(Request::Command(Id::Undo));
    animator.steps(3);
    assert_eq!(kept(&animator), before, "undo selects what was selected before the edit");
    animator.request(Request::Command(Id::Redo));
    animator.steps(3);
    assert_eq!(kept(&animator).selected, selected, "redo selects what was selected after it");
    assert_eq!(kept(&animator).pins, before.pins);
}

#[test]
fn the_command_line_adds_a_root_bone_and_reports_it() {
    let folder = Folder::new("root-bone-command");
    let (edits, output) = (folder.join("edits.jsonl"), folder.join("out.gltf"));
    std::fs::write(&edits, r#"{"edit":"add_root_bone","name":"Root"}"#).unwrap();
    let file = data("gltf/SimpleSkin_embedded.gltf");
    let arguments = ["edit".as_ref(), file.as_os_str(), "--edits".as_ref(), edits.as_os_str()];
    let said = run(arguments.into_iter().chain(["--dry-run".as_ref()])).expect(0);
    assert!(said.text().contains("1 bone added"), "{}", said.text());
    run(arguments.into_iter().chain(["-o".as_ref(), output.as_os_str()])).expect(0);
    let info = run(["info".as_ref(), output.as_os_str(), "--json".as_ref()]).expect(0).json();
    assert_eq!(info["bones"][0]["name"], "Root", "{info}");
    // Twice is refused.
    let again =
        ["edit".as_ref(), output.as_os_str(), "--edits".as_ref(), edits.as_os_str(), "--dry-run".as_ref()];
    let refused = run(again).expect(2);
    let text = refused.stderr;
    assert!(text.contains("another bone has the name \"Root\""), "{text}");
}

#[test]
fn a_root_bone_that_was_added_over_standard_input_is_in_the_saved_file_until_it_is_undone() {
    let folder = Folder::new("root-bone-stdio");
    let path = folder.join("Fox.glb");
    std::fs::copy(data("gltf/Fox.glb"), &path).unwrap();
    let info = || run(["info".as_ref(), path.as_os_str(), "--json".as_ref()]).expect(0).json();
    let opened = info();
    let mut session = StdioSession::about(&path);
    session.ask(&json!({"edit": "add_root_bone", "name": "Motion"}));
    let bones = session.ask(&json!({"query": "bones"}));
    assert_eq!((&bones[0]["name"], &bones[1]["name"]), (&json!("Motion"), &opened["bones"][0]["name"]));
    let pose = json!([{"bone": 0, "translation": [1, 0, 0]}]);
    session.ask(&json!({"edit": "set", "take": "Walk", "time": 0.1, "poses": pose}));
    assert_eq!(session.ask(&json!({"do": "plan"}))["bonesAdded"][0]["bone"], "Motion");
    session.ask(&json!({"do": "save"}));
    assert_eq!(info()["bones"][0]["name"], "Motion");
    session.ask(&json!({"do": "go_to", "steps": 0}));
    assert_eq!(session.ask(&json!({"query": "bones"}))[0]["name"], opened["bones"][0]["name"]);
    session.ask(&json!({"do": "save"}));
    assert_eq!(info()["bones"], opened["bones"]);
}
