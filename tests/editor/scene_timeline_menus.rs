//! The timeline of a scene: menus, ripple, and what is selected elsewhere.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_timeline::{Lanes, drag};
use crate::workbench::Window;
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
        // Fields of attributes have the same words.
        window.get_by_role_and_label(egui::accesskit::Role::Button, title).click();
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
fn the_menu_of_a_lane_adds_takes_shots_and_attachments_at_the_playhead() {
    let mut window = window();
    window.state_mut().state.execute(Request::Seek(4.0));
    window.run_steps(2);
    let at = beside(&window, MOVE);
    right_click(&mut window, at);
    choose(&mut window, &["Add clip at the playhead", "Run"]);
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
        let label = window.state().edited.as_ref().unwrap().labels()[0].unwrap_or_default();
        let name = line.trim_start_matches('<').split(' ').next().unwrap_or_default();
        assert_eq!(label, format!("Add {name}"));
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
    // The list scrolls to what is selected.
    let ben = SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(ben));
    window.run_steps(3);
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
