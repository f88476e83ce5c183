//! Drawn lines selected by clicks in the viewport and in the list, and deleted.

use crate::scene_bench::{FOXES, named_text, project};
use crate::scene_lines::{at, send};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent, Modifiers};
use dragonfly::panels::Request;
use dragonfly::panels::scene::{LineRequest, SceneRequest};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use egui::{Key, Pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;

/// Three notes on the ground, one of them farther away and one shown later.
/// Size of a window in which all rows of the list are in sight, points.
const TALL: egui::Vec2 = egui::vec2(1280.0, 1600.0);

const LINES: &str = r#"<lines version="1">
  <line id="near" points="-0.3 0 1.5  -0.1 0 1.5  0.1 0 1.5  0.3 0 1.5"/>
  <line id="far" points="-0.3 0 1.1  -0.1 0 1.1  0.1 0 1.1  0.3 0 1.1"/>
  <line id="late" points="-0.3 0 1.3  -0.1 0 1.3  0.1 0 1.3  0.3 0 1.3" from="2"/>
</lines>
"#;

const SHIFT: Modifiers = Modifiers { shift: true, ctrl: false, alt: false };
const CTRL: Modifiers = Modifiers { shift: false, ctrl: true, alt: false };

fn click(window: &mut Window, z: f64, modifiers: Modifiers) -> Pos2 {
    let place = at(window, DVec3::new(0.05, 0.0, z));
    send(window, InputEvent::Modifiers(modifiers));
    send(window, InputEvent::MouseMove(place));
    send(window, InputEvent::MouseDown(Button::Left));
    send(window, InputEvent::MouseUp(Button::Left));
    send(window, InputEvent::Modifiers(Modifiers::default()));
    Pos2::new(place.x, place.y)
}

fn selected(window: &Window) -> Vec<String> {
    let read = window.state().state.read();
    let listed: Vec<String> =
        read.scene_editing.lines().selected_list().iter().map(|line| line.to_string()).collect();
    for line in ["near", "far", "late"] {
        let name = format!("{line}, line");
        let row = window.get_by_label(&name);
        let is_marked = row.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True);
        assert_eq!(
            is_marked,
            listed.iter().any(|own| own == line),
            "the list shows {line} as it is: {listed:?}"
        );
    }
    listed
}

fn lines(window: &Window) -> String {
    named_text(window, "scene.lines.xml")
}

#[test]
fn a_click_on_a_note_selects_it_shift_adds_another_one_and_delete_removes_both_in_one_step() {
    let mut window = project(FOXES, LINES).window_of(TALL, egui::Theme::Dark);
    click(&mut window, 1.5, Modifiers::default());
    assert_eq!(selected(&window), ["near"]);
    assert!(window.state().state.read().scene_editing.things().is_empty());
    click(&mut window, 1.1, SHIFT);
    assert_eq!(selected(&window), ["near", "far"]);
    window.key_press(Key::Delete);
    window.run_steps(3);
    let left = lines(&window);
    assert!(!left.contains("near") && !left.contains("far") && left.contains("late"), "{left}");
    assert_eq!(window.state().steps(), (1, 1));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(lines(&window), LINES);
}

#[test]
fn a_click_selects_only_notes_that_are_seen_and_the_ground_none() {
    let mut window = project(FOXES, LINES).window_of(TALL, egui::Theme::Dark);
    click(&mut window, 1.3, Modifiers::default());
    assert!(selected(&window).is_empty(), "it is not shown yet");
    window.state_mut().state.execute(Request::Seek(3.0));
    window.run_steps(2);
    click(&mut window, 1.3, Modifiers::default());
    assert_eq!(selected(&window), ["late"]);
    click(&mut window, 1.5, CTRL);
    click(&mut window, 1.1, CTRL);
    click(&mut window, 1.5, CTRL);
    assert_eq!(selected(&window), ["late", "far"]);
    let hide = Request::Scene(SceneRequest::Line(LineRequest::Hide("near".into(), true)));
    window.state_mut().state.execute(hide);
    window.run_steps(2);
    // Nothing is there for the graphics thread either.
    let at = click(&mut window, 1.5, Modifiers::default());
    assert_eq!(selected(&window), ["late", "far"], "the click is for the things behind");
    window.state_mut().state.thing_picked(at, &[], Choice::Replace);
    window.run_steps(2);
    assert!(selected(&window).is_empty());
    click(&mut window, 1.1, Modifiers::default());
    window.state_mut().state.thing_picked(at, &["anna".into()], Choice::Replace);
    window.run_steps(2);
    assert!(selected(&window).is_empty());
    assert_eq!(window.state().state.read().scene_editing.things(), [Box::from("anna")]);
}

#[test]
fn rows_of_the_list_are_selected_with_shift_and_ctrl_as_those_of_things() {
    let mut window = project(FOXES, LINES).window_of(TALL, egui::Theme::Dark);
    window.get_by_label("near, line").click();
    window.run_steps(2);
    window.get_by_label("late, line").click_modifiers(egui::Modifiers::SHIFT);
    window.run_steps(2);
    assert_eq!(selected(&window), ["near", "far", "late"]);
    window.get_by_label("far, line").click_modifiers(egui::Modifiers::COMMAND);
    window.run_steps(2);
    assert_eq!(selected(&window), ["near", "late"]);
}
