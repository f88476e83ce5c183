//! Positions that a script names: a point, a thing, a bone of a thing.

use crate::data::BoneIndex;
use glam::DVec3;

/// A position that may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StageSpot {
    /// A point, meters.
    Point(DVec3),
    /// The position of a thing.
    Thing(usize),
    /// A bone of a thing.
    Bone(usize, BoneIndex),
}

impl StageSpot {
    /// Returns the thing that it depends on.
    pub(super) fn thing(self) -> Option<usize> {
        match self {
            Self::Point(_) => None,
            Self::Thing(thing) | Self::Bone(thing, _) => Some(thing),
        }
    }
}
