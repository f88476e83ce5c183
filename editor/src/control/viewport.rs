//! The mouse over the picture: orbit, pan, zoom, pick (keys and buttons as hands know them from other programs).

use crate::camera::Camera;
use glam::Vec2;

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Picks; with Alt it orbits.
    Left,
    /// Orbits; with Shift or Alt it pans.
    Middle,
    /// With Alt it zooms.
    Right,
}

/// What happened in one frame. Lengths are points from the top left of the picture, y down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input {
    /// Size of the picture.
    pub size: Vec2,
    /// Where the pointer is; `None` outside the window.
    pub pointer: Option<Vec2>,
    /// The button that went down over the picture in this frame.
    pub pressed: Option<Button>,
    /// Buttons held: left, middle, right.
    pub down: [bool; 3],
    /// Turned over the picture: positive is away from the person.
    pub wheel: f32,
    /// Two fingers spread: a factor, 0 or 1 for none.
    pub pinch: f32,
    /// Held keys.
    pub alt: bool,
    /// Held keys.
    pub shift: bool,
    /// Was Escape pressed?
    pub escape: bool,
    /// Has the window the keyboard?
    pub focused: bool,
}

/// What the machine asks for besides moving the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Which bone lies here?
    Pick(Vec2),
}

/// What the mouse is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Mode {
    #[default]
    Idle,
    /// Down, but not moved yet: may become a click.
    Pressed {
        at: Vec2,
    },
    Drag {
        kind: Drag,
        button: Button,
        last: Vec2,
        before: Camera,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Drag {
    Orbit,
    Pan,
    Zoom,
}

/// Moves a camera as the mouse says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewportControl {
    mode: Mode,
}

/// Radians a point.
const ORBIT: f32 = 0.008;
/// Change of the logarithm of the distance a point of wheel or drag.
const ZOOM_WHEEL: f32 = 0.002;
const ZOOM_DRAG: f32 = 0.008;
/// A press that moves further than this is no click.
const CLICK: f32 = 4.0;
/// No screen is so large: a pointer reported there is a mistake of the driver.
const FARTHEST: f32 = 1e5;

impl ViewportControl {
    /// Is a drag going on?
    pub fn is_dragging(&self) -> bool {
        matches!(self.mode, Mode::Drag { .. })
    }

    /// Takes one frame's input; moves `camera`.
    ///
    /// A drag ends where it is when its button comes up or the window loses the keyboard (the release would never be
    /// heard of), and is taken back by Escape.
    pub fn step(&mut self, input: &Input, camera: &mut Camera) -> Option<Outcome> {
        let sound = |point: &Vec2| point.is_finite() && point.abs().max_element() < FARTHEST;
        let pointer = input.pointer.filter(sound);
        if let Some(pointer) = pointer {
            zoom(input, pointer, camera);
        }
        if !input.focused {
            self.mode = Mode::Idle;
            return None;
        }
        let pointer = pointer?;
        match self.mode {
            Mode::Idle => {
                if let Some(button) = input.pressed {
                    self.mode = match kind(button, input) {
                        Some(kind) => Mode::Drag { kind, button, last: pointer, before: *camera },
                        None if button == Button::Left => Mode::Pressed { at: pointer },
                        None => Mode::Idle,
                    };
                }
                None
            }
            Mode::Pressed { at } => {
                if at.distance(pointer) > CLICK || input.escape {
                    self.mode = Mode::Idle;
                } else if !input.down[0] {
                    self.mode = Mode::Idle;
                    return Some(Outcome::Pick(pointer));
                }
                None
            }
            Mode::Drag { kind, button, last, before } => {
                if input.escape {
                    *camera = before;
                    self.mode = Mode::Idle;
                    return None;
                }
                drag(kind, pointer - last, input.size, camera);
                self.mode = if input.down[button as usize] {
                    Mode::Drag { kind, button, last: pointer, before }
                } else {
                    Mode::Idle
                };
                None
            }
        }
    }
}

fn zoom(input: &Input, pointer: Vec2, camera: &mut Camera) {
    let pinch = if input.pinch.is_finite() && input.pinch > 0.0 { 1.0 / input.pinch } else { 1.0 };
    let wheel = if input.wheel.is_finite() { -input.wheel * ZOOM_WHEEL } else { 0.0 };
    let factor = pinch.clamp(0.1, 10.0) * wheel.clamp(-2.0, 2.0).exp();
    if factor != 1.0 {
        camera.zoom_to(pointer, input.size, factor);
    }
}

/// What a press of `button` begins.
fn kind(button: Button, input: &Input) -> Option<Drag> {
    match (button, input.alt, input.shift) {
        (Button::Left, true, _) => Some(Drag::Orbit),
        (Button::Left, false, _) => None,
        (Button::Middle, false, false) => Some(Drag::Orbit),
        (Button::Middle, ..) => Some(Drag::Pan),
        (Button::Right, true, _) => Some(Drag::Zoom),
        (Button::Right, false, _) => None,
    }
}

fn drag(kind: Drag, by: Vec2, size: Vec2, camera: &mut Camera) {
    match kind {
        Drag::Orbit => orbit(by, camera),
        Drag::Pan => camera.pan(by, size.y),
        Drag::Zoom => camera.dolly(((by.y - by.x) * ZOOM_DRAG).clamp(-2.0, 2.0).exp()),
    }
}

/// Turns the picture as if it were held at the pointer.
pub(crate) fn orbit(by: Vec2, camera: &mut Camera) {
    camera.orbit(-by.x * ORBIT, by.y * ORBIT);
}
