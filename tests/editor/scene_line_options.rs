//! The options of the tool that draws lines: a bar in the viewport shows them while it is used, and new lines have them.

use crate::scene_bench::{FOXES, named_text, project, scene};
use crate::scene_lines::{run, stroke};
use crate::workbench::{Window, press, release};
use dragonfly::control::line::LineSurface;
use dragonfly::panels::commands::Id;
use egui_kittest::kittest::Queryable;
use glam::DVec3;

const LINES: &str = "<lines version=\"1\">\n</lines>\n";

fn click(window: &mut Window, label: &str) {
    let at = window.get_by_label(label).rect().center();
    press(window, at);
    release(window, at);
    window.run_steps(2);
}

#[test]
fn a_bar_shows_the_options_and_keys_while_lines_are_drawn() {
    let mut window = project(FOXES, LINES).window();
    assert!(window.query_by_label_contains("Drag: freehand").is_none());
    run(&mut window, Id::ToolLine);
    for label in ["Draw on the ground", "Draw in the view", "Draw on surfaces", "Draw on bones"] {
        assert!(window.query_by_label(label).is_some(), "{label}");
    }
    assert!(window.query_by_label_contains("Ctrl + drag erases").is_some());
    // The bar is inside the viewport.
    let viewport = window.get_by_label("Viewport").rect();
    let keys = window.get_by_label_contains("Drag: freehand").rect();
    assert!(viewport.contains_rect(keys), "{keys} in {viewport}");
    run(&mut window, Id::ToolSelect);
    assert!(window.query_by_label_contains("Drag: freehand").is_none());
}

#[test]
fn the_bar_chooses_on_what_is_drawn_and_the_color_of_new_lines() {
    let mut window = project(FOXES, LINES).window();
    run(&mut window, Id::ToolLine);
    click(&mut window, "Draw in the view");
    let surface = |window: &Window| window.state().state.read().tools.controls().line().note_surface();
    assert_eq!(surface(&window), LineSurface::View);
    click(&mut window, "Draw on the ground");
    assert_eq!(surface(&window), LineSurface::Ground);
    let places = [DVec3::ZERO, DVec3::new(0.5, 0.0, 0.2), DVec3::new(1.0, 0.0, 0.0)];
    stroke(&mut window, &places);
    let lines = named_text(&window, "scene.lines.xml");
    assert!(
        lines.contains("<line ") && !lines.contains("color="),
        "red is that of lines without one: {lines}"
    );
    click(&mut window, "New lines: Blue");
    stroke(&mut window, &places);
    let lines = named_text(&window, "scene.lines.xml");
    assert_eq!(lines.matches("color=\"#4080ff\"").count(), 1, "{lines}");
}

#[test]
fn the_bar_of_paths_has_keys_only_and_says_what_ends_corners() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolPath);
    assert!(window.query_by_label_contains("Click: corners").is_some());
    assert!(window.query_by_label("Draw in the view").is_none(), "paths are always on the ground");
    stroke(&mut window, &[DVec3::ZERO]);
    assert!(window.query_by_label_contains("Enter ends the line").is_some());
}
