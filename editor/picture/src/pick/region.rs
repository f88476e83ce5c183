//! Box and lasso selection of bones.
//!
//! A bone is inside a region if its joint or the center of its shape is: the visible part of a bone is around its
//! center, and a small bone is only its joint. (Touching an edge does not count, so a long bone that crosses a box is
//! not selected by accident.) Bones behind the camera are never inside.

use dragonfly_anim::data::BoneIndex;
use glam::{Vec2, Vec3};

/// Smallest distance between the points of a lasso, points of the screen.
const SPACING: f32 = 2.0;
/// Largest number of points of a lasso; beyond it every second point is dropped.
const MOST: usize = 2048;

/// A region of the viewport, in points from its top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region<'a> {
    /// Rectangle between any two opposite corners.
    Box(Vec2, Vec2),
    /// Area enclosed by a line that is closed from its end to its start; where it crosses itself, every area it winds
    /// around.
    Lasso(&'a [Vec2]),
}

/// An owned [`Region`], for sending to another thread.
#[derive(Clone, Debug, PartialEq)]
pub enum OwnedRegion {
    /// Rectangle between two opposite corners.
    Box(Vec2, Vec2),
    /// Area enclosed by a line.
    Lasso(Vec<Vec2>),
}

impl OwnedRegion {
    /// The region.
    pub fn region(&self) -> Region<'_> {
        match self {
            Self::Box(a, b) => Region::Box(*a, *b),
            Self::Lasso(line) => Region::Lasso(line),
        }
    }
}

impl Region<'_> {
    /// An owned copy.
    pub fn to_owned(&self) -> OwnedRegion {
        match *self {
            Self::Box(a, b) => OwnedRegion::Box(a, b),
            Self::Lasso(line) => OwnedRegion::Lasso(line.to_vec()),
        }
    }

    /// Returns whether the region contains a point.
    pub fn holds(&self, point: Vec2) -> bool {
        match *self {
            Region::Box(a, b) => point.cmpge(a.min(b)).all() && point.cmple(a.max(b)).all(),
            Region::Lasso(line) => winding(line, point) != 0,
        }
    }
}

/// Winding number of a closed line around a point.
fn winding(line: &[Vec2], point: Vec2) -> i32 {
    let mut count = 0;
    for (index, &from) in line.iter().enumerate() {
        let to = line[(index + 1) % line.len()];
        let side = (to - from).perp_dot(point - from);
        if from.y <= point.y && to.y > point.y && side > 0.0 {
            count += 1;
        } else if from.y > point.y && to.y <= point.y && side < 0.0 {
            count -= 1;
        }
    }
    count
}

/// A lasso being drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lasso {
    line: Vec<Vec2>,
    /// Smallest distance between two points; doubles when there are too many.
    spacing: f32,
}

impl Lasso {
    /// Starts a lasso at `at`.
    pub fn begin(&mut self, at: Vec2) {
        self.line.clear();
        self.spacing = SPACING;
        self.push(at);
    }

    /// Adds the position of the pointer.
    pub fn push(&mut self, at: Vec2) {
        if !at.is_finite() || self.line.last().is_some_and(|last| last.distance(at) < self.spacing) {
            return;
        }
        if self.line.len() == MOST {
            let mut index = 0;
            self.line.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.spacing *= 2.0;
        }
        self.line.push(at);
    }

    /// The region it encloses.
    pub fn region(&self) -> Region<'_> {
        Region::Lasso(&self.line)
    }
}

/// Writes the bones inside a region to `out`, each once, in the order of the skeleton.
///
/// `shapes` are a bone with the start of its shape (its joint) and the end, scene space; a bone may have several.
/// `to_screen` returns the position on the screen, or `None` behind the camera.
pub fn bones_in_region(
    region: &Region<'_>,
    shapes: impl Iterator<Item = (BoneIndex, Vec3, Vec3)>,
    to_screen: impl Fn(Vec3) -> Option<Vec2>,
    out: &mut Vec<BoneIndex>,
) {
    out.clear();
    let holds = |place: Vec3| to_screen(place).is_some_and(|at| region.holds(at));
    out.extend(shapes.filter(|&(_, from, to)| holds(from) || holds((from + to) / 2.0)).map(|shape| shape.0));
    out.sort_unstable();
    out.dedup();
}
