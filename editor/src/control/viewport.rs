//! The mouse in the viewport: orbit, pan, zoom, click, box and lasso, with the usual keys and buttons.

use super::base::{BaseControl, InputFlow, Mouse};
use super::drag::{DragEvent, DragMachine};
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

/// A press of the left button, which may become a click or a region that begins there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RegionPress {
    at: Vec2,
    catch: Catch,
}

/// What the mouse drags.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ViewportDrag {
    /// A region that selects bones.
    Region { press: RegionPress, to: Vec2 },
    /// The camera; it follows the mouse at once, without a threshold.
    Camera { kind: CameraMove, button: Button, last: Vec2, before: Camera },
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
    machine: DragMachine<RegionPress, ViewportDrag>,
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

impl ViewportControl {
    /// Whether a drag is in progress.
    pub fn is_dragging(&self) -> bool {
        self.machine.drag().is_some()
    }

    /// Whether the mouse moves the camera.
    pub fn moves_camera(&self) -> bool {
        matches!(self.machine.drag(), Some(ViewportDrag::Camera { .. }))
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
        match self.machine.drag()? {
            ViewportDrag::Region { press, to } => Some(match press.catch {
                Catch::Box => Region::Box(press.at, *to),
                Catch::Lasso => self.lasso.region(),
            }),
            ViewportDrag::Camera { .. } => None,
        }
    }

    /// Returns the request that was made since the last call.
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

    /// Returns the distance of the wheel, points, that zooms as much as a pinch by `factor`.
    pub fn wheel_of_pinch(factor: f32) -> f32 {
        let sound = factor.is_finite() && factor > 0.0;
        if sound { factor.clamp(0.1, 10.0).ln() / ZOOM_WHEEL } else { 0.0 }
    }

    fn moved(&mut self, at: Vec2) {
        if let DragEvent::Started(press) = self.machine.moved(at) {
            self.lasso.begin(press.at);
            self.machine.begin(ViewportDrag::Region { press, to: at });
        }
        match self.machine.drag_mut() {
            None => {}
            Some(ViewportDrag::Region { to, .. }) => {
                *to = at;
                self.lasso.push(at);
            }
            Some(ViewportDrag::Camera { kind, last, .. }) => {
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

    fn caught(&mut self, press: RegionPress, to: Vec2, modifiers: Modifiers) {
        let region = match press.catch {
            Catch::Box => OwnedRegion::Box(press.at, to),
            Catch::Lasso => self.lasso.region().to_owned(),
        };
        // Ctrl together with Alt draws a lasso, so it does not toggle the selection.
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
        if self.moves_camera() {
            return InputFlow::Stop;
        }
        // Another button cancels a box.
        if self.machine.can_cancel() {
            self.machine.cancelled();
            return InputFlow::Stop;
        }
        let armed = self.armed.take().filter(|_| button == Button::Left);
        match armed.map_or_else(|| begins(button, mouse.modifiers), Begins::Catch) {
            Begins::Catch(catch) => self.machine.press(at, RegionPress { at, catch }),
            Begins::Drag(kind) => {
                self.machine.begin(ViewportDrag::Camera { kind, button, last: at, before: self.camera });
            }
            Begins::Nothing => {}
        }
        InputFlow::Stop
    }

    fn mouse_up(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        let held = match self.machine.drag() {
            Some(ViewportDrag::Camera { button, .. }) => *button,
            Some(ViewportDrag::Region { .. }) | None => Button::Left,
        };
        if button != held {
            return InputFlow::Stop;
        }
        match self.machine.released() {
            DragEvent::Clicked(press) => {
                self.outcome = Some(ViewportOutcome::Pick(press.at, Choice::from(mouse.modifiers)));
            }
            DragEvent::Dropped(ViewportDrag::Region { press, to }) => {
                self.caught(press, to, mouse.modifiers);
            }
            DragEvent::Dropped(ViewportDrag::Camera { .. })
            | DragEvent::Nothing
            | DragEvent::Pressed
            | DragEvent::Started(_)
            | DragEvent::Moved(_)
            | DragEvent::Cancelled(_) => {}
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
        let busy = self.machine.can_cancel() || self.armed.is_some();
        if key != Key::Escape || !busy {
            return InputFlow::ToParent;
        }
        if let DragEvent::Cancelled(ViewportDrag::Camera { before, .. }) = self.machine.cancelled() {
            self.camera = before;
        }
        self.armed = None;
        InputFlow::Stop
    }

    /// The release would never arrive: the camera stays where it is, and a box is dropped.
    fn input_lost(&mut self, _framework: &mut ControlFramework) {
        self.machine.cancelled();
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
