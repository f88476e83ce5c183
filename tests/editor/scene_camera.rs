//! Cameras of a scene in the viewport: the wheel and the mouse move an attached one, and framing leaves it.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::{Window, Workbench};
use dragonfly::control::{Button, InputEvent};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::{SceneRequest, ScriptChange};
use dragonfly::panels::{Effect, Request};
use dragonfly_document::Change;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::gizmo::GizmoView;
use glam::{Vec2, Vec3};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Opens the scene and attaches the camera `wide` to the view.
fn attached() -> Window {
    let mut window = scene(FOXES).window();
    let through = SceneRequest::Through(ThroughCamera::Of("wide".into()));
    window.state_mut().state.execute(Request::Scene(through));
    window.state_mut().state.execute(Request::Command(Id::AttachCamera));
    window.run_steps(2);
    window
}

/// Begins a frame at a time, gives requests to it, and ends it as the window does: no button is held. Returns what goes to the document.
fn frame(bench: &mut Workbench, now: Instant, requests: Vec<Request>) -> Vec<(u64, Change)> {
    bench.state.begin_frame(now);
    let mut effects: Vec<Effect> =
        requests.into_iter().filter_map(|request| bench.state.execute(request)).collect();
    if bench.state.read().dragging.is_open() {
        effects.push(Effect::ReleaseDrag);
    }
    let mut sent = Vec::new();
    for effect in effects {
        bench.state.let_through(effect, &mut |effect| match effect {
            Effect::Send(number, change) => sent.push((number, change)),
            other => panic!("{other:?}"),
        });
    }
    sent
}

fn answer(bench: &mut Workbench, sent: Vec<(u64, Change)>) {
    for (number, change) in sent {
        bench.answer(number, change);
    }
}

fn input(window: &mut Window, event: InputEvent) {
    let mut effects = Vec::new();
    window.state_mut().state.input(event, &mut effects);
    for effect in effects {
        if let Effect::Change(change) = effect {
            window.state_mut().change(change);
        }
    }
}

/// Returns the middle of the viewport.
fn middle(window: &Window) -> Vec2 {
    let at = window.state().state.read().viewport.center();
    Vec2::new(at.x, at.y)
}

#[test]
fn turns_of_the_wheel_are_one_step_until_there_is_a_pause() {
    let mut window = attached();
    let at = middle(&window);
    input(&mut window, InputEvent::MouseMove(at));
    let bench = window.state_mut();
    let start = bench.state.read().now;
    let at = |milliseconds: u64| start + Duration::from_millis(milliseconds);
    // The document answers after all of them.
    let sent: Vec<_> =
        (1..=6).flat_map(|turn| frame(bench, at(16 * turn), vec![Request::Wheel(12.0)])).collect();
    assert_eq!(sent.len(), 6, "{sent:?}");
    assert!(sent.iter().all(|(_, change)| matches!(change, Change::Edit(_, Some(_)))), "{sent:?}");
    let read = bench.state.read();
    assert!(read.is_camera_attached && *read.through == ThroughCamera::Of("wide".into()));
    assert!(read.takes_shortcuts(), "keys run commands");
    assert!(bench.state.next_display().is_some_and(|left| left <= Duration::from_secs(1)));
    answer(bench, sent);
    assert_eq!(bench.steps(), (1, 1));
    assert_eq!(frame(bench, at(300), Vec::new()), [], "another turn may follow");
    let ended = frame(bench, at(900), Vec::new());
    assert!(matches!(ended[..], [(_, Change::Release(_))]), "{ended:?}");
    answer(bench, ended);
    let first = text(&window);
    let bench = window.state_mut();
    let sent = frame(bench, at(1000), vec![Request::Wheel(12.0)]);
    answer(bench, sent);
    assert_eq!(bench.steps(), (2, 2));
    assert_ne!(text(&window), first);
    let line = new_lines(FOXES, &text(&window));
    assert_eq!(line.len(), 1, "{line:?}");
    assert!(line[0].contains("id=\"wide\"") && !line[0].contains("at=\"0 1 5\""), "{line:?}");
    // Something else ends the step and keeps it.
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), first, "the second step was kept, so that it is undone alone");
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_camera_stays_attached_while_the_document_has_not_answered() {
    let mut window = attached();
    let at = middle(&window);
    input(&mut window, InputEvent::MouseMove(at));
    let bench = window.state_mut();
    let now = bench.state.read().now;
    let typed = ScriptChange {
        from: FOXES.into(),
        text: FOXES.replace("The End", "Fin"),
        also: Vec::new(),
        label: ScriptLabel::Type,
        gesture: None,
        things: Arc::default(),
    };
    let sent = frame(bench, now, vec![Request::Scene(SceneRequest::Text(typed))]);
    let late = frame(bench, now, vec![Request::Wheel(12.0)]);
    let read = bench.state.read();
    assert!(read.is_camera_attached && *read.through == ThroughCamera::Of("wide".into()));
    answer(bench, sent);
    answer(bench, late);
    let sent = frame(bench, now, vec![Request::Wheel(12.0)]);
    answer(bench, sent);
    assert_eq!(new_lines(FOXES, &text(&window)).len(), 2, "the title and the camera");
}

#[test]
fn a_camera_that_nothing_was_written_of_is_released_too() {
    let mut window = attached();
    let camera = window.state().state.read().camera;
    let bench = window.state_mut();
    let now = bench.state.read().now;
    // Less than a millimeter, which the script does not have.
    let mut moved = camera;
    moved.target.x += 1e-5;
    assert_eq!(frame(bench, now, vec![Request::Camera(moved)]), []);
    frame(bench, now + Duration::from_secs(1), Vec::new());
    assert_eq!(bench.state.next_display(), None, "nothing is waited for");
    assert!(bench.state.read().camera.target.distance(camera.target) < 1e-6, "it is where the script has it");
}

#[test]
fn a_cancelled_drag_of_a_camera_is_over_and_the_next_one_counts() {
    let mut window = attached();
    let at = middle(&window);
    let by = Vec2::new(40.0, 10.0);
    input(&mut window, InputEvent::MouseMove(at));
    input(&mut window, InputEvent::MouseDown(Button::Middle));
    input(&mut window, InputEvent::MouseMove(at + by));
    assert_ne!(text(&window), FOXES, "a drag is shown before it ends");
    let mut sent = Vec::new();
    let bench = window.state_mut();
    bench.state.let_through(Effect::CancelDrag, &mut |effect| sent.push(effect));
    for effect in sent {
        if let Effect::Send(number, change) = effect {
            bench.answer(number, change);
        }
    }
    assert_eq!(text(&window), FOXES);
    input(&mut window, InputEvent::MouseMove(at + 2.0 * by));
    assert_eq!(text(&window), FOXES, "the drag is over");
    input(&mut window, InputEvent::MouseUp(Button::Middle));
    input(&mut window, InputEvent::MouseMove(at));
    input(&mut window, InputEvent::MouseDown(Button::Middle));
    input(&mut window, InputEvent::MouseMove(at + by));
    input(&mut window, InputEvent::MouseUp(Button::Middle));
    assert_eq!(new_lines(FOXES, &text(&window)).len(), 1);
    assert_eq!(window.state().steps(), (1, 1));
}

#[test]
fn a_text_that_comes_after_its_drag_was_cancelled_is_not_shown() {
    let mut window = scene(FOXES).window();
    let gesture = window.state().state.read().new_gesture();
    let moved = |to: &str| {
        let text = FOXES.replace("at=\"0.6 0 0.8\"", &format!("at=\"{to}\""));
        let change = ScriptChange {
            from: FOXES.into(),
            text,
            also: Vec::new(),
            label: ScriptLabel::MoveThing,
            gesture: Some(gesture),
            things: Arc::default(),
        };
        Request::Scene(SceneRequest::Text(change))
    };
    let change = |window: &mut Window, request: Request| {
        let Some(Effect::Change(change)) = window.state_mut().state.execute(request) else {
            panic!("no change")
        };
        window.state_mut().change(change);
    };
    change(&mut window, moved("1 0 1"));
    let mut sent = Vec::new();
    let bench = window.state_mut();
    bench.state.let_through(Effect::CancelDrag, &mut |effect| sent.push(effect));
    for effect in sent {
        if let Effect::Send(number, change) = effect {
            bench.answer(number, change);
        }
    }
    change(&mut window, moved("2 0 2"));
    assert_eq!(text(&window), FOXES);
    let read = window.state().state.read();
    let scene = read.scene().expect("a scene");
    assert_eq!(**read.scene_editing.text(scene), *FOXES, "the panels show what the document has");
    change(&mut window, Request::Command(Id::AddMark));
    assert_eq!(new_lines(FOXES, &text(&window)).len(), 1, "gestures work at once");
}

#[test]
fn framing_leaves_the_camera_of_the_scene_and_shows_everything() {
    let mut window = scene(FOXES).window();
    window
        .state_mut()
        .state
        .execute(Request::Scene(SceneRequest::Through(ThroughCamera::Of("close".into()))));
    window.run_steps(2);
    window.state_mut().state.execute(Request::Command(Id::FrameAll));
    window.run_steps(2);
    let read = window.state().state.read();
    assert_eq!(*read.through, ThroughCamera::Free);
    let size = Vec2::new(read.viewport.width(), read.viewport.height());
    let view = GizmoView::new(&read.camera, size);
    for foot in [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)] {
        let at = view.to_screen(foot.as_dvec3()).expect("in front of the camera").as_vec2() / size;
        assert!(at.min_element() > 0.0 && at.max_element() < 1.0, "{foot} is at {at}");
    }
    assert_eq!(text(&window), FOXES);
}
