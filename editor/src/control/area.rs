//! The id and the rectangle of a control.

use glam::Vec2;

/// Identifies a control in its framework. The id of a removed control is never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ControlId {
    pub(super) slot: u32,
    pub(super) generation: u32,
}

impl ControlId {
    /// The root control: without function, as large as the window, and ancestor of all others.
    pub const ROOT: Self = Self { slot: 0, generation: 0 };
}

/// A rectangle, in points from the top left of the window, y down. A point on the left or upper edge is inside, a point
/// on the right or lower edge is not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Area {
    /// Top left.
    pub min: Vec2,
    /// Bottom right.
    pub max: Vec2,
}

impl Area {
    /// Returns the rectangle from corner to corner; an empty one, which contains no point, if a number is not finite or
    /// the corners are in the wrong order.
    pub fn new(min: Vec2, max: Vec2) -> Self {
        if min.is_finite() && max.is_finite() && min.cmple(max).all() {
            Self { min, max }
        } else {
            Self::default()
        }
    }

    /// Whether the point is inside.
    pub fn holds(&self, point: Vec2) -> bool {
        point.cmpge(self.min).all() && point.cmplt(self.max).all()
    }

    /// Whether all of `other` is inside. Of two equal rectangles each contains the other.
    pub fn contains(&self, other: &Self) -> bool {
        other.min.cmpge(self.min).all() && other.max.cmple(self.max).all()
    }

    /// Returns the area, square points.
    pub fn size(&self) -> f64 {
        let size = (self.max - self.min).as_dvec2();
        size.x * size.y
    }
}
