//! The second viewport of a scene in the window: its place, the line between the two, and when it is gone.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::{run, send};
use crate::workbench::{Window, drag, press, release};
use dragonfly::control::{Button, InputEvent, Modifiers as Held};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::View;
use dragonfly_document::bones::Choice;
use dragonfly_kit::document::fixture;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::camera::Camera;
use egui::{Modifiers, Pos2, Rect, vec2};
use egui_kittest::kittest::Queryable;
use glam::Vec2;

/// The entry of the free camera.
const FREE: &str = "Free camera";

fn places(window: &Window) -> (Rect, Option<Rect>) {
    let read = window.state().state.read();
    (read.viewport, read.second_view)
}

#[test]
fn the_second_viewport_is_next_to_the_first_and_a_drag_of_the_line_between_them_shares_the_width() {
    let mut window = scene(FOXES).window();
    let (whole, none) = places(&window);
    assert_eq!(none, None);
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(2);
    let (left, right) = places(&window);
    let right = right.expect("a second viewport");
    assert!(left.right() < right.left() && left.left() == whole.left() && right.right() == whole.right());
    assert!((left.width() - right.width()).abs() < 8.0, "{left} {right}");
    assert!(window.query_by_label("Second view, shot: wide").is_some());
    drag(&mut window, "Width of the second view", vec2(100.0, 0.0), Modifiers::NONE);
    window.run_steps(2);
    let (wider, narrower) = places(&window);
    assert!((wider.width() - left.width() - 100.0).abs() < 3.0, "{wider} {left}");
    assert!(narrower.is_some_and(|rect| (right.width() - rect.width() - 100.0).abs() < 3.0), "{narrower:?}");
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(2);
    assert_eq!(places(&window), (whole, None));
}

#[test]
fn a_model_has_no_second_viewport() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(2);
    assert!(places(&window).1.is_some());
    window.state_mut().state.show(fixture::full());
    window.run_steps(3);
    assert_eq!(places(&window).1, None);
}

/// A window with both views, and their places.
fn both() -> (Window, [Rect; 2]) {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(2);
    let (left, right) = places(&window);
    (window, [left, right.expect("a second viewport")])
}

fn point(window: &mut Window, at: Pos2) {
    send(window, InputEvent::MouseMove(Vec2::new(at.x, at.y)));
    window.run_steps(2);
}

/// Returns the camera of the active view, and through which one of the scene it looks.
fn active(window: &Window) -> (Camera, ThroughCamera) {
    let read = window.state().state.read();
    (read.camera, read.through.clone())
}

fn orbit(window: &mut Window, from: Pos2, by: f32) {
    point(window, from);
    let at = Vec2::new(from.x, from.y);
    send(window, InputEvent::Modifiers(Held { alt: true, ..Held::default() }));
    send(window, InputEvent::MouseDown(Button::Left));
    send(window, InputEvent::MouseMove(at + Vec2::new(by, 20.0)));
    send(window, InputEvent::MouseUp(Button::Left));
    send(window, InputEvent::Modifiers(Held::default()));
    window.run_steps(2);
}

#[test]
fn the_view_under_the_pointer_is_the_one_whose_camera_moves() {
    let (mut window, [left, right]) = both();
    point(&mut window, left.center());
    let (free, through) = active(&window);
    assert_eq!((places(&window), through), ((left, Some(right)), ThroughCamera::Free));
    point(&mut window, right.center());
    let (of_shot, through) = active(&window);
    assert_eq!((places(&window), through), ((right, Some(left)), ThroughCamera::Shot));
    assert_ne!(of_shot, free);
    // Orbiting leaves the camera of the shot, in this view alone.
    orbit(&mut window, right.center(), 60.0);
    let (moved, through) = active(&window);
    assert_eq!(through, ThroughCamera::Free);
    assert!(moved.eye().distance(of_shot.eye()) > 0.1, "{moved:?}");
    // The wheel zooms in it.
    window.event(egui::Event::PointerMoved(right.center()));
    window.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 60.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    // Until the wheel, which is smoothed, has come to rest.
    window.run_steps(60);
    let zoomed = active(&window).0;
    assert!(zoomed.distance < moved.distance, "{zoomed:?} {moved:?}");
    point(&mut window, left.center());
    assert_eq!(active(&window), (free, ThroughCamera::Free), "the first view is as it was");
    assert!(window.query_by_label("Second view, free camera").is_some());
    orbit(&mut window, left.center(), -30.0);
    assert_ne!(active(&window).0, free);
    point(&mut window, right.center());
    assert_eq!(active(&window).0, zoomed, "and so is the second one");
}

#[test]
fn clicks_and_commands_of_the_camera_are_for_the_view_under_the_pointer() {
    let (mut window, [left, right]) = both();
    point(&mut window, right.center());
    let mut effects = Vec::new();
    for event in [InputEvent::MouseDown(Button::Left), InputEvent::MouseUp(Button::Left)] {
        window.state_mut().state.input(event, &mut effects);
    }
    assert!(
        effects
            .iter()
            .any(|effect| matches!(effect, Effect::Pick(at, _) if at.distance(right.center()) < 1.0)),
        "{effects:?}"
    );
    run(&mut window, Id::LookFreely);
    let camera = active(&window).0;
    run(&mut window, Id::ViewFront);
    window.run_steps(2);
    assert_ne!(active(&window).0, camera);
    run(&mut window, Id::LookThroughShot);
    point(&mut window, left.center());
    assert_eq!(active(&window).1, ThroughCamera::Free);
    run(&mut window, Id::LookThroughShot);
    assert_eq!(active(&window).1, ThroughCamera::Shot);
    run(&mut window, Id::LookFreely);
    point(&mut window, right.center());
    assert_eq!(active(&window).1, ThroughCamera::Shot);
}

#[test]
fn a_drag_stays_in_its_view_and_one_view_alone_is_the_first_one() {
    let (mut window, [left, right]) = both();
    point(&mut window, left.center());
    let free = active(&window).0;
    let center = Vec2::new(left.center().x, left.center().y);
    send(&mut window, InputEvent::MouseDown(Button::Middle));
    send(&mut window, InputEvent::MouseMove(Vec2::new(right.center().x, center.y)));
    assert_eq!(places(&window), (left, Some(right)), "the button is held");
    let moved = active(&window).0;
    assert_ne!(moved, free);
    send(&mut window, InputEvent::MouseUp(Button::Middle));
    assert_eq!(places(&window), (right, Some(left)), "the pointer is there");
    run(&mut window, Id::ToggleSecondView);
    window.run_steps(3);
    let (whole, none) = places(&window);
    assert!(none.is_none() && whole.left() == left.left() && whole.right() == right.right());
    assert_eq!(active(&window), (moved, ThroughCamera::Free));
}

#[test]
fn a_drag_with_alt_that_ends_in_the_other_view_and_a_box_that_waits_belong_to_the_view_under_the_pointer() {
    let (mut window, [left, right]) = both();
    point(&mut window, left.center());
    let free = active(&window).0;
    let at = Vec2::new(left.center().x, left.center().y);
    send(&mut window, InputEvent::Modifiers(Held { alt: true, ..Held::default() }));
    send(&mut window, InputEvent::MouseDown(Button::Left));
    send(&mut window, InputEvent::MouseMove(Vec2::new(right.center().x, at.y)));
    send(&mut window, InputEvent::MouseUp(Button::Left));
    send(&mut window, InputEvent::Modifiers(Held::default()));
    let (of_shot, through) = active(&window);
    assert_eq!((places(&window), through), ((right, Some(left)), ThroughCamera::Shot));
    // The drag has moved the camera of the view in which it began.
    let other = window.state().state.read().other_camera;
    assert!(other.eye().distance(free.eye()) > 0.1 && of_shot != free, "{other:?} {free:?}");
    // The text about a box is in the view under the pointer, and the box is drawn there.
    run(&mut window, Id::BoxSelect);
    for rect in [right, left, right] {
        point(&mut window, rect.center());
        let hint = window.get_by_label_contains("Drag a box over bones").rect();
        assert!(rect.contains_rect(hint), "{hint} in {rect}");
    }
    let mut effects = Vec::new();
    let from = Vec2::new(right.center().x, right.center().y);
    for event in [
        InputEvent::MouseDown(Button::Left),
        InputEvent::MouseMove(from + Vec2::splat(40.0)),
        InputEvent::MouseUp(Button::Left),
    ] {
        window.state_mut().state.input(event, &mut effects);
    }
    assert!(effects.iter().any(|effect| matches!(effect, Effect::Catch(..))), "{effects:?}");
}

#[test]
fn a_second_view_keeps_its_camera_while_a_model_of_the_scene_is_edited_and_begins_anew_in_another_scene() {
    let (mut window, [left, right]) = both();
    point(&mut window, right.center());
    orbit(&mut window, right.center(), 60.0);
    let of_second = active(&window).0;
    let scene_view = window.state().state.read().view.expect("a scene").clone();
    window.state_mut().state.show(fixture::full());
    window.run_steps(3);
    window.state_mut().state.show(scene_view);
    window.run_steps(3);
    let (_, right) = places(&window);
    point(&mut window, right.expect("a second view").center());
    assert_eq!(active(&window), (of_second, ThroughCamera::Free));
    // Through a camera that another scene does not have.
    let close = SceneRequest::SelectThings(vec!["close".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(close));
    run(&mut window, Id::LookThroughSelected);
    assert_eq!(active(&window).1, ThroughCamera::Of("close".into()));
    point(&mut window, left.center());
    let other = scene(&FOXES.replace("close", "near")).state.read().view.expect("a scene").clone();
    window.state_mut().state.show(View { file: fixture::full().file, ..other });
    window.run_steps(3);
    assert_eq!(*window.state().state.read().other_through, ThroughCamera::Shot);
    let second = places(&window).1.expect("a second view");
    point(&mut window, second.center());
    assert!(window.state().state.read().is_second_active, "it is worked in");
}

#[test]
fn each_of_two_views_has_the_name_of_its_camera_and_the_second_one_a_choice() {
    let (mut window, [left, right]) = both();
    let title = window.get_by_label("Shown scene: Free camera").rect();
    assert!(left.contains_rect(title) && title.width() > 60.0, "it is not cut: {title}");
    let choice = window.get_by_label("Camera of the second view: shot: wide").rect();
    assert!(right.contains_rect(choice), "{choice} in {right}");
    for (entry, name) in [("close", "Second view, close"), (FREE, "Second view, free camera")] {
        let at = window.get_by_label_contains("Camera of the second view: ").rect().center();
        press(&mut window, at);
        release(&mut window, at);
        window.run_steps(3);
        let list =
            window.get_all_by_label(entry).map(|node| node.rect()).filter(|rect| rect.left() >= right.left());
        let at = list.max_by(|one, other| one.top().total_cmp(&other.top())).expect(entry).center();
        press(&mut window, at);
        release(&mut window, at);
        window.run_steps(3);
        assert!(window.query_by_label(name).is_some(), "{name}");
    }
}
