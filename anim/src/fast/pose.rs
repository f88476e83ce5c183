//! A pose as a structure of arrays: eight bones per block, each coordinate of the eight contiguous.
//!
//! ```text
//! block b, lane l = bone 8 b + l
//!
//! rotation     x x x x x x x x | y … | z … | w …      128 bytes
//! translation  x x x x x x x x | y … | z …             96 bytes
//! scale        x x x x x x x x | y … | z …             96 bytes
//! ```
//!
//! A block is five cache lines. One instruction then works on the same coordinate of eight bones. Lanes past the last bone contain the identity.

use super::simd::LANES;
use crate::data::Transform;
use glam::{Quat, Vec3};

/// The poses of eight bones, each relative to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct PoseBlock {
    /// Unit quaternions: x, y, z, w of eight bones each.
    pub rotation: [[f32; LANES]; 4],
    /// Meters: x, y, z of eight bones each.
    pub translation: [[f32; LANES]; 3],
    /// Factors: x, y, z of eight bones each.
    pub scale: [[f32; LANES]; 3],
}

impl PoseBlock {
    /// Eight bones with the identity.
    pub const IDENTITY: Self = Self {
        rotation: [[0.0; LANES], [0.0; LANES], [0.0; LANES], [1.0; LANES]],
        translation: [[0.0; LANES]; 3],
        scale: [[1.0; LANES]; 3],
    };

    /// Returns the bone in `lane`; lanes repeat from 8 on.
    pub fn get(&self, lane: usize) -> Transform {
        let lane = lane % LANES;
        let three = |rows: &[[f32; LANES]; 3]| Vec3::new(rows[0][lane], rows[1][lane], rows[2][lane]);
        let [x, y, z, w] = &self.rotation;
        Transform {
            translation: three(&self.translation),
            rotation: Quat::from_xyzw(x[lane], y[lane], z[lane], w[lane]),
            scale: three(&self.scale),
        }
    }

    /// Sets `lane` to `pose`; lanes repeat from 8 on.
    pub fn set(&mut self, lane: usize, pose: Transform) {
        let lane = lane % LANES;
        for (row, value) in self.rotation.iter_mut().zip(pose.rotation.to_array()) {
            row[lane] = value;
        }
        for (row, value) in self.translation.iter_mut().zip(pose.translation.to_array()) {
            row[lane] = value;
        }
        for (row, value) in self.scale.iter_mut().zip(pose.scale.to_array()) {
            row[lane] = value;
        }
    }
}

impl Default for PoseBlock {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// The poses of all bones of a skeleton, each relative to its parent, in bone order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    bones: usize,
    blocks: Vec<PoseBlock>,
}

impl Pose {
    /// Creates a pose of `bones` bones with the identity.
    pub fn new(bones: usize) -> Self {
        Self { bones, blocks: vec![PoseBlock::IDENTITY; blocks_of(bones)] }
    }

    /// Creates a pose from a list, in its order.
    pub fn from_transforms(poses: &[Transform]) -> Self {
        let mut pose = Self::new(poses.len());
        for (bone, &transform) in poses.iter().enumerate() {
            pose.set(bone, transform);
        }
        pose
    }

    /// Returns the number of bones.
    pub fn bones(&self) -> usize {
        self.bones
    }

    /// Returns the blocks, the last one padded.
    pub fn blocks(&self) -> &[PoseBlock] {
        &self.blocks
    }

    /// Returns the blocks for writing.
    pub fn blocks_mut(&mut self) -> &mut [PoseBlock] {
        &mut self.blocks
    }

    /// Returns the pose of `bone`; `None` past the end.
    pub fn get(&self, bone: usize) -> Option<Transform> {
        (bone < self.bones).then(|| self.blocks[bone / LANES].get(bone))
    }

    /// Sets the pose of `bone`; does nothing past the end. The caller has normalized the rotation and made every number
    /// finite ([`crate::sample::healthy`]).
    pub fn set(&mut self, bone: usize, pose: Transform) {
        if bone < self.bones {
            self.blocks[bone / LANES].set(bone, pose);
        }
    }

    /// Writes the poses to a list, up to the length of `out`.
    pub fn write_to(&self, out: &mut [Transform]) {
        for (bone, out) in out.iter_mut().enumerate().take(self.bones) {
            *out = self.blocks[bone / LANES].get(bone);
        }
    }
}

/// Returns the number of blocks for `bones` bones.
pub(super) fn blocks_of(bones: usize) -> usize {
    bones.div_ceil(LANES)
}
