//! Mouse input over the viewport.

use dragonfly::control::{
    Area, BaseControl, Button, Catch, ControlFramework, ControlId, ControlLookup, InputEvent, Key, Modifiers,
    ViewportControl, ViewportOutcome,
};
use dragonfly_document::bones::Choice;
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::OwnedRegion;
use glam::Vec2;

const CORNER: Vec2 = Vec2::new(100.0, 50.0);
const SIZE: Vec2 = Vec2::new(800.0, 600.0);
const ALT: Modifiers = Modifiers { shift: false, ctrl: false, alt: true };
const SHIFT: Modifiers = Modifiers { shift: true, ctrl: false, alt: false };
const CTRL: Modifiers = Modifiers { shift: false, ctrl: true, alt: false };
const NONE: Modifiers = Modifiers { shift: false, ctrl: false, alt: false };

/// A viewport in a window.
struct Picture {
    framework: ControlFramework,
    owner: Owner,
}

struct Owner(ControlId, ViewportControl);

impl ControlLookup for Owner {
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl> {
        (id == self.0).then_some(&mut self.1 as _)
    }
}

impl Picture {
    fn new() -> Self {
        let mut framework = ControlFramework::new(Vec2::new(1200.0, 700.0));
        let id = framework.register_control(Area::new(CORNER, CORNER + SIZE));
        let mut control = ViewportControl::default();
        (control.corner, control.size) = (CORNER, SIZE);
        Self { framework, owner: Owner(id, control) }
    }

    fn send(&mut self, event: InputEvent) {
        self.framework.resolve_input(event, &mut self.owner);
    }

    fn control(&mut self) -> &mut ViewportControl {
        &mut self.owner.1
    }

    fn camera(&self) -> Camera {
        self.owner.1.camera
    }

    fn to(&mut self, x: f32, y: f32) {
        self.send(InputEvent::MouseMove(CORNER + Vec2::new(x, y)));
    }

    /// Drags along these points with a button held. Returns the requested outcome.
    fn drag(&mut self, button: Button, held: Modifiers, ways: &[[f32; 2]]) -> Option<ViewportOutcome> {
        self.send(InputEvent::Modifiers(held));
        self.to(ways[0][0], ways[0][1]);
        self.send(InputEvent::MouseDown(button));
        ways.iter().for_each(|[x, y]| self.to(*x, *y));
        self.send(InputEvent::MouseUp(button));
        self.control().take_outcome()
    }
}

#[test]
fn a_click_picks_a_drag_draws_a_box_and_neither_moves_the_camera() {
    let mut picture = Picture::new();
    let click = picture.drag(Button::Left, NONE, &[[10.0, 20.0], [11.0, 20.0]]);
    assert_eq!(click, Some(ViewportOutcome::Pick(Vec2::new(10.0, 20.0), Choice::Replace)));
    let boxed = picture.drag(Button::Left, NONE, &[[10.0, 20.0], [60.0, 90.0]]);
    let region = OwnedRegion::Box(Vec2::new(10.0, 20.0), Vec2::new(60.0, 90.0));
    assert_eq!(boxed, Some(ViewportOutcome::Catch(region, Choice::Replace)));
    assert_eq!(picture.camera(), Camera::default());
}

#[test]
fn shift_adds_ctrl_toggles_and_both_with_alt_draw_a_line() {
    let mut picture = Picture::new();
    let choice = |outcome| match outcome {
        Some(ViewportOutcome::Pick(_, choice) | ViewportOutcome::Catch(_, choice)) => choice,
        None => panic!("nothing was asked for"),
    };
    for (held, wanted) in [(SHIFT, Choice::Add), (CTRL, Choice::Toggle)] {
        assert_eq!(choice(picture.drag(Button::Left, held, &[[10.0, 20.0]])), wanted);
        assert_eq!(choice(picture.drag(Button::Left, held, &[[10.0, 20.0], [90.0, 90.0]])), wanted);
    }
    let ways = [[10.0, 20.0], [60.0, 90.0], [200.0, 30.0]];
    let Some(ViewportOutcome::Catch(OwnedRegion::Lasso(line), Choice::Replace)) =
        picture.drag(Button::Left, Modifiers { ctrl: true, ..ALT }, &ways)
    else {
        panic!("no lasso")
    };
    assert_eq!(line, ways.map(Vec2::from));
    // After the command for it, the next drag draws a line too, and only that drag.
    picture.control().arm(Catch::Lasso);
    let outcome = picture.drag(Button::Left, SHIFT, &ways);
    assert!(
        matches!(outcome, Some(ViewportOutcome::Catch(OwnedRegion::Lasso(_), Choice::Add))),
        "{outcome:?}"
    );
    let outcome = picture.drag(Button::Left, NONE, &ways);
    assert!(matches!(outcome, Some(ViewportOutcome::Catch(OwnedRegion::Box(..), _))), "{outcome:?}");
}

#[test]
fn each_mouse_gesture_does_its_standard_action() {
    let gestures = [
        (Button::Middle, NONE, "orbit"),
        (Button::Left, ALT, "orbit"),
        (Button::Middle, SHIFT, "pan"),
        (Button::Middle, ALT, "pan"),
        (Button::Right, ALT, "zoom"),
        (Button::Right, NONE, "nothing"),
    ];
    for (button, held, expected) in gestures {
        let mut picture = Picture::new();
        let before = picture.camera();
        let asked = picture.drag(button, held, &[[100.0, 100.0], [130.0, 160.0]]);
        let camera = picture.camera();
        let found = if camera.yaw != before.yaw && camera.target == before.target {
            "orbit"
        } else if camera.target != before.target && camera.distance == before.distance {
            "pan"
        } else if camera.distance != before.distance {
            "zoom"
        } else {
            "nothing"
        };
        assert_eq!(found, expected, "{button:?} {held:?}");
        assert_eq!(asked, None);
    }
}

#[test]
fn losing_the_focus_ends_a_drag() {
    let mut picture = Picture::new();
    picture.to(100.0, 100.0);
    picture.send(InputEvent::MouseDown(Button::Middle));
    picture.to(120.0, 100.0);
    assert!(picture.control().is_dragging());
    picture.send(InputEvent::Lost);
    let stands = picture.camera();
    assert_ne!(stands, Camera::default());
    picture.to(400.0, 300.0);
    assert_eq!(picture.camera(), stands);
    assert!(!picture.control().is_dragging());
}

#[test]
fn escape_and_another_button_cancel_a_drag() {
    let mut picture = Picture::new();
    picture.to(100.0, 100.0);
    picture.send(InputEvent::MouseDown(Button::Middle));
    picture.to(300.0, 250.0);
    assert_ne!(picture.camera(), Camera::default());
    picture.send(InputEvent::KeyDown(Key::Escape));
    assert_eq!(picture.camera(), Camera::default());
    picture.send(InputEvent::MouseUp(Button::Middle));
    picture.send(InputEvent::MouseDown(Button::Left));
    picture.to(400.0, 250.0);
    assert!(picture.control().catching().is_some());
    picture.send(InputEvent::MouseDown(Button::Right));
    assert!(picture.control().catching().is_none());
    picture.send(InputEvent::MouseUp(Button::Right));
    picture.send(InputEvent::MouseUp(Button::Left));
    assert_eq!(picture.control().take_outcome(), None);
}

#[test]
fn the_wheel_zooms_to_what_is_under_the_pointer() {
    let mut picture = Picture::new();
    let before = picture.camera();
    picture.to(400.0, 300.0);
    picture.send(InputEvent::Wheel(Vec2::new(0.0, 50.0)));
    assert!(picture.camera().distance < before.distance);
    assert!((picture.camera().target - before.target).length() < 1e-5, "in the middle the target stays");
    picture.to(700.0, 300.0);
    picture.send(InputEvent::Wheel(Vec2::new(0.0, 50.0)));
    assert!((picture.camera().target - before.target).dot(before.right()) > 0.0);
    let spread = ViewportControl::wheel_of_pinch(2.0);
    let before = picture.camera();
    picture.send(InputEvent::Wheel(Vec2::new(0.0, spread)));
    assert!((picture.camera().distance * 2.0 - before.distance).abs() < 1e-4, "two fingers spread to twice");
}

#[test]
fn a_thousand_random_sequences_leave_nothing_stuck() {
    let seed = seed(11);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let odd = [f32::NAN, f32::INFINITY, -1e30, 0.0, 1e30];
    let buttons = [Button::Left, Button::Middle, Button::Right];
    for _ in 0..1_000 {
        let mut picture = Picture::new();
        for _ in 0..30 {
            let mut place =
                || if random.below(20) == 0 { random.choice(&odd) } else { random.unit() * 800.0 };
            let at = Vec2::new(place(), place());
            picture.send(match random.below(9) {
                0..3 => InputEvent::MouseMove(at),
                3 => InputEvent::MouseDown(buttons[random.below(3)]),
                4 => InputEvent::MouseUp(buttons[random.below(3)]),
                5 => InputEvent::Wheel(at),
                6 => InputEvent::KeyDown(Key::Escape),
                7 => {
                    let [shift, ctrl, alt] = [(); 3].map(|()| random.below(2) == 0);
                    InputEvent::Modifiers(Modifiers { shift, ctrl, alt })
                }
                _ => InputEvent::Lost,
            });
            let camera = picture.camera();
            let finite = camera.target.is_finite() && camera.distance.is_finite() && camera.yaw.is_finite();
            assert!(finite && camera.distance > 0.0, "{camera:?}");
        }
        // Everything is released: no drag is active.
        buttons.into_iter().for_each(|button| picture.send(InputEvent::MouseUp(button)));
        assert!(!picture.control().is_dragging());
    }
}
