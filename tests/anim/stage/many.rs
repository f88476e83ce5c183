//! Very many lines, names and actions: memory and time stay in proportion.

use super::actors::{assets, fox, fox_script, planned};
use super::read;
use dragonfly_anim::stage::gesture::{
    Followers, GestureScene, SequenceOrder, move_clip, move_clips, move_clips_to_lane, trim_start,
};
use dragonfly_anim::stage::line::{DrawnLines, LineSamples};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::MOST_ERRORS;
use dragonfly_anim::stage::{StageAssets, StagePath};
use dragonfly_kit::counting::count;
use dragonfly_kit::process::thread_time;
use glam::DVec3;
use std::fmt::Write;
use std::time::Duration;

#[test]
fn a_file_of_very_many_curves_is_refused_and_a_long_line_needs_little_memory() {
    let file = |curves: usize, lines: usize| {
        let points = "0 0 0 ".to_owned() + &"1 0 0 1 0 1 2 0 0 ".repeat(curves);
        format!("<lines version=\"1\">{}</lines>", format!("<line points=\"{points}\"/>").repeat(lines))
    };
    assert_eq!(DrawnLines::read(file(100, 200)).expect("20,000 curves").list().len(), 200);
    for (curves, lines) in [(40_000, 1), (100, 400)] {
        let errors = DrawnLines::read(file(curves, lines)).expect_err("40,000 curves");
        assert_eq!(errors.len(), 1);
        assert_eq!(errors[0].message, "the lines have more than 32768 curves together");
    }
    let control: Vec<DVec3> = (0..90_001).map(|at| DVec3::new(f64::from(at), 0.0, 0.0)).collect();
    let (allocated, samples) = count(|| LineSamples::new(&control, false));
    assert!(allocated.bytes < 30 << 20, "{} bytes", allocated.bytes);
    assert!((samples.length() - 90_000.0).abs() < 1e-6);
    let (allocated, path) = count(|| StagePath::new(&control, true));
    assert!(allocated.bytes < 20 << 20, "{} bytes", allocated.bytes);
    assert!((path.length() - 90_000.0).abs() < 1e-6);
}

/// Returns a project of many models, with edits that name `of(number)`.
fn project(models: usize, edits: usize, of: impl Fn(usize) -> String) -> String {
    let mut text = "<project version=\"1\"><models>\n".to_owned();
    for at in 0..models {
        let _ = writeln!(text, "<model id=\"m{at}\" src=\"m{at}.glb\"/>");
    }
    for at in 0..edits {
        let _ = writeln!(text, "<edits of=\"{}\" src=\"c{at}.jsonl\"/>", of(at));
    }
    text + "</models></project>"
}

#[test]
fn a_project_of_very_many_names_is_checked_in_proportion_to_it() {
    let text = project(40_000, 40_000, |_| "m39999".to_owned());
    let begin = thread_time();
    let project_read = StageProject::read(text).expect("a project");
    assert_eq!(project_read.files().len(), 80_000);
    let spent = thread_time() - begin;
    assert!(spent < Duration::from_secs(3), "{spent:?}");
    // Suggestions are looked for only while errors are collected.
    let wrong = |size: usize| {
        let text = project(size, size, |at| format!("x{at}"));
        let (allocated, errors) = count(|| StageProject::read(text).expect_err("no such models"));
        assert_eq!(errors.len(), MOST_ERRORS);
        allocated.bytes as f64
    };
    let (few, many) = (wrong(500), wrong(4_000));
    assert!(many < 16.0 * few, "{few} {many}");
}

#[test]
fn a_gesture_reads_the_new_text_once() {
    let mut actions = String::new();
    for at in 0..2_000 {
        let _ =
            writeln!(actions, "<play id=\"p{at}\" who=\"anna\" take=\"Survey\" begin=\"{at}\" dur=\"2\"/>");
    }
    let text = fox_script(&actions);
    let (once, script) = count(|| read(&text));
    let plan = planned(&text, &assets(&fox()));
    let scene = GestureScene { script: &script, plan: &plan };
    let middle = script.action_called("p1000").expect("an action");
    let moved = count(|| {
        let to = dragonfly_anim::stage::time::StageTime::from_seconds(1234.0);
        move_clip(&scene, middle, to, SequenceOrder::Keep, Followers::Follow).expect("a text")
    });
    // Three attributes: `begin`, `dur` and `from`.
    let trimmed = count(|| {
        trim_start(&scene, middle, dragonfly_anim::stage::time::StageTime::from_seconds(1000.5))
            .expect("a text")
    });
    for (what, (allocated, _)) in [("move", moved), ("trim", trimmed)] {
        let share = allocated.bytes as f64 / once.bytes as f64;
        assert!(share < 1.6, "{what}: {share} times the bytes of one reading");
    }
}

#[test]
fn many_clips_are_moved_with_as_few_readings_as_their_references_need() {
    let mut actions = String::new();
    for at in 0..10_000 {
        // Of ten, the last one begins after the one before it, and so moves along.
        let begin = if at % 10 == 9 { format!("p{}.end+0.25", at - 1) } else { at.to_string() };
        let _ = writeln!(
            actions,
            "<play id=\"p{at}\" who=\"anna\" take=\"Survey\" begin=\"{begin}\" dur=\"0.5\"/>"
        );
    }
    let text = fox_script(&actions);
    let (once, script) = count(|| read(&text));
    let plan = planned(&text, &assets(&fox()));
    let scene = GestureScene { script: &script, plan: &plan };
    let first = script.action_called("p5000").expect("an action");
    let by = dragonfly_anim::stage::time::StageTime::from_seconds(0.125);
    for (selected, changed) in [(20, 18), (1_000, 900)] {
        let all: Vec<usize> = (first..first + selected).collect();
        let (allocated, moved) =
            count(|| move_clips(&scene, &all, by, SequenceOrder::Keep, Followers::Follow).expect("a text"));
        let share = allocated.bytes as f64 / once.bytes as f64;
        assert!(share < 6.0, "{selected} clips: {share} times the bytes of one reading");
        let lines = text.lines().zip(moved.lines()).filter(|(old, new)| old != new).count();
        assert_eq!(lines, changed, "those that move along keep their lines");
        let after = planned(&moved, &assets(&fox()));
        for action in first - 10..first + selected + 10 {
            let [was, now] = [&plan, &after].map(|plan| plan.schedule().times()[action].begin);
            let wanted =
                if all.contains(&action) { by } else { dragonfly_anim::stage::time::StageTime::ZERO };
            assert_eq!(now - was, wanted, "{action}");
        }
    }
}

#[test]
fn clips_go_to_the_lane_of_another_role_with_as_many_readings_as_one_needs_however_many_they_are() {
    let mut actions = String::new();
    for at in 0..2_000 {
        let _ =
            writeln!(actions, "<play id=\"p{at}\" who=\"anna\" take=\"Survey\" begin=\"{at}\" dur=\"0.5\"/>");
    }
    let _ = writeln!(actions, "<play id=\"last\" who=\"ben\" take=\"Survey\" begin=\"9000\"/>");
    let text = fox_script(&actions);
    let (once, script) = count(|| read(&text));
    let plan = planned(&text, &assets(&fox()));
    let scene = GestureScene { script: &script, plan: &plan };
    let first = script.action_called("p1000").expect("an action");
    let by = dragonfly_anim::stage::time::StageTime::from_seconds(0.125);
    let moved = |count_of: usize| {
        let all: Vec<usize> = (first..first + count_of).collect();
        count(|| move_clips_to_lane(&scene, &all, by, "ben", Followers::Follow).expect("a text"))
    };
    let share = |bytes: u64| bytes as f64 / once.bytes as f64;
    let [one, few] = [1, 20].map(|count_of| share(moved(count_of).0.bytes));
    assert!(few < 1.5 * one, "{one} readings for one clip, {few} for 20");
    let (allocated, many) = moved(600);
    assert!(
        share(allocated.bytes) < 2.0 * one,
        "{one} readings for one clip, {} for 600",
        share(allocated.bytes)
    );
    // They are after what the other role does, in their order, as long apart as before.
    let lines: Vec<&str> = many.text.lines().filter(|line| line.contains("who=\"ben\" take")).collect();
    assert_eq!(lines.len(), 601);
    for (at, line) in lines[1..].iter().enumerate() {
        let wanted = format!(
            "<play id=\"p{}\" who=\"ben\" take=\"Survey\" begin=\"{}.125\" dur=\"0.5\"/>",
            1000 + at,
            1000 + at
        );
        assert_eq!(*line, wanted);
    }
    assert!(many.text.ends_with(&format!("{}\n\n</script>", lines[600])));
}

#[test]
fn a_path_that_many_walk_is_in_memory_once() {
    let points: Vec<String> = (0..4_000).map(|at| format!("{} 0 {}", at, at % 7)).collect();
    let text = |moves: usize| {
        let actions = "<move who=\"anna\" path=\"long\" speed=\"9\"/>\n".repeat(moves);
        fox_script(&format!("<seq>{actions}</seq>")).replace(
            "<path id=\"aisle\"",
            &format!(
                "<path id=\"long\" points=\"{}\" curve=\"smooth\"/><path id=\"aisle\"",
                points.join(" ")
            ),
        )
    };
    let bytes = |moves: usize| {
        let (text, assets): (String, StageAssets) = (text(moves), assets(&fox()));
        count(|| planned(&text, &assets)).0.bytes as f64
    };
    let (one, forty) = (bytes(1), bytes(40));
    assert!(forty < 2.0 * one, "{one} {forty}");
}
