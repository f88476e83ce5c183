//! Points that can be dragged in the viewport: keys of a motion path, points of paths and lines of a scene.

use glam::{DVec3, Vec3};
use std::sync::Arc;

/// A key on the motion path of a bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathKey {
    /// Seconds.
    pub time: f32,
    /// Position of the joint at that time, scene space.
    pub place: Vec3,
}

/// What a point belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathPointOwner {
    /// A path of the cast, by its id.
    Path(Arc<str>),
    /// A line of the project, by its name in the editor.
    Line(Arc<str>),
}

/// A point that can be dragged.
#[derive(Clone, Debug, PartialEq)]
pub struct PathPoint {
    /// What it belongs to.
    pub owner: PathPointOwner,
    /// Its number there, from 0.
    pub index: usize,
    /// Its position, scene space.
    pub place: DVec3,
    /// For a point that gives a curve its direction: the point of the line that it belongs to.
    pub arm: Option<DVec3>,
    /// Whether it is moved without the one that gives the curve its direction on the other side of that point.
    pub alone: bool,
}
