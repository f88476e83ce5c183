//! The gizmo as a control: it is hit at its handles, receives all input during a drag, and is cancelled when input is
//! lost.

use crate::gizmo_rig::{Rig, Screen, along};
use dragonfly::control::gizmo::{GizmoAnswer, GizmoControl};
use dragonfly::control::{
    Area, BaseControl, Button, ControlFramework, ControlId, ControlLookup, InputEvent, InputFlow, Key,
    Modifiers, Mouse,
};
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::gizmo::{AXIS_TO, GizmoSpace, Tool};
use glam::{Mat3, Vec2, Vec3};

const CORNER: Vec2 = Vec2::new(200.0, 50.0);

/// The control that the gizmo covers; counts the events that reach it.
#[derive(Default)]
struct Picture {
    moves: usize,
    presses: usize,
    keys: usize,
}

impl BaseControl for Picture {
    fn mouse_move(&mut self, _: Mouse, _: &mut ControlFramework) -> InputFlow {
        self.moves += 1;
        InputFlow::Stop
    }
    fn mouse_down(&mut self, _: Button, _: Mouse, _: &mut ControlFramework) -> InputFlow {
        self.presses += 1;
        InputFlow::Stop
    }
    fn key_down(&mut self, _: Key, _: Modifiers, _: bool, _: &mut ControlFramework) -> InputFlow {
        self.keys += 1;
        InputFlow::Stop
    }
}

struct Window {
    framework: ControlFramework,
    owner: Owner,
    rig: Rig,
    /// Window position of the tip of the arrow along the world's y axis.
    tip: Vec2,
}

struct Owner {
    picture: (ControlId, Picture),
    gizmo: (ControlId, GizmoControl),
}

impl ControlLookup for Owner {
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl> {
        if id == self.picture.0 {
            Some(&mut self.picture.1)
        } else if id == self.gizmo.0 {
            Some(&mut self.gizmo.1)
        } else {
            None
        }
    }
}

impl Window {
    fn new() -> Self {
        let (rig, screen) = (Rig::new(), Screen::plain());
        let mut framework = ControlFramework::new(Vec2::new(1200.0, 700.0));
        let area = Area::new(CORNER, CORNER + screen.size);
        let picture = framework.register_control(area);
        let own = framework.register_control(area);
        let mut control = GizmoControl::default();
        control.corner = CORNER;
        control.gizmo.tool = Tool::Move;
        control.gizmo.settings.space = GizmoSpace::World;
        rig.select(&mut control.gizmo, &[1]);
        control.gizmo.look(screen.view());
        let tip = screen.at(along(&screen, rig.joint(1), Mat3::IDENTITY, Vec3::Y * (AXIS_TO as f32 - 10.0)));
        let owner = Owner { picture: (picture, Picture::default()), gizmo: (own, control) };
        Self { framework, owner, rig, tip: tip + CORNER }
    }

    fn send(&mut self, event: InputEvent) -> Option<ControlId> {
        self.framework.resolve_input(event, &mut self.owner)
    }

    fn to(&mut self, at: Vec2) -> Option<ControlId> {
        self.send(InputEvent::MouseMove(at))
    }

    fn control(&mut self) -> &mut GizmoControl {
        &mut self.owner.gizmo.1
    }

    fn is_moved(&self) -> bool {
        self.rig.after(&self.owner.gizmo.1.gizmo) != self.rig.poses
    }
}

#[test]
fn a_handle_that_cannot_be_dragged_does_not_light_up_and_says_so() {
    let mut window = Window::new();
    window.control().editable = false;
    let tip = window.tip;
    window.to(tip);
    assert!(window.control().gizmo.hovered().is_none() && window.control().refuses());
    window.send(InputEvent::MouseDown(Button::Left));
    window.send(InputEvent::MouseUp(Button::Left));
    assert!(window.control().take_refused() && !window.is_moved());
    window.to(CORNER + Vec2::splat(20.0));
    assert!(!window.control().refuses());
    window.to(tip);
    window.control().editable = true;
    assert!(!window.control().refuses());
}

#[test]
fn a_handle_is_dragged_and_input_that_misses_it_goes_to_the_viewport() {
    let mut window = Window::new();
    let (own, picture) = (window.owner.gizmo.0, window.owner.picture.0);
    assert_eq!(window.to(CORNER + Vec2::splat(20.0)), Some(picture));
    window.send(InputEvent::MouseDown(Button::Left));
    window.send(InputEvent::MouseUp(Button::Left));
    assert_eq!(window.owner.picture.1.presses, 1);
    let tip = window.tip;
    window.to(tip);
    assert!(window.control().gizmo.hovered().is_some());
    assert_eq!(window.send(InputEvent::MouseDown(Button::Left)), Some(own));
    assert_eq!(window.to(tip - Vec2::Y * 900.0), Some(own), "outside of the window, too");
    assert_eq!(window.control().take_answer(), Some(GizmoAnswer::Changed));
    assert_eq!(window.send(InputEvent::MouseUp(Button::Left)), Some(own));
    assert_eq!(window.control().take_answer(), Some(GizmoAnswer::Confirmed));
    assert_eq!(window.control().take_answer(), None);
    assert!(window.is_moved());
    window.to(CORNER + Vec2::splat(20.0));
    assert!(window.control().gizmo.hovered().is_none());
    // A drag is cancelled, and another one started by a key while the button is still held. Releasing the button does
    // not end it.
    window.to(tip);
    window.send(InputEvent::MouseDown(Button::Left));
    window.send(InputEvent::KeyDown(Key::Escape));
    let Window { framework, owner, .. } = &mut window;
    assert!(owner.gizmo.1.begin_by_key(own, tip, framework));
    window.send(InputEvent::MouseUp(Button::Left));
    assert!(window.control().gizmo.is_dragging());
    window.send(InputEvent::KeyUp(Key::Escape));
    window.send(InputEvent::KeyDown(Key::Escape));
    // With Alt held, the mouse goes to the viewport.
    window.send(InputEvent::Modifiers(Modifiers { alt: true, ..Modifiers::default() }));
    window.to(tip);
    assert_eq!(window.send(InputEvent::MouseDown(Button::Left)), Some(picture));
}

#[test]
fn a_click_on_a_handle_goes_to_the_control_behind_and_changes_nothing() {
    for (by, click) in [(0.0, true), (1.0, true), (2.5, false)] {
        let mut window = Window::new();
        let tip = window.tip;
        window.to(tip);
        window.send(InputEvent::MouseDown(Button::Left));
        // Nothing jumps when the pointer has moved so far that the press becomes a drag.
        window.to(tip - Vec2::Y * by);
        assert_eq!(window.is_moved(), by > 0.0, "{by}");
        window.send(InputEvent::MouseUp(Button::Left));
        assert_eq!(window.control().take_click().is_some(), click, "{by}");
        assert_eq!(window.is_moved(), !click, "{by}");
        assert!(!window.control().gizmo.is_dragging());
    }
}

#[test]
fn escape_the_right_button_and_lost_input_cancel_the_drag() {
    for end in [InputEvent::KeyDown(Key::Escape), InputEvent::MouseDown(Button::Right), InputEvent::Lost] {
        let mut window = Window::new();
        let tip = window.tip;
        window.to(tip);
        window.send(InputEvent::MouseDown(Button::Left));
        window.to(tip + Vec2::new(30.0, -40.0));
        assert!(window.is_moved());
        window.send(end);
        assert_eq!(window.control().take_answer(), Some(GizmoAnswer::Cancelled), "{end:?}");
        assert!(!window.is_moved(), "{end:?}");
        window.send(InputEvent::MouseUp(Button::Right));
        window.send(InputEvent::MouseUp(Button::Left));
        assert_eq!(window.control().take_answer(), None, "{end:?}");
    }
}

#[test]
fn a_drag_started_by_a_key_captures_mouse_and_keyboard_until_a_click() {
    let mut window = Window::new();
    let (own, at) = (window.owner.gizmo.0, CORNER + Vec2::splat(20.0));
    window.to(at);
    let Window { framework, owner, .. } = &mut window;
    assert!(owner.gizmo.1.begin_by_key(own, at, framework));
    assert_eq!(window.to(at + Vec2::splat(40.0)), Some(own));
    assert_eq!(window.to(Vec2::new(5.0, 5.0)), Some(own), "beside the picture, too");
    window.send(InputEvent::KeyDown(Key::Letter('y')));
    window.send(InputEvent::KeyDown(Key::Letter('2')));
    assert_eq!(window.owner.picture.1.keys, 0);
    assert_eq!(window.send(InputEvent::MouseDown(Button::Left)), Some(own));
    assert_eq!(window.control().take_answer(), Some(GizmoAnswer::Confirmed));
    window.send(InputEvent::MouseUp(Button::Left));
    let found = window.rig.to_root_of(&window.rig.after(&window.owner.gizmo.1.gizmo))[1].w_axis.truncate();
    assert!(found.distance(window.rig.joint(1) + Vec3::Y * 2.0) < 1e-5);
    assert_eq!(window.framework.captured(), None);
    window.to(at);
    window.send(InputEvent::KeyDown(Key::Letter('q')));
    assert_eq!(window.owner.picture.1.keys, 1, "the keyboard is free again");
    let Window { framework, owner, .. } = &mut window;
    owner.gizmo.1.begin_by_key(own, at, framework);
    window.send(InputEvent::Lost);
    assert!(!window.control().gizmo.is_dragging(), "the window lost its input");
}

#[test]
fn a_thousand_sequences_without_a_release_leave_nothing_dragging() {
    let seed = seed(91);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    for _ in 0..1_000 {
        let mut window = Window::new();
        let (own, tip) = (window.owner.gizmo.0, window.tip);
        for _ in 0..20 {
            let at = tip + Vec2::new(random.between(-30.0, 30.0), random.between(-30.0, 120.0));
            let button = random.choice(&[Button::Left, Button::Middle, Button::Right]);
            let key = random.choice(&[Key::Letter('x'), Key::Letter('7'), Key::Enter, Key::Escape]);
            if random.below(10) == 0 {
                let Window { framework, owner, .. } = &mut window;
                owner.gizmo.1.begin_by_key(own, at, framework);
            }
            let event = random.choice(&[
                InputEvent::MouseMove(at),
                InputEvent::MouseMove(at),
                InputEvent::MouseDown(button),
                InputEvent::MouseUp(button),
                InputEvent::KeyDown(key),
                InputEvent::KeyUp(key),
            ]);
            window.send(event);
        }
        window.send(InputEvent::Lost);
        assert!(!window.control().gizmo.is_dragging());
        assert_eq!(window.framework.captured(), None);
    }
}
