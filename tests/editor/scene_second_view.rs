//! The second viewport of a scene in the window: its place, the line between the two, and when it is gone.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::workbench::{Window, drag};
use dragonfly::panels::commands::Id;
use dragonfly_kit::document::fixture;
use egui::{Modifiers, Rect, vec2};
use egui_kittest::kittest::Queryable;

fn places(window: &Window) -> (Rect, Option<Rect>) {
    let read = window.state().state.read();
    (read.viewport, read.second_view)
}

#[test]
fn the_second_viewport_is_next_to_the_first_and_a_drag_of_the_line_between_them_shares_the_width() {
    let mut window = scene(FOXES).window();
    let (whole, none) = places(&window);
    assert_eq!(none, None);
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(2);
    let (left, right) = places(&window);
    let right = right.expect("a second viewport");
    assert!(left.right() < right.left() && left.left() == whole.left() && right.right() == whole.right());
    assert!((left.width() - right.width()).abs() < 8.0, "{left} {right}");
    assert!(window.query_by_label("Second view, shot: wide").is_some());
    drag(&mut window, "Width of the second view", vec2(100.0, 0.0), Modifiers::NONE);
    window.run_steps(2);
    let (wider, narrower) = places(&window);
    assert!((wider.width() - left.width() - 100.0).abs() < 3.0, "{wider} {left}");
    assert!(narrower.is_some_and(|rect| (right.width() - rect.width() - 100.0).abs() < 3.0), "{narrower:?}");
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(2);
    assert_eq!(places(&window), (whole, None));
}

#[test]
fn a_model_has_no_second_viewport() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(2);
    assert!(places(&window).1.is_some());
    window.state_mut().state.show(fixture::full());
    window.run_steps(3);
    assert_eq!(places(&window).1, None);
}
