//! The points of paths and lines of a scene as a control: each can be dragged.
//!
//! ```text
//! drag            moves the point at its height
//! Shift + drag    moves it up and down
//! Ctrl + drag     snaps it to a quarter of a meter
//! Esc, right      cancels the drag
//! ```

use super::base::{BaseControl, InputFlow, Mouse};
use super::drag::{DragEvent, DragMachine};
use super::framework::ControlFramework;
use super::input::Button;
use super::key::{Key, Modifiers};
use super::path_point::PathPoint;
use super::viewport_tools::tool::{ToolOutcome, ViewportTool};
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec3, Vec2};
use std::sync::Arc;

/// Distance within which a point is under the pointer, points of the screen.
const REACH: f64 = 8.0;

/// Distance to which points snap, meters.
const SNAP: f64 = 0.25;

/// Sine of the angle above the ground from which on a drag follows the ground; nearer to it, the plane of the view.
const LEAST_SLOPE: f64 = 0.1;

/// A point, and where the pointer was at its press.
#[derive(Clone, Debug, PartialEq)]
struct DraggedPoint {
    point: PathPoint,
    start: Vec2,
}

/// The outcome of an input.
#[derive(Clone, Debug, PartialEq)]
enum PointAnswer {
    Moved(PathPoint),
    Done,
    Cancelled,
}

/// The control of the points of paths and lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPointControl {
    /// Top left of the viewport, points from that of the window.
    corner: Vec2,
    view: Option<GizmoView>,
    points: Arc<[PathPoint]>,
    hovered: Option<usize>,
    machine: DragMachine<(), DraggedPoint>,
    answer: Option<PointAnswer>,
}

impl PathPointControl {
    /// Sets the points. A drag in progress continues with the point that it drags.
    pub fn show_points(&mut self, points: &Arc<[PathPoint]>) {
        if std::ptr::eq(self.points.as_ptr(), points.as_ptr()) && self.points.len() == points.len() {
            return;
        }
        self.points = Arc::clone(points);
        self.hovered = None;
    }

    /// Returns the points.
    pub fn points(&self) -> &[PathPoint] {
        &self.points
    }

    /// Returns whether a point of the list is dragged or under the pointer.
    pub fn is_marked(&self, index: usize) -> bool {
        match self.machine.drag() {
            Some(drag) => self
                .points
                .get(index)
                .is_some_and(|point| (&point.owner, point.index) == (&drag.point.owner, drag.point.index)),
            None => self.hovered == Some(index),
        }
    }

    fn point_at(&self, at: Vec2) -> Option<usize> {
        let view = self.view.filter(|_| at.is_finite())?;
        let distance = |point: &PathPoint| Some(view.to_screen(point.place)?.distance(at.as_dvec2()));
        let near =
            self.points.iter().enumerate().filter_map(|(index, point)| Some((distance(point)?, index)));
        // Of points that cover each other, the one that is drawn last.
        let nearest =
            near.filter(|near| near.0 <= REACH).min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        nearest.map(|(_, index)| index)
    }

    /// Returns the position of the dragged point with the pointer at `at`; `None` where that is no position.
    fn put(&self, drag: &DraggedPoint, at: Vec2, modifiers: Modifiers) -> Option<DVec3> {
        let view = self.view?;
        let place = drag.point.place;
        let [from, to] = [drag.start, at].map(|at| at.as_dvec2());
        let by = if modifiers.shift {
            DVec3::Y * view.move_by(place, to - from)?.y
        } else if view.back.y.abs() < LEAST_SLOPE {
            view.move_by(place, to - from)?
        } else {
            view.on_plane(to, place, DVec3::Y) - view.on_plane(from, place, DVec3::Y)
        };
        let put = place + by;
        let put = if modifiers.ctrl { (put / SNAP).round() * SNAP } else { put };
        put.is_finite().then_some(put)
    }

    fn end(&mut self, event: &DragEvent<(), DraggedPoint>) -> InputFlow {
        self.answer = Some(match event {
            DragEvent::Dropped(_) => PointAnswer::Done,
            DragEvent::Cancelled(_) => PointAnswer::Cancelled,
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

impl ViewportTool for PathPointControl {
    fn place(&mut self, corner: Vec2) {
        self.corner = corner;
    }

    fn look(&mut self, view: GizmoView) {
        self.view = Some(view);
    }

    fn take_outcome(&mut self) -> Option<ToolOutcome> {
        Some(match self.answer.take()? {
            PointAnswer::Moved(point) => ToolOutcome::MovePoint(point),
            PointAnswer::Done => ToolOutcome::Done,
            PointAnswer::Cancelled => ToolOutcome::Cancelled,
        })
    }

    fn is_dragging(&self) -> bool {
        self.machine.drag().is_some()
    }
}

impl BaseControl for PathPointControl {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.machine.drag().is_some() || self.point_at(point - self.corner).is_some()
    }

    fn mouse_move(&mut self, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        let at = mouse.at - self.corner;
        match self.machine.drag() {
            Some(drag) => {
                if let Some(place) = self.put(drag, at, mouse.modifiers) {
                    self.answer = Some(PointAnswer::Moved(PathPoint { place, ..drag.point.clone() }));
                }
                InputFlow::Stop
            }
            None => {
                self.hovered = self.point_at(at);
                // A point covers the handles of the gizmo.
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
        let point = self.point_at(at).and_then(|point| self.points.get(point)).cloned();
        let begins = button == Button::Left && !mouse.modifiers.alt && self.machine.drag().is_none();
        match point.filter(|_| begins) {
            Some(point) => {
                self.machine.begin(DraggedPoint { point, start: at });
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
