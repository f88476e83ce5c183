//! A take sampled at evenly spaced times: the input of the compressor.

use super::clock::FrameClock;
use super::stored::LARGEST;
use super::{CompressError, CompressionSettings, MAX_BONES, MAX_FRAMES, MAX_VALUES};
use crate::animation::to_root;
use crate::data::{Channel, Interpolation, Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::{Affine3A, Mat4};

/// Keys per second where neither the take nor the settings give a rate.
const USUAL_RATE: f32 = 30.0;
/// A key this close to a frame, in frames, is on it.
const ON_FRAME: f64 = 0.01;

/// Largest number of parts into which the smallest gap between keys is divided to find a grid that contains all keys.
const FINER: u32 = 8;

/// The poses of a take at evenly spaced times.
#[derive(Debug)]
pub(super) struct SampledFrames {
    pub(super) clock: FrameClock,
    pub(super) bones: usize,
    /// Poses relative to the parents, one per bone, frame after frame.
    pub(super) poses: Vec<Transform>,
    /// Bone space → scene space, one matrix per bone, frame after frame.
    pub(super) to_root: Vec<Affine3A>,
}

impl SampledFrames {
    pub(super) fn of(
        take: &Take,
        skeleton: &Skeleton,
        settings: &CompressionSettings,
    ) -> Result<Self, CompressError> {
        let (clock, bones) = (clock(take, settings)?, skeleton.len());
        limit("bones", bones as u64, MAX_BONES as u64)?;
        limit("poses", u64::from(clock.frames) * bones as u64 * 3, MAX_VALUES as u64)?;
        let mut poses = vec![Transform::IDENTITY; clock.frames as usize * bones];
        let interval = clock.interval();
        for (frame, poses) in poses.chunks_exact_mut(bones.max(1)).enumerate() {
            sample_take(Some(take), skeleton, clock.time(frame as u32, interval), poses);
        }
        let to_root = all_to_root(skeleton, &poses);
        if let Some(place) = poses.iter().position(|pose| size(pose) > LARGEST) {
            let (frame, bone) = (place / bones, place % bones);
            let (time, tolerance) = (clock.time(frame as u32, interval), settings.everywhere.tolerance);
            return Err(CompressError::OutOfReach { bone, time, tolerance, reached: f32::INFINITY });
        }
        Ok(Self { clock, bones, poses, to_root })
    }

    pub(super) fn count(&self) -> usize {
        self.clock.frames as usize
    }

    pub(super) fn pose(&self, frame: usize, bone: usize) -> Transform {
        self.poses[frame * self.bones + bone]
    }

    pub(super) fn to_root(&self, frame: usize, bone: usize) -> Affine3A {
        self.to_root[frame * self.bones + bone]
    }
}

fn size(pose: &Transform) -> f32 {
    pose.translation.abs().max_element().max(pose.scale.abs().max_element())
}

/// Returns `to_root` of every bone, frame after frame.
pub(super) fn all_to_root(skeleton: &Skeleton, poses: &[Transform]) -> Vec<Affine3A> {
    let bones = skeleton.len().max(1);
    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
    let mut all = Vec::with_capacity(poses.len());
    for poses in poses.chunks_exact(bones) {
        to_root(skeleton, poses, &mut matrices);
        all.extend(matrices.iter().map(|&matrix| Affine3A::from_mat4(matrix)));
    }
    all
}

pub(super) fn limit(what: &'static str, count: u64, limit: u64) -> Result<(), CompressError> {
    if count <= limit { Ok(()) } else { Err(CompressError::TooLarge { what, count, limit }) }
}

fn clock(take: &Take, settings: &CompressionSettings) -> Result<FrameClock, CompressError> {
    let start = if take.start.is_finite() { take.start } else { 0.0 };
    let length = if take.length.is_finite() && take.length > 0.0 { take.length } else { 0.0 };
    if length == 0.0 || !(start + length).is_finite() || start + length <= start {
        return Ok(FrameClock { start, length: 0.0, frames: 1 });
    }
    let rate = settings.rate.filter(|rate| rate.is_finite() && *rate > 0.0);
    let steps = match rate {
        Some(rate) => steps_at(length, rate),
        None => own_steps(take, start, length).unwrap_or_else(|| steps_at(length, USUAL_RATE)),
    };
    limit("keys", steps + 1, MAX_FRAMES as u64)?;
    Ok(FrameClock { start, length, frames: steps as u32 + 1 })
}

fn steps_at(length: f32, rate: f32) -> u64 {
    ((f64::from(length) * f64::from(rate)).round() as u64).max(1)
}

/// Returns the number of intervals of the take's own keys, where these are evenly spaced and interpolated linearly.
fn own_steps(take: &Take, start: f32, length: f32) -> Option<u64> {
    fn read<T>(channel: &Channel<T>, straight: &mut bool, times: &mut Vec<f32>) {
        *straight &= channel.interpolation == Interpolation::Linear || channel.times.len() < 2;
        times.extend_from_slice(&channel.times);
    }
    let (mut straight, mut times) = (true, Vec::new());
    for track in &take.tracks {
        read(&track.translation, &mut straight, &mut times);
        read(&track.rotation, &mut straight, &mut times);
        read(&track.scale, &mut straight, &mut times);
        if times.len() > 1 << 16 {
            tidy(&mut times);
        }
    }
    tidy(&mut times);
    let smallest =
        times.windows(2).map(|pair| f64::from(pair[1]) - f64::from(pair[0])).fold(f64::MAX, f64::min);
    let fits = |steps: f64| {
        let on_frame = |time: &f32| {
            let frame = (f64::from(*time) - f64::from(start)) / f64::from(length) * steps;
            (frame - frame.round()).abs() <= ON_FRAME
        };
        steps >= 1.0 && steps < MAX_FRAMES as f64 && times.iter().all(on_frame)
    };
    // The gaps may all be multiples of a fraction of the smallest of them.
    let finer = (1..=FINER).map(|finer| (f64::from(length) / smallest * f64::from(finer)).round());
    if straight { finer.into_iter().find(|&steps| fits(steps)).map(|steps| steps as u64) } else { None }
}

/// Sorts the times and removes duplicates.
fn tidy(times: &mut Vec<f32>) {
    times.retain(|time| time.is_finite());
    times.sort_by(f32::total_cmp);
    times.dedup();
}
