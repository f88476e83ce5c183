//! Memory for the pose of a character, from one call to the next.

use super::matrix::RootMatrix;
use super::playable::Playable;
use super::pose::{Pose, PoseBlock};
use super::rig::{NARROW, Rig};
use super::simd::{LANES, Simd};
use super::still::StillPose;
use super::to_root::{put_sheared, to_parent};
use std::any::TypeId;
use std::sync::Arc;

/// A pose in memory that is used again and again. It keeps what does not move of the take that it played most recently,
/// until it plays another one.
#[derive(Clone, Debug)]
pub(super) struct PlayedPose {
    pose: Pose,
    /// The part of a take that `pose` contains; `None` for that of no take.
    still: Option<Arc<StillPose>>,
}

impl PlayedPose {
    /// Allocates memory for the bones of `rig`, in their rest pose.
    pub(super) fn new(rig: &Rig) -> Self {
        Self { pose: rig.rest().clone(), still: None }
    }

    /// Returns whether the pose contains what does not move of the take with `still`; `None`: of no take.
    #[inline(always)]
    pub(super) fn contains(&self, still: Option<&Arc<StillPose>>) -> bool {
        self.still.as_ref().map(Arc::as_ptr) == still.map(Arc::as_ptr)
    }

    /// Writes the pose of `take` at `time` seconds. Blocks that the take does not have get the rest pose of `rig`.
    #[inline(always)]
    pub(super) fn play<S: Simd, T: Playable>(&mut self, rig: &Rig, take: &T, time: f32) {
        let still = take.still();
        if !self.contains(Some(still)) {
            self.start::<S>(rig, still);
        }
        take.sample_moving_with::<S>(time, self.pose.blocks_mut());
    }

    /// Writes what does not move of another take.
    #[inline(always)]
    fn start<S: Simd>(&mut self, rig: &Rig, still: &Arc<StillPose>) {
        let blocks = self.pose.blocks_mut();
        still.put::<S>(blocks);
        for (out, rest) in blocks.iter_mut().zip(rig.rest().blocks()).skip(still.blocks()) {
            *out = *rest;
        }
        self.still = Some(Arc::clone(still));
    }

    /// Returns the pose.
    pub(super) fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Returns the blocks of the pose.
    #[inline(always)]
    pub(super) fn blocks(&self) -> &[PoseBlock] {
        self.pose.blocks()
    }

    /// Returns the blocks of the pose, to be written all.
    #[inline(always)]
    pub(super) fn blocks_mut(&mut self) -> &mut [PoseBlock] {
        self.still = None;
        self.pose.blocks_mut()
    }
}

/// Memory for `to_parent` of the bones of a character. It keeps the matrices of the blocks of which nothing moves in the
/// take of the pose that it was computed from most recently.
#[derive(Clone, Debug)]
pub(super) struct LocalPoses {
    /// As in [`super::RootPoses`]: the identity, and one for each lane, padded.
    matrices: Vec<RootMatrix>,
    /// Whether the matrices of a block are computed already.
    is_ready: Vec<bool>,
    /// The take whose matrices are, and the instructions with which they are computed.
    still: Option<(Arc<StillPose>, TypeId)>,
}

impl LocalPoses {
    /// Allocates matrices for the bones of `rig`.
    pub(super) fn new(rig: &Rig) -> Self {
        let blocks = rig.rest().blocks().len();
        Self {
            matrices: vec![RootMatrix::IDENTITY; (1 + blocks * LANES).max(NARROW)],
            is_ready: vec![false; blocks],
            still: None,
        }
    }

    /// Keeps the matrices that are those of `played` too, and forgets the others.
    #[inline(always)]
    pub(super) fn keep<S: Simd>(&mut self, rig: &Rig, played: &PlayedPose) {
        if self.is_ready.len() != rig.rest().blocks().len() {
            *self = Self::new(rig);
        }
        let is_same = match (&self.still, &played.still) {
            (Some((own, level)), Some(still)) => Arc::ptr_eq(own, still) && *level == TypeId::of::<S>(),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        };
        if !is_same {
            self.start::<S>(played);
        }
    }

    /// Computes the matrices of the blocks of which nothing moves.
    #[inline(always)]
    fn start<S: Simd>(&mut self, played: &PlayedPose) {
        self.is_ready.fill(false);
        self.still = played.still.as_ref().map(|still| (Arc::clone(still), TypeId::of::<S>()));
        let own = self.matrices.get_mut(1..).unwrap_or_default().as_chunks_mut::<LANES>().0;
        for block in played.still.iter().flat_map(|still| still.still_blocks()) {
            if let (Some(pose), Some(own), Some(is_ready)) =
                (played.blocks().get(block), own.get_mut(block), self.is_ready.get_mut(block))
            {
                to_parent::<S>(pose, own);
                *is_ready = true;
            }
        }
    }

    /// Computes all matrices that are not kept. The blocks that `played` does not have are those of the rest pose.
    #[inline(always)]
    pub(super) fn complete<S: Simd>(&mut self, rig: &Rig, played: &PlayedPose) {
        let own = self.matrices.get_mut(1..).unwrap_or_default().as_chunks_mut::<LANES>().0;
        let rest = rig.rest().blocks().iter().enumerate();
        for (((block, rest), own), is_ready) in rest.zip(own).zip(&self.is_ready) {
            if !is_ready {
                to_parent::<S>(played.blocks().get(block).unwrap_or(rest), own);
            }
        }
    }

    /// Puts in the exact matrices of bones with a sheared rest pose, and keeps nothing.
    #[cold]
    pub(super) fn shear(&mut self, rig: &Rig, played: &PlayedPose) {
        put_sheared(rig, played.blocks(), &mut self.matrices);
        self.is_ready.fill(false);
        self.still = None;
    }

    /// Returns the matrices, the identity first, and whether those of each block are kept.
    #[inline(always)]
    pub(super) fn parts(&mut self) -> (&mut [RootMatrix], &[bool]) {
        (&mut self.matrices, &self.is_ready)
    }
}
