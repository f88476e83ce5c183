//! The takes that a role plays over time, and its pose from them.
//!
//! The take that began last counts; while it fades in, the one before has the rest, which may itself still fade in. Layers with a mask
//! follow in the order in which the script names them first.

use super::clock::PlayClock;
use super::fade::ActiveSpan;
use super::places::{MotionKind, PlaceLane};
use crate::fast::simd::SimdLevel;
use crate::fast::{LaneMask, MAX_LAYERS, PoseBlock, PoseLayer, blend, sample};
use crate::stage::model::StageModel;
use crate::stage::scene::StageScratch;
use crate::stage::time::StageTime;

/// The clock of a take.
#[derive(Clone, Debug)]
pub(super) enum TakeClock {
    /// Its own.
    Own(PlayClock),
    /// The distance on a path: the motion of this action.
    Path,
}

/// A take that a role plays.
#[derive(Clone, Debug)]
pub(super) struct PoseCue {
    pub(super) span: ActiveSpan,
    pub(super) weight: f32,
    pub(super) take: usize,
    pub(super) clock: TakeClock,
}

/// The parts of a role that a layer moves.
#[derive(Clone, Debug)]
pub(super) struct PoseMask {
    pub(super) bones: LaneMask,
    /// For each shape key of the model.
    pub(super) shapes: Vec<bool>,
}

/// The takes of one layer, in the order of their begins.
#[derive(Clone, Debug, Default)]
pub(super) struct PoseLane {
    /// The parts that it moves; `None`: everything.
    pub(super) mask: Option<PoseMask>,
    pub(super) cues: Vec<PoseCue>,
}

/// A take and its share of the pose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TakeShare {
    pub(super) cue: usize,
    pub(super) share: f32,
}

impl PoseLane {
    /// Returns the takes that count at `time` with their shares, the latest first, and their number.
    pub(super) fn shares(&self, time: StageTime) -> ([TakeShare; MAX_LAYERS], usize) {
        let (mut found, mut count, mut left) = ([TakeShare::default(); MAX_LAYERS], 0, 1.0);
        let begun = self.cues.partition_point(|cue| cue.span.begin <= time);
        for (index, cue) in self.cues[..begun].iter().enumerate().rev() {
            let weight = cue.span.weight(time) as f32 * cue.weight;
            if weight > 0.0
                && let Some(slot) = found.get_mut(count)
            {
                *slot = TakeShare { cue: index, share: left * weight };
                count += 1;
                left *= 1.0 - weight;
            }
            if left <= 1e-6 || count == MAX_LAYERS {
                break;
            }
        }
        (found, count)
    }

    /// Returns the share of the action at `time`.
    pub(super) fn share_of(&self, action: usize, time: StageTime) -> f32 {
        let (shares, count) = self.shares(time);
        shares[..count]
            .iter()
            .filter(|one| self.cues[one.cue].span.action == action)
            .map(|one| one.share)
            .sum()
    }
}

/// Writes the pose of a role: the takes of its lanes, the first of which is the whole body.
pub(super) fn pose_role(
    level: SimdLevel,
    model: &StageModel,
    lanes: &[PoseLane],
    places: &PlaceLane,
    time: StageTime,
    scratch: &mut StageScratch,
    out: &mut [PoseBlock],
) {
    let blocks = out.len();
    let rest = model.rig().rest().blocks();
    out.copy_from_slice(rest);
    for (number, lane) in lanes.iter().enumerate() {
        let (shares, count) = lane.shares(time);
        let play = |one: &TakeShare, out: &mut [PoseBlock]| {
            let cue = &lane.cues[one.cue];
            let Some(take) = model.takes().get(cue.take) else { return };
            sample(level, &take.keyed, take.clock(take_time(cue, places, time)), out);
        };
        match &shares[..count] {
            [] => {}
            [one] if one.share >= 1.0 && lane.mask.is_none() => play(one, out),
            some => {
                for (one, pose) in some.iter().zip(&mut scratch.poses) {
                    play(one, &mut pose[..blocks]);
                }
                let mask = lane.mask.as_ref().map(|mask| &mask.bones);
                let empty = PoseLayer { pose: &[], weight: 0.0, mask: None };
                let mut layers = [empty; MAX_LAYERS];
                for ((layer, one), pose) in layers.iter_mut().zip(some).zip(&scratch.poses) {
                    *layer = PoseLayer { pose: &pose[..blocks], weight: one.share, mask };
                }
                let base = &mut scratch.base[..blocks];
                base.copy_from_slice(if number == 0 { rest } else { out });
                blend(level, base, &layers[..some.len()], out);
            }
        }
    }
}

/// Returns the time in a take, after its start.
pub(super) fn take_time(cue: &PoseCue, places: &PlaceLane, time: StageTime) -> StageTime {
    match &cue.clock {
        TakeClock::Own(clock) => clock.time(cue.span.after(time)),
        TakeClock::Path => {
            let place = places.cue_of(cue.span.action, cue.span.begin);
            match place.map(|place| &place.kind) {
                Some(MotionKind::Follow(follower)) => follower.take_time(cue.span.after(time)),
                Some(MotionKind::Put { .. } | MotionKind::Turn { .. } | MotionKind::Travel { .. }) | None => {
                    StageTime::ZERO
                }
            }
        }
    }
}
