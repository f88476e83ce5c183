//! The points of paths and lines of a scene as a control: each can be dragged.
//!
//! ```text
//! press           selects the point
//! drag            moves the point at its height
//! Shift + drag    moves it up and down
//! Ctrl + drag     snaps it to a quarter of a meter, on the axes that it moves along
//! Alt in a drag   moves a direction of a smooth line alone, so that the line gets a corner
//! Esc, right      cancels the drag
//! ```

use super::key::Modifiers;
use super::path_point::PathPoint;
use super::point_drag::{PointControl, PointSet};
use super::viewport_tools::tool::ToolOutcome;
use dragonfly_picture::gizmo::GizmoView;
use glam::{BVec3, DVec2, DVec3};
use std::sync::Arc;

/// Distance within which a point is under the pointer, points of the screen.
const REACH: f64 = 8.0;

/// Distance to which points snap, meters.
const SNAP: f64 = 0.25;

/// Sine of the angle above the ground from which on a drag follows the ground; nearer to it, the plane of the view.
const LEAST_SLOPE: f64 = 0.1;

/// The points of paths and lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPoints {
    points: Arc<[PathPoint]>,
}

/// The control of the points of paths and lines.
pub type PathPointControl = PointControl<PathPoints>;

impl PathPointControl {
    /// Sets the points. A drag in progress continues with the point that it drags.
    pub fn show_points(&mut self, points: &Arc<[PathPoint]>) {
        if !Arc::ptr_eq(&self.set().points, points) {
            self.replace(|set| set.points = Arc::clone(points));
        }
    }

    /// Returns the points.
    pub fn points(&self) -> &[PathPoint] {
        &self.set().points
    }

    /// Returns whether a point of the list is dragged or under the pointer.
    pub fn is_marked(&self, index: usize) -> bool {
        match self.dragged() {
            Some(drag) => self
                .set()
                .point(index)
                .is_some_and(|point| (&point.owner, point.index) == (&drag.owner, drag.index)),
            None => self.under_pointer() == Some(index),
        }
    }
}

impl PointSet for PathPoints {
    type Point = PathPoint;

    fn point_at(&self, view: &GizmoView, at: DVec2) -> Option<usize> {
        let distance = |point: &PathPoint| Some(view.to_screen(point.place)?.distance(at));
        let near =
            self.points.iter().enumerate().filter_map(|(index, point)| Some((distance(point)?, index)));
        // Of points that cover each other, the one that is drawn last.
        let nearest =
            near.filter(|near| near.0 <= REACH).min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        nearest.map(|(_, index)| index)
    }

    fn point(&self, index: usize) -> Option<&PathPoint> {
        self.points.get(index)
    }

    fn put(
        &self,
        view: &GizmoView,
        point: &PathPoint,
        [from, to]: [DVec2; 2],
        modifiers: Modifiers,
    ) -> Option<PathPoint> {
        let place = point.place;
        let level = BVec3::new(true, false, true);
        let (by, moved) = if modifiers.shift {
            (DVec3::Y * view.move_by(place, to - from)?.y, !level)
        } else if view.back.y.abs() < LEAST_SLOPE {
            (view.move_by(place, to - from)?, BVec3::TRUE)
        } else {
            (view.on_plane(to, place, DVec3::Y) - view.on_plane(from, place, DVec3::Y), level)
        };
        let put = place + by;
        // The other axes stay exactly as they are.
        let put = if modifiers.ctrl { DVec3::select(moved, (put / SNAP).round() * SNAP, place) } else { put };
        put.is_finite().then(|| PathPoint { place: put, alone: modifiers.alt, ..point.clone() })
    }

    fn pressed(point: &PathPoint) -> Option<ToolOutcome> {
        Some(ToolOutcome::SelectPoint(point.clone()))
    }

    fn request(point: PathPoint) -> ToolOutcome {
        ToolOutcome::MovePoint(point)
    }
}
