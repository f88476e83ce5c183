//! Compression of a take: encodes with several choices, measures each, and keeps the smallest.

use super::encode::{EncodeChoice, Encoder};
use super::extents::ByteSizes;
use super::frames::{SampledFrames, all_to_root};
use super::metric::{LargestError, largest_error};
use super::plan::TrackPlan;
use super::settings::{CompressionSettings, Exactness};
use super::write::write;
use super::{CompressError, CompressedTake};
use crate::data::{Skeleton, Take, Transform};
use crate::fast::Pose;

/// Results of a compression.
#[derive(Clone, Debug, PartialEq)]
pub struct CompressionReport {
    /// Sizes in bytes, by content.
    pub bytes: ByteSizes,
    /// Size in bytes of the same keys as plain floats: 40 per bone and key.
    pub raw_bytes: usize,
    /// The largest error at any key time, measured on the decoded result, and its position.
    pub largest_error: LargestError,
    /// [`Self::largest_error`] in units of its bone's tolerance; at most 1.
    pub share_of_tolerance: f32,
    /// Number of keys in a segment.
    pub keys_per_segment: usize,
    /// Number of channels that are constant at the default value, constant at another value, packed, and stored whole.
    pub channels: [usize; 4],
    /// Number of morph tracks of the take: these are not part of a compressed take.
    pub morphs_left_out: usize,
}

/// Shares of the tolerance tried for the first and the last joint of a chain.
const SHARES: [[f32; 2]; 8] =
    [[0.7, 0.8], [0.5, 0.8], [0.6, 0.7], [0.45, 0.7], [0.5, 0.6], [0.45, 0.6], [0.4, 0.55], [0.3, 0.4]];
/// Segment sizes tried, as powers of two: first [`MIDDLE`], then the smaller and the larger ones while each helps.
const SMALLER: [u32; 2] = [5, 4];
const LARGER: [u32; 2] = [7, 8];
const MIDDLE: u32 = 6;

/// Compresses `take`, whose bones are those of `skeleton`.
///
/// The take is sampled at evenly spaced times (its own, where they are; see [`CompressionSettings::rate`]). At each of
/// them, each of the three shell points of each bone is within the tolerance of its position in the raw take, in scene
/// space: that is measured on the decoded bytes before they are returned.
///
/// # Errors
///
/// Too many bones or keys; or numbers so large that single precision cannot keep the tolerance.
pub fn compress(
    take: &Take,
    skeleton: &Skeleton,
    settings: &CompressionSettings,
) -> Result<(CompressedTake, CompressionReport), CompressError> {
    let frames = SampledFrames::of(take, skeleton, settings)?;
    let exactness = settings.per_bone(skeleton.len());
    let plan = TrackPlan::new(&frames, skeleton, exactness.clone());
    let attempt = |choice: EncodeChoice| Attempt::new(take, skeleton, &frames, &plan, &exactness, choice);
    let mut best: Option<Attempt> = None;
    let mut shares = SHARES[0];
    for next in SHARES {
        let found = attempt(EncodeChoice { shift: MIDDLE, shares: next, whole: false })?;
        let first = best.is_none();
        if better(found, &mut best) {
            shares = next;
        } else if !first {
            break;
        }
    }
    for sizes in [SMALLER, LARGER] {
        for shift in sizes {
            let helps = frames.count() > 1 << shift.min(MIDDLE)
                && better(attempt(EncodeChoice { shift, shares, whole: false })?, &mut best);
            if !helps {
                break;
            }
        }
    }
    if best.is_none() {
        better(attempt(EncodeChoice { shift: MIDDLE, shares: SHARES[0], whole: true })?, &mut best);
    }
    match best {
        Some(best) => Ok((best.take, best.report)),
        None => Err(out_of_reach(
            attempt(EncodeChoice { shift: MIDDLE, shares: SHARES[0], whole: true })?,
            &exactness,
        )),
    }
}

fn out_of_reach(attempt: Attempt, exactness: &[Exactness]) -> CompressError {
    let LargestError { distance, bone, time } = attempt.report.largest_error;
    let tolerance = exactness.get(bone).map_or(0.0, |exactness| exactness.tolerance);
    CompressError::OutOfReach { bone, time, tolerance, reached: distance }
}

/// Replaces `best` by `attempt` where that keeps the tolerance and costs less. Returns whether it did.
fn better(attempt: Attempt, best: &mut Option<Attempt>) -> bool {
    let holds = attempt.report.share_of_tolerance <= 1.0;
    let smaller = best.as_ref().is_none_or(|best| attempt.cost() < best.cost());
    if holds && smaller {
        *best = Some(attempt);
    }
    holds && smaller
}

/// A take compressed with one choice, and its report.
struct Attempt {
    take: CompressedTake,
    report: CompressionReport,
}

impl Attempt {
    /// Returns the bytes, plus a quarter of those of the tables: they are needed only while the take is played.
    fn cost(&self) -> usize {
        self.take.as_bytes().len() * 3 / 4 + self.take.bytes_in_memory() / 4
    }

    fn new(
        take: &Take,
        skeleton: &Skeleton,
        frames: &SampledFrames,
        plan: &TrackPlan,
        exactness: &[Exactness],
        choice: EncodeChoice,
    ) -> Result<Self, CompressError> {
        let stored = Encoder::new(frames, skeleton, plan, choice).run(&take.name);
        let (bytes, spent) = write(&stored)?;
        let compressed = match CompressedTake::from_bytes(bytes) {
            Ok(compressed) => compressed,
            Err(error) => unreachable!("the bytes just written cannot be read: {error}"),
        };
        let decoded = all_to_root(skeleton, &poses(&compressed, frames));
        let (share_of_tolerance, largest_error) = largest_error(frames, &decoded, exactness);
        let mut channels = [0; 4];
        stored.bones.iter().flatten().for_each(|part| channels[part.kind() as usize] += 1);
        let report = CompressionReport {
            bytes: spent,
            raw_bytes: frames.poses.len() * 40,
            largest_error,
            share_of_tolerance,
            keys_per_segment: 1 << choice.shift,
            channels,
            morphs_left_out: take.morphs.len(),
        };
        Ok(Self { take: compressed, report })
    }
}

/// Returns the decoded poses at every key time, frame after frame.
fn poses(take: &CompressedTake, frames: &SampledFrames) -> Vec<Transform> {
    let interval = frames.clock.interval();
    let mut pose = Pose::new(frames.bones);
    let mut poses = vec![Transform::IDENTITY; frames.poses.len()];
    for (key, poses) in poses.chunks_exact_mut(frames.bones.max(1)).enumerate() {
        take.sample(frames.clock.time(key as u32, interval), &mut pose);
        pose.write_to(poses);
    }
    poses
}
