//! The focus of a camera that is picked in the viewport, cameras that follow what they look at, and cameras on paths.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_lines::{at, run, send};
use crate::workbench::Window;
use dragonfly::control::{Button, InputEvent, Key, Modifiers};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_picture::ThroughCamera;
use glam::{DVec3, Vec3};

const FLANK: DVec3 = DVec3::new(-1.0, 0.45, 0.0);

fn execute(window: &mut Window, request: Request) {
    if let Some(Effect::Change(change)) = window.state_mut().state.execute(request) {
        window.state_mut().change(change);
    }
    window.run_steps(2);
}

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
}

fn click(window: &mut Window, place: DVec3) {
    let pointer = at(window, place);
    send(window, InputEvent::MouseMove(pointer));
    send(window, InputEvent::MouseDown(Button::Left));
    send(window, InputEvent::MouseUp(Button::Left));
}

fn said(window: &Window, part: &str) -> bool {
    window.state().state.read().status.lines().any(|message| message.text.contains(part))
}

#[test]
fn a_click_on_a_bone_sets_the_focus_and_with_shift_or_on_the_ground_its_distance() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::PickFocus);
    assert!(said(&window, "Look through a camera, or select one"));
    select(&mut window, &["wide"]);
    run(&mut window, Id::PickFocus);
    click(&mut window, FLANK);
    let new = new_lines(FOXES, &text(&window));
    assert!(
        new.len() == 1 && new[0].contains("id=\"wide\"") && new[0].contains("focus=\"anna.b_"),
        "{new:?}"
    );
    assert_eq!(
        window.state().state.read().scene_editing.things(),
        [Box::from("wide")],
        "nothing else is selected"
    );
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    run(&mut window, Id::PickFocus);
    send(&mut window, InputEvent::Modifiers(Modifiers { shift: true, ..Modifiers::default() }));
    click(&mut window, FLANK);
    send(&mut window, InputEvent::Modifiers(Modifiers::default()));
    let focus = |window: &Window| -> f64 {
        let new = new_lines(FOXES, &text(window));
        let value = new[0].split("focus=\"").nth(1).and_then(|rest| rest.split('"').next());
        value.expect("a focus").parse().expect("a distance")
    };
    // The camera is five meters in front of the foxes.
    assert!((4.5..5.1).contains(&focus(&window)), "{}", focus(&window));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    run(&mut window, Id::PickFocus);
    let place = DVec3::new(0.0, 0.0, 1.5);
    click(&mut window, place);
    let ahead = DVec3::new(0.0, -0.5, -5.0).normalize();
    let wanted = (place - DVec3::new(0.0, 1.0, 5.0)).dot(ahead);
    assert!((focus(&window) - wanted).abs() < 0.05, "{} {wanted}", focus(&window));
}

#[test]
fn escape_gives_up_picking_the_focus() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["wide"]);
    run(&mut window, Id::PickFocus);
    assert!(window.state().state.read().stage.focused_camera().is_some());
    send(&mut window, InputEvent::KeyDown(Key::Escape));
    assert!(window.state().state.read().stage.focused_camera().is_none());
    click(&mut window, FLANK);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_camera_that_looks_at_a_thing_still_does_after_it_was_orbited() {
    let mut window = scene(FOXES).window();
    execute(&mut window, Request::Scene(SceneRequest::Through(ThroughCamera::Of("close".into()))));
    run(&mut window, Id::AttachCamera);
    let camera = window.state().state.read().camera;
    // The view turns about what the camera looks at: ben, at 1 0 0.
    assert!(camera.target.distance(Vec3::X) < 1e-3, "{camera:?}");
    let mut moved = camera;
    moved.orbit(0.4, 0.1);
    execute(&mut window, Request::Camera(moved));
    let new = new_lines(FOXES, &text(&window));
    assert!(new.len() == 1 && new[0].contains("look=\"ben\""), "{new:?}");
    let now = window.state().state.read().camera;
    assert!(now.eye().distance(moved.eye()) < 2e-3, "{now:?} {moved:?}");
    assert!(now.back().distance(moved.back()) < 2e-3, "it looks at the same point");
    assert!((now.eye().distance(Vec3::X) - camera.eye().distance(Vec3::X)).abs() < 2e-3, "as far away");
    run(&mut window, Id::LookFreely);
    select(&mut window, &["close"]);
    let before = text(&window);
    run(&mut window, Id::RotateNow);
    for key in [Key::letter('y'), Key::letter('9'), Key::Enter] {
        send(&mut window, InputEvent::KeyDown(key));
        send(&mut window, InputEvent::KeyUp(key));
    }
    assert_eq!(text(&window), before);
    assert!(said(&window, "close looks at ben: remove its `look` to turn it"));
}

#[test]
fn a_camera_follows_the_selected_path() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["close", "aisle"]);
    window.state_mut().state.execute(Request::Seek(2.0));
    run(&mut window, Id::WalkAlong);
    let line = r#"<move who="close" path="aisle" speed="1" turn="keep" begin="2"/>"#;
    assert_eq!(new_lines(FOXES, &text(&window)), [line]);
    let read = window.state().state.read();
    assert!(read.scene().expect("a scene").errors.is_empty(), "the way has a length");
}
