//! The stride of a take: how far it goes in one cycle, in which direction, and how far at each time of it.
//!
//! A take that travels has it in its movement. In one that walks on the spot, a foot on the ground moves backward as fast as the figure
//! would move forward: of every frame the lowest foot counts, if it is near the ground. The direction is that of the median of these
//! velocities; the speed at each time is theirs along it, or their mean while both feet are in the air, smoothed around the cycle. So a figure that is moved by
//! it goes faster and slower as its steps do, and its feet stand.

use super::foot::StageFoot;
use crate::data::{Skeleton, Take};
use crate::frames::TakeFrames;
use crate::motion::RootMotion;
use glam::{DVec3, Vec3};

/// Frames per second at which takes are measured.
pub(super) const MEASURE_RATE: f32 = 60.0;

/// Height below which a foot may be on the ground, as a part of the length of a leg.
const NEAR_GROUND: f32 = 0.08;

/// Slowest stride in lengths of a leg per second: less is no walk.
const SLOWEST: f32 = 0.6;

/// Standard deviation of the smoothing in frames.
const SMOOTHING: f64 = 2.0;

/// How far a take goes.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::stage) struct Stride {
    /// Lengths of the model from the start to the end of the take.
    pub(in crate::stage) distance: f64,
    /// Unit vector on the ground, to-root space.
    pub(in crate::stage) direction: DVec3,
    /// Share of the distance at even times from the start to the end of the take, of one that walks on the spot; empty for others.
    pub(super) shares: Vec<f64>,
}

impl Stride {
    /// Returns the stride of a take that travels; `None` where it only turns.
    pub(super) fn of_motion(motion: &RootMotion) -> Option<Self> {
        Self::of(motion.at(motion.start + motion.length).translation.as_dvec3(), 1e-4)
    }

    /// Returns the share of the distance at the share `x` of the time; clamped to 0..=1.
    pub(in crate::stage) fn share(&self, x: f64) -> f64 {
        let x = x.clamp(0.0, 1.0);
        let Some(last) = self.shares.len().checked_sub(1).filter(|&last| last > 0) else { return x };
        let at = ((x * last as f64) as usize).min(last - 1);
        let mix = x * last as f64 - at as f64;
        self.shares[at] + (self.shares[at + 1] - self.shares[at]) * mix
    }

    fn of(way: DVec3, least: f64) -> Option<Self> {
        let way = DVec3::new(way.x, 0.0, way.z);
        let distance = way.length();
        (distance.is_finite() && distance > least).then(|| Self {
            distance,
            direction: way / distance,
            shares: Vec::new(),
        })
    }
}

/// Returns the stride of a take that walks on the spot; `None` for one that does not walk.
pub(super) fn stride_of(skeleton: &Skeleton, take: &Take, feet: &[StageFoot], leg: f32) -> Option<Stride> {
    let frames = TakeFrames::of(take, skeleton, MEASURE_RATE).ok()?;
    if feet.is_empty() || frames.len() < 4 {
        return None;
    }
    let height = |frame: usize, foot: &StageFoot| frames.position(frame, foot.bone).y;
    let ground: Vec<f32> = feet
        .iter()
        .map(|foot| (0..frames.len()).map(|frame| height(frame, foot)).fold(f32::INFINITY, f32::min))
        .collect();
    // The velocity that the lowest foot shows, from each frame to the next; `None` in the air.
    let shown = |frame: usize| {
        let above = feet.iter().zip(&ground).map(|(foot, ground)| (height(frame, foot) - ground, foot));
        let (above, foot) = above.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let moved = frames.position(frame + 1, foot.bone) - frames.position(frame, foot.bone);
        (above <= NEAR_GROUND * leg).then(|| Vec3::new(-moved.x, 0.0, -moved.z) * MEASURE_RATE)
    };
    let velocities: Vec<Option<Vec3>> = (0..frames.len() - 1).map(shown).collect();
    let found = || velocities.iter().flatten();
    let middle = Vec3::new(median(found().map(|one| one.x)), 0.0, median(found().map(|one| one.z)));
    let near = |one: &&Vec3| one.distance(middle) < 0.4 * middle.length();
    let mean = found().filter(near).sum::<Vec3>() / found().filter(near).count().max(1) as f32;
    let way = mean.as_dvec3() * f64::from(take.length);
    let stride = Stride::of(way, f64::from(SLOWEST * leg * take.length))?;
    // A foot that lands or leaves is near the ground too, but not as slow: it does not count as standing.
    let along = |one: &Option<Vec3>| {
        one.as_ref().filter(near).map_or(mean.length().into(), |one| one.as_dvec3().dot(stride.direction))
    };
    let speeds = smoothed(&velocities.iter().map(along).collect::<Vec<f64>>());
    let total: f64 = speeds.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return Some(stride);
    }
    let mut shares = vec![0.0];
    let mut sum = 0.0;
    for speed in &speeds {
        sum += speed;
        shares.push(sum / total);
    }
    let distance = total / speeds.len() as f64 * f64::from(take.length);
    Some(Stride { distance, shares, ..stride })
}

/// Returns numbers around a cycle, smoothed.
fn smoothed(numbers: &[f64]) -> Vec<f64> {
    let count = numbers.len() as i64;
    let reach = (3.0 * SMOOTHING) as i64;
    let weight = |offset: i64| libm::exp(-0.5 * (offset as f64 / SMOOTHING) * (offset as f64 / SMOOTHING));
    let whole: f64 = (-reach..=reach).map(weight).sum();
    let at = |index: i64| numbers[index.rem_euclid(count) as usize];
    (0..count)
        .map(|index| (-reach..=reach).map(|offset| weight(offset) * at(index + offset)).sum::<f64>() / whole)
        .collect()
}

fn median(numbers: impl Iterator<Item = f32>) -> f32 {
    let mut numbers: Vec<f32> = numbers.collect();
    numbers.sort_by(f32::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
}
