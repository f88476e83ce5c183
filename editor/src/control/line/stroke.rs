//! Strokes in the scene: where the pointer draws, how long a stroke is, and the curves that it becomes.

use dragonfly_anim::stage::line::fit;
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec2, DVec3};

/// Largest distance between a stroke and its curves, points on the screen.
const TOLERANCE: f64 = 1.5;

/// Least angle at which the ground is seen, as its sine: nearer to the horizon a pointer reaches too far.
const LEAST_SLOPE: f64 = 0.01;

/// Where lines are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineSurface {
    /// On the ground.
    #[default]
    Ground,
    /// In a plane that faces the viewer, at the depth of what is under the pointer when the button is pressed.
    View,
    /// On what is under the pointer.
    Surface,
    /// On what is under the pointer, so that the line moves with the bone at its start.
    Bone,
}

/// A line that was drawn, scene space.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnStroke {
    /// Control points of cubic Bézier curves, meters, 3 n + 1 of them.
    pub control: Vec<DVec3>,
    /// Its corners; empty for a line that was drawn freehand.
    pub corners: Vec<DVec3>,
    /// Where it was drawn.
    pub on: LineSurface,
    /// Meters that a point of the screen covers at its start.
    pub unit: f64,
}

/// How long a stroke is, and where it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeMeasure {
    /// Length, meters.
    pub length: f64,
    /// Direction of a straight line, degrees: on the ground as roles face, 0 along +z and 90 along +x; in the view 0 to the right and 90 up.
    pub angle: Option<f64>,
}

/// The plane on which is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DrawingPlane {
    pub(super) view: GizmoView,
    pub(super) surface: LineSurface,
    pub(super) pivot: DVec3,
    /// Height of the ground, meters.
    pub(super) ground: f64,
}

impl DrawingPlane {
    /// Returns the place under a position, points from the top left of the viewport; `None` where the plane is not in front of the viewer, such as the ground above the horizon.
    pub(super) fn place_at(&self, at: DVec2) -> Option<DVec3> {
        let (origin, direction) = self.view.ray(at);
        let (through, normal) = match self.surface {
            LineSurface::Ground => (DVec3::Y * self.ground, DVec3::Y),
            // A line that leaves a surface continues at the depth where it left it.
            LineSurface::View | LineSurface::Surface | LineSurface::Bone => (self.pivot, self.view.back),
        };
        let slope = direction.dot(normal);
        let along = (through - origin).dot(normal) / slope;
        let place = origin + direction * along;
        let place = match self.surface {
            LineSurface::Ground => place.with_y(self.ground),
            LineSurface::View | LineSurface::Surface | LineSurface::Bone => place,
        };
        (slope.abs() > LEAST_SLOPE && along > 0.0 && place.is_finite()).then_some(place)
    }

    /// Returns the curves of a stroke; `None` for one without length.
    pub(super) fn stroke(&self, mut points: Vec<DVec3>, has_corners: bool) -> Option<DrawnStroke> {
        points.dedup();
        let unit = self.view.units_per_point(*points.first()?)?;
        if points.len() < 2 || StrokeMeasure::of_length(&points).length <= unit {
            return None;
        }
        let (control, corners) = match has_corners {
            true => (straight_curves(&points), points),
            false => (fit(&points, TOLERANCE * unit), Vec::new()),
        };
        Some(DrawnStroke { control, corners, on: self.surface, unit })
    }
}

impl StrokeMeasure {
    /// Measures a line through points.
    pub(super) fn of_length(points: &[DVec3]) -> Self {
        let length = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        Self { length, angle: None }
    }

    /// Measures a straight line.
    pub(super) fn straight(from: DVec3, to: DVec3, plane: &DrawingPlane) -> Self {
        let by = to - from;
        let angle = match plane.surface {
            LineSurface::Ground => by.x.atan2(by.z),
            LineSurface::View | LineSurface::Surface | LineSurface::Bone => {
                by.dot(plane.view.up).atan2(by.dot(plane.view.right))
            }
        };
        Self { length: by.length(), angle: (by.length() > 0.0).then_some(angle.to_degrees()) }
    }
}

/// Returns the control points of straight curves through corners.
fn straight_curves(corners: &[DVec3]) -> Vec<DVec3> {
    let mut control = vec![corners[0]];
    for pair in corners.windows(2) {
        control.extend([pair[0].lerp(pair[1], 1.0 / 3.0), pair[0].lerp(pair[1], 2.0 / 3.0), pair[1]]);
    }
    control
}
