//! The keys of a motion path as a control of the scene: each can be dragged.

use super::base::{BaseControl, InputFlow, Mouse};
use super::drag::{DragEvent, DragMachine};
use super::framework::ControlFramework;
use super::input::Button;
use super::key::{Key, Modifiers};
use super::viewport_tools::tool::{ToolOutcome, ViewportTool};
use dragonfly_picture::gizmo::{AXIS_FROM, GizmoView};
use glam::{DVec3, Vec2, Vec3};

/// Distance within which a key is under the pointer, points.
const REACH: f32 = 7.0;

/// A key on the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathKey {
    /// Seconds.
    pub time: f32,
    /// Position of the joint at that time, scene space.
    pub place: Vec3,
}

/// The outcome of a drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathAnswer {
    /// The joint was dragged to this position at this key.
    Moved(PathKey),
    /// The drag was released.
    Done,
    /// The drag was cancelled.
    Cancelled,
}

/// A key that is dragged, and where the pointer was at its press.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DraggedPathKey {
    key: PathKey,
    start: Vec2,
}

/// The control of the keys on the path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathControl {
    /// Top left of the viewport, points from that of the window.
    pub corner: Vec2,
    /// Whether keys can be changed.
    pub editable: bool,
    /// Pivot of the gizmo, scene space. Handles are long and keys are small, so a key wins over a handle everywhere
    /// except at the center of the gizmo: if the joint does not move, all of its keys are there.
    pub gizmo: Option<DVec3>,
    keys: Vec<PathKey>,
    view: Option<GizmoView>,
    hovered: Option<usize>,
    /// A press on a key is a drag at once: the keys are small, and a click does nothing.
    machine: DragMachine<(), DraggedPathKey>,
    answer: Option<PathAnswer>,
}

impl PathControl {
    /// Sets the keys. A drag in progress keeps the key that it drags.
    pub fn show(&mut self, keys: &[PathKey]) {
        self.keys.clear();
        self.keys.extend_from_slice(keys);
        self.hovered = None;
    }

    /// Returns the time of the key that is dragged or under the pointer.
    pub fn hovered(&self) -> Option<f32> {
        let under = self.hovered.and_then(|key| self.keys.get(key));
        self.machine.drag().map(|drag| drag.key.time).or(under.map(|key| key.time))
    }

    /// Returns the outcome of the drag since the last call.
    pub fn take_answer(&mut self) -> Option<PathAnswer> {
        self.answer.take()
    }

    fn key_at(&self, at: Vec2) -> Option<usize> {
        let view = self.view.filter(|_| at.is_finite() && self.editable)?;
        let middle = self.gizmo.and_then(|pivot| view.to_screen(pivot));
        let mut nearest: Option<(f64, usize)> = None;
        for (index, key) in self.keys.iter().enumerate() {
            let Some(place) = view.to_screen(key.place.as_dvec3()) else { continue };
            if middle.is_some_and(|middle| middle.distance(place) <= AXIS_FROM) {
                continue;
            }
            let distance = place.distance(at.as_dvec2());
            if distance <= f64::from(REACH) && nearest.is_none_or(|(best, _)| distance < best) {
                nearest = Some((distance, index));
            }
        }
        nearest.map(|(_, index)| index)
    }

    /// Returns the position of the dragged key under the pointer, at its distance from the camera.
    fn put(&self, drag: &DraggedPathKey, at: Vec2) -> Option<Vec3> {
        let view = self.view?;
        let place: DVec3 = drag.key.place.as_dvec3();
        let by = view.move_by(place, (at - drag.start).as_dvec2())?;
        let put = (place + by).as_vec3();
        put.is_finite().then_some(put)
    }

    fn end(&mut self, event: &DragEvent<(), DraggedPathKey>) -> InputFlow {
        self.answer = Some(match event {
            DragEvent::Dropped(_) => PathAnswer::Done,
            DragEvent::Cancelled(_) => PathAnswer::Cancelled,
            DragEvent::Nothing
            | DragEvent::Pressed
            | DragEvent::Started(())
            | DragEvent::Moved(_)
            | DragEvent::Clicked(()) => return InputFlow::ToParent,
        });
        InputFlow::Stop
    }

    fn cancel(&mut self) -> InputFlow {
        let event = self.machine.cancelled();
        self.end(&event)
    }
}

impl ViewportTool for PathControl {
    fn place(&mut self, corner: Vec2) {
        self.corner = corner;
    }

    fn look(&mut self, view: GizmoView) {
        self.view = Some(view);
    }

    fn take_outcome(&mut self) -> Option<ToolOutcome> {
        Some(match self.take_answer()? {
            PathAnswer::Moved(key) => ToolOutcome::MoveKey(key),
            PathAnswer::Done => ToolOutcome::Done,
            PathAnswer::Cancelled => ToolOutcome::Cancelled,
        })
    }

    fn is_dragging(&self) -> bool {
        self.machine.drag().is_some()
    }
}

impl BaseControl for PathControl {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.machine.drag().is_some() || self.key_at(point - self.corner).is_some()
    }

    fn mouse_move(&mut self, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        let at = mouse.at - self.corner;
        match self.machine.drag() {
            Some(drag) => {
                if let Some(place) = self.put(drag, at) {
                    self.answer = Some(PathAnswer::Moved(PathKey { place, ..drag.key }));
                }
                InputFlow::Stop
            }
            None => {
                self.hovered = self.key_at(at);
                // A key covers the handles behind it.
                if self.hovered.is_some() { InputFlow::Stop } else { InputFlow::ToParent }
            }
        }
    }

    fn mouse_leave(&mut self, _framework: &mut ControlFramework) {
        self.hovered = None;
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        if button == Button::Right {
            return self.cancel();
        }
        let at = mouse.at - self.corner;
        let key = self.key_at(at).and_then(|key| self.keys.get(key)).copied();
        let begins = button == Button::Left && !mouse.modifiers.alt && self.machine.drag().is_none();
        match key.filter(|_| begins) {
            Some(key) => {
                self.machine.begin(DraggedPathKey { key, start: at });
                InputFlow::Stop
            }
            None => InputFlow::ToParent,
        }
    }

    fn mouse_up(&mut self, button: Button, _mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        if button != Button::Left {
            return InputFlow::ToParent;
        }
        let event = self.machine.released();
        self.end(&event)
    }

    fn key_down(&mut self, key: Key, _: Modifiers, _: bool, _framework: &mut ControlFramework) -> InputFlow {
        if key == Key::Escape { self.cancel() } else { InputFlow::ToParent }
    }

    fn input_lost(&mut self, _framework: &mut ControlFramework) {
        self.cancel();
    }
}
