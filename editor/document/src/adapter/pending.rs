//! Poses that are shown but held by no key yet.
//!
//! With auto-key off a changed pose is *pending*: it is part of the document and of undo, it is seen at its time, and it
//! is not in the keys nor in a saved file until somebody keys it.

use super::super::edit::{Property, SAME_TIME};
use super::kind::ChannelNumbers;
use dragonfly_anim::data::Transform;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// The pending pose of one bone: absolute, parent space; `None` for what is not pending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendingPose {
    /// Which bone.
    pub bone: u32,
    values: [Option<ChannelNumbers>; 3],
}

impl PendingPose {
    /// Nothing of this bone.
    pub(crate) fn none(bone: u32) -> Self {
        Self { bone, values: [None; 3] }
    }

    /// What is pending of a channel; a vector's fourth number is 0.
    pub fn get(&self, property: Property) -> Option<ChannelNumbers> {
        self.values[property as usize]
    }

    pub(crate) fn set(&mut self, property: Property, value: Option<ChannelNumbers>) {
        self.values[property as usize] = value;
    }

    /// Is nothing pending?
    pub(crate) fn is_empty(&self) -> bool {
        self.values == [None; 3]
    }

    /// Puts it over the pose of its bone.
    pub fn put_on(&self, pose: &mut Transform) {
        let [translation, rotation, scale] = self.values;
        let three = |numbers: ChannelNumbers| Vec3::new(numbers[0], numbers[1], numbers[2]);
        pose.translation = translation.map_or(pose.translation, three);
        pose.rotation = rotation.map_or(pose.rotation, Quat::from_array);
        pose.scale = scale.map_or(pose.scale, three);
    }
}

/// The pending poses at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct PendingAt {
    /// Seconds.
    pub time: f32,
    /// Ascending bones, none without anything.
    pub poses: Vec<PendingPose>,
}

impl PendingAt {
    /// What is pending of a bone.
    pub fn of(&self, bone: u32) -> Option<&PendingPose> {
        self.poses.binary_search_by_key(&bone, |pose| pose.bone).ok().map(|at| &self.poses[at])
    }

    /// Puts all of it over poses in bone order.
    pub fn put_on(&self, poses: &mut [Transform]) {
        for pending in &self.poses {
            if let Some(pose) = poses.get_mut(pending.bone as usize) {
                pending.put_on(pose);
            }
        }
    }

    /// The entry of a bone, made where there is none.
    pub(crate) fn entry(&mut self, bone: u32) -> &mut PendingPose {
        let at = match self.poses.binary_search_by_key(&bone, |pose| pose.bone) {
            Ok(at) => at,
            Err(at) => {
                self.poses.insert(at, PendingPose::none(bone));
                at
            }
        };
        &mut self.poses[at]
    }

    /// Takes over what another one has; where both have something, the other's counts.
    fn merge(&mut self, other: &Self) {
        for pose in &other.poses {
            let entry = self.entry(pose.bone);
            for (own, other) in entry.values.iter_mut().zip(pose.values) {
                *own = other.or(*own);
            }
        }
    }
}

/// All pending poses of a take, ascending in time, no two at the same one.
pub type Pending = Vec<Arc<PendingAt>>;

/// Where in the list the poses at `time` are; else where they would come.
pub(crate) fn place_of(pending: &[Arc<PendingAt>], time: f32) -> Result<usize, usize> {
    let after = pending.partition_point(|at| at.time < time - SAME_TIME);
    match pending.get(after) {
        Some(at) if (at.time - time).abs() <= SAME_TIME => Ok(after),
        _ => Err(pending.partition_point(|at| at.time < time)),
    }
}

/// The same poses at other times, `None` for those that go; what comes to lie at one time is put together.
pub(crate) fn remapped(pending: &[Arc<PendingAt>], to: impl Fn(f32) -> Option<f32>) -> Pending {
    let mut moved: Vec<PendingAt> = pending
        .iter()
        .filter_map(|at| Some(PendingAt { time: to(at.time)?, poses: at.poses.clone() }))
        .collect();
    moved.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut found: Vec<PendingAt> = Vec::with_capacity(moved.len());
    for at in moved {
        match found.last_mut() {
            Some(last) if at.time - last.time <= SAME_TIME => last.merge(&at),
            _ => found.push(at),
        }
    }
    found.into_iter().map(Arc::new).collect()
}
