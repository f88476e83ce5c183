//! The loop range of a scene: the part of time that plays.

use crate::scene_bench::{FOXES, scene, text};
use crate::scene_lines::run;
use crate::scene_timeline::Lanes;
use crate::workbench::{Window, drag};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use std::time::Duration;

const LOOKS: usize = 5;

fn range(window: &Window) -> Option<[f32; 2]> {
    window.state().state.read().keys.range()
}

fn is_near(range: Option<[f32; 2]>, wanted: [f32; 2]) -> bool {
    range.is_some_and(|range| range.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 1e-3))
}

/// Returns the time that is shown some seconds after playback was started now.
fn played(window: &mut Window, seconds: f32) -> f32 {
    window.state_mut().state.execute(Request::Command(Id::PlayPause));
    let time = {
        let read = window.state().state.read();
        assert!(read.playback.playing);
        read.playback.time_at(read.now + Duration::from_secs_f32(seconds))
    };
    window.state_mut().state.pause();
    time
}

#[test]
fn a_scene_loops_in_the_range_of_the_selected_actions_until_all_of_it_plays_again() {
    let mut window = scene(FOXES).window();
    let select = SceneRequest::SelectActions(vec![LOOKS], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.state_mut().state.execute(Request::Seek(3.0));
    window.run_steps(2);
    assert!(window.query_by_label("End of the play range").is_none());
    window.key_press(Key::P);
    window.run_steps(3);
    assert!(is_near(range(&window), [0.0, 2.0]), "{:?}", range(&window));
    // The playhead is outside, so playback begins at the start of the range, and begins again at its end.
    assert!((played(&mut window, 2.5) - 0.5).abs() < 1e-3);
    window.key_press_modifiers(Modifiers::ALT, Key::P);
    window.run_steps(3);
    assert_eq!(range(&window), None);
    window.state_mut().state.execute(Request::Seek(0.0));
    assert!((played(&mut window, 2.5) - 2.5).abs() < 1e-3);
    assert_eq!(
        (text(&window).as_str(), window.state().steps()),
        (FOXES, (0, 0)),
        "it is no part of the script"
    );
}

#[test]
fn both_ends_of_the_loop_range_are_set_at_the_playhead_and_dragged_on_the_ruler() {
    let mut window = scene(FOXES).window();
    for (time, id) in [(1.0, Id::LoopFromHere), (3.0, Id::LoopToHere)] {
        window.state_mut().state.execute(Request::Seek(time));
        run(&mut window, id);
    }
    assert!(is_near(range(&window), [1.0, 3.0]), "{:?}", range(&window));
    let points = Lanes::of(&window).scale.per_second() as f32;
    for (end, by, wanted) in
        [("End of the play range", 1.0, [1.0, 4.0]), ("Start of the play range", 0.5, [1.5, 4.0])]
    {
        // From the middle of the mark, which is 4 points inside of the range.
        let inside = if wanted[0] == 1.0 { 4.0 } else { -4.0 };
        drag(&mut window, end, vec2(by * points + inside, 0.0), Modifiers::NONE);
        assert!(is_near(range(&window), wanted), "{:?}", range(&window));
    }
    window.state_mut().state.execute(Request::Seek(2.0));
    assert!((played(&mut window, 2.25) - 1.75).abs() < 1e-3);
}

#[test]
fn the_menu_of_the_ruler_sets_the_loop_range_to_what_the_timeline_shows() {
    let mut window = scene(FOXES).window();
    window.get_by_label("Time of the scene").click_secondary();
    window.run_steps(3);
    window.get_by_label_contains("Set loop range to selection").click();
    window.run_steps(3);
    // All of the scene is shown.
    let (start, length) = window.state().state.read().take_bounds();
    assert!(is_near(range(&window), [start, start + length]), "{:?}", range(&window));
}
