//! Boxes and lassos, and the bones in them.
//!
//! A bone is inside when its joint is, or the middle of its shape: what one sees of a bone is around its middle, and a joint
//! alone is what a small bone is. (Touching with an edge does not count, so a long bone that crosses a box is not caught by
//! chance.) Bones behind the eye are never inside.

use dragonfly_anim::data::BoneIndex;
use glam::{Vec2, Vec3};

/// Points of a lasso are this far apart at least, points of the screen.
const SPACING: f32 = 2.0;
/// Points of a lasso at most; then every second is forgotten.
const MOST: usize = 2048;

/// A part of the picture, in points from its top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region<'a> {
    /// Between two corners, any two.
    Box(Vec2, Vec2),
    /// Within a line that is closed from its end to its beginning; where it crosses itself, what it runs around any number
    /// of times.
    Lasso(&'a [Vec2]),
}

/// A [`Region`] that can be sent elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub enum OwnedRegion {
    /// Between two corners.
    Box(Vec2, Vec2),
    /// Within a line.
    Lasso(Vec<Vec2>),
}

impl OwnedRegion {
    /// What it holds.
    pub fn region(&self) -> Region<'_> {
        match self {
            Self::Box(a, b) => Region::Box(*a, *b),
            Self::Lasso(line) => Region::Lasso(line),
        }
    }
}

impl Region<'_> {
    /// The same, to be sent elsewhere.
    pub fn to_owned(&self) -> OwnedRegion {
        match *self {
            Self::Box(a, b) => OwnedRegion::Box(a, b),
            Self::Lasso(line) => OwnedRegion::Lasso(line.to_vec()),
        }
    }

    /// Does it hold this point?
    pub fn holds(&self, point: Vec2) -> bool {
        match *self {
            Region::Box(a, b) => point.cmpge(a.min(b)).all() && point.cmple(a.max(b)).all(),
            Region::Lasso(line) => winding(line, point) != 0,
        }
    }
}

/// How often a closed line runs around a point.
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

/// A lasso while it is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lasso {
    line: Vec<Vec2>,
    /// Least distance of two points; doubles when there are too many.
    spacing: f32,
}

impl Lasso {
    /// Begins here.
    pub fn begin(&mut self, at: Vec2) {
        self.line.clear();
        self.spacing = SPACING;
        self.push(at);
    }

    /// The pointer is there now.
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

    /// What it holds.
    pub fn region(&self) -> Region<'_> {
        Region::Lasso(&self.line)
    }
}

/// Writes the bones inside of a region to `out`, each once, in the order of the skeleton.
///
/// `shapes` are a bone, where its shape begins (its joint) and where that ends, scene space; a bone may have several.
/// `to_screen` says where a place appears, `None` behind the eye.
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
