//! The stride of a take: how far it goes in one cycle, and in which direction.
//!
//! A take that travels has it in its movement. In one that walks on the spot, a foot on the ground moves backwards as fast as the figure
//! would move forward: of every frame the lowest foot counts, if it is near the ground, and the stride is the median of these velocities, then
//! the mean of those near it.

use super::StageFoot;
use crate::data::{Skeleton, Take};
use crate::frames::TakeFrames;
use crate::motion::RootMotion;
use glam::{DVec3, Vec3};

/// Frames per second at which takes are measured.
pub(super) const MEASURE_RATE: f32 = 60.0;

/// Height below which a foot may stand, as a part of the length of a leg.
const NEAR_GROUND: f32 = 0.08;

/// Slowest stride in lengths of a leg per second: less is no walk.
const SLOWEST: f32 = 0.25;

/// How far a take goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::stage) struct Stride {
    /// Lengths of the model from the start to the end of the take.
    pub(in crate::stage) distance: f64,
    /// Unit vector on the ground, to-root space.
    pub(in crate::stage) direction: DVec3,
}

impl Stride {
    /// Returns the stride of a take that travels; `None` where it only turns.
    pub(super) fn of_motion(motion: &RootMotion) -> Option<Self> {
        Self::of(motion.at(motion.start + motion.length).translation.as_dvec3(), 1e-4)
    }

    fn of(way: DVec3, least: f64) -> Option<Self> {
        let way = DVec3::new(way.x, 0.0, way.z);
        let distance = way.length();
        (distance.is_finite() && distance > least).then(|| Self { distance, direction: way / distance })
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
    let mut found: Vec<Vec3> = Vec::with_capacity(frames.len());
    for frame in 0..frames.len() - 1 {
        let above = feet.iter().zip(&ground).map(|(foot, ground)| (height(frame, foot) - ground, foot));
        let Some((above, foot)) = above.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        if above <= NEAR_GROUND * leg {
            let moved = frames.position(frame + 1, foot.bone) - frames.position(frame, foot.bone);
            found.push(Vec3::new(-moved.x, 0.0, -moved.z) * MEASURE_RATE);
        }
    }
    let middle = Vec3::new(median(found.iter().map(|one| one.x)), 0.0, median(found.iter().map(|one| one.z)));
    let near: Vec<Vec3> =
        found.into_iter().filter(|one| one.distance(middle) < 0.4 * middle.length()).collect();
    let mean = near.iter().sum::<Vec3>() / near.len().max(1) as f32;
    let way = mean.as_dvec3() * f64::from(take.length);
    Stride::of(way, f64::from(SLOWEST * leg * take.length))
}

fn median(numbers: impl Iterator<Item = f32>) -> f32 {
    let mut numbers: Vec<f32> = numbers.collect();
    numbers.sort_by(f32::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
}
