//! When the feet of a take are on the ground, and where they are then.

use super::foot::StageFoot;
use super::stride::{MEASURE_RATE, Stride};
use crate::animation::to_root;
use crate::contact::{ContactThresholds, detect_contacts};
use crate::data::{Skeleton, Take, Transform};
use crate::frames::TakeFrames;
use crate::sample::sample_take;
use crate::stage::time::StageTime;
use glam::{Mat4, Vec3};

/// A time in which a foot is on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootContact {
    /// Position of the foot in the list of feet of the model.
    pub foot: usize,
    /// Its start, after the start of the take. One that crosses the end of a take that repeats ends after the take.
    pub from: StageTime,
    /// Its end.
    pub to: StageTime,
    /// Positions of the foot at the start, in the middle and at the end, to-root space of the take in place.
    pub(in crate::stage) at: [Vec3; 3],
}

/// Length of the leg of a human, meters: thresholds are in proportion to it.
const HUMAN_LEG: f32 = 0.9;

/// Finds the contacts of `moving`; positions are those of the same take in place.
pub(super) fn foot_contacts(
    skeleton: &Skeleton,
    moving: &Take,
    in_place: &Take,
    feet: &[StageFoot],
    leg: f32,
    stride: Option<&Stride>,
) -> Vec<FootContact> {
    let Ok(frames) = TakeFrames::of(moving, skeleton, MEASURE_RATE) else { return Vec::new() };
    let unit = HUMAN_LEG / leg;
    let usual = ContactThresholds::default();
    // A foot on the ground is much slower than the figure, but not still: the ankle rolls over the toes.
    let speed = stride.map_or(0.0, |stride| stride.distance as f32 / moving.length.max(1e-3)) * unit;
    let thresholds = ContactThresholds {
        enter_speed: usual.enter_speed.max(0.25 * speed),
        leave_speed: usual.leave_speed.max(0.5 * speed),
        enter_height: 0.04,
        leave_height: 0.07,
        least: 0.05,
        meters_per_unit: unit,
        ..usual
    };
    let bones: Vec<_> = feet.iter().map(|foot| foot.bone).collect();
    let length = StageTime::from_seconds(f64::from(moving.length));
    let near_end = StageTime::from_seconds(1.5 / f64::from(MEASURE_RATE));
    let mut spans: Vec<(usize, StageTime, StageTime)> = detect_contacts(&frames, &bones, &thresholds)
        .into_iter()
        .filter_map(|contact| {
            let foot = bones.iter().position(|&bone| bone == contact.bone)?;
            let after = |time: f32| StageTime::from_seconds(f64::from(time) - f64::from(moving.start));
            Some((foot, after(contact.from), after(contact.to)))
        })
        .collect();
    // A contact that continues at the start of the next cycle is one contact.
    for foot in 0..feet.len() {
        let first = spans.iter().position(|span| span.0 == foot && span.1 <= StageTime::ZERO);
        let last = spans.iter().position(|span| span.0 == foot && span.2 >= length - near_end);
        if let (Some(first), Some(last)) = (first, last)
            && first != last
            && stride.is_some()
        {
            spans[last].2 = length + spans[first].2;
            spans.remove(first);
        }
    }
    let mut pose = FootPose::new(skeleton, in_place, length);
    let contact = |(foot, from, to): (usize, StageTime, StageTime)| {
        let middle = StageTime::from_ticks((from.ticks() + to.ticks()) / 2);
        let at = [from, middle, to].map(|time| pose.position(feet[foot].bone, time));
        FootContact { foot, from, to, at }
    };
    spans.into_iter().map(contact).collect()
}

/// Positions of bones of a take.
struct FootPose<'a> {
    skeleton: &'a Skeleton,
    take: &'a Take,
    length: StageTime,
    poses: Vec<Transform>,
    matrices: Vec<Mat4>,
}

impl<'a> FootPose<'a> {
    fn new(skeleton: &'a Skeleton, take: &'a Take, length: StageTime) -> Self {
        let bones = skeleton.len();
        Self {
            skeleton,
            take,
            length,
            poses: vec![Transform::IDENTITY; bones],
            matrices: vec![Mat4::IDENTITY; bones],
        }
    }

    /// Returns the position of a bone at a time after the start, of a take that repeats.
    fn position(&mut self, bone: u32, time: StageTime) -> Vec3 {
        let inside = if time > self.length { time - self.length } else { time };
        let clock = (f64::from(self.take.start) + inside.seconds()) as f32;
        sample_take(Some(self.take), self.skeleton, clock, &mut self.poses);
        to_root(self.skeleton, &self.poses, &mut self.matrices);
        self.matrices[bone as usize].w_axis.truncate()
    }
}
