//! Lines and paths drawn with the mouse in the viewport of a scene.

use crate::scene_bench::{FOXES, new_lines, scene, shared, text};
use crate::workbench::Window;
use dragonfly::control::line::LineUse;
use dragonfly::control::{Button, InputEvent, Key, Modifiers};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::{LineRequest, SceneRequest};
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::stage::StagePath;
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::adapter::{TextFile, TextFiles};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::Edit;
use dragonfly_document::{Change, SceneView, View};
use dragonfly_kit::document::fixture;
use dragonfly_picture::gizmo::GizmoView;
use egui_kittest::kittest::Queryable;
use glam::{DVec3, Vec2};
use std::sync::Arc;

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
fn paths_are_drawn_on_the_ground_of_the_project_however_high_it_is() {
    let ground = "<project version=\"1\"><scene ground=\"0.5\"/><script id=\"main\" src=\"scene.xml\"/><script id=\"end\" src=\"end.xml\"/></project>";
    let mut window = shared(ground, FOXES, "<script version=\"1\"/>").window();
    run(&mut window, Id::ToolPath);
    let places = quarter().into_iter().map(|place| place.with_y(0.5)).collect::<Vec<_>>();
    stroke(&mut window, &places);
    let drawn = points(&new_lines(FOXES, &text(&window))[0]);
    assert!(drawn.iter().all(|point| point.y == 0.5), "{drawn:?}");
    let ends = [drawn[0], drawn[drawn.len() - 1]];
    let away = [ends[0].distance(places[0]), ends[1].distance(places[places.len() - 1])];
    assert!(away.iter().all(|away| *away < 0.03), "{ends:?}");
}

#[test]
fn paths_are_drawn_in_an_orthographic_view_in_front_of_its_target_too() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToggleProjection);
    for places in [quarter(), quarter().into_iter().map(|place| place + DVec3::Z).collect()] {
        let before = text(&window);
        run(&mut window, Id::ToolPath);
        stroke(&mut window, &places);
        let drawn = new_lines(&before, &text(&window));
        assert_eq!(drawn.len(), 1, "{drawn:?}");
        let drawn = points(&drawn[0]);
        let away = [drawn[0].distance(places[0]), drawn[drawn.len() - 1].distance(places[places.len() - 1])];
        assert!(away.iter().all(|away| *away < 0.03), "{drawn:?}");
        run(&mut window, Id::ToolPath);
    }
}

#[test]
fn a_line_that_cannot_be_drawn_says_what_is_missing() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ViewFront);
    for (projection, reason) in [("perspective", "horizon"), ("orthographic", "edge")] {
        run(&mut window, Id::ToolPath);
        let viewport = window.state().state.read().viewport;
        let [x, y] = [viewport.center().x, viewport.center().y - 0.2 * viewport.height()];
        send(&mut window, InputEvent::MouseMove(Vec2::new(x, y)));
        send(&mut window, InputEvent::MouseDown(Button::Left));
        send(&mut window, InputEvent::MouseUp(Button::Left));
        let read = window.state().state.read();
        let said = read.status.last().map(|message| message.text.clone()).unwrap_or_default();
        assert!(said.contains(reason), "{projection}: {said}");
        run(&mut window, Id::ToolPath);
        run(&mut window, Id::ToggleProjection);
    }
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
fn a_double_click_ends_a_line_of_corners_and_one_at_its_start_adds_none() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolPath);
    let corners = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 1.0)];
    for corner in [corners[0], corners[0], corners[1], corners[2], corners[2]] {
        stroke(&mut window, &[corner]);
    }
    let new = new_lines(FOXES, &text(&window));
    assert_eq!((new.len(), window.state().steps()), (1, (1, 1)), "{new:?}");
    let found = points(&new[0]);
    assert!(
        found.len() == 3 && found.iter().zip(corners).all(|(found, corner)| found.distance(corner) < 0.01)
    );
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
    // The fade of a clip that is inside of the way now is gone: it followed its overlap with another clip.
    assert_eq!(new.len(), 3, "{new:?}");
    assert!(new[1].contains("take=\"Run\" begin=\"-0.5\" repeat=\"3\""), "{new:?}");
    assert!(new[2].contains("<move who=\"anna\" path=\"path\" take=\"Walk\""), "{new:?}");
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

#[test]
fn the_tool_that_draws_lines_is_put_away_with_its_scene() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolPath);
    window.state_mut().state.show(fixture::full());
    assert_eq!(window.state().state.read().tools.controls().line().use_of(), None);
}

/// A file of lines: one straight piece of two meters, one that is shown later, one of two curves.
const LINES: &str = r##"<?xml version="1.0" encoding="UTF-8"?>
<lines version="1">
  <line id="long" points="-1 0 -0.5  -0.4 0 -0.5  0.4 0 -0.5  1 0 -0.5" color="#ff8000"/>
  <line id="late" points="-1 0 0.5  -0.4 0 0.5  0.4 0 0.5  1 0 0.5" from="2"/>
  <line id="far" points="-1 0 1.5  -0.4 0 1.5  0.4 0 1.5  1 0 1.5"/>
</lines>
"##;

const PROJECT: &str = "<project version=\"1\">\n  <lines src=\"a.lines.xml\"/>\n  <script id=\"main\" src=\"scene.xml\"/>\n</project>\n";

/// Opens the scene as one of a project with drawn lines.
fn project() -> Window {
    let mut window = scene(FOXES).window();
    let bench = window.state_mut();
    let view = bench.state.read().view.cloned().expect("a view");
    let scene = view.scene.as_deref().expect("a scene");
    let file = |name: &str, text: &str| TextFile { name: name.into(), text: text.into() };
    let scene = SceneView {
        texts: TextFiles::new(vec![
            file("a.meproj", PROJECT),
            file("a.lines.xml", LINES),
            file("scene.xml", FOXES),
        ]),
        project: Some(Arc::new(StageProject::read(PROJECT).expect("a project"))),
        lines: Some(Arc::new(DrawnLines::read(LINES).expect("lines"))),
        ..scene.clone()
    };
    bench.state.show(View { scene: Some(Arc::new(scene)), generation: view.generation + 1, ..view });
    bench.state.execute(Request::Command(Id::ViewTop));
    window.run_steps(2);
    run(&mut window, Id::ToolLine);
    window
}

/// Erases from one place of the scene to another in one movement. Returns the ids of the lines that are gone.
fn erased(window: &mut Window, from: DVec3, to: DVec3) -> Vec<&'static str> {
    let [from, to] = [from, to].map(|place| at(window, place));
    let ctrl = |ctrl| InputEvent::Modifiers(Modifiers { ctrl, ..Modifiers::default() });
    let mut effects = Vec::new();
    let events = [
        ctrl(true),
        InputEvent::MouseMove(from),
        InputEvent::MouseDown(Button::Left),
        InputEvent::MouseMove(to),
        InputEvent::MouseUp(Button::Left),
        ctrl(false),
    ];
    for event in events {
        window.state_mut().state.input(event, &mut effects);
    }
    let Some(Effect::Change(Change::Edit(Edit::EditScript(edit), None))) = effects.pop() else {
        return Vec::new();
    };
    let removed: String = edit.splices.iter().map(|splice| splice.old.as_str()).collect();
    ["long", "late", "far"].into_iter().filter(|id| removed.contains(&format!("id=\"{id}\""))).collect()
}

#[test]
fn the_eraser_removes_what_it_crosses_and_only_what_is_seen() {
    let mut window = project();
    let [left, right] = [-0.97, 0.97].map(|x| move |z: f64| DVec3::new(x, 0.0, z));
    // One fast movement across a line, far from every point of it that a curve is measured at.
    assert_eq!(erased(&mut window, DVec3::new(0.3, 0.0, -0.2), DVec3::new(0.31, 0.0, -0.9)), ["long"]);
    assert_eq!(erased(&mut window, left(0.0), right(0.0)), [""; 0], "it touches none");
    // A line that is shown from two seconds on.
    assert_eq!(erased(&mut window, left(0.2), right(0.8)), [""; 0], "it is not shown yet");
    window.state_mut().state.execute(Request::Seek(3.0));
    window.run_steps(2);
    assert_eq!(erased(&mut window, left(0.2), right(0.8)), ["late"]);
    // A line that is hidden in the list, and all of them.
    let hide = |hide| Request::Scene(SceneRequest::Line(LineRequest::Hide("far".into(), hide)));
    window.state_mut().state.execute(hide(true));
    assert_eq!(erased(&mut window, left(1.3), right(1.7)), [""; 0], "it is hidden");
    window.state_mut().state.execute(hide(false));
    assert_eq!(erased(&mut window, left(0.2), right(1.7)), ["late", "far"]);
    window.state_mut().state.settings_mut().look.lines = false;
    assert_eq!(erased(&mut window, left(0.2), right(1.7)), [""; 0], "no line is shown");
}

/// Executes a request about a line. Returns its effect, and the newest message.
fn line_request(window: &mut Window, request: LineRequest) -> (Option<Effect>, String) {
    let effect = window.state_mut().state.execute(Request::Scene(SceneRequest::Line(request)));
    let read = window.state().state.read();
    (effect, read.status.last().map(|message| message.text.clone()).unwrap_or_default())
}

#[test]
fn a_line_that_a_path_follows_is_not_deleted_and_names_that_break_the_file_are_refused() {
    let mut window = project();
    let set = |name: &str| LineRequest::Set("far".into(), "id", Some(name.to_owned()));
    let (effect, said) = line_request(&mut window, set("my line"));
    assert!(effect.is_none() && said.contains("my line"), "{said}");
    let (effect, said) = line_request(&mut window, set("long"));
    assert!(effect.is_none() && said.contains("used"), "{said}");
    let (effect, said) = line_request(&mut window, LineRequest::Delete("far".into()));
    assert!(matches!(effect, Some(Effect::Change(_))), "nothing follows it: {said}");
    // A path along one of the lines.
    let view = window.state().state.read().view.cloned().expect("a view");
    let followed = FOXES.replace("  </cast>", "    <path id=\"way\" line=\"long\"/>\n  </cast>");
    let before = view.scene.as_deref().expect("a scene");
    let mut texts = before.texts.list().to_vec();
    texts[2].text = followed.as_str().into();
    let scene = SceneView {
        script: Some(Arc::new(StageScript::read(followed).expect("a script"))),
        texts: TextFiles::new(texts),
        ..before.clone()
    };
    window.state_mut().state.show(View { scene: Some(Arc::new(scene)), ..view });
    let (effect, said) = line_request(&mut window, LineRequest::Delete("long".into()));
    assert!(effect.is_none() && said.contains("way") && said.contains("long"), "{said}");
    // Without a name it could not be followed; the path follows it under another name in the same step.
    let (effect, said) = line_request(&mut window, LineRequest::Set("long".into(), "id", None));
    assert!(effect.is_none() && said.contains("way"), "{said}");
    let name = Some("wide".to_owned());
    let (effect, said) = line_request(&mut window, LineRequest::Set("long".into(), "id", name));
    let Some(Effect::Change(Change::Edit(Edit::EditScript(edit), None))) = effect else { panic!("{said}") };
    let also: Vec<&str> = edit.also.iter().flat_map(|own| &own.splices).map(|splice| &*splice.new).collect();
    assert!(also.len() == 1 && also[0].contains("wide"), "{also:?}");
}

#[test]
fn errors_of_the_project_and_of_its_lines_are_listed_with_their_files() {
    let mut window = project();
    let view = window.state().state.read().view.cloned().expect("a view");
    let errors = |text: &str| DrawnLines::read(text).expect_err("an error");
    let scene = SceneView {
        line_errors: errors(&LINES.replace("points=\"-1 0 1.5 ", "points=\"x 0 1.5 ")).into(),
        project_errors: StageProject::read(PROJECT.replace("src=\"a.lines.xml\"", ""))
            .expect_err("an error")
            .into(),
        ..view.scene.as_deref().expect("a scene").clone()
    };
    window.state_mut().state.show(View { scene: Some(Arc::new(scene)), ..view });
    window.run_steps(3);
    for file in ["a.lines.xml", "a.meproj"] {
        let found = window.query_all_by_label_contains(&format!("Error at {file}, ")).count();
        assert!(found > 0, "no error of {file} is listed");
    }
}
