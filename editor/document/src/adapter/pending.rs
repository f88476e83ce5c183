//! Pending poses: shown, but in no key yet.
//!
//! With auto-key off, a changed pose is *pending*: it is part of the document and of undo and is shown at its time,
//! and it is in no key and in no saved file until the user keys it.

use super::kind::ChannelNumbers;
use crate::edit::target::{Property, SAME_TIME};
use dragonfly_anim::data::Transform;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// The pending pose of one bone, absolute, parent space. Each channel may be pending or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendingPose {
    /// The bone.
    pub bone: u32,
    values: [Option<ChannelNumbers>; 3],
}

impl PendingPose {
    /// Returns a pose of this bone with no pending channel.
    pub(crate) fn none(bone: u32) -> Self {
        Self { bone, values: [None; 3] }
    }

    /// Returns the same pose of another bone.
    pub(crate) fn of_bone(self, bone: u32) -> Self {
        Self { bone, ..self }
    }

    /// Returns the pending value of a channel; the fourth number of a vector is 0.
    pub fn get(&self, property: Property) -> Option<ChannelNumbers> {
        self.values[property as usize]
    }

    pub(crate) fn set(&mut self, property: Property, value: Option<ChannelNumbers>) {
        self.values[property as usize] = value;
    }

    /// Returns whether no channel is pending.
    pub(crate) fn is_empty(&self) -> bool {
        self.values == [None; 3]
    }

    /// Replaces the pending channels in the pose of its bone.
    pub fn put_on(&self, pose: &mut Transform) {
        let [translation, rotation, scale] = self.values;
        let three = |numbers: ChannelNumbers| Vec3::new(numbers[0], numbers[1], numbers[2]);
        pose.translation = translation.map_or(pose.translation, three);
        pose.rotation = rotation.map_or(pose.rotation, Quat::from_array);
        pose.scale = scale.map_or(pose.scale, three);
    }
}

/// The pending weight of a shape key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendingShape {
    /// Index of its mesh in the list of mesh instances of the model.
    pub instance: u32,
    /// Index of the shape key in the mesh.
    pub shape: u32,
    /// The weight.
    pub weight: f32,
}

/// The pending poses and weights of shape keys at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct PendingAt {
    /// Seconds.
    pub time: f32,
    /// In ascending order of bones, each with a pending channel.
    pub poses: Vec<PendingPose>,
    /// In ascending order of meshes and of shape keys.
    pub shapes: Vec<PendingShape>,
}

impl PendingAt {
    /// Returns nothing pending at a time.
    pub(crate) fn none(time: f32) -> Self {
        Self { time, poses: Vec::new(), shapes: Vec::new() }
    }

    /// Returns whether nothing is pending.
    pub(crate) fn is_empty(&self) -> bool {
        self.poses.is_empty() && self.shapes.is_empty()
    }

    /// Returns the number of bones and of meshes with something pending.
    pub(crate) fn count(&self) -> usize {
        self.poses.len() + self.shapes.chunk_by(|a, b| a.instance == b.instance).count()
    }

    /// Returns the pending weights of a mesh.
    pub fn shapes_of(&self, instance: u32) -> &[PendingShape] {
        let start = self.shapes.partition_point(|shape| shape.instance < instance);
        let end = self.shapes.partition_point(|shape| shape.instance <= instance);
        &self.shapes[start..end]
    }

    /// Replaces the weights of a mesh that are pending in `weights`.
    pub fn put_weights(&self, instance: u32, weights: &mut [f32]) {
        for pending in self.shapes_of(instance) {
            if let Some(weight) = weights.get_mut(pending.shape as usize) {
                *weight = pending.weight;
            }
        }
    }

    /// Sets the pending weight of a shape key; `None` removes it. Returns whether there was one.
    pub(crate) fn set_shape(&mut self, instance: u32, shape: u32, weight: Option<f32>) -> bool {
        let at = self.shapes.binary_search_by_key(&(instance, shape), |shape| (shape.instance, shape.shape));
        match (at, weight) {
            (Ok(at), Some(weight)) => self.shapes[at].weight = weight,
            (Ok(at), None) => drop(self.shapes.remove(at)),
            (Err(at), Some(weight)) => self.shapes.insert(at, PendingShape { instance, shape, weight }),
            (Err(_), None) => {}
        }
        at.is_ok()
    }

    /// Returns the pending pose of a bone.
    pub fn of(&self, bone: u32) -> Option<&PendingPose> {
        self.poses.binary_search_by_key(&bone, |pose| pose.bone).ok().map(|at| &self.poses[at])
    }

    /// Applies all of them to poses in bone order.
    pub fn put_on(&self, poses: &mut [Transform]) {
        for pending in &self.poses {
            if let Some(pose) = poses.get_mut(pending.bone as usize) {
                pending.put_on(pose);
            }
        }
    }

    /// Returns the entry of a bone, inserted where there is none.
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

    /// Merges the poses and weights of another; where both have a value, that of `other` wins.
    fn merge(&mut self, other: &Self) {
        for pose in &other.poses {
            let entry = self.entry(pose.bone);
            for (own, other) in entry.values.iter_mut().zip(pose.values) {
                *own = other.or(*own);
            }
        }
        for shape in &other.shapes {
            self.set_shape(shape.instance, shape.shape, Some(shape.weight));
        }
    }
}

/// All pending poses of a take, ascending in time.
pub type Pending = Vec<Arc<PendingAt>>;

/// Returns the index of the poses at `time`, or the index at which to insert them.
pub(crate) fn place_of(pending: &[Arc<PendingAt>], time: f32) -> Result<usize, usize> {
    let after = pending.partition_point(|at| at.time < time - SAME_TIME);
    match pending.get(after) {
        Some(at) if (at.time - time).abs() <= SAME_TIME => Ok(after),
        _ => Err(pending.partition_point(|at| at.time < time)),
    }
}

/// Returns the poses moved to the times that `to` returns, without those for which it returns `None`. Poses that come
/// to the same time are merged.
pub(crate) fn remapped(pending: &[Arc<PendingAt>], to: impl Fn(f32) -> Option<f32>) -> Pending {
    let mut moved: Vec<PendingAt> = pending
        .iter()
        .filter_map(|at| Some(PendingAt { time: to(at.time)?, ..PendingAt::clone(at) }))
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
