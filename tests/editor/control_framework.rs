//! Every input reaches the control it is meant for, whatever the controls do while it is delivered.

use crate::control_probe::{Owner, PressAction, ProbeEvent};
use dragonfly::control::{
    Area, BaseControl, Button, ControlFramework, ControlId, InputEvent, Key, PlaceError,
};
use dragonfly_kit::counting;
use glam::Vec2;

fn area(x: f32, y: f32, width: f32, height: f32) -> Area {
    Area::new(Vec2::new(x, y), Vec2::new(x + width, y + height))
}

fn to(x: f32, y: f32) -> InputEvent {
    InputEvent::MouseMove(Vec2::new(x, y))
}

const A: Key = Key::Letter('a');
const LEFT: Button = Button::Left;

/// Creates a window with a viewport, a tool inside the viewport, and a panel next to it.
fn window() -> (ControlFramework, Owner, [ControlId; 3]) {
    let (mut framework, mut owner) = (ControlFramework::new(Vec2::new(800.0, 600.0)), Owner::default());
    // The inner one first: the order of registration does not matter.
    let tool = owner.add(&mut framework, area(100.0, 100.0, 50.0, 50.0));
    let picture = owner.add(&mut framework, area(0.0, 0.0, 600.0, 600.0));
    let panel = owner.add(&mut framework, area(600.0, 0.0, 200.0, 600.0));
    (framework, owner, [picture, tool, panel])
}

#[test]
fn a_control_is_the_parent_of_all_controls_entirely_inside_it() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    assert_eq!(framework.parent(tool), Some(picture));
    assert_eq!(framework.parent(picture), Some(ControlId::ROOT));
    assert_eq!(framework.parent(panel), Some(ControlId::ROOT));
    assert_eq!(framework.parent(ControlId::ROOT), None);
    // As large as the picture and registered later, so it becomes the parent of the tool and a child of the picture.
    let between = owner.add(&mut framework, area(0.0, 0.0, 600.0, 600.0));
    assert_eq!(framework.parent(tool), Some(between));
    assert_eq!(framework.parent(between), Some(picture));
    assert!(framework.is_inside(tool, picture) && !framework.is_inside(picture, tool));
    // When it is unregistered, its children get its parent, and its identifier is no longer valid.
    assert!(framework.unregister_control(between));
    assert!(!framework.unregister_control(between));
    assert_eq!(framework.parent(tool), Some(picture));
    // The tool is moved, so that it is no longer inside the picture.
    assert!(framework.move_control(tool, area(590.0, 0.0, 50.0, 50.0)));
    assert_eq!(framework.parent(tool), Some(ControlId::ROOT));
    assert!(!framework.unregister_control(ControlId::ROOT));
}

#[test]
fn a_child_control_must_lie_inside_its_parent_control() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    let inside = owner.get(picture).register_control(picture, area(10.0, 10.0, 5.0, 5.0), &mut framework);
    assert_eq!(framework.parent(inside.unwrap()), Some(picture));
    let outside = owner.get(tool).register_control(tool, area(10.0, 10.0, 5.0, 5.0), &mut framework);
    assert_eq!(outside, Err(PlaceError::NotInside));
    assert!(!owner.get(panel).unregister_control(panel, tool, &mut framework), "not its own");
    assert!(owner.get(picture).unregister_control(picture, tool, &mut framework));
    assert_eq!(framework.register_inside(tool, area(0.0, 0.0, 1.0, 1.0)), Err(PlaceError::NoParent));
}

#[test]
fn mouse_events_go_to_the_deepest_control_and_bubble_while_passed_on() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    owner.get(tool).passes = true;
    assert_eq!(framework.resolve_input(to(120.0, 120.0), &mut owner), Some(picture));
    assert_eq!(owner.take_events(tool), [ProbeEvent::Enter, ProbeEvent::Move]);
    assert_eq!(owner.take_events(picture), [ProbeEvent::Move]);
    owner.get(tool).passes = false;
    assert_eq!(framework.resolve_input(InputEvent::Wheel(Vec2::Y), &mut owner), Some(tool));
    assert_eq!((owner.take_events(tool), owner.take_events(picture)), (vec![ProbeEvent::Wheel], vec![]));
    framework.resolve_input(to(700.0, 50.0), &mut owner);
    assert_eq!(owner.take_events(tool), [ProbeEvent::Leave]);
    assert_eq!(owner.take_events(panel), [ProbeEvent::Enter, ProbeEvent::Move]);
    assert_eq!(owner.take_events(picture), []);
    // A round control is hit only on its disc.
    owner.get(tool).circle = Some((Vec2::new(125.0, 125.0), 10.0));
    assert_eq!(framework.resolve_input(to(101.0, 101.0), &mut owner), Some(picture));
    assert_eq!(framework.resolve_input(to(900.0, 50.0), &mut owner), None, "outside of the window");
    framework.resize(Vec2::new(50.0, 50.0));
    assert_eq!(framework.resolve_input(to(700.0, 50.0), &mut owner), None, "the window is smaller");
}

#[test]
fn a_held_button_captures_the_mouse_for_the_pressed_control() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(to(700.0, 50.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(Button::Right), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    framework.resolve_input(to(-50.0, 50.0), &mut owner);
    assert_eq!(framework.captured(), Some(tool));
    framework.resolve_input(InputEvent::MouseUp(Button::Right), &mut owner);
    use ProbeEvent::{Down, Enter, Leave, Move, Up};
    let right = Button::Right;
    let expected = [Enter, Move, Down(LEFT), Move, Down(right), Up(LEFT), Move, Up(right), Leave];
    assert_eq!(owner.take_events(tool), expected);
    assert_eq!(framework.captured(), None);
    assert_eq!((owner.take_events(panel), owner.take_events(picture)), (vec![], vec![]));
    // A press that began outside the window has no owner, even after the pointer enters the window.
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(owner.take_events(tool), [Enter], "after the release");
}

#[test]
fn keys_go_to_the_focus_or_the_hovered_control_and_are_released_there() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    framework.resolve_input(to(300.0, 300.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    framework.set_focus(panel);
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    framework.resolve_input(InputEvent::KeyDown(Key::Enter), &mut owner);
    framework.resolve_input(InputEvent::KeyUp(A), &mut owner);
    assert_eq!(
        owner.take_events(picture),
        [ProbeEvent::KeyDown(A, false), ProbeEvent::KeyDown(A, true), ProbeEvent::KeyUp(A)]
    );
    assert_eq!(owner.take_events(panel), [ProbeEvent::Focus, ProbeEvent::KeyDown(Key::Enter, false)]);
    framework.null_focus();
    framework.update(&mut owner);
    framework.resolve_input(InputEvent::KeyUp(Key::Enter), &mut owner);
    framework.resolve_input(InputEvent::KeyUp(Key::Enter), &mut owner);
    assert_eq!(owner.take_events(panel), [ProbeEvent::NoFocus, ProbeEvent::KeyUp(Key::Enter)]);
    // A control may pass key events on to its parent, as it may mouse events.
    owner.get(tool).passes = true;
    framework.set_focus(tool);
    assert_eq!(framework.resolve_input(InputEvent::KeyDown(A), &mut owner), Some(picture));
}

#[test]
fn keys_go_to_the_dragged_control_regardless_of_mouse_and_focus() {
    let (mut framework, mut owner, [_, tool, panel]) = window();
    framework.set_focus(panel);
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(to(700.0, 50.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::KeyDown(Key::Escape), &mut owner);
    assert_eq!(
        (owner.take_events(tool), owner.take_events(panel)),
        (vec![ProbeEvent::KeyDown(Key::Escape, false)], vec![])
    );
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    assert_eq!(owner.take_events(panel).last(), Some(&ProbeEvent::KeyDown(A, false)));
}

#[test]
fn lost_input_cancels_the_capture_and_releases_every_key() {
    let (mut framework, mut owner, [picture, tool, panel]) = window();
    owner.get(tool).passes = true;
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::Lost, &mut owner);
    assert_eq!(owner.take_events(tool), [ProbeEvent::Lost, ProbeEvent::KeyUp(A), ProbeEvent::Leave]);
    assert_eq!(
        owner.take_events(picture),
        [ProbeEvent::Lost, ProbeEvent::KeyUp(A)],
        "the press was passed on to it"
    );
    assert_eq!(owner.take_events(panel), []);
    assert_eq!(framework.captured(), None);
    // A release after the loss of input has no effect.
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    framework.resolve_input(InputEvent::KeyUp(A), &mut owner);
    assert_eq!(owner.take_events(tool), []);
    // A second press without a release in between: the first was lost.
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    use ProbeEvent::{Down, Enter, Lost, Move};
    assert_eq!(owner.take_events(tool), [Enter, Move, Down(LEFT), Lost, Down(LEFT)]);
}

#[test]
fn controls_can_be_added_and_removed_during_an_input() {
    let (mut framework, mut owner, [picture, tool, _]) = window();
    owner.get(tool).passes = true;
    owner.get(tool).on_press = PressAction::UnregisterSelf;
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    assert_eq!(framework.captured(), Some(picture), "the press goes on to the parent, which keeps the mouse");
    framework.resolve_input(to(700.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(owner.take_events(picture), [ProbeEvent::Down(LEFT), ProbeEvent::Move, ProbeEvent::Up(LEFT)]);
    assert_eq!(owner.take_events(tool), [ProbeEvent::Down(LEFT)]);

    let (mut framework, mut owner, [picture, tool, _]) = window();
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.unregister_control(tool);
    framework.resolve_input(to(130.0, 120.0), &mut owner);
    assert_eq!(owner.take_events(picture), [], "no control gets the mouse of a control that is gone");
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(owner.take_events(picture), [ProbeEvent::Enter]);

    let (mut framework, mut owner, [picture, tool, _]) = window();
    owner.get(tool).passes = true;
    owner.get(tool).on_press = PressAction::Unregister(picture);
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    owner.forget();
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    assert_eq!(owner.take_events(picture), [], "it is unregistered, although its owner still has it");

    let (mut framework, mut owner, [_, tool, panel]) = window();
    owner.get(tool).on_press = PressAction::Register(area(110.0, 110.0, 20.0, 20.0));
    framework.resolve_input(to(120.0, 120.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    assert_eq!(framework.hovered(), Some(tool), "a control that its owner does not have is not hit");
    owner.get(tool).on_press = PressAction::Focus(panel);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    assert_eq!(owner.take_events(panel), [ProbeEvent::Focus]);
}

#[test]
fn two_controls_that_take_the_focus_from_each_other_do_not_loop() {
    let (mut framework, mut owner, [picture, _, panel]) = window();
    owner.get(picture).greedy = true;
    owner.get(panel).greedy = true;
    framework.set_focus(picture);
    framework.update(&mut owner);
    framework.set_focus(panel);
    framework.update(&mut owner);
    framework.update(&mut owner);
    owner.forget();
    framework.update(&mut owner);
    assert!(owner.probes.iter().all(|probe| probe.events.is_empty()));
}

#[test]
fn handling_an_input_allocates_nothing() {
    let (mut framework, mut owner, [_, tool, panel]) = window();
    owner.get(tool).passes = true;
    let events = [to(120.0, 120.0), InputEvent::MouseDown(LEFT), to(300.0, 10.0), InputEvent::MouseUp(LEFT)];
    let keys = [InputEvent::KeyDown(A), InputEvent::KeyUp(A), InputEvent::Wheel(Vec2::Y), InputEvent::Lost];
    let (count, ()) = counting::count(|| {
        for event in events.into_iter().chain(keys) {
            framework.resolve_input(event, &mut owner);
            framework.set_focus(panel);
        }
    });
    assert_eq!(count.allocations, 0, "{count:?}");
}

#[test]
fn a_control_that_grabs_the_input_receives_all_of_it_until_it_releases_it() {
    let (mut framework, mut owner, [picture, tool, _]) = window();
    framework.grab(tool);
    assert_eq!(framework.resolve_input(to(700.0, 50.0), &mut owner), Some(tool));
    framework.resolve_input(InputEvent::KeyDown(A), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::MouseUp(LEFT), &mut owner);
    framework.resolve_input(InputEvent::KeyUp(A), &mut owner);
    use ProbeEvent::{Down, Enter, KeyDown, KeyUp, Leave, Lost, Move, Up};
    let told = [Enter, Move, KeyDown(A, false), Down(LEFT), Up(LEFT), KeyUp(A)];
    assert_eq!(owner.take_events(tool), told);
    framework.release();
    framework.resolve_input(to(300.0, 300.0), &mut owner);
    assert_eq!((owner.take_events(tool), owner.take_events(picture)), (vec![Leave], vec![Enter, Move]));
    framework.grab(tool);
    framework.update(&mut owner);
    framework.resolve_input(InputEvent::Lost, &mut owner);
    assert_eq!(owner.take_events(tool), [Enter, Lost, Leave]);
    framework.grab(tool);
    framework.resolve_input(to(700.0, 50.0), &mut owner);
    framework.resolve_input(InputEvent::MouseDown(LEFT), &mut owner);
    framework.resolve_input(InputEvent::Lost, &mut owner);
    assert_eq!(owner.take_events(tool), [Enter, Move, Down(LEFT), Lost, Leave], "one event only");
    framework.grab(tool);
    framework.unregister_control(tool);
    assert_eq!(framework.captured(), None);
}
