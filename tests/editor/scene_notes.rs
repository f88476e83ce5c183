//! Lines of a project drawn freehand: in the view, on surfaces, on bones, from a time on; erased, dragged, and their attributes.

use crate::scene_bench::{FOXES, named_text, new_lines, project};
use crate::scene_lines::{at, points, run, send, stroke};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent, Modifiers};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::{LineRequest, SceneRequest};
use dragonfly_anim::stage::RigidPlace;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::Change;
use egui::Key;
use egui_kittest::kittest::Queryable;
use glam::DVec3;

const NONE: &str = "<lines version=\"1\">\n</lines>\n";

/// Places on the flank of the fox called anna, from her tail to her head, as the camera sees them.
fn along_flank() -> Vec<DVec3> {
    (0..=12).map(|step| DVec3::new(-1.15 + 0.025 * f64::from(step), 0.45, 0.0)).collect()
}

fn lines(window: &Window) -> String {
    named_text(window, "scene.lines.xml")
}

fn seek(window: &mut Window, time: f32) {
    window.state_mut().state.execute(Request::Seek(time));
    window.run_steps(2);
}

fn place_of(window: &Window, name: &str, seconds: f64) -> RigidPlace {
    let read = window.state().state.read();
    let plan = read.scene().and_then(|scene| scene.plan.clone()).expect("a plan");
    let mut state = plan.new_scene();
    plan.scene_at(StageTime::from_seconds(seconds), &mut state);
    plan.place_of_name(name, &state).expect("a place")
}

fn value<'a>(line: &'a str, attribute: &str) -> Option<&'a str> {
    line.split(&format!(" {attribute}=\"")).nth(1)?.split('"').next()
}

/// Draws a line on the flank with this surface. Returns what the file has of it.
fn drawn(window: &mut Window, surface: Id) -> String {
    let before = lines(window);
    run(window, surface);
    run(window, Id::ToolLine);
    stroke(window, &along_flank());
    run(window, Id::ToolLine);
    let new = new_lines(&before, &lines(window));
    assert_eq!(new.len(), 1, "{new:?}");
    new[0].clone()
}

#[test]
fn a_freehand_line_in_the_view_is_at_the_depth_of_what_is_under_its_start() {
    let mut window = project(FOXES, NONE).window();
    let line = drawn(&mut window, Id::LinesInView);
    assert_eq!(value(&line, "on"), Some("view"), "{line}");
    let back = window.state().state.read().camera.back().as_dvec3();
    let drawn = points(&line);
    let depths: Vec<f64> = drawn.iter().map(|point| point.dot(back)).collect();
    assert!(depths.iter().all(|depth| (depth - depths[0]).abs() < 2e-3), "{depths:?}");
    // The flank is nearer to the camera than the middle of the fox, by less than half of its width.
    let middle = DVec3::new(-1.15, 0.45, 0.0).dot(back);
    assert!((0.01..0.4).contains(&(depths[0] - middle)), "{depths:?} {middle}");
    assert!(drawn.len() % 3 == 1, "curves");
    // The plane through the point that the camera looks at is elsewhere.
    let target = window.state().state.read().camera.target.as_dvec3().dot(back);
    assert!((depths[0] - target).abs() > 0.02, "{depths:?} {target}");
}

#[test]
fn a_line_on_a_surface_follows_the_skin_in_its_pose() {
    let mut window = project(FOXES, NONE).window();
    seek(&mut window, 0.5);
    let line = drawn(&mut window, Id::LinesOnSurface);
    assert_eq!((value(&line, "on"), value(&line, "of")), (Some("surface"), None), "{line}");
    let back = window.state().state.read().camera.back().as_dvec3();
    let depths: Vec<f64> = points(&line).iter().map(|point| point.dot(back)).collect();
    let (least, most) = depths.iter().fold((f64::MAX, f64::MIN), |(a, b), d| (a.min(*d), b.max(*d)));
    assert!(most - least > 1e-3, "a flank is not flat: {depths:?}");
    assert!(points(&line).iter().all(|point| point.distance(DVec3::new(-1.0, 0.45, 0.0)) < 0.5), "{line}");
}

#[test]
fn a_line_on_a_bone_moves_with_it_is_dragged_and_is_erased_where_it_is() {
    let mut window = project(FOXES, NONE).window();
    seek(&mut window, 0.5);
    let line = drawn(&mut window, Id::LinesOnBone);
    let of = value(&line, "of").expect("a bone").to_owned();
    assert!(value(&line, "on") == Some("bone") && of.starts_with("anna.b_"), "{line}");
    // In the space of the bone at the time at which it was drawn, it is on the flank.
    let place = place_of(&window, &of, 0.5);
    let shown = |place: &RigidPlace, line: &str| -> Vec<DVec3> {
        points(line).iter().map(|point| place.rotation * *point + place.position).collect()
    };
    let there = shown(&place, &line);
    let [first, end] = [there[0], there[there.len() - 1]];
    for (point, wanted) in [(first, along_flank()[0]), (end, along_flank()[12])] {
        let [point, wanted] = [point, wanted].map(|point| at(&window, point));
        assert!(point.distance(wanted) < 4.0, "{point} {wanted}");
    }
    // It has points where it is now, also at another time.
    let handles = |window: &Window| -> Vec<DVec3> {
        window
            .state()
            .state
            .read()
            .tools
            .controls()
            .points()
            .points()
            .iter()
            .map(|point| point.place)
            .collect()
    };
    assert!(handles(&window)[0].distance(first) < 1e-3, "{:?} {first}", handles(&window));
    seek(&mut window, 1.5);
    let later = shown(&place_of(&window, &of, 1.5), &line);
    assert!(later[0].distance(first) > 1e-4, "the bone moves");
    assert!(handles(&window)[0].distance(later[0]) < 1e-3);
    let [from, to] = [later[0], later[0] + DVec3::X * 0.2].map(|place| at(&window, place));
    send(&mut window, InputEvent::MouseMove(from));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    send(&mut window, InputEvent::MouseMove(to));
    send(&mut window, InputEvent::MouseUp(Button::Left));
    let moved = lines(&window).lines().find(|line| line.contains("<line ")).expect("a line").to_owned();
    let now = shown(&place_of(&window, &of, 1.5), &moved)[0];
    assert!(at(&window, now).distance(to) < 1.5, "{now} {to}");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    run(&mut window, Id::ToolLine);
    send(&mut window, InputEvent::Modifiers(Modifiers { ctrl: true, ..Modifiers::default() }));
    let middle = at(&window, later[later.len() / 2]);
    send(&mut window, InputEvent::MouseMove(middle));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    send(&mut window, InputEvent::MouseUp(Button::Left));
    assert_eq!(lines(&window), NONE, "erased");
}

/// Notes on a surface, and on a bone of the fox that walks.
const NOTES: &str = r#"<lines version="1">
  <line id="skin" on="surface" points="-0.3 0 1.5  -0.1 0.02 1.5  0.1 0.02 1.5  0.3 0 1.5"/>
  <line id="held" on="bone" of="ben.b_Head_05" points="0 0.1 0  0 0.2 0  0 0.3 0  0 0.4 0"/>
</lines>
"#;

/// Clicks at a place of the scene. Returns the line that is selected then.
fn clicked(window: &mut Window, place: DVec3) -> Option<String> {
    let none = Request::Scene(SceneRequest::Line(LineRequest::Select(None)));
    window.state_mut().state.execute(none);
    window.run_steps(2);
    let at = at(window, place);
    send(window, InputEvent::MouseMove(at));
    send(window, InputEvent::MouseDown(Button::Left));
    send(window, InputEvent::MouseUp(Button::Left));
    window.state().state.read().scene_editing.lines().selected().map(str::to_owned)
}

#[test]
fn a_note_on_a_surface_or_a_bone_is_picked_where_it_is_drawn_at_the_frame_that_is_shown() {
    let mut window = project(FOXES, NOTES).window();
    let middle = |window: &Window, seconds: f64| {
        let place = place_of(window, "ben.b_Head_05", seconds);
        place.rotation * DVec3::new(0.0, 0.25, 0.0) + place.position
    };
    let [before, after] = [0.0, 3.0].map(|seconds| middle(&window, seconds));
    assert!(at(&window, before).distance(at(&window, after)) > 40.0, "the fox has walked");
    for (seconds, here, elsewhere) in [(0.0, before, after), (3.0, after, before)] {
        seek(&mut window, seconds);
        assert_eq!(clicked(&mut window, here).as_deref(), Some("held"), "{seconds} s");
        assert_eq!(clicked(&mut window, elsewhere), None, "{seconds} s");
        let on_surface = DVec3::new(0.0, 0.015, 1.5);
        assert_eq!(clicked(&mut window, on_surface).as_deref(), Some("skin"), "{seconds} s");
    }
}

#[test]
fn a_line_that_is_to_move_with_a_bone_has_to_begin_on_one() {
    let mut window = project(FOXES, NONE).window();
    run(&mut window, Id::LinesOnBone);
    run(&mut window, Id::ToolLine);
    stroke(&mut window, &[DVec3::new(0.0, 0.0, 1.5), DVec3::new(0.2, 0.0, 1.5), DVec3::new(0.4, 0.0, 1.6)]);
    assert_eq!(lines(&window), NONE);
    let read = window.state().state.read();
    assert!(read.status.lines().any(|message| message.text.contains("Begin the line on the bone")));
}

#[test]
fn a_line_is_shown_from_the_frame_on_at_which_it_was_drawn_unless_lines_are_always_shown() {
    let mut window = project(FOXES, NONE).window();
    let line = drawn(&mut window, Id::LinesOnGround);
    assert_eq!(value(&line, "from"), None, "from the start on is always");
    seek(&mut window, 1.5);
    let line = drawn(&mut window, Id::LinesOnGround);
    assert_eq!(value(&line, "from"), Some("1.5"), "{line}");
    run(&mut window, Id::ToggleLinesFrom);
    let line = drawn(&mut window, Id::LinesOnGround);
    assert_eq!(value(&line, "from"), None, "{line}");
}

#[test]
fn the_attributes_of_the_selected_line_are_edited_as_fields() {
    const LINE: &str =
        "<lines version=\"1\">\n  <line id=\"note\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\"/>\n</lines>\n";
    let mut window = project(FOXES, LINE).window();
    assert!(window.query_by_label("line width").is_none(), "nothing is selected");
    let select = Request::Scene(SceneRequest::Line(LineRequest::Select(Some("note".into()))));
    window.state_mut().state.execute(select);
    window.run_steps(2);
    window.get_by_label("line width").click();
    window.run_steps(2);
    window.get_by_label("line width").type_text("6");
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert!(lines(&window).contains("width=\"6\""), "{}", lines(&window));
    assert_eq!(window.state().steps(), (1, 1));
    window.get_by_label("line color").click();
    window.run_steps(2);
    window.get_by_label("line color").type_text("red");
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert!(!lines(&window).contains("red"));
    let said =
        |part: &str| window.state().state.read().status.lines().any(|message| message.text.contains(part));
    assert!(said("is not a color such as #ffcc00"));
}

#[test]
fn a_note_is_shown_up_to_the_next_one_that_is_drawn_later_and_all_of_it_is_one_step() {
    let mut window = project(FOXES, NONE).window();
    let draw = |window: &mut Window, seconds: f32| {
        seek(window, seconds);
        run(window, Id::LinesOnGround);
        run(window, Id::ToolLine);
        stroke(window, &[DVec3::ZERO, DVec3::new(0.3, 0.0, 0.2), DVec3::new(0.6, 0.0, 0.1)]);
        run(window, Id::ToolLine);
    };
    draw(&mut window, 0.5);
    draw(&mut window, 0.5);
    let both = lines(&window);
    assert_eq!((both.matches("from=\"0.5\"").count(), both.matches(" to=").count()), (2, 0), "{both}");
    draw(&mut window, 1.25);
    let new = lines(&window);
    assert_eq!(new.matches("to=\"1.25\"").count(), 2, "{new}");
    assert_eq!(new.matches("from=\"1.25\"").count(), 1, "{new}");
    let steps = window.state().steps();
    assert_eq!(steps, (3, 3));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(lines(&window), both, "undo takes both back");
    // Lines that are shown all the time end nothing.
    window.state_mut().state.execute(Request::Command(Id::ToggleLinesFrom));
    draw(&mut window, 2.0);
    assert_eq!(lines(&window).matches(" to=").count(), 0);
}
