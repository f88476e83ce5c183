//! Locked things of a scene: no gesture changes them, each refusal names the locked thing, and the others that are selected with them are changed.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_timeline::Lanes;
use crate::workbench::{Window, move_to, press, release, type_into};
use dragonfly::control::{InputEvent, Key as ToolKey};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers, PointerButton, Pos2, pos2};
use egui_kittest::kittest::Queryable;

const LOOKS: usize = 5;
const RUN: usize = 6;
const MOVE: usize = 7;
const LOOK: usize = 8;

fn execute(window: &mut Window, request: Request) -> Option<Effect> {
    let effect = match window.state_mut().state.execute(request) {
        Some(Effect::Change(change)) => {
            window.state_mut().change(change);
            None
        }
        other => other,
    };
    window.run_steps(3);
    effect
}

fn lock(window: &mut Window, things: &[&str]) {
    let things = things.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::Lock(things, true)));
}

fn select(window: &mut Window, things: &[&str]) {
    let things = things.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::SelectThings(things, Choice::Replace)));
}

fn select_actions(window: &mut Window, actions: &[usize]) {
    execute(window, Request::Scene(SceneRequest::SelectActions(actions.to_vec(), Choice::Replace)));
}

fn said(window: &Window, part: &str) -> bool {
    window.state().state.read().status.lines().any(|message| message.text.contains(part))
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

fn choose(window: &mut Window, path: &[&str]) {
    for title in path {
        window.get_by_role_and_label(egui::accesskit::Role::Button, title).click();
        window.run_steps(8);
    }
}

/// Returns a point of the bar of an action that is under no other bar.
fn on(window: &Window, action: usize) -> Pos2 {
    let bar = Lanes::of(window).bar(window, action);
    pos2(bar.right() - 14.0, bar.bottom() - 4.0)
}

/// Returns a point of the lane of an action in which no bar is.
fn beside(window: &Window, action: usize) -> Pos2 {
    let lanes = Lanes::of(window);
    pos2(lanes.canvas.right() - 6.0, lanes.bar(window, action).center().y)
}

/// Checks that the text is as it was, and that the locked thing was named.
fn refused(window: &Window, thing: &str, what: &str) {
    assert_eq!(text(window), FOXES, "{what}");
    assert!(said(window, &format!("{thing} is locked")), "{what}: the refusal names {thing}");
}

#[test]
fn no_entry_of_the_menus_of_bars_and_lanes_changes_a_locked_thing() {
    type Case = (usize, bool, &'static [&'static str]);
    let cases: [Case; 8] = [
        (LOOK, true, &["Fade in", "0.5 s"]),
        (LOOK, true, &["Fade out", "0.5 s"]),
        (RUN, true, &["Speed", "2×"]),
        (RUN, true, &["Repeat", "2×"]),
        (RUN, true, &["Wait after it"]),
        (MOVE, false, &["Add clip at the playhead", "Run"]),
        (MOVE, false, &["Attach at the playhead to", "anna", "The whole"]),
        (MOVE, false, &["Add action", "Place here"]),
    ];
    for (action, is_bar, path) in cases {
        let thing = if action == RUN { "anna" } else { "ben" };
        let mut window = scene(FOXES).window();
        execute(&mut window, Request::Seek(4.0));
        lock(&mut window, &[thing]);
        let at = if is_bar { on(&window, action) } else { beside(&window, action) };
        right_click(&mut window, at);
        choose(&mut window, path);
        refused(&window, thing, &path.join(" > "));
    }
    // A cut to a camera changes the shots, not the camera.
    let mut window = scene(FOXES).window();
    execute(&mut window, Request::Seek(4.0));
    lock(&mut window, &["wide"]);
    let at = beside(&window, MOVE);
    right_click(&mut window, at);
    choose(&mut window, &["Cut at the playhead to", "wide"]);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<shot who="wide" begin="4"/>"#]);
}

#[test]
fn a_locked_thing_follows_no_path_gets_no_copies_and_keeps_its_name() {
    let mut window = scene(FOXES).window();
    lock(&mut window, &["ben"]);
    select(&mut window, &["aisle", "ben"]);
    execute(&mut window, Request::Command(Id::WalkAlong));
    refused(&window, "ben", "walk along");

    let mut window = scene(FOXES).window();
    select_actions(&mut window, &[MOVE]);
    let Some(Effect::Copy(copied)) = execute(&mut window, Request::Command(Id::CopyActions)) else {
        panic!("nothing was copied")
    };
    lock(&mut window, &["ben"]);
    select_actions(&mut window, &[LOOKS]);
    execute(&mut window, Request::PastePose { text: copied, mirrored: false });
    refused(&window, "ben", "paste for the things that were copied");

    let mut window = scene(FOXES).window();
    lock(&mut window, &["ben"]);
    select(&mut window, &["ben"]);
    window.key_press(Key::F2);
    window.run_steps(2);
    if window.query_by_label("Name of the thing").is_some() {
        type_into(&mut window, "Name of the thing", "bernard", Key::Enter);
    }
    refused(&window, "ben", "rename");
}

#[test]
fn a_clip_is_not_dropped_onto_the_lane_of_a_locked_thing() {
    let mut window = scene(FOXES).window();
    lock(&mut window, &["ben"]);
    let lanes = Lanes::of(&window);
    let [from, to] = [LOOKS, MOVE].map(|action| lanes.bar(&window, action).center());
    let from = pos2(from.x, from.y + 4.0);
    press(&mut window, from);
    for step in 1..=4 {
        move_to(&mut window, from + (pos2(from.x, to.y) - from) * (step as f32 / 4.0), Modifiers::NONE);
    }
    release(&mut window, pos2(from.x, to.y));
    let new = text(&window);
    assert!(!new.contains("id=\"looks\" who=\"ben\""), "{:?}", new_lines(FOXES, &new));
    assert!(said(&window, "ben is locked"));
}

#[test]
fn what_is_selected_with_a_locked_thing_or_one_on_a_path_is_moved_without_it() {
    let typed = |window: &mut Window, id: Id, keys: &str| {
        execute(window, Request::Command(Id::SpaceWorld));
        execute(window, Request::Command(id));
        for key in keys.chars().map(ToolKey::letter).chain([ToolKey::Enter]) {
            for event in [InputEvent::KeyDown(key), InputEvent::KeyUp(key)] {
                let mut effects = Vec::new();
                window.state_mut().state.input(event, &mut effects);
                for effect in effects {
                    if let Effect::Change(change) = effect {
                        window.state_mut().change(change);
                    }
                }
                window.run_steps(2);
            }
        }
    };
    let anna = r#"<role   id="anna"  model="Fox.glb" at="1 0 0" facing="90" scale="0.01"/>"#;
    let mut window = scene(FOXES).window();
    lock(&mut window, &["ben"]);
    // Also where the locked one was selected last.
    for things in [["anna", "ben"], ["ben", "anna"]] {
        select(&mut window, &things);
        typed(&mut window, Id::MoveNow, "x2");
        assert_eq!(new_lines(FOXES, &text(&window)), [anna], "{things:?}");
        assert!(said(&window, "ben is locked and stays"));
        window.state_mut().change(dragonfly_document::Change::Undo);
        window.run_steps(2);
        assert_eq!(text(&window), FOXES);
    }
    // At 2 s ben is on the path.
    let script = FOXES.replace(
        "who=\"ben\" path=\"aisle\" take=\"Walk\" begin=\"1\"",
        "who=\"ben\" path=\"aisle\" take=\"Walk\"",
    );
    let mut window = scene(&script).window();
    select(&mut window, &["ben", "anna"]);
    typed(&mut window, Id::MoveNow, "x2");
    assert_eq!(new_lines(&script, &text(&window)), [anna]);
    assert!(said(&window, "ben follows the path aisle"), "it says why it stays");
    // Alone it is refused as before.
    let moved = text(&window);
    select(&mut window, &["ben"]);
    typed(&mut window, Id::MoveNow, "x2");
    assert_eq!(text(&window), moved);
}
