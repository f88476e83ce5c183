//! The limits of a whole skeleton.

use super::JointLimit;
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::sample::rest_pose;

/// The bones with limits. A bone without one is free.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointLimits {
    /// Ascending by bone, each once.
    limits: Vec<(BoneIndex, JointLimit)>,
}

/// Result of [`JointLimits::apply`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimitReport {
    /// Number of bones that were outside their limits.
    pub clamped: usize,
    /// The bone that was furthest outside, the first of several; `None` when all were within.
    pub worst: Option<BoneIndex>,
    /// Angle by which that bone was outside, in radians.
    pub by: f32,
}

impl JointLimits {
    /// Creates an empty set of limits.
    pub fn new() -> Self {
        Self::default()
    }

    /// Replaces the limit of `bone` and returns the old one; `None` removes it.
    pub fn set(&mut self, bone: BoneIndex, limit: impl Into<Option<JointLimit>>) -> Option<JointLimit> {
        let index = self.limits.binary_search_by_key(&bone, |&(bone, _)| bone);
        match (index, limit.into()) {
            (Ok(index), Some(limit)) => Some(std::mem::replace(&mut self.limits[index].1, limit)),
            (Ok(index), None) => Some(self.limits.remove(index).1),
            (Err(index), Some(limit)) => {
                self.limits.insert(index, (bone, limit));
                None
            }
            (Err(_), None) => None,
        }
    }

    /// Returns the limit of a bone.
    pub fn get(&self, bone: BoneIndex) -> Option<&JointLimit> {
        let index = self.limits.binary_search_by_key(&bone, |&(bone, _)| bone).ok()?;
        Some(&self.limits[index].1)
    }

    /// Iterates over all limits, ascending by bone.
    pub fn iter(&self) -> impl Iterator<Item = (BoneIndex, &JointLimit)> {
        self.limits.iter().map(|(bone, limit)| (*bone, limit))
    }

    /// Returns the number of bones with a limit.
    pub fn len(&self) -> usize {
        self.limits.len()
    }

    /// Returns whether all bones are free.
    pub fn is_empty(&self) -> bool {
        self.limits.is_empty()
    }

    /// Clamps `poses` (relative to the parents) to the limits, each relative to its bone's rest pose, and returns how
    /// many were outside.
    ///
    /// `by[bone]` becomes the angle (radians) by which a bone was turned: 0 for one that was within its limits or has
    /// none. It may be shorter than the skeleton, or empty. Translations, scales, and rotations within the limits are
    /// unchanged bit for bit. A limit of a missing bone has no effect. Allocates nothing.
    pub fn apply(&self, skeleton: &Skeleton, poses: &mut [Transform], by: &mut [f32]) -> LimitReport {
        by.fill(0.0);
        let mut report = LimitReport::default();
        for (bone, limit) in &self.limits {
            let index = *bone as usize;
            let (Some(rest), Some(pose)) = (skeleton.bones.get(index), poses.get_mut(index)) else {
                continue;
            };
            let clamped = limit.clamp(pose.rotation, rest_pose(rest).rotation);
            pose.rotation = clamped.rotation;
            if let Some(by) = by.get_mut(index) {
                *by = clamped.by;
            }
            if clamped.by > 0.0 {
                report.clamped += 1;
            }
            if clamped.by > report.by {
                (report.worst, report.by) = (Some(*bone), clamped.by);
            }
        }
        report
    }
}
