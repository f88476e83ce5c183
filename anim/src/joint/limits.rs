//! The limits of a whole skeleton.

use super::JointLimit;
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::sample::rest_pose;

/// Which bones have limits. A bone without one is free.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointLimits {
    /// Ascending by bone, each once.
    limits: Vec<(BoneIndex, JointLimit)>,
}

/// What [`JointLimits::apply`] had to do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimitReport {
    /// Bones that were not within their limits.
    pub clamped: usize,
    /// The one that was furthest out, the first of several; `None` when all were within.
    pub worst: Option<BoneIndex>,
    /// How far that one was out, radians.
    pub by: f32,
}

impl JointLimits {
    /// No limits.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gives `bone` a limit in the place of what it had, which is returned; `None` takes it away.
    pub fn set(&mut self, bone: BoneIndex, limit: impl Into<Option<JointLimit>>) -> Option<JointLimit> {
        let place = self.limits.binary_search_by_key(&bone, |&(bone, _)| bone);
        match (place, limit.into()) {
            (Ok(place), Some(limit)) => Some(std::mem::replace(&mut self.limits[place].1, limit)),
            (Ok(place), None) => Some(self.limits.remove(place).1),
            (Err(place), Some(limit)) => {
                self.limits.insert(place, (bone, limit));
                None
            }
            (Err(_), None) => None,
        }
    }

    /// The limit of a bone.
    pub fn get(&self, bone: BoneIndex) -> Option<&JointLimit> {
        let place = self.limits.binary_search_by_key(&bone, |&(bone, _)| bone).ok()?;
        Some(&self.limits[place].1)
    }

    /// All of them, ascending by bone.
    pub fn iter(&self) -> impl Iterator<Item = (BoneIndex, &JointLimit)> {
        self.limits.iter().map(|(bone, limit)| (*bone, limit))
    }

    /// Number of bones with a limit.
    pub fn len(&self) -> usize {
        self.limits.len()
    }

    /// Are all bones free?
    pub fn is_empty(&self) -> bool {
        self.limits.is_empty()
    }

    /// Holds `poses` (relative to the parents) within the limits, each relative to its bone's rest pose, and says how many
    /// were not.
    ///
    /// `by[bone]` becomes the angle (radians) by which a bone was turned back: 0 for one that was within its limits or
    /// has none. It may be shorter than the skeleton, or empty. Translations, scales, and rotations within the limits
    /// keep every bit. A limit of a bone that is not there has no effect. Allocates nothing.
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
