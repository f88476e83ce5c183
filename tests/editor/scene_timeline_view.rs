//! The timeline of a scene and the margin of its script: speed by dragging, snapping to the playhead, zoom, marks of errors.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_script::{put_cursor, type_text};
use crate::scene_timeline::{Lanes, drag};
use crate::workbench::{Window, press, release};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, EditScript};
use egui::{Event, Modifiers, MouseWheelUnit, PointerButton, Pos2, Shape, Vec2, pos2};
use egui_kittest::kittest::Queryable;

const RUN: usize = 6;
const MOVE: usize = 7;

fn window() -> Window {
    scene(FOXES).window()
}

/// Returns begin and end of the bar of an action, seconds.
fn times(window: &Window, action: usize) -> [f64; 2] {
    let lanes = window.state().state.read().scene_editing.lanes().clone();
    let (_, bar) = lanes.bar_of(action).expect("a bar");
    [bar.begin.seconds(), bar.end.seconds()]
}

#[test]
fn the_end_of_a_bar_dragged_with_alt_changes_its_speed_and_no_other_line() {
    let mut window = window();
    let [begin, end] = times(&window, RUN);
    let bar = Lanes::of(&window).bar(&window, RUN);
    drag(&mut window, pos2(bar.right() - 2.0, bar.bottom() - 3.0), -0.5, Modifiers::ALT);
    let lines = new_lines(FOXES, &text(&window));
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].starts_with(r#"<play who="anna" take="Run""#), "{lines:?}");
    assert!(lines[0].contains(r#"repeat="3""#) && lines[0].contains("speed=\"1."), "{lines:?}");
    let [new_begin, new_end] = times(&window, RUN);
    assert_eq!(new_begin, begin);
    // On the nearest frame.
    let wanted = ((end - 0.5) * 24.0).round() / 24.0;
    assert!((new_end - wanted).abs() < 2e-3, "{new_end} instead of {wanted}");
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn a_bar_snaps_to_the_playhead_also_between_frames_and_its_time_is_written_short() {
    let mut window = window();
    window.state_mut().state.execute(Request::Seek(3.3));
    window.run_steps(2);
    let from = Lanes::of(&window).bar(&window, MOVE).center();
    // From 1 to 3.3.
    drag(&mut window, from, 2.29, Modifiers::NONE);
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [r#"<move who="ben" path="aisle" take="Walk" begin="3.3"/>"#]
    );
}

fn turn_wheel(window: &mut Window, at: Pos2, delta: Vec2) {
    window.event(Event::PointerMoved(at));
    window.run_steps(1);
    window.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta,
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(20);
}

#[test]
fn the_zoom_stays_while_a_drag_makes_the_scene_longer_and_fits_the_whole_scene_after_it() {
    let mut window = window();
    let canvas = Lanes::of(&window).canvas;
    let title = |window: &Window| {
        let mut shapes = window.output().shapes.iter().map(|clipped| &clipped.shape);
        let found = shapes.find_map(|shape| match shape {
            Shape::Text(text) if text.galley.text() == "The End" && canvas.contains(text.pos) => {
                Some(text.pos.x)
            }
            _ => None,
        });
        found.expect("the bar of the title")
    };
    let before = title(&window);
    // Something elsewhere is dragged, in the viewport.
    let at = window.state().state.read().viewport.center();
    press(&mut window, at);
    let longer = FOXES.replace("begin=\"4\" dur=\"1\"", "begin=\"4\" dur=\"9\"");
    let edit = EditScript::between(FOXES, &longer, None).expect("another text");
    window.state_mut().change(Change::Edit(Edit::EditScript(edit), None));
    window.run_steps(4);
    assert!((title(&window) - before).abs() < 0.5, "{before} {}", title(&window));
    release(&mut window, at);
    window.run_steps(2);
    assert!(title(&window) < before - 20.0, "{before} {}", title(&window));
}

#[test]
fn the_wheel_zooms_about_the_pointer_the_middle_button_pans_and_a_command_shows_all() {
    let mut window = window();
    let shown = |window: &Window| window.state().state.read().scene_editing.window();
    let whole = shown(&window);
    let lanes = Lanes::of(&window);
    let at = pos2(lanes.scale.x_of(2.0), lanes.canvas.center().y);
    turn_wheel(&mut window, at, Vec2::new(0.0, 120.0));
    let near = shown(&window);
    assert!(near.length < 0.9 * whole.length, "{near:?} of {whole:?}");
    let under = Lanes::of(&window).scale.time_at(at.x);
    assert!((under - 2.0).abs() < 0.02, "{under} s is under the pointer");
    // A drag with the middle button moves what is under the pointer along with it.
    let before = Lanes::of(&window).scale.time_at(at.x);
    for (x, pressed) in [(0.0, Some(true)), (30.0, None), (60.0, None), (60.0, Some(false))] {
        let pos = pos2(at.x + x, at.y);
        window.event(Event::PointerMoved(pos));
        if let Some(pressed) = pressed {
            let (button, modifiers) = (PointerButton::Middle, Modifiers::NONE);
            window.event(Event::PointerButton { pos, button, pressed, modifiers });
        }
        window.run_steps(1);
    }
    let after = Lanes::of(&window).scale.time_at(at.x + 60.0);
    assert!((after - before).abs() < 0.02, "{before} s became {after} s");
    assert_eq!(shown(&window).length, near.length);
    window.state_mut().state.execute(Request::Command(Id::FitScene));
    window.run_steps(2);
    assert_eq!(shown(&window), whole);
    assert_eq!(text(&window), FOXES, "looking changes nothing");
}

#[test]
fn the_wheel_zooms_out_to_a_limit_and_not_into_the_time_before_the_scene() {
    let mut window = window();
    let lanes = Lanes::of(&window);
    let at = pos2(lanes.canvas.right() - 20.0, lanes.canvas.center().y);
    for _ in 0..12 {
        turn_wheel(&mut window, at, Vec2::new(0.0, -400.0));
    }
    let shown = window.state().state.read().scene_editing.window();
    assert!(shown.length <= 15.0 && shown.start >= -0.1 * shown.length, "{shown:?}");
}

#[test]
fn an_error_has_a_mark_in_the_margin_at_its_line() {
    let mut window = window();
    let take = FOXES.find("take=\"Walk").expect("a take") + "take=\"Walk".len();
    put_cursor(&mut window, take);
    type_text(&mut window, "s");
    // The list of errors takes room, and the text is scrolled to the cursor.
    window.run_steps(30);
    let line = FOXES[..take].lines().count();
    let mark = window.get_by_label(&format!("Error in line {line}")).rect();
    let script = window.get_by_label("Script of the scene").rect();
    // Lines have equal heights.
    let height = script.height() / (FOXES.lines().count() + 1) as f32;
    let middle = script.top() + (line as f32 - 0.5) * height;
    assert!((mark.center().y - middle).abs() < 1.5 * height, "{mark:?} is not at {middle}");
    let other = format!("Error in line {}", line + 1);
    assert!(window.query_by_label(&other).is_none());
}
