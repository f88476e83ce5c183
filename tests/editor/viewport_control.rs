//! The mouse over the picture.

use dragonfly::camera::Camera;
use dragonfly::control::{Button, Input, Outcome, ViewportControl};
use dragonfly_kit::random::{Random, seed};
use glam::Vec2;

const SIZE: Vec2 = Vec2::new(800.0, 600.0);

fn input(x: f32, y: f32) -> Input {
    Input { size: SIZE, pointer: Some(Vec2::new(x, y)), focused: true, ..Input::default() }
}

fn press(button: Button, x: f32, y: f32) -> Input {
    let mut down = [false; 3];
    down[button as usize] = true;
    Input { pressed: Some(button), down, ..input(x, y) }
}

fn held(button: Button, x: f32, y: f32) -> Input {
    Input { pressed: None, ..press(button, x, y) }
}

#[test]
fn a_click_picks_and_a_drag_does_not() {
    let (mut control, mut camera) = (ViewportControl::default(), Camera::default());
    assert_eq!(control.step(&press(Button::Left, 10.0, 20.0), &mut camera), None);
    assert_eq!(control.step(&input(11.0, 20.0), &mut camera), Some(Outcome::Pick(Vec2::new(11.0, 20.0))));
    control.step(&press(Button::Left, 10.0, 20.0), &mut camera);
    control.step(&held(Button::Left, 60.0, 20.0), &mut camera);
    assert_eq!(control.step(&input(60.0, 20.0), &mut camera), None);
    assert_eq!(camera, Camera::default(), "neither moves the eye");
}

#[test]
fn each_gesture_does_what_hands_expect() {
    let gestures = [
        (Button::Middle, false, false, "orbit"),
        (Button::Left, true, false, "orbit"),
        (Button::Middle, false, true, "pan"),
        (Button::Middle, true, false, "pan"),
        (Button::Right, true, false, "zoom"),
        (Button::Right, false, false, "nothing"),
    ];
    for (button, alt, shift, deed) in gestures {
        let (mut control, mut camera) = (ViewportControl::default(), Camera::default());
        let before = camera;
        control.step(&Input { alt, shift, ..press(button, 100.0, 100.0) }, &mut camera);
        control.step(&Input { alt, shift, ..held(button, 130.0, 160.0) }, &mut camera);
        let found = if camera.yaw != before.yaw && camera.target == before.target {
            "orbit"
        } else if camera.target != before.target && camera.distance == before.distance {
            "pan"
        } else if camera.distance != before.distance {
            "zoom"
        } else {
            "nothing"
        };
        assert_eq!(found, deed, "{button:?} alt {alt} shift {shift}");
    }
}

#[test]
fn losing_the_focus_ends_a_drag() {
    let (mut control, mut camera) = (ViewportControl::default(), Camera::default());
    control.step(&press(Button::Middle, 100.0, 100.0), &mut camera);
    control.step(&held(Button::Middle, 120.0, 100.0), &mut camera);
    assert!(control.is_dragging());
    control.step(&Input { focused: false, ..held(Button::Middle, 120.0, 100.0) }, &mut camera);
    let stands = camera;
    // The release was never heard of: the button still counts as held.
    control.step(&held(Button::Middle, 400.0, 300.0), &mut camera);
    assert_eq!(camera, stands);
    assert!(!control.is_dragging());
}

#[test]
fn escape_takes_a_drag_back() {
    let (mut control, mut camera) = (ViewportControl::default(), Camera::default());
    control.step(&press(Button::Middle, 100.0, 100.0), &mut camera);
    control.step(&held(Button::Middle, 300.0, 250.0), &mut camera);
    assert_ne!(camera, Camera::default());
    control.step(&Input { escape: true, ..held(Button::Middle, 300.0, 250.0) }, &mut camera);
    assert_eq!(camera, Camera::default());
}

#[test]
fn the_wheel_zooms_to_what_is_under_the_pointer() {
    let (mut control, mut camera) = (ViewportControl::default(), Camera::default());
    let before = camera;
    control.step(&Input { wheel: 50.0, ..input(400.0, 300.0) }, &mut camera);
    assert!(camera.distance < before.distance);
    assert!((camera.target - before.target).length() < 1e-5, "in the middle the target stays");
    control.step(&Input { wheel: 50.0, ..input(700.0, 300.0) }, &mut camera);
    assert!((camera.target - before.target).dot(before.right()) > 0.0);
}

#[test]
fn a_thousand_random_sequences_leave_nothing_stuck() {
    let seed = seed(11);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let odd = [f32::NAN, f32::INFINITY, -1e30, 0.0, 1e30];
    for _ in 0..1_000 {
        let (mut control, mut camera) = (ViewportControl::default(), Camera::default());
        for _ in 0..30 {
            let buttons = [Button::Left, Button::Middle, Button::Right];
            let mut place =
                || if random.below(20) == 0 { random.choice(&odd) } else { random.unit() * 800.0 };
            let pointer = Vec2::new(place(), place());
            control.step(
                &Input {
                    size: SIZE,
                    pointer: (random.below(8) > 0).then_some(pointer),
                    pressed: (random.below(4) == 0).then(|| buttons[random.below(3)]),
                    down: [random.below(2) == 0, random.below(2) == 0, random.below(2) == 0],
                    wheel: if random.below(4) == 0 { (random.unit() - 0.5) * 400.0 } else { 0.0 },
                    pinch: if random.below(8) == 0 { odd[random.below(5)] } else { 1.0 },
                    alt: random.below(2) == 0,
                    shift: random.below(2) == 0,
                    escape: random.below(10) == 0,
                    focused: random.below(10) > 0,
                },
                &mut camera,
            );
            let finite = camera.target.is_finite() && camera.distance.is_finite() && camera.yaw.is_finite();
            assert!(finite && camera.distance > 0.0, "{camera:?}");
        }
        // Everything let go: nothing drags.
        control.step(&input(1.0, 1.0), &mut camera);
        control.step(&input(2.0, 2.0), &mut camera);
        assert!(!control.is_dragging());
    }
}
