//! The timeline of a scene: menus, Alt, snapping, ripple, zoom, and what is selected elsewhere.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_timeline::{Lanes, drag};
use crate::workbench::{Window, move_to};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers, PointerButton, Pos2, pos2};
use egui_kittest::kittest::Queryable;

const LOOKS: usize = 5;
const RUN: usize = 6;
const MOVE: usize = 7;
const CHANGE: usize = 9;
const TITLE: usize = 10;

fn window() -> Window {
    scene(FOXES).window()
}

fn right_click(window: &mut Window, pos: Pos2) {
    window.event(egui::Event::PointerMoved(pos));
    window.run_steps(1);
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Secondary, Modifiers::NONE);
        window.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
        window.run_steps(2);
    }
    window.run_steps(4);
}

/// Chooses an entry of the menu that is open; the ones before the last are submenus.
fn choose(window: &mut Window, path: &[&str]) {
    for title in path {
        window.get_by_label(title).click();
        window.run_steps(8);
    }
}

fn undo(window: &mut Window) {
    window.state_mut().change(Change::Undo);
    window.run_steps(3);
    assert_eq!(text(window), FOXES);
}

/// Returns a point of the lane of an action in which no bar is.
fn beside(window: &Window, action: usize) -> Pos2 {
    let lanes = Lanes::of(window);
    pos2(lanes.canvas.right() - 6.0, lanes.bar(window, action).center().y)
}

#[test]
fn the_speed_is_changed_by_alt_and_the_end_of_a_bar_and_in_the_menu() {
    let mut window = window();
    let bar = Lanes::of(&window).bar(&window, LOOKS);
    // Two seconds become two and a half.
    drag(&mut window, pos2(bar.right() - 2.0, bar.bottom() - 4.0), 0.5, Modifiers::ALT);
    let line = new_lines(FOXES, &text(&window)).concat();
    assert!(line.contains(r#"take="Survey" to="2" speed="0.8""#), "{line}");
    undo(&mut window);
    let bar = Lanes::of(&window).bar(&window, LOOKS);
    right_click(&mut window, pos2(bar.center().x, bar.bottom() - 4.0));
    choose(&mut window, &["Speed", "2×"]);
    let line = new_lines(FOXES, &text(&window)).concat();
    assert!(line.contains(r#"take="Survey" to="2" speed="2""#), "{line}");
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn drags_snap_to_ends_moments_and_the_playhead_and_ctrl_leaves_them_free() {
    let mut window = window();
    window.state_mut().state.execute(Request::Seek(3.3));
    window.run_steps(2);
    // The title begins at 4: to the playhead, which is on no frame.
    let to = |window: &mut Window, time: f64, modifiers: Modifiers| {
        let bar = Lanes::of(window).bar(window, TITLE);
        drag(window, pos2(bar.center().x, bar.bottom() - 4.0), time - 4.0, modifiers);
        let line = new_lines(FOXES, &text(window)).concat();
        undo(window);
        line
    };
    let pixel = 1.0 / Lanes::of(&window).scale.per_second();
    let line = to(&mut window, 3.3 + 2.0 * pixel, Modifiers::NONE);
    assert!(line.contains("begin=\"3.3\""), "the playhead: {line}");
    let line = to(&mut window, 2.0 + 2.0 * pixel, Modifiers::NONE);
    assert!(line.contains("begin=\"2\""), "the end of another bar: {line}");
    let line = to(&mut window, 1.25 + 2.0 * pixel, Modifiers::NONE);
    assert!(line.contains("begin=\"1.25\""), "a moment of a take: {line}");
    let line = to(&mut window, 3.3 + 2.0 * pixel, Modifiers::COMMAND);
    assert!(!line.contains("begin=\"3.3\""), "free: {line}");
}

#[test]
fn the_ripple_switch_and_the_held_key_decide_whether_what_follows_moves() {
    let mut window = window();
    let begin_of_run = |window: &Window| {
        window.state().state.read().scene_editing.lanes().bar_of(RUN).unwrap().1.begin.seconds()
    };
    let trim = |window: &mut Window, key: bool| {
        let bar = Lanes::of(window).bar(window, LOOKS);
        if key {
            window.key_down(Key::Num2);
        }
        // The next bar is above the end of this one.
        let at = pos2(bar.left() + 2.0, bar.bottom() - 3.0);
        drag(window, pos2(at.x + 20.0, at.y), 0.5, Modifiers::NONE);
        if key {
            window.key_up(Key::Num2);
            window.run_steps(1);
        }
        let begin = begin_of_run(window);
        undo(window);
        begin
    };
    assert_eq!(begin_of_run(&window), 1.5);
    assert_eq!(trim(&mut window, false), 2.0, "it moves along");
    assert_eq!(trim(&mut window, true), 1.5, "the key turns it round");
    window.state_mut().state.execute(Request::Command(Id::ToggleSceneRipple));
    window.run_steps(1);
    assert_eq!(trim(&mut window, false), 1.5);
    assert_eq!(trim(&mut window, true), 2.0);
}

#[test]
fn the_wheel_zooms_the_middle_button_pans_and_fit_shows_all() {
    let mut window = window();
    let shown = |window: &Window| window.state().state.read().scene_editing.window();
    let whole = shown(&window);
    let canvas = Lanes::of(&window).canvas;
    let at = canvas.center();
    move_to(&mut window, at, Modifiers::NONE);
    let under = Lanes::of(&window).scale.time_at(at.x);
    window.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::vec2(0.0, 120.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(10);
    let zoomed = shown(&window);
    assert!(zoomed.length < whole.length * 0.95, "{zoomed:?} of {whole:?}");
    assert!((Lanes::of(&window).scale.time_at(at.x) - under).abs() < 0.02, "the time at the pointer stays");
    let button = |window: &mut Window, pos: Pos2, pressed: bool| {
        let (button, modifiers) = (PointerButton::Middle, Modifiers::NONE);
        window.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
        window.run_steps(2);
    };
    button(&mut window, at, true);
    move_to(&mut window, pos2(at.x - 60.0, at.y), Modifiers::NONE);
    button(&mut window, pos2(at.x - 60.0, at.y), false);
    let panned = shown(&window);
    assert!(panned.start > zoomed.start && (panned.length - zoomed.length).abs() < 1e-9, "{panned:?}");
    window.state_mut().state.execute(Request::Command(Id::FitScene));
    window.run_steps(2);
    assert_eq!(shown(&window), whole);
}

#[test]
fn the_menu_of_a_lane_adds_takes_shots_and_attachments_at_the_playhead() {
    let mut window = window();
    window.state_mut().state.execute(Request::Seek(4.0));
    window.run_steps(2);
    let at = beside(&window, MOVE);
    right_click(&mut window, at);
    choose(&mut window, &["Add take at the playhead", "Run"]);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<play who="ben" take="Run" begin="4"/>"#]);
    undo(&mut window);
    right_click(&mut window, at);
    choose(&mut window, &["Cut at the playhead to", "wide"]);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<shot who="wide" begin="4"/>"#]);
    undo(&mut window);
    right_click(&mut window, at);
    choose(&mut window, &["Attach at the playhead to", "anna", "The whole"]);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<attach who="ben" to="anna" begin="4"/>"#]);
}

#[test]
fn the_menu_of_a_lane_adds_the_other_actions_by_their_table() {
    let mut window = window();
    window.state_mut().state.execute(Request::Seek(4.0));
    window.run_steps(2);
    let add = |window: &mut Window, action: usize, path: &[&str]| {
        let at = beside(window, action);
        right_click(window, at);
        choose(window, &["Add action"]);
        choose(window, path);
        let line = new_lines(FOXES, &text(window)).concat();
        assert!(window.state().state.read().scene().unwrap().errors.is_empty(), "{line}");
        undo(window);
        line
    };
    assert_eq!(
        add(&mut window, MOVE, &["Turn to", "anna"]),
        r#"<turn who="ben" to="anna" dur="0.5" begin="4"/>"#
    );
    assert_eq!(
        add(&mut window, MOVE, &["Move to", "door"]),
        r#"<move who="ben" to="door" take="Walk" begin="4"/>"#
    );
    assert_eq!(
        add(&mut window, MOVE, &["Walk along", "aisle"]),
        r#"<move who="ben" path="aisle" take="Walk" begin="4"/>"#
    );
    assert!(add(&mut window, MOVE, &["Place here"]).starts_with(r#"<place who="ben" at=""#));
    assert_eq!(
        add(&mut window, CHANGE, &["Set", "strength"]),
        r##"<set who="sun" property="strength" to="0.4" begin="4"/>"##
    );
    assert_eq!(
        add(&mut window, CHANGE, &["Change", "color"]),
        r##"<change who="sun" property="color" to="#ffffff" dur="1" begin="4"/>"##
    );
    assert_eq!(add(&mut window, MOVE, &["Title"]), r#"<title dur="2" text="Title" begin="4"/>"#);
}

#[test]
fn an_added_effect_is_on_from_the_playhead() {
    let mut window = window();
    window.state_mut().state.execute(Request::Seek(2.0));
    if let Some(Effect::Change(change)) = window.state_mut().state.execute(Request::Command(Id::AddEffect)) {
        window.state_mut().change(change);
    }
    window.run_steps(3);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new.len(), 2, "{new:?}");
    assert!(new[0].starts_with(r#"<effect id="effect""#), "{new:?}");
    assert_eq!(new[1], r#"<run who="effect" begin="2"/>"#);
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn things_are_duplicated_and_hidden_by_the_keyboard_and_the_list() {
    let mut window = window();
    let door = SceneRequest::SelectThings(vec!["door".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(door));
    if let Some(Effect::Change(change)) =
        window.state_mut().state.execute(Request::Command(Id::SceneDuplicate))
    {
        window.state_mut().change(change);
    }
    window.run_steps(3);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new.len(), 1);
    assert!(new[0].contains("id=\"door-2\""), "{new:?}");
    window.get_by_label("Hide ben").click();
    window.run_steps(3);
    assert!(window.state().state.read().scene_editing.is_hidden("ben"));
    assert!(window.query_by_label("Show ben").is_some());
    assert_eq!(window.state().steps(), (1, 1), "hiding changes nothing in the script");
}

#[test]
fn the_timeline_shows_the_action_that_the_cursor_of_the_script_is_in() {
    let roles: String = (0..40)
        .map(|role| {
            format!("    <role id=\"r{role}\" model=\"Fox.glb\" at=\"{role} 0 3\" scale=\"0.01\"/>\n")
        })
        .collect();
    let last = "    <play who=\"r39\" take=\"Run\" begin=\"30\"/>\n";
    let script = FOXES
        .replace("    <camera id=\"wide\"", &format!("{roles}    <camera id=\"wide\""))
        .replace("    <title", &format!("{last}    <title"));
    let mut window = scene(&script).window();
    // Zoomed in to the start.
    let start = dragonfly::panels::keys::TimeWindow { start: 0.0, length: 5.0 };
    window.state_mut().state.execute(Request::Scene(SceneRequest::Window(Some(start))));
    window.run_steps(2);
    let lane_is_shown = |window: &Window| window.query_by_label("Lane of r39").is_some();
    assert!(!lane_is_shown(&window));
    let place = script.find("<play who=\"r39\"").unwrap() + 3;
    window.state_mut().state.execute(Request::Scene(SceneRequest::Cursor(place)));
    window.run_steps(4);
    assert!(lane_is_shown(&window));
    let shown = window.state().state.read().scene_editing.window();
    assert!((shown.start..shown.start + shown.length).contains(&30.0), "{shown:?}");
    assert_eq!(shown.length, 5.0);
}

#[test]
fn an_error_is_marked_in_the_margin_of_its_line() {
    let mut window = window();
    let wrong = FOXES.replace("take=\"Walk\"", "take=\"Wolk\"");
    let change = dragonfly::panels::scene::ScriptChange {
        from: FOXES.into(),
        text: wrong.clone(),
        also: Vec::new(),
        label: dragonfly_document::edit::ScriptLabel::Type,
        gesture: None,
    };
    if let Some(Effect::Change(change)) =
        window.state_mut().state.execute(Request::Scene(SceneRequest::Typed(change)))
    {
        window.state_mut().change(change);
    }
    window.run_steps(3);
    let line = wrong.lines().position(|line| line.contains("Wolk")).unwrap() + 1;
    let mark = window.get_by_label(&format!("Error in line {line}")).rect();
    // A row is as high as the letters of the text: the mark is at the height of its own line.
    let script = window.get_by_label("Script of the scene").rect();
    let row = (mark.center().y - script.top()) / mark.height();
    assert!((row - (line as f32 - 0.5)).abs() < 1.0, "{row} for line {line}");
}
