//! Points of paths and lines that are dragged in the viewport of a scene.

use crate::scene_bench::{FOXES, named_text, new_lines, project, scene, text};
use crate::scene_lines::{at, points, send};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent, Key, Modifiers};
use dragonfly::panels::Request;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_kit::counting::count;
use glam::{DVec3, Vec2};

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
    window.run_steps(2);
}

fn shown_points(window: &Window) -> Vec<DVec3> {
    window.state().state.read().tools.controls().points().points().iter().map(|point| point.place).collect()
}

/// Drags from one place of the scene to where another one is seen, and releases the button unless `then` cancels it.
fn drag(window: &mut Window, from: DVec3, to: DVec3, then: Option<Key>) {
    let [from, to] = [from, to].map(|place| at(window, place));
    drag_pixels(window, from, to, then);
}

fn drag_pixels(window: &mut Window, from: Vec2, to: Vec2, then: Option<Key>) {
    send(window, InputEvent::MouseMove(from));
    send(window, InputEvent::MouseDown(Button::Left));
    for share in [0.25, 0.5, 0.75, 1.0] {
        send(window, InputEvent::MouseMove(from.lerp(to, share)));
    }
    match then {
        Some(key) => send(window, InputEvent::KeyDown(key)),
        None => send(window, InputEvent::MouseUp(Button::Left)),
    }
}

#[test]
fn a_point_of_the_selected_path_is_dragged_on_the_ground_as_one_step() {
    let mut window = scene(FOXES).window();
    assert!(shown_points(&window).is_empty(), "nothing is selected");
    select(&mut window, &["aisle"]);
    let middle = DVec3::new(0.0, 0.0, 0.6);
    assert_eq!(shown_points(&window), [DVec3::NEG_X, middle, DVec3::X]);
    let wanted = DVec3::new(0.4, 0.0, 1.1);
    drag(&mut window, middle, wanted, None);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!((new.len(), window.state().steps()), (1, (1, 1)), "{new:?}");
    // The other points stay as they are written.
    assert!(new[0].contains("points=\"-1 0 0  ") && new[0].contains("  1 0 0\" curve"), "{new:?}");
    let found = points(&new[0])[1];
    assert!(found.distance(wanted) < 0.01 && found.y == 0.0, "{found}");
    assert!(shown_points(&window)[1].distance(wanted) < 0.01, "the point is where the path is");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn shift_moves_a_point_up_and_ctrl_snaps_it() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["aisle"]);
    let modifiers = |shift, ctrl| InputEvent::Modifiers(Modifiers { shift, ctrl, ..Modifiers::default() });
    send(&mut window, modifiers(true, false));
    drag(&mut window, DVec3::X, DVec3::new(1.0, 0.5, 0.0), None);
    let found = points(&new_lines(FOXES, &text(&window))[0])[2];
    assert!(found.with_y(0.0) == DVec3::X && (found.y - 0.5).abs() < 0.1, "{found}");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    send(&mut window, modifiers(false, true));
    drag(&mut window, DVec3::X, DVec3::new(1.3, 0.0, 0.7), None);
    assert_eq!(points(&new_lines(FOXES, &text(&window))[0])[2], DVec3::new(1.25, 0.0, 0.75));
}

#[test]
fn ctrl_snaps_a_point_only_on_the_axes_that_the_drag_moves() {
    let start = DVec3::new(1.1, 0.1, 0.6);
    let script = FOXES.replace("  1 0 0\" curve", "  1.1 0.1 0.6\" curve");
    let mut window = scene(&script).window();
    select(&mut window, &["aisle"]);
    let modifiers = |shift| InputEvent::Modifiers(Modifiers { shift, ctrl: true, ..Modifiers::default() });
    send(&mut window, modifiers(false));
    drag(&mut window, start, DVec3::new(1.3, 0.1, 0.7), None);
    assert_eq!(points(&new_lines(&script, &text(&window))[0])[2], DVec3::new(1.25, 0.1, 0.75));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    send(&mut window, modifiers(true));
    drag(&mut window, start, start + DVec3::Y * 0.4, None);
    assert_eq!(points(&new_lines(&script, &text(&window))[0])[2], DVec3::new(1.1, 0.5, 0.6));
}

#[test]
fn a_cancelled_drag_a_locked_path_and_a_hidden_one_change_nothing() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["aisle"]);
    drag(&mut window, DVec3::X, DVec3::new(0.5, 0.0, 0.5), Some(Key::Escape));
    assert_eq!((text(&window).as_str(), window.state().steps().0), (FOXES, 0));
    send(&mut window, InputEvent::MouseUp(Button::Left));
    let path = || vec!["aisle".into()];
    for request in [
        SceneRequest::Lock(path(), true),
        SceneRequest::Lock(path(), false),
        SceneRequest::Hide(path(), true),
    ] {
        let is_free = request == SceneRequest::Lock(path(), false);
        window.state_mut().state.execute(Request::Scene(request));
        window.run_steps(2);
        assert_eq!(shown_points(&window).is_empty(), !is_free);
    }
    let looks = window.state().state.read().scene_editing.lines().looks().len();
    assert_eq!(looks, 0, "a hidden path is not drawn");
}

/// A line of two curves.
const LINES: &str = r#"<lines version="1">
  <!-- a way -->
  <line id="way" points="-1 0 0  -0.6 0 0.5  -0.4 0 0.5  0 0 0  0.4 0 -0.5  0.6 0 -0.5  1 0 0"/>
</lines>
"#;

#[test]
fn a_line_that_is_a_path_has_points_and_its_curve_follows_one_of_them() {
    let script = FOXES.replace("points=\"-1 0 0  0 0 0.6  1 0 0\" curve=\"smooth\"", "line=\"way\"");
    let mut window = project(&script, LINES).window();
    select(&mut window, &["aisle"]);
    assert_eq!(shown_points(&window).len(), 7);
    let by = DVec3::new(0.25, 0.0, 0.5);
    drag(&mut window, DVec3::ZERO, by, None);
    let lines = named_text(&window, "scene.lines.xml");
    let new = new_lines(LINES, &lines);
    assert_eq!((new.len(), window.state().steps(), text(&window)), (1, (1, 1), script), "{new:?}");
    let before = DrawnLines::read(LINES).unwrap().list()[0].points.clone();
    let after = DrawnLines::read(lines.as_str()).unwrap().list()[0].points.clone();
    for (index, (before, after)) in before.iter().zip(&after).enumerate() {
        // The point and the two that give the curve its direction there.
        let expected = if (2..=4).contains(&index) { by } else { DVec3::ZERO };
        assert!((*after - *before).distance(expected) < 0.01, "{index}: {before} {after}");
    }
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(named_text(&window, "scene.lines.xml"), LINES);
}

#[test]
fn a_smooth_line_stays_smooth_when_one_of_its_directions_is_dragged_unless_alt_is_held() {
    let script = FOXES.replace("points=\"-1 0 0  0 0 0.6  1 0 0\" curve=\"smooth\"", "line=\"way\"");
    let mut window = project(&script, LINES).window();
    select(&mut window, &["aisle"]);
    let (from, to) = (DVec3::new(0.4, 0.0, -0.5), DVec3::new(0.5, 0.0, 0.2));
    let read = |window: &Window| {
        let text = named_text(window, "scene.lines.xml");
        DrawnLines::read(text.as_str()).unwrap().list()[0].points.clone()
    };
    let before = read(&window);
    drag(&mut window, from, to, None);
    let after = read(&window);
    assert!(after[4].distance(to) < 0.01, "{}", after[4]);
    let [one, other] = [after[2], after[4]].map(|arm| (arm - after[3]).normalize());
    assert!(one.dot(other) < -0.999_99, "{one} {other}");
    assert!((after[2].length() - before[2].length()).abs() < 0.001, "its length stays: {}", after[2]);
    for index in [0, 1, 3, 5, 6] {
        assert_eq!(after[index], before[index], "{index}");
    }
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(named_text(&window, "scene.lines.xml"), LINES);

    let [start, end] = [from, to].map(|place| at(&window, place));
    send(&mut window, InputEvent::MouseMove(start));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    send(&mut window, InputEvent::Modifiers(Modifiers { alt: true, ..Modifiers::default() }));
    for share in [0.5, 1.0] {
        send(&mut window, InputEvent::MouseMove(start.lerp(end, share)));
    }
    send(&mut window, InputEvent::MouseUp(Button::Left));
    let alone = read(&window);
    assert!(alone[4].distance(to) < 0.01, "{}", alone[4]);
    assert_eq!(alone[2], before[2], "the other direction");
}

#[test]
fn alt_counts_for_a_direction_whose_place_on_the_grid_stays() {
    let script = FOXES.replace("points=\"-1 0 0  0 0 0.6  1 0 0\" curve=\"smooth\"", "line=\"way\"");
    let mut window = project(&script, LINES).window();
    select(&mut window, &["aisle"]);
    let read = |window: &Window| {
        let text = named_text(window, "scene.lines.xml");
        DrawnLines::read(text.as_str()).unwrap().list()[0].points.clone()
    };
    let before = read(&window);
    let [start, end] =
        [DVec3::new(0.4, 0.0, -0.5), DVec3::new(0.5, 0.0, 0.25)].map(|place| at(&window, place));
    send(&mut window, InputEvent::MouseMove(start));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    let mut moved = |alt: bool, to: Vec2| {
        send(&mut window, InputEvent::Modifiers(Modifiers { ctrl: true, alt, ..Modifiers::default() }));
        send(&mut window, InputEvent::MouseMove(to));
        let points = read(&window);
        (points[4], points[2])
    };
    let snapped = DVec3::new(0.5, 0.0, 0.25);
    let (own, other) = moved(false, end);
    assert!(own.distance(snapped) < 1e-6 && other != before[2], "{own} {other}");
    assert_eq!(moved(true, end + Vec2::ONE), (own, before[2]), "alone");
    assert_eq!(moved(false, end), (own, other), "both again");
}

#[test]
fn a_selected_camera_shows_the_points_of_the_path_that_it_moves_along_and_they_are_dragged() {
    let script =
        FOXES.replace("  </par>", "    <move who=\"wide\" path=\"aisle\" begin=\"0\" dur=\"4\"/>\n  </par>");
    let mut window = scene(&script).window();
    select(&mut window, &["ben"]);
    assert!(shown_points(&window).is_empty(), "a role");
    select(&mut window, &["close"]);
    assert!(shown_points(&window).is_empty(), "a camera that does not move");
    select(&mut window, &["wide"]);
    assert_eq!(shown_points(&window), [DVec3::NEG_X, DVec3::new(0.0, 0.0, 0.6), DVec3::X]);
    select(&mut window, &["aisle", "wide"]);
    assert_eq!(shown_points(&window).len(), 3, "each point once");
    select(&mut window, &["wide"]);
    drag(&mut window, DVec3::X, DVec3::new(0.9, 0.0, 0.7), None);
    let new = new_lines(&script, &text(&window));
    assert!(new.len() == 1 && new[0].starts_with("<path") && points(&new[0])[2].z > 0.5, "{new:?}");
    window.state_mut().state.execute(Request::Scene(SceneRequest::Lock(vec!["aisle".into()], true)));
    window.run_steps(2);
    assert!(shown_points(&window).is_empty(), "its path is locked");
}

#[test]
fn a_point_of_a_small_path_is_dragged_where_the_gizmo_covers_it() {
    let script = FOXES.replace("-1 0 0  0 0 0.6  1 0 0", "-0.05 0 0  0 0 0.03  0.05 0 0");
    let mut window = scene(&script).window();
    select(&mut window, &["aisle"]);
    drag(&mut window, DVec3::new(0.0, 0.0, 0.03), DVec3::new(0.1, 0.0, 0.4), None);
    let new = new_lines(&script, &text(&window));
    assert_eq!(new.len(), 1, "{new:?}");
    assert!(new[0].contains("points=\"-0.05 0 0  ") && new[0].contains("  0.05 0 0\""), "one point: {new:?}");
    assert!(points(&new[0])[1].distance(DVec3::new(0.1, 0.0, 0.4)) < 0.01, "{new:?}");
}

#[test]
fn paths_show_where_feet_land_and_where_they_bend_too_much() {
    let mut window = scene(FOXES).window();
    let looks = |window: &Window| window.state().state.read().scene_editing.lines().looks().clone();
    let dots = |window: &Window| looks(window).iter().map(|look| look.dots.len()).sum::<usize>();
    // Of a walk of the fox, one contact a cycle is found; it goes about two meters, which are more than three cycles.
    assert!(dots(&window) >= 3, "{}", dots(&window));
    assert_eq!(looks(&window).len(), 1, "the path has no part that bends too much");
    select(&mut window, &["aisle"]);
    // Two ends of a hairpin.
    drag(&mut window, DVec3::X, DVec3::new(-0.9, 0.0, 0.2), None);
    let parts = looks(&window);
    assert!(parts.len() > 1, "a part in red");
    let tight = &parts[1];
    assert!(tight.ink != parts[0].ink && tight.dots.is_empty() && tight.points.len() > 1);
    let turn = tight.points[tight.points.len() / 2];
    assert!(turn.distance(glam::Vec3::new(0.0, 0.0, 0.6)) < 0.2, "the turn is at {turn}");
}

#[test]
fn a_drag_of_a_point_among_many_lines_reads_none_of_them_and_sends_no_place_twice() {
    let script = FOXES.replace("points=\"-1 0 0  0 0 0.6  1 0 0\" curve=\"smooth\"", "line=\"way\"");
    let more: String = (0..2_000)
        .map(|at| format!("  <line id=\"l{at}\" points=\"{at} 0 9  {at} 1 9  {at} 2 9  {at} 3 9\"/>\n"))
        .collect();
    let lines = LINES.replace("</lines>", &format!("{more}</lines>"));
    let mut window = project(&script, &lines).window();
    select(&mut window, &["aisle"]);
    let [from, first, second] =
        [DVec3::ZERO, DVec3::new(0.1, 0.0, 0.1), DVec3::new(0.2, 0.0, 0.3)].map(|place| at(&window, place));
    send(&mut window, InputEvent::MouseMove(from));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    send(&mut window, InputEvent::MouseMove(first));
    let moved = |window: &mut Window, to: Vec2| {
        let mut effects = Vec::new();
        let state = &mut window.state_mut().state;
        let (count, ()) = count(|| {
            state.input(InputEvent::MouseMove(to), &mut effects);
        });
        (count.allocations, effects.len())
    };
    let (allocations, effects) = moved(&mut window, second);
    assert_eq!(effects, 1);
    assert!(allocations < 1_000, "{allocations} allocations, and the file has 2,001 lines");
    assert_eq!(moved(&mut window, second).1, 0, "the point is there already");
    // The same for the points of a path.
    let mut window = scene(FOXES).window();
    select(&mut window, &["aisle"]);
    let end = at(&window, DVec3::X);
    send(&mut window, InputEvent::MouseMove(end));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    assert_eq!([moved(&mut window, first).1, moved(&mut window, first).1], [1, 0]);
}
