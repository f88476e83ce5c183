//! Lines and paths drawn with the mouse in the viewport of a scene.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::Window;
use dragonfly::control::line::LineUse;
use dragonfly::control::{Button, InputEvent, Key, Modifiers};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::stage::StagePath;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec3, Vec2};

/// Gives an event to the viewport, and the changes that follow from it to the document.
pub(crate) fn send(window: &mut Window, event: InputEvent) {
    let mut effects = Vec::new();
    window.state_mut().state.input(event, &mut effects);
    carry(window, effects);
}

fn carry(window: &mut Window, effects: Vec<Effect>) {
    for effect in effects {
        if let Effect::Change(change) = effect {
            window.state_mut().change(change);
        }
    }
    window.run_steps(2);
}

pub(crate) fn run(window: &mut Window, id: Id) {
    let effect = window.state_mut().state.execute(Request::Command(id));
    carry(window, effect.into_iter().collect());
}

/// Returns where a place of the scene is, points from the top left of the window.
pub(crate) fn at(window: &Window, place: DVec3) -> Vec2 {
    let read = window.state().state.read();
    let rect = read.viewport;
    let view = GizmoView::new(&read.camera, Vec2::new(rect.width(), rect.height()));
    view.to_screen(place).expect("in front of the camera").as_vec2() + Vec2::new(rect.left(), rect.top())
}

/// Draws with the left button through places of the scene.
pub(crate) fn stroke(window: &mut Window, places: &[DVec3]) {
    let points: Vec<Vec2> = places.iter().map(|place| at(window, *place)).collect();
    send(window, InputEvent::MouseMove(points[0]));
    send(window, InputEvent::MouseDown(Button::Left));
    for point in &points[1..] {
        send(window, InputEvent::MouseMove(*point));
    }
    send(window, InputEvent::MouseUp(Button::Left));
}

/// A quarter of a circle on the ground, 1 m about the middle of the scene.
fn quarter() -> Vec<DVec3> {
    (0..=40)
        .map(|step| {
            let (sin, cos) = (f64::from(step) / 40.0 * std::f64::consts::FRAC_PI_2).sin_cos();
            DVec3::new(cos - 0.5, 0.0, sin - 0.5)
        })
        .collect()
}

pub(crate) fn points(line: &str) -> Vec<DVec3> {
    let text = line.split("points=\"").nth(1).expect("points").split('"').next().expect("an end");
    let numbers: Vec<f64> = text.split_whitespace().map(|number| number.parse().expect("a number")).collect();
    numbers.chunks(3).map(DVec3::from_slice).collect()
}

#[test]
fn a_stroke_on_the_ground_becomes_a_path_of_the_script_that_follows_it() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolPath);
    assert_eq!(window.state().state.read().tools.controls().line().use_of(), Some(LineUse::Path));
    stroke(&mut window, &quarter());
    let new = new_lines(FOXES, &text(&window));
    assert_eq!((new.len(), window.state().steps()), (1, (1, 1)), "{new:?}");
    assert!(
        new[0].starts_with("<path id=\"path\" points=") && new[0].ends_with("curve=\"smooth\"/>"),
        "{new:?}"
    );
    let points = points(&new[0]);
    assert!(points.len() <= 12, "{points:?}");
    let path = StagePath::new(&points, true);
    // The length of a quarter of a circle, and every place on the path is on the circle.
    assert!((path.length() - std::f64::consts::FRAC_PI_2).abs() < 0.03, "{}", path.length());
    for step in 0..=20 {
        let place = path.at(path.length() * f64::from(step) / 20.0).position;
        assert_eq!(place.y, 0.0);
        let radius = (place - DVec3::new(-0.5, 0.0, -0.5)).length();
        assert!((radius - 1.0).abs() < 0.03, "{place} is {radius} from the middle");
    }
    let read = window.state().state.read();
    assert_eq!(read.scene_editing.things(), [Box::from("path")]);
}

#[test]
fn corners_end_with_enter_and_escape_gives_them_up() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolPath);
    let corners = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 1.0)];
    for end in [Key::Escape, Key::Enter] {
        for corner in corners {
            stroke(&mut window, &[corner]);
        }
        send(&mut window, InputEvent::KeyDown(end));
    }
    let new = new_lines(FOXES, &text(&window));
    assert_eq!((new.len(), window.state().steps()), (1, (1, 1)), "{new:?}");
    let found = points(&new[0]);
    assert_eq!(found.len(), 3);
    assert!(found.iter().zip(corners).all(|(found, corner)| found.distance(corner) < 0.01), "{found:?}");
    assert!(!new[0].contains("smooth"), "corners stay corners: {new:?}");
}

#[test]
fn shift_draws_a_straight_line_and_tells_length_and_direction() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolPath);
    send(&mut window, InputEvent::Modifiers(Modifiers { shift: true, ..Modifiers::default() }));
    let [from, to] = [DVec3::new(-0.5, 0.0, 0.5), DVec3::new(1.0, 0.0, 0.5)].map(|place| at(&window, place));
    send(&mut window, InputEvent::MouseMove(from));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    for share in [0.3, 0.6, 1.0] {
        let bent = Vec2::new(0.0, if share < 1.0 { 30.0 } else { 0.0 });
        send(&mut window, InputEvent::MouseMove(from.lerp(to, share) + bent));
    }
    let measure = window.state().state.read().tools.controls().line().measure().expect("a line");
    assert!((measure.length - 1.5).abs() < 0.01, "{measure:?}");
    // Along +x, as a role that faces 90 degrees.
    assert!((measure.angle.expect("a direction") - 90.0).abs() < 0.5, "{measure:?}");
    send(&mut window, InputEvent::MouseUp(Button::Left));
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(points(&new[0]).len(), 2, "{new:?}");
}

#[test]
fn a_role_walks_along_a_drawn_path_and_undo_of_all_leaves_the_same_text() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolPath);
    stroke(&mut window, &quarter());
    let select =
        Request::Scene(SceneRequest::SelectThings(vec!["anna".into(), "path".into()], Choice::Replace));
    window.state_mut().state.execute(select);
    run(&mut window, Id::WalkAlong);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new.len(), 2, "{new:?}");
    assert!(new[1].contains("<move who=\"anna\" path=\"path\" take=\"Walk\""), "{new:?}");
    let read = window.state().state.read();
    let plan = read.scene().and_then(|scene| scene.plan.clone()).expect("a plan");
    let ticks: usize = read.scene_editing.lines().looks().iter().map(|look| look.ticks.len()).sum();
    assert!(plan.length().seconds() > 1.0 && ticks > 0, "a tick for each second of those that follow");
    for _ in 0..2 {
        window.state_mut().change(Change::Undo);
        window.run_steps(2);
    }
    assert_eq!(text(&window), FOXES);
}

#[test]
fn lines_need_a_project_and_the_tool_says_so() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolLine);
    let read = window.state().state.read();
    assert_eq!(read.tools.controls().line().use_of(), None);
    let said = read.status.last().map(|message| message.text.clone()).unwrap_or_default();
    assert!(said.contains("New project from this scene"), "{said}");
}
