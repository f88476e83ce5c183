//! A take as a BVH file has it: at frames, relative to a rest pose without rotations.

use super::check as code;
use super::rate::FrameGrid;
use super::scene_pose::{ScenePose, SceneSampler};
use crate::data::{Skeleton, Take};
use crate::format::losses::Losses;
use crate::frames::FramesError;
use glam::{DQuat, DVec3};

/// Poses of all bones at every frame.
pub(super) struct FramePoses {
    /// Frames per second.
    rate: f64,
    parents: Vec<Option<usize>>,
    rest: Vec<DVec3>,
    poses: Vec<ScenePose>,
    is_animated: Vec<bool>,
}

impl FramePoses {
    /// Samples a take at the rate that [`FrameGrid`] chooses; without a take, the rest pose once.
    pub(super) fn of(
        take: Option<&Take>,
        skeleton: &Skeleton,
        losses: &mut Losses,
    ) -> Result<Self, FramesError> {
        let (mut sampler, rest) = SceneSampler::of(take, skeleton);
        let grid = match take {
            Some(take) => FrameGrid::of(take, skeleton, &mut sampler, losses)?,
            None => FrameGrid { start: 0.0, rate: 30.0, frames: 1 },
        };
        if grid.start != 0.0 {
            let text = format!("the take starts at {} s, a BVH file always at 0 s", grid.start);
            losses.add("/animation/takes/0/start".to_owned(), code::START_NOT_STORED, text);
        }
        let is_animated =
            |bone: usize| take.and_then(|take| take.tracks.get(bone)).is_some_and(|track| !track.is_empty());
        Ok(Self {
            rate: grid.rate,
            parents: skeleton.bones.iter().map(|bone| bone.parent.map(|parent| parent as usize)).collect(),
            rest,
            poses: (0..grid.frames).map(|frame| sampler.pose(grid.time(frame))).collect(),
            is_animated: (0..skeleton.len()).map(is_animated).collect(),
        })
    }

    pub(super) fn frames(&self) -> usize {
        self.poses.len()
    }

    /// Returns the frames per second.
    pub(super) fn rate(&self) -> f64 {
        self.rate
    }

    /// Returns whether a take has keys for a bone.
    pub(super) fn is_animated(&self, bone: usize) -> bool {
        self.is_animated[bone]
    }

    /// Returns the position of a bone relative to its parent in the rest pose, in meters along the axes of the scene.
    pub(super) fn offset(&self, bone: usize) -> DVec3 {
        self.rest[bone] - self.parents[bone].map_or(DVec3::ZERO, |parent| self.rest[parent])
    }

    /// Returns whether a bone moves in its parent by more than `distance` in any frame.
    pub(super) fn moves(&self, bone: usize, distance: f64) -> bool {
        let offset = self.offset(bone);
        (0..self.frames()).any(|frame| self.local(frame, bone).1.distance(offset) > distance)
    }

    /// Returns the rotation and the position of a bone relative to its parent in a frame.
    pub(super) fn local(&self, frame: usize, bone: usize) -> (DQuat, DVec3) {
        self.poses[frame].local(bone, self.parents[bone])
    }
}
