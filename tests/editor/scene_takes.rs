//! The takes of the selected role: dragged onto a lane, or added at the playhead; events of takes on bars.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_timeline::Lanes;
use crate::workbench::{Window, move_to, press, release};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::scene::timeline::events_of;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::data::Take;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers, Pos2, pos2};
use egui_kittest::kittest::Queryable;

const LOOKS: usize = 5;
const RUN: usize = 6;
const MOVE: usize = 7;
const TITLE: usize = 10;

fn window_of(thing: &str) -> Window {
    let mut window = scene(FOXES).window();
    let select = SceneRequest::SelectThings(vec![thing.into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.run_steps(3);
    window
}

/// Brings a row of the list of takes into sight, and returns its middle.
fn row(window: &mut Window, take: &str) -> Pos2 {
    let name = format!("Take {take}");
    window.get_by_label(&name).scroll_to_me();
    window.run_steps(10);
    window.get_by_label(&name).rect().center()
}

fn drag_to(window: &mut Window, from: Pos2, to: Pos2) {
    press(window, from);
    for step in 1..=4 {
        move_to(window, from + (to - from) * (step as f32 / 4.0), Modifiers::NONE);
    }
}

#[test]
fn the_takes_of_the_selected_role_are_listed_and_a_double_click_adds_one_at_the_playhead() {
    let mut window = window_of("ben");
    for take in ["Survey", "Walk", "Run"] {
        assert!(window.query_by_label(&format!("Take {take}")).is_some(), "{take}");
    }
    window.state_mut().state.execute(Request::Seek(4.0));
    let at = row(&mut window, "Run");
    for _ in 0..2 {
        press(&mut window, at);
        release(&mut window, at);
    }
    window.run_steps(3);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<play who="ben" take="Run" begin="4"/>"#]);
    assert_eq!(window.state().steps(), (1, 1));
    let other = window_of("sun");
    assert_eq!(other.query_all_by_label_contains("Take ").count(), 0, "a light has none");
}

#[test]
fn a_take_dropped_onto_a_lane_plays_from_the_snapped_time_fades_over_the_clip_before_it_and_is_selected() {
    let mut window = window_of("anna");
    let from = row(&mut window, "Walk");
    let lanes = Lanes::of(&window);
    // Next to frame 84, on the lane of another role than the one that is selected.
    let to = pos2(lanes.scale.x_of(3.506), lanes.bar(&window, MOVE).center().y);
    drag_to(&mut window, from, to);
    assert_eq!(text(&window), FOXES, "nothing before it is dropped");
    release(&mut window, to);
    window.run_steps(3);
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [r#"<play who="ben" take="Walk" begin="3.5" fade-in="0.158"/>"#]
    );
    assert_eq!(window.state().steps(), (1, 1));
    // It overlaps the walk before it, which fades into it, and it is what commands change next.
    let editing = window.state().state.read().scene_editing;
    let [new] = editing.actions() else { panic!("{:?} are selected", editing.actions()) };
    let (_, bar) = editing.lanes().bar_of(*new).expect("a bar");
    assert_eq!((bar.kind, bar.begin), ("play", StageTime::from_seconds(3.5)));
    assert_eq!(editing.things(), [Box::from("ben")]);
}

#[test]
fn a_take_dropped_onto_a_lane_without_takes_or_beside_the_lanes_changes_nothing() {
    let mut window = window_of("anna");
    let from = row(&mut window, "Walk");
    let title = Lanes::of(&window).bar(&window, TITLE).center();
    drag_to(&mut window, from, title);
    release(&mut window, title);
    let above = pos2(title.x, Lanes::of(&window).canvas.top() - 60.0);
    drag_to(&mut window, from, above);
    release(&mut window, above);
    window.run_steps(3);
    assert_eq!((text(&window).as_str(), window.state().steps().0), (FOXES, 0));
    // Escape gives the drag up.
    let to = Lanes::of(&window).bar(&window, MOVE).center();
    drag_to(&mut window, from, to);
    window.key_press(Key::Escape);
    window.run_steps(2);
    release(&mut window, to);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn events_of_a_take_count_from_its_start() {
    let text = r#"{"version":1,"events":[{"time":1.5,"name":"step"},{"time":1.25,"name":"fire"}]}"#;
    let mut take = Take { start: 1.0, length: 2.0, ..Take::default() };
    assert_eq!(events_of(&take), []);
    take.extras.set("events", Some(text.into()));
    let events: Vec<(String, StageTime)> =
        events_of(&take).into_iter().map(|event| (event.name, event.after)).collect();
    let seconds = StageTime::from_seconds;
    assert_eq!(events, [("fire".to_owned(), seconds(0.25)), ("step".to_owned(), seconds(0.5))]);
}

#[test]
fn steps_call_bars_that_play_takes_clips_and_all_others_actions() {
    for (actions, label) in [
        (vec![LOOKS], "Move clip"),
        (vec![LOOKS, RUN], "Move clips"),
        (vec![TITLE], "Move action"),
        (vec![RUN, TITLE], "Move actions"),
    ] {
        let mut window = scene(FOXES).window();
        let select = SceneRequest::SelectActions(actions, Choice::Replace);
        window.state_mut().state.execute(Request::Scene(select));
        let effect = window.state_mut().state.execute(Request::Command(Id::ClipLater));
        let Some(Effect::Change(change)) = effect else { panic!("{effect:?}") };
        window.state_mut().change(change);
        let read = window.state().state.read();
        assert_eq!(read.view.expect("a scene").history.labels()[0], Some(label));
    }
}
