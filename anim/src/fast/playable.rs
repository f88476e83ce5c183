//! The interface of takes that the fast path can play.

use super::pose::PoseBlock;
use super::simd::Simd;
use super::still::StillPose;
use std::sync::Arc;

/// A take in a form that is sampled eight bones at once, into blocks of a [`super::Pose`].
///
/// Any time costs the same: there is no state between two calls.
pub trait Playable {
    /// Returns the number of bones.
    fn bones(&self) -> usize;

    /// Returns the start of the take in seconds.
    fn start(&self) -> f32;

    /// Returns the length of the take in seconds.
    fn length(&self) -> f32;

    /// Returns the part of the take that does not move, always the same.
    fn still(&self) -> &Arc<StillPose>;

    /// Writes what moves at `time` seconds, clamped to the take; NaN counts as before it. `out` contains
    /// [`Self::still`] already, and possibly what moves at another time.
    ///
    /// Writes the blocks that `out` and the take both have. Rotations have unit length, every number is finite. Mark it
    /// `#[inline(always)]`: it becomes part of the kernel that calls it.
    fn sample_moving_with<S: Simd>(&self, time: f32, out: &mut [PoseBlock]);

    /// Writes the pose of every bone at `time` seconds, as [`Self::sample_moving_with`], into any pose.
    #[inline(always)]
    fn sample_with<S: Simd>(&self, time: f32, out: &mut [PoseBlock]) {
        self.still().put::<S>(out);
        self.sample_moving_with::<S>(time, out);
    }
}

/// Kernel that samples one take, for [`super::simd::SimdLevel::run`].
pub(super) struct Sample<'a, T> {
    pub(super) take: &'a T,
    pub(super) time: f32,
    pub(super) out: &'a mut [PoseBlock],
}

impl<T: Playable> super::simd::Kernel for Sample<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        self.take.sample_with::<S>(self.time, self.out);
    }
}

/// Samples the poses of all bones of `take` at `time` seconds, each relative to its parent; see
/// [`Playable::sample_with`]. Allocates nothing.
pub fn sample<T: Playable>(level: super::simd::SimdLevel, take: &T, time: f32, out: &mut [PoseBlock]) {
    level.run(Sample { take, time, out });
}
