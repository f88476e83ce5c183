//! Small points in the viewport as a control: the one under the pointer can be dragged.
//!
//! A press on a point is a drag at once: the points are small, and a click does nothing. What the points are, where a drag
//! puts one and what is asked for then is the [`PointSet`].

use super::base::{BaseControl, InputFlow, Mouse};
use super::drag::{DragEvent, DragMachine};
use super::framework::ControlFramework;
use super::input::Button;
use super::key::{Key, Modifiers};
use super::viewport_tools::tool::{ToolOutcome, ViewportTool};
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec2, Vec2};
use std::fmt::Debug;

/// Points that can be dragged.
pub trait PointSet {
    /// A point of the set.
    type Point: Clone + Debug + PartialEq;

    /// Returns the index of the point that a press at `at` drags, points of the screen from the top left of the viewport.
    fn point_at(&self, view: &GizmoView, at: DVec2) -> Option<usize>;

    /// Returns a point of the set.
    fn point(&self, index: usize) -> Option<&Self::Point>;

    /// Returns `point` after the pointer went by `way` from its press, from and to; `None` where that is no position.
    fn put(
        &self,
        view: &GizmoView,
        point: &Self::Point,
        way: [DVec2; 2],
        modifiers: Modifiers,
    ) -> Option<Self::Point>;

    /// Returns the request that follows a press on a point, before it is dragged.
    fn pressed(point: &Self::Point) -> Option<ToolOutcome> {
        let _ = point;
        None
    }

    /// Returns the request to move a point of the document there.
    fn request(point: Self::Point) -> ToolOutcome;
}

/// A point that is dragged, and where the pointer was at its press.
#[derive(Clone, Debug, PartialEq)]
struct DraggedPoint<P> {
    point: P,
    start: Vec2,
}

/// The control of a set of points.
#[derive(Clone, Debug, PartialEq)]
pub struct PointControl<S: PointSet> {
    /// Top left of the viewport, points from that of the window.
    corner: Vec2,
    view: Option<GizmoView>,
    set: S,
    hovered: Option<usize>,
    machine: DragMachine<(), DraggedPoint<S::Point>>,
    outcome: Option<ToolOutcome>,
}

impl<S: PointSet + Default> Default for PointControl<S> {
    fn default() -> Self {
        Self {
            corner: Vec2::ZERO,
            view: None,
            set: S::default(),
            hovered: None,
            machine: DragMachine::default(),
            outcome: None,
        }
    }
}

impl<S: PointSet> PointControl<S> {
    /// Returns the points.
    pub fn set(&self) -> &S {
        &self.set
    }

    /// Returns what belongs to all points, to be changed; other points are set by [`replace`](Self::replace).
    pub(super) fn set_mut(&mut self) -> &mut S {
        &mut self.set
    }

    /// Changes the points. A drag in progress continues with the point that it drags.
    pub(super) fn replace(&mut self, change: impl FnOnce(&mut S)) {
        change(&mut self.set);
        self.hovered = None;
    }

    /// Returns the point that is dragged.
    pub(super) fn dragged(&self) -> Option<&S::Point> {
        self.machine.drag().map(|drag| &drag.point)
    }

    /// Returns the index of the point under the pointer; `None` during a drag too.
    pub(super) fn under_pointer(&self) -> Option<usize> {
        self.hovered.filter(|_| self.machine.drag().is_none())
    }

    fn point_at(&self, at: Vec2) -> Option<usize> {
        let view = self.view.filter(|_| at.is_finite())?;
        self.set.point_at(&view, at.as_dvec2())
    }

    fn end(&mut self, event: &DragEvent<(), DraggedPoint<S::Point>>) -> InputFlow {
        self.outcome = Some(match event {
            DragEvent::Dropped(_) => ToolOutcome::Done,
            DragEvent::Cancelled(_) => ToolOutcome::Cancelled,
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

impl<S: PointSet> ViewportTool for PointControl<S> {
    fn place(&mut self, corner: Vec2) {
        self.corner = corner;
    }

    fn look(&mut self, view: GizmoView) {
        self.view = Some(view);
    }

    fn take_outcome(&mut self) -> Option<ToolOutcome> {
        self.outcome.take()
    }

    fn is_dragging(&self) -> bool {
        self.machine.drag().is_some()
    }
}

impl<S: PointSet> BaseControl for PointControl<S> {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.machine.drag().is_some() || self.point_at(point - self.corner).is_some()
    }

    fn mouse_move(&mut self, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        let at = mouse.at - self.corner;
        let Some(drag) = self.machine.drag() else {
            self.hovered = self.point_at(at);
            // A point covers the handles of the gizmo.
            return if self.hovered.is_some() { InputFlow::Stop } else { InputFlow::ToParent };
        };
        let way = [drag.start, at].map(|at| at.as_dvec2());
        let put = self.view.and_then(|view| self.set.put(&view, &drag.point, way, mouse.modifiers));
        if let Some(point) = put {
            self.outcome = Some(S::request(point));
        }
        InputFlow::Stop
    }

    fn mouse_leave(&mut self, _framework: &mut ControlFramework) {
        self.hovered = None;
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        if button == Button::Right {
            return self.cancel();
        }
        let at = mouse.at - self.corner;
        let begins = button == Button::Left && !mouse.modifiers.alt && self.machine.drag().is_none();
        let point = self.point_at(at).filter(|_| begins).and_then(|index| self.set.point(index)).cloned();
        match point {
            Some(point) => {
                self.outcome = S::pressed(&point);
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
