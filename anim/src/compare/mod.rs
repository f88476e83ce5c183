//! The differences of two takes: per bone, in space, with the time of the largest difference.
//!
//! Bones are paired by name, so the two takes may belong to different files. Both are sampled with the open evaluator
//! ([`crate::sample`]) at the key times of both and between them, so that no two samples are further apart than
//! [`LONGEST_GAP`]. Outside its range a take holds its first or last pose.
//!
//! The distance of a bone is the largest displacement, in root space, of its joint; its angle is the largest angle
//! between the two rotations to the root. Both are zero, exactly, for takes with equal keys.

mod pairs;
mod profile;
mod times;

pub use pairs::{BonePairs, pair_bones};
pub use profile::{DifferenceProfile, compare_at};
pub use times::{LONGEST_GAP, MOST_SAMPLES, even_times, sample_times};

use crate::animation::to_root;
use crate::data::{BoneIndex, Skeleton, Take, Transform};
use crate::sample::{sample_morph_weights, sample_take};
use glam::{Mat4, Quat};

/// The largest value of a difference and the time at which it occurs, seconds. Zero at the first sample where nothing
/// differs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    /// The largest value; never negative, never NaN.
    pub value: f32,
    /// Seconds.
    pub time: f32,
}

impl Peak {
    fn raise(&mut self, value: f32, time: f32) {
        // A pose that is not finite counts as the largest possible difference.
        let value = if value.is_nan() { f32::MAX } else { value.min(f32::MAX) };
        if value > self.value {
            *self = Self { value, time };
        }
    }
}

/// The difference of one pair of bones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoneDifference {
    /// Index in the first skeleton.
    pub first: BoneIndex,
    /// Index in the second skeleton.
    pub second: BoneIndex,
    /// Displacement of the joint in root space, scene units.
    pub distance: Peak,
    /// Angle between the rotations to the root, radians, 0 to π.
    pub angle: Peak,
}

/// The difference of two takes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TakeDifference {
    /// The difference of each pair of bones, in the order of the first skeleton.
    pub bones: Vec<BoneDifference>,
    /// The largest difference of a morph weight.
    pub weight: Peak,
    /// First and last time compared, seconds.
    pub range: [f32; 2],
}

impl TakeDifference {
    /// The pair of bones with the largest distance; `None` without bones.
    pub fn farthest(&self) -> Option<&BoneDifference> {
        self.bones.iter().reduce(|a, b| if b.distance.value > a.distance.value { b } else { a })
    }

    /// The pair of bones with the largest angle; `None` without bones.
    pub fn most_turned(&self) -> Option<&BoneDifference> {
        self.bones.iter().reduce(|a, b| if b.angle.value > a.angle.value { b } else { a })
    }
}

/// A skeleton and its pose, reused from sample to sample.
struct Posed<'a> {
    skeleton: &'a Skeleton,
    take: &'a Take,
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
}

impl<'a> Posed<'a> {
    fn new(skeleton: &'a Skeleton, take: &'a Take) -> Self {
        let bones = skeleton.len();
        Self { skeleton, take, poses: vec![Transform::IDENTITY; bones], to_root: vec![Mat4::IDENTITY; bones] }
    }

    fn at(&mut self, time: f32) {
        sample_take(Some(self.take), self.skeleton, time, &mut self.poses);
        to_root(self.skeleton, &self.poses, &mut self.to_root);
    }
}

/// Compares `first` with `second`, each on its own skeleton.
///
/// Takes time in proportion to bones × samples; with very many bones fewer samples between keys are taken, so that the
/// product stays below [`MOST_SAMPLES`].
pub fn compare_takes(first: (&Skeleton, &Take), second: (&Skeleton, &Take)) -> TakeDifference {
    compare_takes_within(first, second, MOST_SAMPLES)
}

/// Compares as [`compare_takes`] does, with at most `most` bones × samples, for a program that cannot wait.
pub fn compare_takes_within(
    first: (&Skeleton, &Take),
    second: (&Skeleton, &Take),
    most: usize,
) -> TakeDifference {
    let times = times::sample_times_within(first.1, second.1, first.0.len().max(second.0.len()), most);
    let range = [times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0)];
    let mut weight = Peak { value: 0.0, time: range[0] };
    let mut weights = Weights::of(first.1, second.1);
    for &time in &times {
        weight.raise(weights.difference(first.1, second.1, time), time);
    }
    let bones = compare_at(first, second, times).bones;
    TakeDifference { bones, weight, range }
}

/// The angle between the rotations of two matrices, radians; scale and shear are left out.
fn angle_between(one: &Mat4, other: &Mat4) -> f32 {
    let rotation = |matrix: &Mat4| -> Quat { matrix.to_scale_rotation_translation().1 };
    let between = rotation(one).conjugate() * rotation(other);
    // Computed with the sine of half the angle: the cosine of a small angle is 1 within rounding.
    2.0 * libm::atan2f(between.xyz().length(), between.w.abs())
}

/// Morph weights of both takes at one time.
struct Weights {
    instances: Vec<(u32, usize)>,
    one: Vec<f32>,
    other: Vec<f32>,
}

impl Weights {
    fn of(first: &Take, second: &Take) -> Self {
        let mut instances: Vec<(u32, usize)> = Vec::new();
        for track in first.morphs.iter().chain(&second.morphs) {
            match instances.iter_mut().find(|(instance, _)| *instance == track.instance) {
                Some((_, targets)) => *targets = (*targets).max(track.targets as usize),
                None => instances.push((track.instance, track.targets as usize)),
            }
        }
        Self { instances, one: Vec::new(), other: Vec::new() }
    }

    fn difference(&mut self, first: &Take, second: &Take, time: f32) -> f32 {
        let mut largest = 0.0_f32;
        for &(instance, targets) in &self.instances {
            for (take, out) in [(first, &mut self.one), (second, &mut self.other)] {
                out.clear();
                out.resize(targets, 0.0);
                sample_morph_weights(Some(take), instance, &[], time, out);
            }
            let differences = self.one.iter().zip(&self.other).map(|(one, other)| (one - other).abs());
            largest = differences.fold(largest, f32::max);
        }
        largest
    }
}
