//! The reason why there is no ground under the pointer is shown at the pointer, as long as it lasts.

use crate::scene_bench::{FOXES, looked, new_lines, scene, text};
use crate::scene_lines::{run, send};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent, Modifiers};
use dragonfly::panels::commands::Id;
use dragonfly::panels::status::MessageSeverity;
use dragonfly::panels::{Effect, Request};
use egui::Rect;
use egui_kittest::kittest::Queryable;
use glam::Vec2;
use std::path::PathBuf;

const HORIZON: &str = "no ground above the horizon";
const EDGE: &str = "seen from its edge";

/// Moves the pointer to a height of the viewport: 0 is its upper edge and 1 its lower one. Returns the position.
fn point(window: &mut Window, height: f32) -> Vec2 {
    let rect = window.state().state.read().viewport;
    let at = Vec2::new(rect.center().x, rect.top() + rect.height() * height);
    send(window, InputEvent::MouseMove(at));
    at
}

/// Returns where a sentence is that contains these words; `None` where there is none.
fn hint(window: &Window, words: &str) -> Option<Rect> {
    window.query_all_by_label_contains(words).map(|node| node.rect()).next()
}

#[test]
fn the_tool_for_paths_tells_at_the_pointer_why_there_is_no_ground_while_that_is_so() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ViewFront);
    point(&mut window, 0.3);
    assert_eq!(hint(&window, HORIZON), None, "no tool is used");
    run(&mut window, Id::ToolPath);
    let at = point(&mut window, 0.3);
    let shown = hint(&window, HORIZON).expect("above the horizon");
    let distance = shown.distance_to_pos(egui::pos2(at.x, at.y));
    assert!(distance < 40.0, "{shown} is {distance} points from the pointer");
    point(&mut window, 0.9);
    assert_eq!(hint(&window, HORIZON), None, "the ground is there");
    // The pointer does not move while the view does.
    run(&mut window, Id::ToggleProjection);
    window.run_steps(2);
    assert!(hint(&window, EDGE).is_some());
    run(&mut window, Id::ViewTop);
    window.run_steps(2);
    assert_eq!(hint(&window, EDGE), None);
    run(&mut window, Id::ViewFront);
    window.run_steps(2);
    assert!(hint(&window, EDGE).is_some());
    // With Alt a drag orbits.
    send(&mut window, InputEvent::Modifiers(Modifiers { alt: true, ..Modifiers::default() }));
    assert_eq!(hint(&window, EDGE), None);
    send(&mut window, InputEvent::Modifiers(Modifiers::default()));
    run(&mut window, Id::ToolPath);
    assert_eq!(hint(&window, EDGE), None, "the tool was put away");
}

#[test]
fn a_line_that_is_drawn_beyond_the_horizon_tells_why_it_does_not_go_on() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ViewFront);
    run(&mut window, Id::ToolPath);
    point(&mut window, 0.95);
    send(&mut window, InputEvent::MouseDown(Button::Left));
    point(&mut window, 0.9);
    assert_eq!(hint(&window, HORIZON), None);
    point(&mut window, 0.1);
    assert!(hint(&window, HORIZON).is_some());
    point(&mut window, 0.9);
    assert_eq!(hint(&window, HORIZON), None);
    send(&mut window, InputEvent::MouseUp(Button::Left));
}

#[test]
fn a_model_that_is_dropped_above_the_horizon_is_added_near_the_others_with_the_reason() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ViewFront);
    point(&mut window, 0.2);
    let effect = window.state_mut().state.execute(Request::Dropped(vec![PathBuf::from("/scenes/Fox.glb")]));
    let Some(Effect::Change(change)) = looked(&mut window, effect) else { panic!("no change") };
    window.state_mut().change(change);
    window.run_steps(2);
    assert_eq!(new_lines(FOXES, &text(&window)).len(), 1);
    // Warnings are shown at the pointer, too.
    let read = window.state().state.read();
    let mut warnings = read.status.lines().filter(|message| message.level == MessageSeverity::Warning);
    assert!(warnings.any(|message| message.text.contains(HORIZON)), "{:?}", read.status);
}
