//! The list of shots: their begins and durations, and where a click goes.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::workbench::Window;
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::shots::{shot_at, shots_of};
use dragonfly_anim::stage::time::StageTime;
use egui_kittest::kittest::Queryable;

/// A window with the list of shots in front.
fn shown(script: &str) -> Window {
    let mut window = scene(script).window();
    window.state_mut().desk.show_panel("shots");
    window.run_steps(2);
    window
}

fn time(window: &Window) -> f32 {
    window.state().state.read().time()
}

fn said(window: &Window) -> String {
    window.state().state.read().status.last().map(|message| message.text.clone()).unwrap_or_default()
}

#[test]
fn a_click_on_a_shot_goes_to_its_start_and_selects_it() {
    let mut window = shown(FOXES);
    // The second camera is seen from the end of the first take on, which is cut at 2 s, to the end of the scene.
    let end = window.state().state.read().scene_bounds().expect("a scene").1;
    let last = format!("Shot 2, close, from 2.00 s, {:.2} s", end - 2.0);
    assert!(window.query_by_label("Shot 1, wide, from 0.00 s, 2.00 s").is_some());
    window.get_by_label(&last).click();
    window.run_steps(3);
    assert_eq!(time(&window), 2.0);
    let read = window.state().state.read();
    let shots = shots_of(read.scene_editing.lanes());
    assert_eq!(read.scene_editing.action(), Some(shots[1].action));
}

#[test]
fn commands_go_from_shot_to_shot() {
    let mut window = shown(FOXES);
    for (id, expected) in
        [(Id::NextShot, 2.0), (Id::NextShot, 2.0), (Id::PreviousShot, 0.0), (Id::PreviousShot, 0.0)]
    {
        run(&mut window, id);
        assert_eq!(time(&window), expected, "{id:?}");
    }
}

#[test]
fn a_shot_that_begins_between_frames_is_left_and_shown_like_others() {
    // As a number of single precision, the one is before its time and the other one after it.
    for begin in ["1.01", "1.1"] {
        let script = FOXES.replace("begin=\"looks.end\" blend", &format!("begin=\"{begin}\" blend"));
        let mut window = shown(&script);
        let seen = |window: &Window| {
            let read = window.state().state.read();
            shot_at(shots_of(read.scene_editing.lanes()), read.scene_time())
        };
        run(&mut window, Id::NextShot);
        let start = time(&window);
        assert_eq!((start, seen(&window)), (start.max(begin.parse().expect("a number")), Some(1)), "{begin}");
        run(&mut window, Id::NextShot);
        assert_eq!((time(&window), said(&window)), (start, "There is no shot on that side".to_owned()));
        run(&mut window, Id::PreviousShot);
        assert_eq!((time(&window), seen(&window)), (0.0, Some(0)), "{begin}");
        window.get_by_label_contains("Shot 2, close").click();
        window.run_steps(3);
        assert_eq!((time(&window), seen(&window)), (start, Some(1)), "{begin}");
    }
}

#[test]
fn the_shot_at_a_time_is_the_last_one_that_has_begun() {
    let window = shown(FOXES);
    let read = window.state().state.read();
    let shots = shots_of(read.scene_editing.lanes());
    let at = |seconds: f64| shot_at(shots, StageTime::from_seconds(seconds));
    assert_eq!([at(-1.0), at(0.0), at(1.99), at(2.0), at(99.0)], [None, Some(0), Some(0), Some(1), Some(1)]);
}

#[test]
fn of_many_shots_only_those_in_sight_are_drawn_and_all_can_be_scrolled_to() {
    let more: String =
        (0..500).map(|at| format!("    <shot who=\"wide\" begin=\"{}\"/>\n", 10 + at)).collect();
    let mut window = shown(&FOXES.replace("    <seq>", &format!("{more}    <seq>")));
    let drawn = |window: &Window| window.query_all_by_label_contains(", from ").count();
    assert!(drawn(&window) < 60, "{} rows", drawn(&window));
    let at = window.get_by_label_contains("Shot 1, ").rect().center();
    window.event(egui::Event::PointerMoved(at));
    window.run_steps(1);
    for _ in 0..3 {
        window.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: egui::vec2(0.0, -100_000.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: egui::Modifiers::NONE,
        });
        window.run_steps(20);
    }
    assert!(window.query_by_label_contains("Shot 502, ").is_some(), "the last one");
    assert!(window.query_by_label_contains("Shot 1, ").is_none() && drawn(&window) < 60);
}
