//! The mouse in the viewport: orbit, pan, zoom, click, box and lasso, with the usual keys and buttons.

use super::base::{BaseControl, InputFlow, Mouse};
use super::framework::ControlFramework;
use super::input::Button;
use super::key::{Key, Modifiers};
use dragonfly_document::bones::Choice;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::{Lasso, OwnedRegion, Region};
use glam::Vec2;

/// A request of the viewport apart from moving the camera. Positions are points from its top left.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewportOutcome {
    /// Select the bone at a position.
    Pick(Vec2, Choice),
    /// Select the bones in a region.
    Catch(OwnedRegion, Choice),
}

/// Shape of a region that selects bones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Catch {
    /// A box from corner to corner.
    Box,
    /// A closed line.
    Lasso,
}

/// State of the mouse.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum MouseMode {
    #[default]
    Idle,
    /// A button is down and has not moved: may become a click, or `catch`.
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
        kind: CameraMove,
        button: Button,
        last: Vec2,
        before: Camera,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CameraMove {
    Orbit,
    Pan,
    Zoom,
}

/// Moves a camera by the mouse. Its owner sets the camera and the area of the viewport before an input, and reads the
/// camera and the outcome after it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViewportControl {
    /// The camera.
    pub camera: Camera,
    /// Top left of the viewport, points from that of the window.
    pub corner: Vec2,
    /// Size of the viewport, points.
    pub size: Vec2,
    mode: MouseMode,
    lasso: Lasso,
    /// The next press selects in this shape, whatever is under it.
    armed: Option<Catch>,
    outcome: Option<ViewportOutcome>,
}

/// Radians per point.
const ORBIT: f32 = 0.008;
/// Change of the logarithm of the distance per point of wheel or drag.
const ZOOM_WHEEL: f32 = 0.002;
const ZOOM_DRAG: f32 = 0.008;
/// Distance beyond which a press is not a click, points.
pub(super) const CLICK: f32 = 4.0;

impl ViewportControl {
    /// Whether a drag is in progress.
    pub fn is_dragging(&self) -> bool {
        matches!(self.mode, MouseMode::Drag { .. } | MouseMode::Catching { .. })
    }

    /// Whether the mouse moves the camera.
    pub fn moves_camera(&self) -> bool {
        matches!(self.mode, MouseMode::Drag { .. })
    }

    /// Makes the next press of the left button begin a selection, even on a handle.
    pub fn arm(&mut self, catch: Catch) {
        self.armed = Some(catch);
    }

    /// Returns the shape of the selection that the next press begins.
    pub fn armed(&self) -> Option<Catch> {
        self.armed
    }

    /// Returns the box or lasso in progress.
    pub fn catching(&self) -> Option<Region<'_>> {
        match self.mode {
            MouseMode::Catching { from, to, catch: Catch::Box } => Some(Region::Box(from, to)),
            MouseMode::Catching { catch: Catch::Lasso, .. } => Some(self.lasso.region()),
            _ => None,
        }
    }

    /// Returns the request since the last call.
    pub fn take_outcome(&mut self) -> Option<ViewportOutcome> {
        self.outcome.take()
    }

    /// Zooms about a point of the viewport by `by`, points of the wheel; positive is nearer.
    pub fn zoom(&mut self, at: Vec2, by: f32) {
        let factor = (-by * ZOOM_WHEEL).clamp(-2.0, 2.0).exp();
        if factor.is_finite() && at.is_finite() && factor != 1.0 {
            self.camera.zoom_to(at, self.size, factor);
        }
    }

    /// Returns the points of the wheel that zoom as much as a pinch by `factor`.
    pub fn wheel_of_pinch(factor: f32) -> f32 {
        let sound = factor.is_finite() && factor > 0.0;
        if sound { factor.clamp(0.1, 10.0).ln() / ZOOM_WHEEL } else { 0.0 }
    }

    fn moved(&mut self, at: Vec2) {
        match &mut self.mode {
            MouseMode::Idle => {}
            MouseMode::Pressed { at: from, catch } => {
                if from.distance(at) > CLICK {
                    let (from, catch) = (*from, *catch);
                    self.lasso.begin(from);
                    self.lasso.push(at);
                    self.mode = MouseMode::Catching { from, to: at, catch };
                }
            }
            MouseMode::Catching { to, .. } => {
                *to = at;
                self.lasso.push(at);
            }
            MouseMode::Drag { kind, last, .. } => {
                let by = at - *last;
                *last = at;
                match *kind {
                    CameraMove::Orbit => orbit(by, &mut self.camera),
                    CameraMove::Pan => self.camera.pan(by, self.size.y),
                    CameraMove::Zoom => {
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
        // Ctrl and Alt together mean the lasso itself.
        let ctrl = modifiers.ctrl && !modifiers.alt;
        self.outcome = Some(ViewportOutcome::Catch(region, Choice::from(Modifiers { ctrl, ..modifiers })));
    }
}

impl BaseControl for ViewportControl {
    fn mouse_move(&mut self, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        self.moved(mouse.at - self.corner);
        InputFlow::Stop
    }

    fn mouse_wheel(&mut self, by: Vec2, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        self.zoom(mouse.at - self.corner, by.y);
        InputFlow::Stop
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        let at = mouse.at - self.corner;
        match self.mode {
            MouseMode::Idle => {
                let armed = self.armed.take().filter(|_| button == Button::Left);
                self.mode = match begins(button, mouse.modifiers) {
                    _ if armed.is_some() => MouseMode::Pressed { at, catch: armed.unwrap_or(Catch::Box) },
                    Begins::Catch(catch) => MouseMode::Pressed { at, catch },
                    Begins::Drag(kind) => MouseMode::Drag { kind, button, last: at, before: self.camera },
                    Begins::Nothing => MouseMode::Idle,
                };
            }
            // Another button cancels a box.
            MouseMode::Pressed { .. } | MouseMode::Catching { .. } => self.mode = MouseMode::Idle,
            MouseMode::Drag { .. } => {}
        }
        InputFlow::Stop
    }

    fn mouse_up(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        match self.mode {
            MouseMode::Pressed { at, .. } if button == Button::Left => {
                self.mode = MouseMode::Idle;
                self.outcome = Some(ViewportOutcome::Pick(at, Choice::from(mouse.modifiers)));
            }
            MouseMode::Catching { from, to, catch } if button == Button::Left => {
                self.mode = MouseMode::Idle;
                self.caught(from, to, catch, mouse.modifiers);
            }
            MouseMode::Drag { button: held, .. } if button == held => self.mode = MouseMode::Idle,
            _ => {}
        }
        InputFlow::Stop
    }

    /// Escape cancels what the mouse does.
    fn key_down(
        &mut self,
        key: Key,
        _modifiers: Modifiers,
        _repeat: bool,
        _framework: &mut ControlFramework,
    ) -> InputFlow {
        let busy = self.mode != MouseMode::Idle || self.armed.is_some();
        if key != Key::Escape || !busy {
            return InputFlow::ToParent;
        }
        if let MouseMode::Drag { before, .. } = self.mode {
            self.camera = before;
        }
        self.mode = MouseMode::Idle;
        self.armed = None;
        InputFlow::Stop
    }

    /// The release would never arrive: the camera stays where it is, and a box is dropped.
    fn input_lost(&mut self, _framework: &mut ControlFramework) {
        self.mode = MouseMode::Idle;
        self.armed = None;
    }
}

enum Begins {
    Nothing,
    Drag(CameraMove),
    Catch(Catch),
}

/// Returns what a press of `button` begins.
fn begins(button: Button, Modifiers { shift, ctrl, alt }: Modifiers) -> Begins {
    match (button, alt, shift) {
        (Button::Left, true, _) if ctrl => Begins::Catch(Catch::Lasso),
        (Button::Left, true, _) => Begins::Drag(CameraMove::Orbit),
        (Button::Left, false, _) => Begins::Catch(Catch::Box),
        (Button::Middle, false, false) => Begins::Drag(CameraMove::Orbit),
        (Button::Middle, ..) => Begins::Drag(CameraMove::Pan),
        (Button::Right, true, _) => Begins::Drag(CameraMove::Zoom),
        (Button::Right, false, _) => Begins::Nothing,
    }
}

/// Orbits as if the scene were held at the pointer.
pub(crate) fn orbit(by: Vec2, camera: &mut Camera) {
    camera.orbit(-by.x * ORBIT, by.y * ORBIT);
}
