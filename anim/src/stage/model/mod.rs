//! Models prepared for the stage: once a model, shared by all scripts and threads.

mod contacts;
mod foot;
mod shapes;
mod stride;
mod take;

pub use contacts::FootContact;
pub use foot::StageFoot;
pub use shapes::StageShapes;
pub use take::StageTake;

use crate::contact::{feet_by_name, limb_of};
use crate::data::{BoneIndex, ModelData, Skeleton};
use crate::fast::{FastTwoBone, Rig};
use crate::retarget::normalized_name;
use crate::sample::rest_pose;
use foot::hips_above;
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// A model with everything that the stage needs of it.
#[derive(Clone, Debug)]
pub struct StageModel {
    data: Arc<ModelData>,
    rig: Rig,
    feet: Vec<StageFoot>,
    takes: Vec<StageTake>,
    shapes: StageShapes,
    head: Option<BoneIndex>,
    /// The bone above all feet.
    hips: Option<BoneIndex>,
    /// Mean length of the legs in the rest pose, lengths of the model; 1 without feet.
    leg: f32,
    /// Rotation of each bone in the rest pose, to-root space.
    rest_rotations: Vec<Quat>,
}

impl StageModel {
    /// Prepares `model`. Takes time in proportion to the keys of all takes.
    ///
    /// A take whose root or hips end elsewhere than they start moves the role ([`crate::motion`]). One that walks on the spot gets the
    /// stride that its feet show. Feet are found by their names ([`feet_by_name`]).
    pub fn new(model: Arc<ModelData>) -> Self {
        let skeleton = &model.animation.skeleton;
        let feet: Vec<StageFoot> = feet_by_name(skeleton)
            .into_iter()
            .filter_map(|bone| {
                let limb = limb_of(skeleton, bone)?;
                Some(StageFoot { bone, limb: FastTwoBone::new(limb.root, limb.middle, limb.end) })
            })
            .collect();
        let rest = rest_matrices(skeleton);
        let leg = leg_length(&feet, &rest);
        let takes =
            model.animation.takes.iter().map(|take| StageTake::new(skeleton, take, &feet, leg)).collect();
        let rest_rotations = rest.iter().map(|matrix| matrix.to_scale_rotation_translation().1).collect();
        let head = skeleton.bones.iter().position(|bone| normalized_name(&bone.name) == "head");
        let rig = Rig::new(skeleton);
        let hips = hips_above(skeleton, &feet);
        let head = head.map(|bone| bone as BoneIndex);
        let shapes = StageShapes::new(&model);
        Self { data: Arc::clone(&model), rig, feet, takes, shapes, head, hips, leg, rest_rotations }
    }

    /// Returns the model.
    pub fn data(&self) -> &Arc<ModelData> {
        &self.data
    }

    /// Returns the skeleton.
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        &self.data.animation.skeleton
    }

    /// Returns the skeleton for the fast path.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Returns the takes, in the order of the model.
    pub fn takes(&self) -> &[StageTake] {
        &self.takes
    }

    /// Returns the position of the first take called `name`.
    pub fn take_called(&self, name: &str) -> Option<usize> {
        self.takes.iter().position(|take| take.name() == name)
    }

    /// Returns the shape keys.
    pub fn shapes(&self) -> &StageShapes {
        &self.shapes
    }

    /// Returns the feet.
    pub fn feet(&self) -> &[StageFoot] {
        &self.feet
    }

    /// Returns the bone called head, which looks at things; `None` where there is none.
    pub fn head(&self) -> Option<BoneIndex> {
        self.head
    }

    pub(in crate::stage) fn hips(&self) -> Option<BoneIndex> {
        self.hips
    }

    /// Returns the mean length of the legs, lengths of the model.
    pub(in crate::stage) fn leg(&self) -> f32 {
        self.leg
    }

    /// Returns the axis of a bone that points along `direction` of to-root space in the rest pose.
    pub(in crate::stage) fn bone_axis(&self, bone: BoneIndex, direction: Vec3) -> Vec3 {
        self.rest_rotations.get(bone as usize).map_or(direction, |rotation| rotation.inverse() * direction)
    }
}

/// Returns to-root of every bone in the rest pose.
fn rest_matrices(skeleton: &Skeleton) -> Vec<Mat4> {
    let mut matrices: Vec<Mat4> = Vec::with_capacity(skeleton.len());
    for bone in &skeleton.bones {
        let parent =
            bone.parent.and_then(|parent| matrices.get(parent as usize)).copied().unwrap_or(Mat4::IDENTITY);
        let matrix = parent * rest_pose(bone).to_matrix();
        matrices.push(if matrix.is_finite() { matrix } else { parent });
    }
    matrices
}

/// Returns the mean length of the legs in the rest pose; 1 without feet.
fn leg_length(feet: &[StageFoot], rest: &[Mat4]) -> f32 {
    let at = |bone: BoneIndex| rest[bone as usize].w_axis.truncate();
    let length = |foot: &StageFoot| {
        let limb = &foot.limb;
        at(limb.root).distance(at(limb.middle)) + at(limb.middle).distance(at(limb.end))
    };
    let mean = feet.iter().map(length).sum::<f32>() / feet.len().max(1) as f32;
    if mean.is_finite() && mean > 0.0 { mean } else { 1.0 }
}
