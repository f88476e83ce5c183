//! The frame rate belongs to the document: the lowest usual one that its keys fit, or the one that was chosen for its file.

use crate::workbench::{Window, Workbench, type_into};
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, Request, Settings, State};
use dragonfly_document::edit::{Edit, SetPoses};
use dragonfly_document::{Change, View};
use dragonfly_kit::document::fixture;
use egui::Key;
use egui_kittest::kittest::Queryable;
use std::time::Instant;

/// Returns a file with a key on each of 41 frames.
fn file(title: &str, rate: f32) -> View {
    fixture::view(title, fixture::skeleton(2), &[("Walk", 40.0 / rate, 41)])
}

fn state() -> State {
    State::new(Settings::default(), Instant::now())
}

fn rate_of(state: &mut State, view: View) -> u32 {
    state.show(view);
    state.read().frame_rate
}

#[test]
fn each_document_has_the_lowest_usual_frame_rate_that_its_keys_fit() {
    let mut state = state();
    for rate in [24, 120, 24, 30, 60, 30, 25, 24] {
        assert_eq!(rate_of(&mut state, file(&format!("{rate}.glb"), rate as f32)), rate);
    }
    // Keys that fit no rate, after a document of another rate.
    assert_eq!(
        rate_of(&mut state, fixture::view("any.glb", fixture::skeleton(2), &[("Any", 3.417, 41)])),
        30
    );
    assert_eq!(rate_of(&mut state, fixture::empty()), 30);
}

#[test]
fn a_chosen_frame_rate_is_restored_with_its_file_and_concerns_no_other() {
    let mut first = state();
    first.show(file("Fox.glb", 24.0));
    assert_eq!(first.side_files().unsaved_marks(), None, "a guessed rate is not stored");
    first.execute(Request::FrameRate(18));
    let text = first.side_files().unsaved_marks().expect("chosen");
    assert_eq!(rate_of(&mut first, file("Crow.glb", 60.0)), 60);
    assert_eq!(rate_of(&mut first, file("Fox.glb", 24.0)), 18);
    let settings = Settings::parse(&first.read().settings.to_text());
    let mut again = State::new(settings, Instant::now());
    again.side_files().read_marks(&text);
    assert_eq!(rate_of(&mut again, file("Crow.glb", 60.0)), 60);
    assert_eq!(rate_of(&mut again, file("Fox.glb", 24.0)), 18);
    assert_eq!(again.side_files().unsaved_marks(), None, "as it was read");
    // An invalid number in the file of marks becomes the nearest valid one.
    let mut damaged = state();
    damaged.side_files().read_marks(&text.replace("18", "4000000000"));
    assert_eq!(rate_of(&mut damaged, file("Fox.glb", 24.0)), 480);
}

#[test]
fn a_frame_rate_is_chosen_from_a_list_or_typed() {
    let mut window: Window = Workbench::full().window();
    window.get_by_label("30 fps").click();
    window.run_steps(3);
    window.get_by_label("12 fps").click();
    window.run_steps(3);
    assert_eq!(window.state().state.read().frame_rate, 12);
    window.get_by_label("12 fps").click();
    window.run_steps(3);
    type_into(&mut window, "Frame rate", "2*9 fps", Key::Enter);
    assert_eq!(window.state().state.read().frame_rate, 18);
}

#[test]
fn baking_adds_keys_at_whole_frames_of_the_document_whatever_was_open_before() {
    let mut state = state();
    state.show(file("fast.glb", 120.0));
    state.show(file("slow.glb", 24.0));
    state.pause();
    state.execute(Request::Select(Some(3)));
    state.execute(Request::Command(Id::Pin));
    let effect = state.execute(Request::Command(Id::BakePins));
    let Some(Effect::Change(Change::Edit(Edit::SetPoses(SetPoses { at, .. }), _))) = effect else {
        panic!("{effect:?}");
    };
    assert_eq!(at.len(), 41, "one key a frame");
    for (frame, pose) in at.iter().enumerate() {
        assert!((pose.time * 24.0 - frame as f32).abs() < 1e-3, "{}", pose.time);
    }
}
