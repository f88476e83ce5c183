//! Drags of bars of a scene: to what they snap, and what Alt does at the end of a walk.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_timeline::{Lanes, drag};
use crate::workbench::{Window, draws, move_to, press, release};
use dragonfly::panels::Request;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_document::bones::Choice;
use egui::{Modifiers, pos2};

const LOOKS: usize = 5;
const RUN: usize = 6;
const MOVE: usize = 7;
const LOOK: usize = 8;
const TITLE: usize = 10;

/// Returns begin and end of the bar of an action, seconds.
fn times(window: &Window, action: usize) -> [f64; 2] {
    let lanes = window.state().state.read().scene_editing.lanes().clone();
    let (_, bar) = lanes.bar_of(action).expect("a bar");
    [bar.begin.seconds(), bar.end.seconds()]
}

fn said(window: &Window, part: &str) -> bool {
    window.state().state.read().status.lines().any(|message| message.text.contains(part))
}

#[test]
fn an_end_whose_followers_move_along_is_trimmed_frame_by_frame() {
    // The next one begins where this one ends.
    let apart = FOXES.replace("begin=\"-0.5\" fade-in=\"0.5\" repeat=\"3\"", "repeat=\"3\"");
    let mut window = scene(&apart).window();
    let lanes = Lanes::of(&window);
    // A frame is wider than a point and narrower than the reach of snapping.
    let frame = lanes.scale.per_second() / 24.0;
    assert!((1.5..6.0).contains(&frame), "{frame} points");
    let bar = lanes.bar(&window, LOOKS);
    let from = pos2(bar.right() - 2.0, bar.bottom() - 3.0);
    press(&mut window, from);
    let mut ends = Vec::new();
    // From 2 s on, away from what else begins or ends: nothing does between 2 and 2.5 s but `looks.end`, which moves along.
    for step in 4..=9 {
        move_to(&mut window, pos2(from.x + (frame * f64::from(step)) as f32, from.y), Modifiers::NONE);
        let [_, end] = times(&window, LOOKS);
        assert_eq!(times(&window, RUN)[0], end, "what follows moves along");
        ends.push((end * 24.0).round() as i64);
    }
    release(&mut window, pos2(from.x + (frame * 9.0) as f32, from.y));
    assert_eq!(ends, [52, 53, 54, 55, 56, 57]);
}

#[test]
fn a_clip_that_is_dragged_past_the_next_one_of_its_sequence_tells_its_new_place_and_time_at_the_pointer() {
    let apart = FOXES.replace("begin=\"-0.5\" fade-in=\"0.5\" repeat=\"3\"", "repeat=\"3\"");
    let mut window = scene(&apart).window();
    let lanes = Lanes::of(&window);
    let from = lanes.bar(&window, LOOKS).center();
    let after = |seconds: f64| pos2(from.x + (seconds * lanes.scale.per_second()) as f32, from.y);
    press(&mut window, from);
    move_to(&mut window, after(0.25), Modifiers::NONE);
    move_to(&mut window, after(0.5), Modifiers::NONE);
    assert!(draws(window.output(), "begins at 0.500 s") && !draws(window.output(), "in sequence"));
    move_to(&mut window, after(3.25), Modifiers::NONE);
    // It is the second one of the two now.
    let [begin, _] = times(&window, RUN);
    assert!(
        begin > 3.0 && draws(window.output(), &format!("becomes 2nd in sequence, begins at {begin:.3} s")),
        "{begin}"
    );
    release(&mut window, after(3.25));
    assert_eq!(times(&window, RUN)[0], begin);
}

#[test]
fn a_body_snaps_by_the_nearer_one_of_its_begin_and_its_end() {
    let mut window = scene(FOXES).window();
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectAction(None)));
    window.state_mut().state.execute(Request::Seek(3.375));
    window.run_steps(2);
    // The title lasts from 4 to 5 s: with its end at the playhead it begins at 2.375 s, near to which nothing else is.
    let lanes = Lanes::of(&window);
    let near = 4.0 / lanes.scale.per_second();
    assert!(near * 24.0 > 0.75, "nearer to another frame");
    let from = lanes.bar(&window, TITLE).center();
    drag(&mut window, from, -1.625 + near, Modifiers::NONE);
    assert_eq!(times(&window, TITLE), [2.375, 3.375]);
    assert_eq!(new_lines(FOXES, &text(&window)).len(), 1);
}

#[test]
fn a_walk_whose_end_is_dragged_with_alt_goes_at_the_speed_that_ends_there() {
    let mut window = scene(FOXES).window();
    let [begin, end] = times(&window, MOVE);
    let bar = Lanes::of(&window).bar(&window, MOVE);
    let at = pos2(bar.right() - 2.0, bar.bottom() - 3.0);
    drag(&mut window, at, 0.5, Modifiers::ALT);
    let [new_begin, new_end] = times(&window, MOVE);
    let wanted = ((end + 0.5) * 24.0).round() / 24.0;
    assert!((new_end - wanted).abs() < 5e-3 && new_begin == begin, "{begin} {end}, {new_begin} {new_end}");
    let first = text(&window);
    let line = new_lines(FOXES, &first);
    assert!(line.len() == 1 && line[0].contains(" speed=\""), "{line:?}");
    // From a speed that is written, and back.
    let bar = Lanes::of(&window).bar(&window, MOVE);
    drag(&mut window, pos2(bar.right() - 2.0, bar.bottom() - 3.0), -1.0, Modifiers::ALT);
    let [_, last] = times(&window, MOVE);
    let wanted = ((wanted - 1.0) * 24.0).round() / 24.0;
    assert!((last - wanted).abs() < 5e-3, "{last} instead of {wanted}");
}

#[test]
fn a_length_that_is_written_is_not_changed_by_a_speed() {
    for (attributes, reason) in [(" dur=\"2\"", "`dur`"), (" end=\"4\"", "`end`")] {
        let script =
            FOXES.replace("take=\"Walk\" begin=\"1\"", &format!("take=\"Walk\" begin=\"1\"{attributes}"));
        let mut window = scene(&script).window();
        let bar = Lanes::of(&window).bar(&window, MOVE);
        drag(&mut window, pos2(bar.right() - 2.0, bar.bottom() - 3.0), 0.5, Modifiers::ALT);
        assert_eq!(text(&window), script, "{attributes}");
        assert!(said(&window, reason), "{reason} is named");
    }
    // A look has no speed at all.
    let mut window = scene(FOXES).window();
    let bar = Lanes::of(&window).bar(&window, LOOK);
    drag(&mut window, pos2(bar.right() - 2.0, bar.bottom() - 3.0), 0.5, Modifiers::ALT);
    assert_eq!(text(&window), FOXES);
}

/// Drags the selected bars straight down to the lane of the other role.
fn drag_to_ben(window: &mut Window) {
    let lanes = Lanes::of(window);
    let from = lanes.bar(window, LOOKS).center();
    let ben = lanes.bar(window, MOVE).center();
    press(window, from);
    for share in [0.5, 1.0] {
        move_to(window, pos2(from.x, from.y + (ben.y - from.y) * share), Modifiers::NONE);
    }
    release(window, pos2(from.x, ben.y));
}

#[test]
fn several_bars_go_to_the_lane_of_another_role_in_one_step_and_keep_their_distances() {
    let mut window = scene(FOXES).window();
    let select = SceneRequest::SelectActions(vec![LOOKS, RUN], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.run_steps(2);
    let before = [times(&window, LOOKS), times(&window, RUN)];
    drag_to_ben(&mut window);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(window.state().steps(), (1, 1), "{new:?}");
    let plays: Vec<&String> = new.iter().filter(|line| line.starts_with("<play ")).collect();
    assert!(plays.len() == 2 && plays.iter().all(|line| line.contains("who=\"ben\"")), "{new:?}");
    assert!(plays[0].contains("id=\"looks\"") && plays[1].contains("take=\"Run\""), "{new:?}");
    assert!(!text(&window).contains("<play id=\"looks\" who=\"anna\""));
    // All other actions refer to them as before, at the same times.
    let lanes = window.state().state.read().scene_editing.lanes().clone();
    let bars: Vec<[f64; 2]> = lanes
        .list
        .iter()
        .filter(|lane| &*lane.name == "ben")
        .flat_map(|lane| lane.bars.iter().filter(|bar| bar.kind == "play"))
        .map(|bar| [bar.begin.seconds(), bar.end.seconds()])
        .collect();
    for (bar, before) in bars.iter().zip(before) {
        assert!(
            (bar[0] - before[0]).abs() < 2e-3 && (bar[1] - before[1]).abs() < 2e-3,
            "{bars:?} {before:?}"
        );
    }
    assert_eq!(bars.len(), 2);
    window.state_mut().change(dragonfly_document::Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn bars_that_another_role_cannot_do_stay_where_they_are_and_the_status_line_has_the_reason() {
    let script = FOXES.replace(
        "<look who=\"ben\"",
        "<attach who=\"anna\" to=\"door\" begin=\"3\"/>\n    <look who=\"ben\"",
    );
    let mut window = scene(&script).window();
    let attach = MOVE + 1;
    let select = SceneRequest::SelectActions(vec![attach, LOOKS], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.run_steps(2);
    drag_to_ben(&mut window);
    let new = text(&window);
    assert!(new.contains("<play id=\"looks\" who=\"ben\""), "{new}");
    assert!(new.contains("<attach who=\"anna\" to=\"door\" begin=\"3\"/>"), "{new}");
    assert!(said(&window, "1 action stays: An attachment stays with the thing that is held"));
    assert_eq!(window.state().steps(), (1, 1));
}
