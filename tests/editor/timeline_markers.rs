//! Markers are stored by the program for each model, never in the file of the model.

use crate::panels::Bench;
use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{KeysRequest, MarkerAction};
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use dragonfly_document::{Change, FileView};
use dragonfly_kit::document::fixture;
use egui::{PointerButton, vec2};
use egui_kittest::kittest::Queryable;
use std::sync::Arc;

fn marker(animator: &mut Animator, action: MarkerAction) {
    animator.request(Request::Timeline(KeysRequest::Marker(action)));
}

fn names(animator: &Animator) -> Vec<(f32, String)> {
    animator
        .harness
        .state()
        .state
        .read()
        .markers()
        .iter()
        .map(|marker| (marker.time, marker.name.clone()))
        .collect()
}

#[test]
fn markers_are_added_named_moved_jumped_to_and_deleted() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Seek(2.0));
    animator.request(Request::Command(Id::AddMarker));
    animator.request(Request::Command(Id::AddMarker));
    assert_eq!(names(&animator).len(), 1, "one at a time is enough");
    animator.request(Request::Seek(1.0));
    animator.request(Request::Command(Id::AddMarker));
    marker(&mut animator, MarkerAction::Rename(0, "left contact".to_owned()));
    assert_eq!(names(&animator)[0], (1.0, "left contact".to_owned()), "ascending");
    animator.request(Request::Command(Id::NextMarker));
    assert_eq!(animator.harness.state().state.read().time(), 2.0);
    let place = animator.harness.get_by_label("Marker left contact").rect().left_center() + vec2(6.0, 0.0);
    animator.click(place);
    assert_eq!(animator.harness.state().state.read().time(), 1.0, "a click goes there");
    animator.drag(place, place + vec2(60.0, 0.0));
    animator.release(place + vec2(60.0, 0.0));
    assert!(names(&animator)[0].0 > 1.2, "{:?}", names(&animator));
    marker(&mut animator, MarkerAction::Delete(7));
    marker(&mut animator, MarkerAction::Delete(0));
    assert_eq!(names(&animator).len(), 1);
    assert!(animator.changes.is_empty(), "the document knows nothing of it");
}

#[test]
fn markers_are_restored_with_the_file_and_a_damaged_text_gives_none() {
    let mut animator = Animator::with_bone(3);
    marker(&mut animator, MarkerAction::Add(0.5));
    let (file, text) = animator.harness.state_mut().state.side_files().unsaved_markers().unwrap();
    assert!(file.starts_with("markers/") && file.ends_with(".json"));
    assert_eq!(animator.harness.state_mut().state.side_files().unsaved_markers(), None, "said once");
    let mut again = Bench::new(Some(fixture::full())).state;
    assert_eq!(again.side_files().wanted_markers(), Some(file));
    assert_eq!(again.side_files().wanted_markers(), None, "asked once");
    again.side_files().read_markers(&text);
    assert_eq!(again.read().markers().len(), 1);
    for damaged in ["", "{", "[1,2]", &text.replace("0.5", "1e999"), &text[..text.len() / 2]] {
        let mut other = Bench::new(Some(fixture::full())).state;
        other.side_files().read_markers(damaged);
        assert!(other.read().markers().len() <= 1);
    }
}

#[test]
fn a_copied_take_has_its_markers_and_a_split_take_those_after_the_cut() {
    let times = |animator: &Animator| names(animator).iter().map(|(time, _)| *time).collect::<Vec<_>>();
    let mut animator = Animator::with_bone(3);
    for time in [0.5, 1.0, 2.0] {
        marker(&mut animator, MarkerAction::Add(time));
    }
    marker(&mut animator, MarkerAction::Rename(2, "turn".to_owned()));
    animator.request(Request::Command(Id::DuplicateTake));
    assert_eq!(animator.harness.state().state.read().playback.take, Some(1), "the copy is shown");
    assert_eq!(times(&animator), [0.5, 1.0, 2.0]);
    assert_eq!(names(&animator)[2].1, "turn");
    marker(&mut animator, MarkerAction::Delete(0));
    animator.request(Request::ShowTake(Some(0)));
    assert_eq!(times(&animator).len(), 3, "each has its own");
    animator.request(Request::Seek(1.5));
    animator.request(Request::Command(Id::SplitTake));
    animator.request(Request::ShowTake(Some(1)));
    assert_eq!(names(&animator), [(0.5, "turn".to_owned())]);
    // A new empty take has no markers.
    animator.request(Request::Command(Id::NewTake));
    assert!(names(&animator).is_empty());
}

#[test]
fn typing_replaces_the_name_of_a_marker() {
    let mut animator = Animator::with_bone(3);
    marker(&mut animator, MarkerAction::Add(1.0));
    let place = animator.harness.get_by_label("Marker Marker 1").rect().left_center() + vec2(6.0, 0.0);
    animator.move_to(place);
    animator.button(place, PointerButton::Secondary, true);
    animator.button(place, PointerButton::Secondary, false);
    animator.steps(2);
    animator.harness.get_by_label("Rename").click();
    animator.steps(2);
    assert!(animator.harness.query_by_label("Name of the marker").is_some());
    animator.harness.event(egui::Event::Text("contact".to_owned()));
    animator.steps(2);
    animator.harness.key_press(egui::Key::Enter);
    animator.steps(2);
    assert_eq!(names(&animator), [(1.0, "contact".to_owned())]);
}

#[test]
fn markers_follow_save_as_and_renamed_takes() {
    let mut animator = Animator::with_bone(3);
    // As the window does when a file is opened.
    let state = &mut animator.harness.state_mut().state;
    assert!(state.side_files().wanted_markers().is_some());
    state.side_files().read_markers("");
    marker(&mut animator, MarkerAction::Add(0.5));
    let first = animator.harness.state_mut().state.side_files().unsaved_markers().unwrap();
    let rename = Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: "March".to_owned() });
    animator.request(Request::Change(Change::Edit(rename, None)));
    animator.steps(2);
    let state = &mut animator.harness.state_mut().state;
    let mut view = state.read().view.cloned().unwrap();
    let other = Arc::new(FileView {
        title: "other.glb".to_owned(),
        path: Some("other.glb".into()),
        ..FileView::default()
    });
    view.file = Arc::clone(&other);
    state.show(view);
    let (file, text) = state.side_files().unsaved_markers().expect("of the new file too");
    assert_ne!(file, first.0);
    // Until it is saved the file contains the old name of the take, afterwards the new one.
    let renamed = fixture::view("other.glb", fixture::skeleton(3), &[("March", 2.0, 21)]);
    for mut opened in [fixture::full(), renamed] {
        opened.file = Arc::clone(&other);
        let mut again = Bench::new(Some(opened)).state;
        assert_eq!(again.side_files().wanted_markers().as_ref(), Some(&file));
        again.side_files().read_markers(&text);
        assert_eq!(again.read().markers().len(), 1);
    }
}
