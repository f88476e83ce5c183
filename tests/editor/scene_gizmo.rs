//! The gizmo of things of a scene: lights shine elsewhere, props are tilted, paths are moved as a whole, and with Auto-key things are elsewhere from the
//! playhead on.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_lines::{run, send};
use crate::workbench::Window;
use dragonfly::control::{InputEvent, Key};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
    window.run_steps(2);
}

fn seek(window: &mut Window, time: f32) {
    window.state_mut().state.execute(Request::Seek(time));
    window.run_steps(2);
}

fn typed(window: &mut Window, id: Id, keys: &str) {
    run(window, Id::SpaceWorld);
    run(window, id);
    for key in keys.chars().map(Key::letter).chain([Key::Enter]) {
        send(window, InputEvent::KeyDown(key));
        send(window, InputEvent::KeyUp(key));
    }
}

fn said(window: &Window, part: &str) -> bool {
    window.state().state.read().status.lines().any(|message| message.text.contains(part))
}

/// Returns the numbers of an attribute in the only line that is new.
fn numbers(window: &Window, old: &str, attribute: &str) -> Vec<f64> {
    let new = new_lines(old, &text(window));
    assert_eq!(new.len(), 1, "{new:?}");
    let value = new[0].split(&format!(" {attribute}=\"")).nth(1).unwrap_or_else(|| panic!("{new:?}"));
    let value = value.split('"').next().expect("an end");
    value.split_whitespace().map(|number| number.parse().expect("a number")).collect()
}

fn near(found: &[f64], wanted: &[f64]) -> bool {
    found.len() == wanted.len() && found.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 2e-3)
}

#[test]
fn a_sun_that_is_turned_shines_in_another_direction_and_a_point_light_says_why_not() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["sun"]);
    // A quarter turn about the vertical: +x becomes -z, and +z becomes +x.
    typed(&mut window, Id::RotateNow, "y90");
    let found = numbers(&window, FOXES, "direction");
    assert!(near(&found, &[-1.0, -2.0, 1.0]), "{found:?}");
    assert!(!text(&window).contains("id=\"sun\"   kind=\"sun\" direction=\"-1 -2 1\" facing"));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    typed(&mut window, Id::RotateNow, "x90");
    let found = numbers(&window, FOXES, "direction");
    assert!(near(&found, &[-1.0, 1.0, -2.0]), "{found:?}");
    let lamp = FOXES.replace("kind=\"sun\" direction=\"-1 -2 -1\"", "kind=\"point\" at=\"0 2 0\"");
    let mut window = scene(&lamp).window();
    select(&mut window, &["sun"]);
    typed(&mut window, Id::RotateNow, "y90");
    assert_eq!(text(&window), lamp);
    assert!(said(&window, "shines in all directions"));
}

#[test]
fn a_prop_is_pitched_and_rolled_and_a_role_only_turned() {
    let script = FOXES.replacen(
        "    <camera id=\"wide\"",
        "    <prop id=\"box\" model=\"Fox.glb\" scale=\"0.01\"/>\n    <camera id=\"wide\"",
        1,
    );
    let mut window = scene(&script).window();
    select(&mut window, &["box"]);
    typed(&mut window, Id::RotateNow, "x30");
    assert!(
        near(&numbers(&window, &script, "tilt"), &[30.0, 0.0]),
        "{:?}",
        new_lines(&script, &text(&window))
    );
    assert!(!new_lines(&script, &text(&window))[0].contains("facing"));
    let tilted = text(&window);
    typed(&mut window, Id::RotateNow, "y90");
    assert!(near(&numbers(&window, &tilted, "facing"), &[90.0]));
    assert!(
        text(&window).contains("tilt=\"30 0\""),
        "the tilt stays: {:?}",
        new_lines(&tilted, &text(&window))
    );
    let before = text(&window);
    select(&mut window, &["anna"]);
    typed(&mut window, Id::RotateNow, "x30");
    assert!(!text(&window).contains("tilt=\"30 0\" tilt"), "{:?}", new_lines(&before, &text(&window)));
    assert_eq!(text(&window).matches("tilt").count(), 1, "a role has no tilt");
}

#[test]
fn with_auto_key_a_thing_moved_after_the_start_is_elsewhere_from_then_on() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["door", "sun"]);
    seek(&mut window, 1.5);
    // A mark has no actions: its place in the cast is moved.
    select(&mut window, &["sun"]);
    typed(&mut window, Id::MoveNow, "x2");
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<place who="sun" at="2 0 0" begin="1.5"/>"#]);
    let keyed = text(&window);
    typed(&mut window, Id::MoveNow, "y1");
    assert_eq!(new_lines(&keyed, &text(&window)), [r#"<place who="sun" at="2 1 0" begin="1.5"/>"#]);
    window.state_mut().change(Change::Undo);
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
    seek(&mut window, 0.0);
    typed(&mut window, Id::MoveNow, "x2");
    assert!(new_lines(FOXES, &text(&window))[0].starts_with("<light"), "at the start, its start is moved");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    run(&mut window, Id::AutoKey);
    seek(&mut window, 1.5);
    typed(&mut window, Id::MoveNow, "x2");
    assert!(
        new_lines(FOXES, &text(&window))[0].starts_with("<light"),
        "without Auto-key, its start is moved"
    );
}

#[test]
fn a_thing_on_a_path_says_what_to_do() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["ben"]);
    seek(&mut window, 1.25);
    typed(&mut window, Id::MoveNow, "x2");
    assert_eq!(text(&window), FOXES);
    assert!(said(&window, "follows the path aisle at this time: move the path, or go to its end"));
    run(&mut window, Id::AutoKey);
    typed(&mut window, Id::MoveNow, "x2");
    assert_eq!(text(&window), FOXES);
    assert!(said(&window, "follows the path aisle at this time: move the path"));
}

#[test]
fn the_gizmo_of_a_path_moves_turns_and_scales_all_of_its_points() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["aisle"]);
    typed(&mut window, Id::MoveNow, "x2");
    assert_eq!(numbers(&window, FOXES, "points"), [1.0, 0.0, 0.0, 2.0, 0.0, 0.6, 3.0, 0.0, 0.0]);
    assert_eq!(window.state().steps(), (1, 1));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    // About the middle of its points, which is at 0 0 0.2.
    typed(&mut window, Id::RotateNow, "y90");
    let found = numbers(&window, FOXES, "points");
    assert!(near(&found, &[-0.2, 0.0, 1.2, 0.4, 0.0, 0.2, -0.2, 0.0, -0.8]), "{found:?}");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    typed(&mut window, Id::ScaleNow, "2");
    let found = numbers(&window, FOXES, "points");
    assert!(near(&found, &[-2.0, 0.0, -0.2, 0.0, 0.0, 1.0, 2.0, 0.0, -0.2]), "{found:?}");
}

#[test]
fn the_gizmo_of_one_of_many_things_needs_no_memory_for_all_of_them_while_the_scene_plays() {
    let marks: String = (0..3_000).map(|at| format!("    <mark id=\"m{at}\" at=\"{at} 0 0\"/>\n")).collect();
    let script = FOXES.replacen("    <camera id=\"wide\"", &format!("{marks}    <camera id=\"wide\""), 1);
    let mut bench = scene(&script);
    let select = SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace);
    bench.state.execute(Request::Scene(select));
    bench.state.execute(Request::Command(Id::PlayPause));
    let start = bench.state.read().now;
    let frame = |at: u32| start + std::time::Duration::from_millis(u64::from(at) * 17);
    for at in 0..4 {
        bench.state.begin_frame(frame(at));
        bench.state.end_frame();
    }
    let pivot =
        |bench: &crate::workbench::Workbench| bench.state.read().tools.controls().gizmo().gizmo.pivot();
    let before = pivot(&bench);
    let (allocated, ()) = dragonfly_kit::counting::count(|| {
        for at in 100..110 {
            bench.state.begin_frame(frame(at));
            bench.state.end_frame();
        }
    });
    assert_ne!(pivot(&bench), before, "it follows the thing that walks");
    assert!(allocated.bytes < 10 * 3_000, "{allocated:?} in ten frames: less than a byte for each thing");
}
