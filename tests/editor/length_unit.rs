//! The unit of length of a model is guessed from its size, or was set for its file; foot slide and edits are measured with it.

use crate::timeline_rig::Animator;
use crate::workbench::{Window, Workbench, type_into};
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, Request, Settings, State};
use dragonfly_anim::data::Skeleton;
use dragonfly_document::edit::{DetectContacts, Edit};
use dragonfly_document::{Change, View};
use dragonfly_kit::document::fixture;
use egui::Key;
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use std::time::Instant;

/// Returns a file with bones that are `length` apart.
fn file(title: &str, length: f32) -> View {
    let mut skeleton: Skeleton = fixture::skeleton(4);
    skeleton.bones.iter_mut().skip(1).for_each(|bone| bone.rest.translation = Vec3::Y * length);
    fixture::view(title, skeleton, &[("Walk", 1.0, 25)])
}

fn state() -> State {
    State::new(Settings::default(), Instant::now())
}

fn meters_of(state: &mut State, view: View) -> f32 {
    state.show(view);
    state.read().unit.meters()
}

#[test]
fn a_unit_that_was_set_is_restored_with_its_file_and_concerns_no_other() {
    let mut first = state();
    assert_eq!(meters_of(&mut first, file("human.glb", 0.4)), 1.0);
    assert_eq!(meters_of(&mut first, file("fox.glb", 40.0)), 0.01);
    assert_eq!(first.side_files().unsaved_marks(), None, "what the size says is not stored");
    first.execute(Request::LengthUnit(Some(0.0254)));
    let text = first.side_files().unsaved_marks().expect("set");
    assert_eq!(meters_of(&mut first, file("human.glb", 0.4)), 1.0);
    let mut again = state();
    again.side_files().read_marks(&text);
    assert_eq!(meters_of(&mut again, file("fox.glb", 40.0)), 0.0254);
    // A number that is no unit is not taken.
    for wrong in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        again.execute(Request::LengthUnit(Some(wrong)));
        assert_eq!(again.read().unit.meters(), 0.0254, "{wrong}");
    }
    again.execute(Request::LengthUnit(None));
    assert_eq!(again.read().unit.meters(), 0.01);
    let mut damaged = state();
    damaged.side_files().read_marks(&text.replace("0.0254", "-4"));
    assert_eq!(meters_of(&mut damaged, file("fox.glb", 40.0)), 0.01);
}

#[test]
fn the_dialog_shows_the_size_and_sets_the_unit_that_detection_uses() {
    let bench = Workbench::new(Some(file("fox.glb", 40.0)));
    let mut window: Window = bench.window();
    window.state_mut().state.execute(Request::Command(Id::ModelSize));
    window.run_steps(3);
    window.get_by_label_contains("By its file it would be ");
    let detection = |window: &mut Window| {
        let effect = window.state_mut().state.execute(Request::Command(Id::DetectContacts));
        let Some(Effect::Change(Change::Edit(Edit::DetectContacts(edit), _))) = effect else {
            panic!("{effect:?}")
        };
        let DetectContacts { meters_per_unit, .. } = edit;
        meters_per_unit
    };
    assert_eq!(detection(&mut window), Some(0.01.into()), "as the size says");
    type_into(&mut window, "Meters per unit", "0.025", Key::Enter);
    assert_eq!(window.state().state.read().unit.chosen(), Some(0.025));
    assert_eq!(detection(&mut window), Some(0.025.into()));
    window.get_by_label("Inches").click();
    window.run_steps(3);
    assert_eq!(window.state().state.read().unit.chosen(), Some(0.0254));
    window.get_by_label("By the size").click();
    window.run_steps(3);
    assert_eq!(window.state().state.read().unit.chosen(), None);
    window.get_by_label_contains("By its file it would be ");
}

#[test]
fn foot_slide_is_measured_again_in_another_unit() {
    let mut animator = Animator::with_bone(3);
    let slide = |animator: &mut Animator| {
        animator.steps(3);
        let worst = animator.harness.state().state.read().contacts.worst();
        worst.expect("a contact").millimeters_per_second
    };
    let line = r#"{"edit":"set_contacts","take":0,"contacts":[{"bone":5,"from":0.2,"to":0.8}]}"#;
    let edit: Edit = serde_json::from_str(line).expect(line);
    animator.request(Request::Change(Change::Edit(edit, None)));
    animator.request(Request::LengthUnit(Some(1.0)));
    let meters = slide(&mut animator);
    animator.request(Request::LengthUnit(Some(0.01)));
    let centimeters = slide(&mut animator);
    assert!(meters > 1.0 && (centimeters * 100.0 / meters - 1.0).abs() < 1e-4, "{meters} {centimeters}");
}
