//! The mouse over the picture: orbit, pan, zoom, click, box and lasso (keys and buttons as hands know them from other
//! programs).

use super::base::{BaseControl, Mouse, Pass};
use super::framework::ControlFramework;
use super::key::{Key, Modifiers};
use dragonfly_document::bones::Choice;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::{Lasso, OwnedRegion, Region};
use glam::Vec2;

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Picks and boxes; with Alt it orbits, with Ctrl and Alt it draws a lasso.
    Left,
    /// Orbits; with Shift or Alt it pans.
    Middle,
    /// With Alt it zooms.
    Right,
}

/// What the picture asks for besides moving the camera. Places are points from its top left.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Which bone lies here?
    Pick(Vec2, Choice),
    /// Which bones lie in there?
    Catch(OwnedRegion, Choice),
}

/// A form in which bones are caught.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Catch {
    /// From corner to corner.
    Box,
    /// Within a line.
    Lasso,
}

/// What the mouse is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Mode {
    #[default]
    Idle,
    /// Down, but not moved yet: may become a click, or `catch`.
    Pressed {
        at: Vec2,
        catch: Catch,
    },
    Catching {
        from: Vec2,
        to: Vec2,
        catch: Catch,
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

/// Moves a camera as the mouse says. Its owner gives it the camera and the place of the picture before an input, and takes
/// the camera and the outcome after it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViewportControl {
    /// From where the picture is seen.
    pub camera: Camera,
    /// Top left of the picture, points from that of the window.
    pub corner: Vec2,
    /// Size of the picture, points.
    pub size: Vec2,
    mode: Mode,
    lasso: Lasso,
    /// The next press catches bones, whatever it meets.
    armed: Option<Catch>,
    outcome: Option<Outcome>,
}

/// Radians a point.
const ORBIT: f32 = 0.008;
/// Change of the logarithm of the distance a point of wheel or drag.
const ZOOM_WHEEL: f32 = 0.002;
const ZOOM_DRAG: f32 = 0.008;
/// A press that moves further than this is no click, points.
pub(super) const CLICK: f32 = 4.0;

impl ViewportControl {
    /// Is a drag going on?
    pub fn is_dragging(&self) -> bool {
        matches!(self.mode, Mode::Drag { .. } | Mode::Catching { .. })
    }

    /// Does the mouse move the camera?
    pub fn moves_camera(&self) -> bool {
        matches!(self.mode, Mode::Drag { .. })
    }

    /// The next press of the left button catches bones, also where it meets a handle.
    pub fn arm(&mut self, catch: Catch) {
        self.armed = Some(catch);
    }

    /// What the next press catches with.
    pub fn armed(&self) -> Option<Catch> {
        self.armed
    }

    /// The box or lasso that is being drawn.
    pub fn catching(&self) -> Option<Region<'_>> {
        match self.mode {
            Mode::Catching { from, to, catch: Catch::Box } => Some(Region::Box(from, to)),
            Mode::Catching { catch: Catch::Lasso, .. } => Some(self.lasso.region()),
            _ => None,
        }
    }

    /// What was asked for since this was called last.
    pub fn take_outcome(&mut self) -> Option<Outcome> {
        self.outcome.take()
    }

    /// Zooms so that what is under a point of the picture stays there; `by` is turned points of a wheel, positive is nearer.
    pub fn zoom(&mut self, at: Vec2, by: f32) {
        let factor = (-by * ZOOM_WHEEL).clamp(-2.0, 2.0).exp();
        if factor.is_finite() && at.is_finite() && factor != 1.0 {
            self.camera.zoom_to(at, self.size, factor);
        }
    }

    /// Turns of a wheel that zoom as two fingers do which spread by `factor`.
    pub fn wheel_of_pinch(factor: f32) -> f32 {
        let sound = factor.is_finite() && factor > 0.0;
        if sound { factor.clamp(0.1, 10.0).ln() / ZOOM_WHEEL } else { 0.0 }
    }

    fn moved(&mut self, at: Vec2) {
        match &mut self.mode {
            Mode::Idle => {}
            Mode::Pressed { at: from, catch } => {
                if from.distance(at) > CLICK {
                    let (from, catch) = (*from, *catch);
                    self.lasso.begin(from);
                    self.lasso.push(at);
                    self.mode = Mode::Catching { from, to: at, catch };
                }
            }
            Mode::Catching { to, .. } => {
                *to = at;
                self.lasso.push(at);
            }
            Mode::Drag { kind, last, .. } => {
                let by = at - *last;
                *last = at;
                match *kind {
                    Drag::Orbit => orbit(by, &mut self.camera),
                    Drag::Pan => self.camera.pan(by, self.size.y),
                    Drag::Zoom => {
                        self.camera.dolly(((by.y - by.x) * ZOOM_DRAG).clamp(-2.0, 2.0).exp());
                    }
                }
            }
        }
    }

    fn caught(&mut self, from: Vec2, to: Vec2, catch: Catch, modifiers: Modifiers) {
        let region = match catch {
            Catch::Box => OwnedRegion::Box(from, to),
            Catch::Lasso => self.lasso.region().to_owned(),
        };
        // Ctrl and Alt together belong to the lasso itself.
        let ctrl = modifiers.ctrl && !modifiers.alt;
        self.outcome = Some(Outcome::Catch(region, Choice::from(Modifiers { ctrl, ..modifiers })));
    }
}

impl BaseControl for ViewportControl {
    fn mouse_move(&mut self, mouse: Mouse, _framework: &mut ControlFramework) -> Pass {
        self.moved(mouse.at - self.corner);
        Pass::Stop
    }

    fn mouse_wheel(&mut self, by: Vec2, mouse: Mouse, _framework: &mut ControlFramework) -> Pass {
        self.zoom(mouse.at - self.corner, by.y);
        Pass::Stop
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> Pass {
        let at = mouse.at - self.corner;
        match self.mode {
            Mode::Idle => {
                let armed = self.armed.take().filter(|_| button == Button::Left);
                self.mode = match begins(button, mouse.modifiers) {
                    _ if armed.is_some() => Mode::Pressed { at, catch: armed.unwrap_or(Catch::Box) },
                    Begins::Catch(catch) => Mode::Pressed { at, catch },
                    Begins::Drag(kind) => Mode::Drag { kind, button, last: at, before: self.camera },
                    Begins::Nothing => Mode::Idle,
                };
            }
            // Another button takes a box back.
            Mode::Pressed { .. } | Mode::Catching { .. } => self.mode = Mode::Idle,
            Mode::Drag { .. } => {}
        }
        Pass::Stop
    }

    fn mouse_up(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> Pass {
        match self.mode {
            Mode::Pressed { at, .. } if button == Button::Left => {
                self.mode = Mode::Idle;
                self.outcome = Some(Outcome::Pick(at, Choice::from(mouse.modifiers)));
            }
            Mode::Catching { from, to, catch } if button == Button::Left => {
                self.mode = Mode::Idle;
                self.caught(from, to, catch, mouse.modifiers);
            }
            Mode::Drag { button: held, .. } if button == held => self.mode = Mode::Idle,
            _ => {}
        }
        Pass::Stop
    }

    /// Escape takes back what the mouse is doing.
    fn key_down(
        &mut self,
        key: Key,
        _modifiers: Modifiers,
        _repeat: bool,
        _framework: &mut ControlFramework,
    ) -> Pass {
        let busy = self.mode != Mode::Idle || self.armed.is_some();
        if key != Key::Escape || !busy {
            return Pass::ToParent;
        }
        if let Mode::Drag { before, .. } = self.mode {
            self.camera = before;
        }
        self.mode = Mode::Idle;
        self.armed = None;
        Pass::Stop
    }

    /// The release would never be heard of: the eye stays where it is, a box is forgotten.
    fn input_lost(&mut self, _framework: &mut ControlFramework) {
        self.mode = Mode::Idle;
        self.armed = None;
    }
}

enum Begins {
    Nothing,
    Drag(Drag),
    Catch(Catch),
}

/// What a press of `button` begins.
fn begins(button: Button, Modifiers { shift, ctrl, alt }: Modifiers) -> Begins {
    match (button, alt, shift) {
        (Button::Left, true, _) if ctrl => Begins::Catch(Catch::Lasso),
        (Button::Left, true, _) => Begins::Drag(Drag::Orbit),
        (Button::Left, false, _) => Begins::Catch(Catch::Box),
        (Button::Middle, false, false) => Begins::Drag(Drag::Orbit),
        (Button::Middle, ..) => Begins::Drag(Drag::Pan),
        (Button::Right, true, _) => Begins::Drag(Drag::Zoom),
        (Button::Right, false, _) => Begins::Nothing,
    }
}

/// Turns the picture as if it were held at the pointer.
pub(crate) fn orbit(by: Vec2, camera: &mut Camera) {
    camera.orbit(-by.x * ORBIT, by.y * ORBIT);
}
