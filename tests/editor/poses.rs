//! The panel of the pose library: saves the pose of the selected bones, applies and blends poses, and finds them by name and tag.

use crate::timeline_rig::Animator;
use crate::workbench::Workbench;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly::panels::{Effect, FileAction, Request};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BonePose, BoneRef, Edit};
use dragonfly_document::{DocumentMessage, PoseFile, PoseFolder, PoseOrder, StoredPose};
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::Queryable;
use std::path::PathBuf;

/// The bone that the poses of the library turn, and the one of the other side.
const BONES: [(u32, &str); 2] = [(3, "rib_00_left_middle"), (6, "rib_00_right_middle")];

fn turned(bone: &str, angle: f32) -> BonePose {
    let rotation = Some(glam::Quat::from_rotation_z(angle).to_array());
    BonePose { bone: BoneRef::Name(bone.to_owned()), translation: None, rotation, scale: None }
}

fn file(name: &str, tags: &[&str], poses: Vec<BonePose>) -> PoseFile {
    let tags = tags.iter().map(|tag| (*tag).to_owned()).collect();
    PoseFile { file: format!("{name}.pose.json"), pose: StoredPose::new(name.to_owned(), tags, poses) }
}

/// Creates a window with the panel at 1 s, where no key is, and two poses: one of both bones, one of a bone that the model does not have.
fn animator() -> Animator {
    let mut animator = Animator::new(fixture::full());
    let state = &mut animator.harness.state_mut().state;
    state.set_usual_pose_folder(Some(PathBuf::from("poses")));
    let poses = vec![turned(BONES[0].1, 1.0), turned(BONES[1].1, 0.5)];
    let folder = PoseFolder {
        folder: PathBuf::from("poses"),
        poses: vec![
            file("Wide", &["chest", "Calm"], poses),
            file("Tail up", &["tail"], vec![turned("tail", 1.0)]),
        ],
        problems: Vec::new(),
    };
    state.poses_read(folder);
    animator.harness.get_by_label("Poses").click();
    animator.steps(3);
    animator.request(Request::Seek(1.0));
    animator
}

/// Returns the orders for the library so far.
fn orders(animator: &Animator) -> Vec<PoseOrder> {
    let order = |effect: &Effect| match effect {
        Effect::File(FileAction::Send(DocumentMessage::Poses(order))) => Some(order.clone()),
        _ => None,
    };
    animator.harness.state().effects.iter().filter_map(order).collect()
}

/// Returns the angle about z of a key of a bone at 1 s.
fn angle(animator: &Animator, bone: u32) -> Option<f32> {
    let rotation = &animator.edited.adapter().slots()[0].result.tracks[bone as usize].rotation;
    let key = rotation.times.iter().position(|time| (time - 1.0).abs() < 1e-4)?;
    let [_, _, z, w] = rotation.value(key)?.to_array();
    Some(2.0 * z.atan2(w))
}

fn near(angle: Option<f32>, wanted: f32) -> bool {
    angle.is_some_and(|angle| (angle - wanted).abs() < 1e-4)
}

/// Chooses an entry of the context menu of a pose.
fn choose(animator: &mut Animator, name: &str, entry: &str) {
    let at = animator.harness.get_by_label(name).rect().center();
    animator.move_to(at);
    for pressed in [true, false] {
        animator.button(at, egui::PointerButton::Secondary, pressed);
    }
    animator.steps(3);
    animator.harness.get_by_label(entry).click();
    animator.steps(4);
}

#[test]
fn the_panel_reads_its_folder_once_and_saves_the_pose_of_the_selected_bones() {
    let mut animator = animator();
    assert_eq!(orders(&animator), [PoseOrder::Read(PathBuf::from("poses"))]);
    animator.request(Request::Select(Some(BONES[0].0)));
    animator.harness.get_by_label("Save pose").click();
    animator.steps(3);
    let Some(PoseOrder::Save { file: None, pose, .. }) = orders(&animator).pop() else {
        panic!("{:?}", orders(&animator))
    };
    assert_eq!((pose.name.as_str(), pose.poses.len()), ("Pose 1", 1));
    assert_eq!(pose.poses[0].bone, BoneRef::Name(BONES[0].1.to_owned()));
    let given = &pose.poses[0];
    assert!(given.translation.is_some() && given.rotation.is_some() && given.scale.is_some());
    animator.request(Request::Select(None));
    animator.harness.get_by_label("Save pose").click();
    animator.steps(3);
    let Some(PoseOrder::Save { pose, .. }) = orders(&animator).pop() else { panic!("not saved") };
    assert_eq!(pose.poses.len(), animator.edited.adapter().skeleton().len(), "all bones");
}

#[test]
fn a_pose_is_applied_to_the_selected_bones_as_one_step() {
    let mut animator = animator();
    animator.request(Request::Select(Some(BONES[0].0)));
    choose(&mut animator, "Wide", "Apply");
    assert!(near(angle(&animator, 3), 1.0), "{:?}", angle(&animator, 3));
    assert_eq!((angle(&animator, 6), animator.edited.steps().1), (None, 1));
    animator.request(Request::Command(Id::Undo));
    animator.request(Request::Select(None));
    choose(&mut animator, "Wide", "Apply");
    assert!(near(angle(&animator, 3), 1.0) && near(angle(&animator, 6), 0.5), "all bones of the pose");
    assert_eq!(animator.edited.steps().1, 1);
}

#[test]
fn a_double_click_applies_a_pose() {
    let mut window = Workbench::full().window();
    let state = &mut window.state_mut().state;
    state.set_usual_pose_folder(Some(PathBuf::from("poses")));
    let poses = vec![file("Wide", &[], vec![turned(BONES[0].1, 1.0)])];
    state.poses_read(PoseFolder { folder: PathBuf::from("poses"), poses, problems: Vec::new() });
    window.get_by_label("Poses").click();
    // Half a second later, so that this click is not the first of a triple click.
    window.run_steps(30);
    let pos = window.get_by_label("Wide").rect().center();
    window.event(egui::Event::PointerMoved(pos));
    for pressed in [true, false, true, false] {
        let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::NONE);
        window.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
    }
    window.run_steps(3);
    let [_, _, z, w] = window.state().pose(3).rotation.to_array();
    assert!(near(Some(2.0 * z.atan2(w)), 1.0), "{z} {w}");
}

#[test]
fn a_deleted_pose_is_deleted_in_its_folder() {
    let mut animator = animator();
    choose(&mut animator, "Tail up", "Delete pose");
    let (folder, file) = (PathBuf::from("poses"), "Tail up.pose.json".to_owned());
    assert_eq!(orders(&animator).pop(), Some(PoseOrder::Delete { folder, file }));
}

#[test]
fn a_locked_bone_keeps_its_pose_and_without_auto_key_the_pose_is_pending() {
    let mut animator = animator();
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 3, true)));
    choose(&mut animator, "Wide", "Apply");
    assert_eq!(angle(&animator, 3), None);
    assert!(near(angle(&animator, 6), 0.5));
    animator.request(Request::Command(Id::Undo));
    animator.request(Request::Command(Id::AutoKey));
    choose(&mut animator, "Wide", "Apply");
    assert_eq!((angle(&animator, 6), animator.edited.adapter().pending_poses()), (None, 1));
}

#[test]
fn a_mirrored_pose_goes_to_the_other_side() {
    let mut animator = animator();
    animator.request(Request::Select(Some(BONES[1].0)));
    let at = animator.harness.get_by_label("Wide").rect().center();
    animator.click(at);
    animator.steps(20);
    animator.harness.get_by_label("Mirrored").click();
    animator.steps(3);
    // A mirror reverses rotations about z; the angle comes from the left bone.
    assert!(near(angle(&animator, 6), -1.0), "{:?}", angle(&animator, 6));
    assert_eq!(angle(&animator, 3), None);
    assert!(matches!(animator.edits()[..], [Edit::PastePose(_)]));
}

#[test]
fn a_drag_sideways_blends_as_one_step_and_escape_leaves_no_trace() {
    let mut animator = animator();
    animator.request(Request::SelectBones(vec![3, 6], Choice::Replace));
    let poses = animator.harness.state().state.read().posed.animation().expect("poses").poses().to_vec();
    let now = |bone: usize| {
        let [_, _, z, w] = poses[bone].rotation.to_array();
        2.0 * z.atan2(w)
    };
    let from = animator.harness.get_by_label("Wide").rect().center();
    // 60 of 120 points.
    let to = from + egui::vec2(60.0, 0.0);
    animator.drag(from, to);
    assert!(near(angle(&animator, 3), (now(3) + 1.0) / 2.0), "{:?}", angle(&animator, 3));
    animator.harness.key_press(egui::Key::Escape);
    animator.steps(2);
    animator.release(to);
    assert_eq!((angle(&animator, 3), animator.edited.steps().1), (None, 0));
    animator.drag(from, to);
    animator.release(to);
    assert!(near(angle(&animator, 6), (now(6) + 0.5) / 2.0), "{:?}", angle(&animator, 6));
    assert_eq!(animator.edited.steps().1, 1);
    let far = from + egui::vec2(400.0, 0.0);
    animator.drag(from, far);
    animator.release(far);
    assert!(near(angle(&animator, 3), 1.0), "at most 100 %");
}

#[test]
fn poses_are_found_by_name_and_tag() {
    let mut animator = animator();
    let shown =
        |animator: &Animator| ["Wide", "Tail up"].map(|name| animator.harness.query_by_label(name).is_some());
    assert_eq!(shown(&animator), [true, true]);
    for (text, expected) in [("calm", [true, false]), ("tail", [false, true]), ("chest tail", [false, false])]
    {
        let field = animator.harness.get_by_label("Find a pose").rect().center();
        animator.click(field);
        animator.hold(egui::Modifiers::COMMAND);
        animator.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        animator.hold(egui::Modifiers::NONE);
        animator.harness.event(egui::Event::Text(text.to_owned()));
        animator.steps(3);
        assert_eq!(shown(&animator), expected, "{text}");
    }
}

#[test]
fn a_pose_gets_another_name_and_tags_in_its_file() {
    let mut animator = animator();
    let at = animator.harness.get_by_label("Wide").rect().center();
    animator.click(at);
    animator.steps(3);
    let field = animator.harness.get_by_label("Tags, with commas").rect().center();
    animator.click(field);
    animator.harness.key_press(egui::Key::End);
    animator.harness.event(egui::Event::Text(", open".to_owned()));
    animator.steps(2);
    animator.harness.key_press(egui::Key::Enter);
    animator.steps(3);
    let Some(PoseOrder::Save { file, pose, .. }) = orders(&animator).pop() else { panic!("not saved") };
    assert_eq!(file.as_deref(), Some("Wide.pose.json"));
    assert_eq!(
        (pose.name.as_str(), pose.tags),
        ("Wide", ["chest", "Calm", "open"].map(str::to_owned).to_vec())
    );
    assert_eq!(pose.poses.len(), 2);
}

#[test]
fn the_chosen_folder_is_remembered() {
    let mut animator = animator();
    animator.request(Request::PoseFolder(PathBuf::from("shared/poses")));
    assert_eq!(orders(&animator).pop(), Some(PoseOrder::Read(PathBuf::from("shared/poses"))));
    let text = animator.harness.state().state.read().settings.to_text();
    let again = dragonfly::panels::Settings::parse(&text);
    assert_eq!(again.pose_folder, Some(PathBuf::from("shared/poses")));
}
