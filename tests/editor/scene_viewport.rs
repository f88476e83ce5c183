//! The viewport of a scene: what is framed, what a click selects, whose eyes it looks through, and what the gizmo writes.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::{Window, Workbench};
use dragonfly::control::{InputEvent, Key as ToolKey};
use dragonfly::panels::commands::Id;
use dragonfly::panels::request::FileAction;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::bones::Choice;
use dragonfly_document::{Change, DocumentMessage, FileView, LoadedModel, SceneModel, View};
use dragonfly_kit::document::fixture;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::gizmo::GizmoView;
use egui::{Event, Key, Modifiers, PointerButton, pos2};
use egui_kittest::kittest::Queryable;
use glam::{Vec2, Vec3};
use std::path::Path;
use std::sync::Arc;

fn run(window: &mut Window, id: Id) -> Option<Effect> {
    execute(window, Request::Command(id))
}

fn execute(window: &mut Window, request: Request) -> Option<Effect> {
    let effect = window.state_mut().state.execute(request);
    let effect = match effect {
        Some(Effect::Change(change)) => {
            window.state_mut().change(change);
            None
        }
        other => other,
    };
    window.run_steps(2);
    effect
}

/// Returns the model of the roles.
fn fox(bench: &Workbench) -> Arc<LoadedModel> {
    match &bench.state.read().scene().expect("a scene").models["Fox.glb"] {
        SceneModel::Loaded(loaded) => Arc::clone(loaded),
        other => panic!("{other:?}"),
    }
}

/// Puts the pointer into the middle of the viewport, over a thing.
fn point_at(window: &mut Window, thing: &str) -> egui::Pos2 {
    window.run_steps(3);
    let middle = window.get_by_label("Viewport").rect().center();
    window.event(Event::PointerMoved(middle));
    window.run_steps(2);
    assert!(window.state_mut().state.set_pointed_thing(Some(thing.into())));
    middle
}

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
}

fn things(window: &Window) -> Vec<String> {
    window.state().state.read().scene_editing.things().iter().map(|id| id.to_string()).collect()
}

/// Gives an input to the tools of the viewport.
fn input(window: &mut Window, event: InputEvent) {
    let mut effects = Vec::new();
    window.state_mut().state.input(event, &mut effects);
    for effect in effects {
        if let Effect::Change(change) = effect {
            window.state_mut().change(change);
        }
    }
}

fn keys(window: &mut Window, keys: &[ToolKey]) {
    for &key in keys {
        input(window, InputEvent::KeyDown(key));
        input(window, InputEvent::KeyUp(key));
    }
    window.run_steps(2);
}

/// Returns where the viewport shows points, as shares of its size.
fn seen(bench: &Workbench, points: &[Vec3]) -> Vec<Vec2> {
    let panels = bench.state.read();
    let size = Vec2::new(panels.viewport.width(), panels.viewport.height());
    let view = GizmoView::new(&panels.camera, size);
    points
        .iter()
        .map(|point| view.to_screen(point.as_dvec3()).expect("in front of the camera").as_vec2() / size)
        .collect()
}

#[test]
fn an_opened_scene_is_framed_and_so_is_what_is_selected() {
    // Two foxes of about half a meter's length at one meter from the middle.
    let feet = [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)];
    let mut bench = scene(FOXES);
    let both = seen(&bench, &feet);
    assert!(both.iter().all(|at| at.min_element() > 0.0 && at.max_element() < 1.0), "{both:?}");
    assert!((both[1].x - both[0].x).abs() > 0.3, "{both:?}");
    let far = bench.state.read().camera.distance;
    bench.state.execute(Request::Scene(SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace)));
    bench.state.execute(Request::Command(Id::FrameSelected));
    let near = seen(&bench, &[Vec3::new(1.0, 0.35, 0.0)]);
    assert!((near[0] - 0.5).length() < 0.25, "{near:?} {:?}", bench.state.read().camera);
    assert!(bench.state.read().camera.distance < 0.7 * far);
    bench.state.execute(Request::Command(Id::FrameAll));
    assert!((bench.state.read().camera.distance / far - 1.0).abs() < 1e-3);
}

#[test]
fn a_click_selects_the_nearest_thing_and_the_next_one_there_the_one_behind() {
    let mut window = scene(FOXES).window();
    let hits: [Arc<str>; 2] = ["anna".into(), "ben".into()];
    let click = |window: &mut Window, x: f32, choice: Choice| {
        window.state_mut().state.thing_picked(pos2(x, 300.0), &hits, choice);
        things(window)
    };
    assert_eq!(click(&mut window, 300.0, Choice::Replace), ["anna"]);
    assert_eq!(click(&mut window, 301.0, Choice::Replace), ["ben"]);
    assert_eq!(click(&mut window, 300.0, Choice::Replace), ["anna"]);
    assert_eq!(click(&mut window, 400.0, Choice::Replace), ["anna"], "elsewhere it begins again");
    execute(&mut window, Request::Scene(SceneRequest::Lock(vec!["anna".into()], true)));
    assert_eq!(click(&mut window, 500.0, Choice::Replace), ["ben"], "a locked thing is not selected");
    execute(&mut window, Request::Scene(SceneRequest::Lock(vec!["anna".into()], false)));
    window.state_mut().state.things_caught(&hits, Choice::Replace);
    assert_eq!(things(&window), ["anna", "ben"]);
    window.state_mut().state.thing_picked(pos2(9.0, 9.0), &["sun".into()], Choice::Add);
    assert_eq!(things(&window), ["anna", "ben", "sun"]);
    window.state_mut().state.thing_picked(pos2(9.0, 9.0), &[], Choice::Replace);
    assert!(things(&window).is_empty(), "a click on nothing deselects");
}

#[test]
fn zero_looks_through_the_shot_and_orbiting_leaves_it() {
    let mut window = scene(FOXES).window();
    window.key_press(Key::Num0);
    window.run_steps(3);
    let camera = window.state().state.read().camera;
    assert!(camera.eye().distance(Vec3::new(0.0, 1.0, 5.0)) < 1e-3, "{camera:?}");
    let ahead = Vec3::new(0.0, -0.5, -5.0).normalize();
    assert!(camera.back().distance(-ahead) < 1e-3, "{camera:?}");
    assert!(window.query_by_label("Shown scene: scene.xml  ·  shot: wide").is_some());
    execute(&mut window, Request::Scene(SceneRequest::Through(ThroughCamera::Of("close".into()))));
    assert!(window.query_by_label("Shown scene: scene.xml  ·  close").is_some());
    let mut moved = window.state().state.read().camera;
    moved.orbit(0.3, 0.0);
    execute(&mut window, Request::Camera(moved));
    assert_eq!(*window.state().state.read().through, ThroughCamera::Free);
    assert_eq!(text(&window), FOXES, "the camera of the script stays");
    assert!(window.query_by_label("Shown scene: scene.xml").is_some());
}

#[test]
fn a_camera_that_is_attached_to_the_view_is_moved_in_the_script() {
    let mut window = scene(FOXES).window();
    execute(&mut window, Request::Scene(SceneRequest::Through(ThroughCamera::Of("wide".into()))));
    run(&mut window, Id::AttachCamera);
    let mut moved = window.state().state.read().camera;
    moved.target += Vec3::new(1.0, 0.25, 0.0);
    execute(&mut window, Request::Camera(moved));
    let line = r#"<camera id="wide"  at="1 1.25 5" look="1 0.75 0" lens="35mm"/>"#;
    assert_eq!(new_lines(FOXES, &text(&window)), [line]);
    assert_eq!(window.state().steps(), (1, 1));
    assert_eq!(*window.state().state.read().through, ThroughCamera::Of("wide".into()));
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn the_gizmo_moves_turns_and_scales_things_by_one_attribute_each() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::SpaceWorld);
    select(&mut window, &["ben"]);
    let letter = ToolKey::letter;
    let drags = [
        (Id::MoveNow, vec![letter('x'), letter('1'), ToolKey::Enter], "at=\"1 0 0\"", "at=\"2 0 0\""),
        (
            Id::RotateNow,
            vec![letter('y'), letter('9'), letter('0'), ToolKey::Enter],
            "facing=\"-90\"",
            "facing=\"0\"",
        ),
        (Id::ScaleNow, vec![letter('2'), ToolKey::Enter], "scale=\"0.01\"", "scale=\"0.02\""),
    ];
    for (id, typed, old, new) in drags {
        run(&mut window, id);
        keys(&mut window, &typed);
        let ben = r#"<role   id="ben"   model="Fox.glb" at="1 0 0" facing="-90" scale="0.01"/>"#;
        assert_eq!(new_lines(FOXES, &text(&window)), [ben.replace(old, new)], "{id:?}");
        assert_eq!(window.state().steps().0, 1, "{id:?}");
        window.state_mut().change(Change::Undo);
        window.run_steps(2);
        assert_eq!(text(&window), FOXES, "{id:?}");
    }
}

#[test]
fn a_cancelled_drag_of_a_thing_and_a_locked_thing_change_nothing() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::SpaceWorld);
    select(&mut window, &["ben"]);
    run(&mut window, Id::MoveNow);
    keys(&mut window, &[ToolKey::letter('x'), ToolKey::letter('3')]);
    assert_ne!(text(&window), FOXES, "the drag is shown before it ends");
    keys(&mut window, &[ToolKey::Escape]);
    assert_eq!(text(&window), FOXES);
    execute(&mut window, Request::Scene(SceneRequest::Lock(vec!["ben".into()], true)));
    run(&mut window, Id::MoveNow);
    keys(&mut window, &[ToolKey::letter('x'), ToolKey::letter('3'), ToolKey::Enter]);
    assert_eq!((text(&window).as_str(), window.state().steps().0), (FOXES, 0));
}

#[test]
fn the_model_of_a_thing_is_opened_in_place_and_the_scene_shown_again() {
    let mut bench = scene(FOXES);
    let sent = |effect: Option<Effect>| match effect {
        Some(Effect::File(FileAction::Send(message))) => message,
        other => panic!("{other:?}"),
    };
    let opened = bench.state.execute(Request::Scene(SceneRequest::EditModel("anna".into())));
    assert_eq!(sent(opened), DocumentMessage::EditModel("Fox.glb".to_owned()));
    assert_eq!(bench.state.execute(Request::Command(Id::BackToScene)), None, "the model is still being read");
    let model = View { waiting_scene: Some("scene.xml".into()), ..fixture::full() };
    bench.state.show(model);
    let around = bench.state.read().around.cloned().expect("the scene is around it");
    assert_eq!(around.left_out, [Arc::from("anna")], "it is not drawn twice");
    bench.state.execute(Request::Command(Id::ToggleAround));
    assert!(bench.state.read().around.is_none(), "it can be switched off");
    let back = bench.state.execute(Request::Command(Id::BackToScene));
    assert_eq!(sent(back), DocumentMessage::ShowScene);
}

#[test]
fn a_model_is_opened_at_the_time_and_the_place_that_it_has_in_the_scene_and_seen_from_the_same_side() {
    let mut bench = scene(FOXES);
    // In the midst of the second repetition of a clip that began half a second early.
    let bar = |bench: &Workbench| {
        let lanes = bench.state.read().scene_editing.lanes().clone();
        lanes.bar_of(6).expect("the run").1.clone()
    };
    let bar = bar(&bench);
    let (once, after) = (bar.once.seconds(), 0.25);
    let time = bar.begin.seconds() + once + after;
    bench.state.execute(Request::Seek(time as f32));
    let eye = bench.state.read().camera.eye();
    bench.state.execute(Request::Scene(SceneRequest::EditModel("anna".into())));
    let loaded = fox(&bench);
    let run = loaded.model.animation.takes.iter().position(|take| take.name == "Run").expect("a take");
    let model = View { waiting_scene: Some("scene.xml".into()), ..View::opened(5, loaded) };
    bench.state.show(model);
    let read = bench.state.read();
    assert_eq!(read.playback.take, Some(run), "the take that it plays there");
    assert!((f64::from(read.time()) - after).abs() < 1e-3, "{} s", read.time());
    assert!(!read.playback.playing);
    let around = read.around.expect("the scene is around it");
    assert!((around.time_of(Some(run), f64::from(read.time())) - time).abs() < 1e-3);
    // The role faces +x, and its model +z; the scene is a hundredth of its size.
    let ahead = around.model_from_scene.transform_vector3(glam::Vec3::X);
    assert!(ahead.distance(glam::Vec3::Z * 100.0) < 0.05, "{ahead}");
    let seen = around.model_from_scene.inverse().transform_point3(read.camera.eye());
    assert!(seen.distance(eye) < 0.05, "{seen}, not {eye}");
    // Another model, opened for itself, has nothing around it.
    bench.state.show(View { generation: 9, ..fixture::full() });
    assert!(bench.state.read().around.is_none());
}

#[test]
fn a_model_in_place_of_its_scene_differs_from_one_that_is_opened_itself() {
    let mut bench = scene(FOXES);
    let is_in_place = |bench: &Workbench, path: &str| bench.state.is_opened_in_place(Path::new(path));
    assert!(!is_in_place(&bench, "/scenes/Fox.glb"));
    bench.state.execute(Request::Scene(SceneRequest::EditModel("anna".into())));
    assert!(is_in_place(&bench, "/scenes/Fox.glb") && !is_in_place(&bench, "/scenes/scene.xml"));
    let file = FileView { path: Some("/scenes/Fox.glb".into()), ..FileView::default() };
    let model = View { waiting_scene: Some("scene.xml".into()), file: Arc::new(file), ..fixture::full() };
    bench.state.show(model);
    assert!(is_in_place(&bench, "/scenes/Fox.glb") && !is_in_place(&bench, "/models/Fox.glb"));
    bench.state.show(View { generation: 9, ..fixture::full() });
    assert!(!is_in_place(&bench, "/scenes/Fox.glb"));
}

#[test]
fn a_model_on_a_way_is_opened_with_the_take_for_walking_at_its_step() {
    let mut bench = scene(FOXES);
    let time = 1.5;
    bench.state.execute(Request::Seek(time));
    let plan = bench.state.read().scene().expect("a scene").plan.clone().expect("a plan");
    let ben = plan.thing_called("ben").expect("a role");
    let (_, after) = plan.take_at(ben, StageTime::from_seconds(f64::from(time))).expect("a take");
    assert!(after > StageTime::ZERO);
    bench.state.execute(Request::Scene(SceneRequest::EditModel("ben".into())));
    let loaded = fox(&bench);
    let walk = loaded.model.animation.takes.iter().position(|take| take.name == "Walk").expect("a take");
    bench.state.show(View { waiting_scene: Some("scene.xml".into()), ..View::opened(5, loaded) });
    let read = bench.state.read();
    assert_eq!(read.playback.take, Some(walk));
    assert!((f64::from(read.time()) - after.seconds()).abs() < 1e-3, "{} s, not {after:?}", read.time());
}

#[test]
fn a_right_click_in_the_viewport_opens_the_menu_of_the_thing_there() {
    let mut window = scene(FOXES).window();
    let middle = point_at(&mut window, "ben");
    for pressed in [true, false] {
        let button = PointerButton::Secondary;
        window.event(Event::PointerButton { pos: middle, button, pressed, modifiers: Modifiers::NONE });
        window.run_steps(2);
    }
    window.run_steps(2);
    let things = window.state().state.read().scene_editing.things().to_vec();
    assert_eq!(things, [Box::from("ben")]);
    let entry = window.get_by_label("Edit takes and bones").rect();
    assert!(entry.height() < 30.0 && entry.width() > 120.0, "its menu, on one line: {entry}");
}

#[test]
fn nothing_is_highlighted_any_more_when_the_pointer_has_left_the_viewport() {
    let mut window = scene(FOXES).window();
    point_at(&mut window, "ben");
    assert!(window.state().state.read().stage.hovered().is_some());
    window.event(Event::PointerMoved(egui::pos2(5.0, 5.0)));
    window.run_steps(2);
    assert!(window.state().state.read().stage.hovered().is_none());
}
