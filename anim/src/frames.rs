//! A take sampled at its frame rate: the table of poses that contacts, loops and the lint of takes read.
//!
//! Frame `f` is at `start + f / rate` seconds; the last frame is the one at or just before the end. Positions are those of
//! the origins of bones in scene space (to-root).

use crate::animation::to_root;
use crate::data::{BoneIndex, Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::{Mat4, Vec3};

/// Largest number of bones × frames of one table: 10 minutes of 200 bones at 60 frames per second.
pub const MOST_POSES: usize = 8 << 20;

/// The usual frame rates, ascending.
const RATES: [f32; 10] = [12.0, 15.0, 24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 100.0, 120.0];

/// Share of a frame by which a key, or the end of a take, may be off its frame.
pub const OFF_FRAME: f64 = 0.02;

/// Returns the number of frames from a start to the last one at or just before the end, `length` seconds later.
pub fn frames_within(length: f64, rate: f64) -> usize {
    ((length * rate + OFF_FRAME).floor().max(0.0) as usize).saturating_add(1)
}

/// Returns the number of frames from a start to the first one at or just after the end, `length` seconds later.
pub fn frames_over(length: f64, rate: f64) -> usize {
    ((length * rate - OFF_FRAME).ceil().max(0.0) as usize).saturating_add(1)
}

/// Returns the lowest usual frame rate at which every key of `take` is on a frame; 30 where there is none.
pub fn frame_rate(take: &Take) -> f32 {
    let fits = |rate: f32| {
        let on = |time: f32| {
            let frame = (f64::from(time) - f64::from(take.start)) * f64::from(rate);
            (frame - frame.round()).abs() <= OFF_FRAME
        };
        let channels = |track: &crate::data::Track| {
            let times = [&track.translation.times, &track.rotation.times, &track.scale.times];
            times.into_iter().all(|times| times.iter().all(|&time| on(time)))
        };
        take.tracks.iter().all(channels)
    };
    if take.length > 0.0 { RATES.into_iter().find(|&rate| fits(rate)).unwrap_or(30.0) } else { 30.0 }
}

/// Reasons why a take cannot be sampled.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FramesError {
    /// The table would be too large.
    #[error("{frames} frames of {bones} bones are more than {MOST_POSES} poses")]
    TooMany {
        /// The number of frames.
        frames: usize,
        /// The number of bones.
        bones: usize,
    },
    /// The frame rate is not a positive number.
    #[error("{rate} is not a frame rate")]
    Rate {
        /// The rate that was given.
        rate: f32,
    },
}

/// The poses of a take at every frame.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeFrames {
    rate: f32,
    bones: usize,
    times: Vec<f32>,
    poses: Vec<Transform>,
    positions: Vec<Vec3>,
}

impl TakeFrames {
    /// Samples `take` at `rate` frames per second.
    ///
    /// # Errors
    ///
    /// The rate is not a positive number, or the table would exceed [`MOST_POSES`].
    pub fn of(take: &Take, skeleton: &Skeleton, rate: f32) -> Result<Self, FramesError> {
        if !(rate.is_finite() && rate > 0.0) {
            return Err(FramesError::Rate { rate });
        }
        let (start, length) = (finite(take.start), f64::from(finite(take.length).max(0.0)));
        let bones = skeleton.len();
        let frames = frames_within(length, f64::from(rate));
        if frames.saturating_mul(bones.max(1)) > MOST_POSES {
            return Err(FramesError::TooMany { frames, bones });
        }
        let at = |frame: usize| (f64::from(start) + frame as f64 / f64::from(rate)) as f32;
        Ok(Self::at(take, skeleton, rate, (0..frames).map(at).collect()))
    }

    /// Samples only the first two frames and the last two, as the table of a take of four frames: all that the gap of a loop
    /// depends on. The last one is at the end of the take, also where that is between two frames.
    ///
    /// # Errors
    ///
    /// As [`Self::of`], but a take may be of any length.
    pub fn ends(take: &Take, skeleton: &Skeleton, rate: f32) -> Result<Self, FramesError> {
        let last = f64::from(finite(take.length).max(0.0)) * f64::from(rate);
        if !(rate.is_finite() && rate > 0.0 && last >= 4.0) {
            return Self::of(take, skeleton, rate);
        }
        let at = |frame: f64| (f64::from(finite(take.start)) + frame / f64::from(rate)) as f32;
        Ok(Self::at(take, skeleton, rate, [0.0, 1.0, last - 1.0, last].map(at).into()))
    }

    /// Samples a take at these times.
    fn at(take: &Take, skeleton: &Skeleton, rate: f32, times: Vec<f32>) -> Self {
        let (frames, bones) = (times.len(), skeleton.len());
        let mut poses = vec![Transform::IDENTITY; frames * bones];
        let mut positions = Vec::with_capacity(frames * bones);
        let mut matrices = vec![Mat4::IDENTITY; bones];
        for (frame, &time) in times.iter().enumerate() {
            let row = &mut poses[frame * bones..(frame + 1) * bones];
            sample_take(Some(take), skeleton, time, row);
            to_root(skeleton, row, &mut matrices);
            positions.extend(matrices.iter().map(|matrix| matrix.w_axis.truncate()));
        }
        Self { rate, bones, times, poses, positions }
    }

    /// Returns the number of frames; at least one.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Returns whether there is no frame: never.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Returns the number of bones.
    pub fn bones(&self) -> usize {
        self.bones
    }

    /// Returns the frames per second.
    pub fn rate(&self) -> f32 {
        self.rate
    }

    /// Returns the time of each frame in seconds, ascending.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// Returns the position of the origin of `bone` in scene space at `frame`.
    ///
    /// # Panics
    ///
    /// There is no such frame or bone.
    pub fn position(&self, frame: usize, bone: BoneIndex) -> Vec3 {
        self.positions[frame * self.bones + bone as usize]
    }

    /// Returns the pose of `bone` relative to its parent at `frame`.
    ///
    /// # Panics
    ///
    /// There is no such frame or bone.
    pub fn pose(&self, frame: usize, bone: BoneIndex) -> Transform {
        self.poses[frame * self.bones + bone as usize]
    }

    /// Returns the velocity of `bone` at `frame` in units of length per second: from the frame before to the frame after;
    /// at the ends one-sided. Zero for a single frame.
    pub fn velocity(&self, frame: usize, bone: BoneIndex) -> Vec3 {
        let (before, after) = (frame.saturating_sub(1), (frame + 1).min(self.len() - 1));
        if before == after {
            return Vec3::ZERO;
        }
        let moved = self.position(after, bone) - self.position(before, bone);
        moved * (self.rate / (after - before) as f32)
    }

    /// Returns the frame nearest to `time` seconds.
    pub fn frame_at(&self, time: f32) -> usize {
        let frame = ((time - self.times[0]) * self.rate).round().max(0.0) as usize;
        frame.min(self.len() - 1)
    }
}

fn finite(number: f32) -> f32 {
    if number.is_finite() { number } else { 0.0 }
}
