//! The places of the things that have the gizmo, as the poses of bones without parents.

use dragonfly_anim::data::{Bone, Skeleton, Transform};
use dragonfly_picture::gizmo::PosedSkeleton;
use glam::Mat4;

/// A bone for each thing of a scene. It is kept, so that a scene that plays allocates nothing; only bones that were set have their places.
#[derive(Clone, Debug)]
pub struct ThingPoses {
    skeleton: Skeleton,
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
}

impl Default for ThingPoses {
    fn default() -> Self {
        Self { skeleton: Skeleton { bones: Vec::new() }, poses: Vec::new(), to_root: Vec::new() }
    }
}

impl ThingPoses {
    /// Adapts to the number of things.
    pub fn resize(&mut self, things: usize) {
        self.skeleton.bones.resize(things, Bone::root(""));
        self.poses.resize(things, Transform::IDENTITY);
        self.to_root.resize(things, Mat4::IDENTITY);
    }

    /// Puts a thing to a place.
    pub fn set(&mut self, thing: usize, place: Transform) {
        if let Some(bone) = self.skeleton.bones.get_mut(thing) {
            bone.rest = place;
            self.poses[thing] = place;
            self.to_root[thing] = place.to_matrix();
        }
    }

    /// Returns the bones.
    pub fn posed(&self) -> PosedSkeleton<'_> {
        PosedSkeleton { skeleton: &self.skeleton, poses: &self.poses, to_root: &self.to_root }
    }
}
