//! From a take and a time to matrices ready for the GPU (thesis §3.1.4).
//!
//! [`Animation`] keeps its results, so that playing allocates nothing; the formulas themselves are free functions
//! ([`to_root`](to_root()), [`final_poses`]) for callers that store the poses themselves.

mod formula;

pub(crate) use formula::child_to_root;
pub use formula::{final_pose, final_poses, to_parent, to_root};

use crate::data::{AnimationData, ModelData, Skin, Take, Transform};
use crate::sample::sample_take;
use glam::Mat4;
use std::sync::Arc;

/// A skeleton, its takes, and the most recently computed poses.
///
/// ```
/// use dragonfly_anim::animation::Animation;
/// # let model = dragonfly_anim::data::ModelData::default();
/// let mut animation = Animation::of(&model);
/// animation.to_root_bone_poses(Some(0), 0.35);
/// for skin in &model.skins {
///     let ready_for_the_gpu: &[glam::Mat4] = animation.skin_poses(skin);
/// }
/// ```
#[derive(Debug)]
pub struct Animation {
    data: AnimationData,
    /// Poses relative to the parents.
    poses: Vec<Transform>,
    /// Bone space → scene space, one matrix per bone.
    to_root: Vec<Mat4>,
    /// Result of the most recent method that fills the output.
    output: Vec<Mat4>,
}

impl Animation {
    /// Creates an animation of `data`, in the rest pose.
    pub fn new(data: AnimationData) -> Self {
        let bones = data.skeleton.len();
        let mut animation = Self {
            data,
            poses: vec![Transform::IDENTITY; bones],
            to_root: vec![Mat4::IDENTITY; bones],
            output: Vec::with_capacity(bones),
        };
        animation.to_root_bone_poses(None, 0.0);
        animation
    }

    /// Creates an animation of `model`, with capacity for the largest of its skins.
    pub fn of(model: &ModelData) -> Self {
        let mut animation = Self::new(model.animation.clone());
        let largest = model.skins.iter().map(|skin| skin.bones.len()).max().unwrap_or(0);
        animation.output.reserve(largest.saturating_sub(animation.output.len()));
        animation
    }

    /// Fills the output with the bind pose of each bone, its offset: bind space → bone space (the identity where it is
    /// not finite).
    #[doc(alias = "inverse bind matrices")]
    pub fn bind_bone_poses(&mut self) -> &[Mat4] {
        self.output.clear();
        self.output.extend(
            self.data
                .skeleton
                .bones
                .iter()
                .map(|bone| if bone.offset.is_finite() { bone.offset } else { Mat4::IDENTITY }),
        );
        &self.output
    }

    /// Fills the output with `to_root` of each bone at `time` seconds: bone space → scene space.
    ///
    /// `take` is a position in [`AnimationData::takes`]; `None`, or a position past the end, is the rest pose. The time
    /// is clamped to the keys; see [`crate::sample::loop_time`] to repeat.
    pub fn to_root_bone_poses(&mut self, take: Option<usize>, time: f32) -> &[Mat4] {
        let take = take.and_then(|take| self.data.takes.get(take));
        sample_take(take.map(Arc::as_ref), &self.data.skeleton, time, &mut self.poses);
        self.chain()
    }

    /// As [`Self::to_root_bone_poses`], for a take that is not among the animation's own, but has the same skeleton.
    pub fn to_root_bone_poses_of(&mut self, take: &Take, time: f32) -> &[Mat4] {
        sample_take(Some(take), &self.data.skeleton, time, &mut self.poses);
        self.chain()
    }

    /// Lets `change` alter the most recent poses (relative to the parents), then fills the output with `to_root` of
    /// each bone: bone space → scene space.
    pub fn to_root_bone_poses_with(&mut self, change: impl FnOnce(&mut [Transform])) -> &[Mat4] {
        change(&mut self.poses);
        self.chain()
    }

    /// Fills the output with the final pose of each bone at `time` seconds: bind space → scene space, the complete
    /// computation, with each bone's own offset.
    ///
    /// Correct for a model with one skin; where skins give a bone different offsets, use [`Self::skin_poses`].
    pub fn final_bone_poses(&mut self, take: Option<usize>, time: f32) -> &[Mat4] {
        self.to_root_bone_poses(take, time);
        self.output.clear();
        let bones = &self.data.skeleton.bones;
        self.output
            .extend(self.to_root.iter().zip(bones).map(|(&to_root, bone)| final_pose(to_root, bone.offset)));
        &self.output
    }

    /// Fills the output with the final pose of each joint of `skin`, in the skin's order, from the most recent
    /// `to_root` poses.
    #[doc(alias = "skinning matrices")]
    pub fn skin_poses(&mut self, skin: &Skin) -> &[Mat4] {
        self.output.clear();
        self.output.resize(skin.bones.len(), Mat4::IDENTITY);
        final_poses(skin, &self.to_root, &mut self.output);
        &self.output
    }

    /// Returns the output: the result of the most recent method that filled it.
    pub fn output(&self) -> &[Mat4] {
        &self.output
    }

    /// Returns the most recent `to_root` poses: bone space → scene space, in bone order.
    pub fn to_root(&self) -> &[Mat4] {
        &self.to_root
    }

    /// Returns the most recent poses, each relative to its parent.
    pub fn poses(&self) -> &[Transform] {
        &self.poses
    }

    /// Returns the skeleton and the takes.
    pub fn data(&self) -> &AnimationData {
        &self.data
    }

    /// Replaces take number `index` by `take`, and returns the old one; `None` past the end.
    ///
    /// The most recent poses stay as they are.
    pub fn replace_take(&mut self, index: usize, take: Arc<Take>) -> Option<Arc<Take>> {
        self.data.takes.get_mut(index).map(|old| std::mem::replace(old, take))
    }

    /// Computes `to_root` from the poses and copies it to the output.
    fn chain(&mut self) -> &[Mat4] {
        to_root(&self.data.skeleton, &self.poses, &mut self.to_root);
        self.output.clear();
        self.output.extend_from_slice(&self.to_root);
        &self.output
    }
}
