//! What the fast path can play.

use super::pose::PoseBlock;
use super::simd::Simd;

/// A take in a form that is sampled eight bones at once, into blocks of a [`super::Pose`].
///
/// Any time costs the same: nothing is remembered between two calls.
pub trait Playable {
    /// Number of bones.
    fn bones(&self) -> usize;

    /// Seconds: where the take begins.
    fn start(&self) -> f32;

    /// Seconds from its beginning to its end.
    fn length(&self) -> f32;

    /// Writes the pose of every bone at `time` seconds, clamped to the take; NaN counts as before it.
    ///
    /// Writes as many blocks as `out` and the take both have. Rotations have unit length, every number is finite. Mark
    /// it `#[inline(always)]`: it becomes part of the kernel that calls it.
    fn sample_with<S: Simd>(&self, time: f32, out: &mut [PoseBlock]);
}

/// Work that samples one take, for [`super::simd::Level::run`].
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

/// The poses of all bones of `take` at `time` seconds, each relative to its parent; see [`Playable::sample_with`].
/// Allocates nothing.
pub fn sample<T: Playable>(level: super::simd::Level, take: &T, time: f32, out: &mut [PoseBlock]) {
    level.run(Sample { take, time, out });
}
