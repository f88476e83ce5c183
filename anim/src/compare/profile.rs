//! The differences of two takes over time.

use super::pairs::pair_bones;
use super::{BoneDifference, Peak, Posed, angle_between};
use crate::data::{Skeleton, Take};

/// The differences of two takes at given times; see [`compare_at`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DifferenceProfile {
    /// The times, seconds.
    pub times: Vec<f32>,
    /// The largest distance of a joint at each time, scene units.
    pub distances: Vec<f32>,
    /// The largest angle between the rotations of a bone at each time, radians.
    pub angles: Vec<f32>,
    /// The largest difference of each pair of bones over all times, in the order of the first skeleton.
    pub bones: Vec<BoneDifference>,
}

impl DifferenceProfile {
    /// Returns how much the takes differ at each time, 0 to 1: the distance as a part of the largest one, or the angle where no joint moves,
    /// as when only bones without children turn.
    pub fn parts(&self) -> impl ExactSizeIterator<Item = f32> + Clone + '_ {
        let most = |values: &[f32]| values.iter().copied().fold(0.0, f32::max);
        let values = if most(&self.distances) > 0.0 { &self.distances } else { &self.angles };
        let most = most(values).max(f32::MIN_POSITIVE);
        values.iter().map(move |value| (value / most).clamp(0.0, 1.0))
    }
}

/// Compares `first` with `second`, each on its own skeleton, at `times` (seconds, ascending). Bones are paired by name; distances and
/// angles are measured as in [`compare_takes`](super::compare_takes).
///
/// Takes time in proportion to bones × times.
pub fn compare_at(
    first: (&Skeleton, &Take),
    second: (&Skeleton, &Take),
    times: Vec<f32>,
) -> DifferenceProfile {
    let (mut a, mut b) = (Posed::new(first.0, first.1), Posed::new(second.0, second.1));
    let none = Peak { value: 0.0, time: times.first().copied().unwrap_or(0.0) };
    let pairs = pair_bones(first.0, second.0);
    let mut bones: Vec<BoneDifference> = pairs
        .both
        .iter()
        .map(|&(first, second)| BoneDifference { first, second, distance: none, angle: none })
        .collect();
    let (mut distances, mut angles) = (Vec::with_capacity(times.len()), Vec::with_capacity(times.len()));
    for &time in &times {
        a.at(time);
        b.at(time);
        let (mut distance, mut angle) = (none, none);
        for bone in &mut bones {
            let (one, other) = (&a.to_root[bone.first as usize], &b.to_root[bone.second as usize]);
            if one == other {
                continue;
            }
            let (apart, turned) =
                (one.w_axis.truncate().distance(other.w_axis.truncate()), angle_between(one, other));
            bone.distance.raise(apart, time);
            bone.angle.raise(turned, time);
            distance.raise(apart, time);
            angle.raise(turned, time);
        }
        distances.push(distance.value);
        angles.push(angle.value);
    }
    DifferenceProfile { times, distances, angles, bones }
}
