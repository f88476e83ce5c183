//! The places of one thing over time.
//!
//! Position and direction are two channels. For each, the action that began last decides, and continues to do so after its end: a role
//! stays where its last motion left it. What begins later starts there, so the start of every motion is computed once, in the order of time,
//! and any time is computed without the ones before it.

use super::clock::PlayClock;
use super::follow::PathFollower;
use super::placement::{Placement, shortest};
use crate::stage::ease::StageEase;
use crate::stage::model::StageModel;
use crate::stage::time::StageTime;
use glam::DVec3;
use std::sync::Arc;

/// How an action moves a thing.
#[derive(Clone, Debug)]
pub(super) enum MotionKind {
    /// Is elsewhere at once.
    Put {
        /// The new position; `None`: the old one.
        position: Option<DVec3>,
        /// The new direction; `None`: the old one.
        facing: Option<f64>,
    },
    /// Follows a path.
    Follow(Box<PathFollower>),
    /// Turns to a direction.
    Turn {
        /// The direction, radians.
        to: f64,
        /// The duration.
        dur: StageTime,
        /// The course.
        ease: StageEase,
    },
    /// Moves as its take does.
    Travel {
        /// The model of the take.
        model: Arc<StageModel>,
        /// The take.
        take: usize,
        /// Its clock.
        clock: PlayClock,
        /// Meters in one length of the model.
        scale: f64,
    },
}

/// A motion of a thing.
#[derive(Clone, Debug)]
pub(super) struct PlaceCue {
    pub(super) action: usize,
    pub(super) begin: StageTime,
    pub(super) stop: StageTime,
    pub(super) fade_in: StageTime,
    /// Whether the direction before counts again after the stop.
    pub(super) is_released: bool,
    pub(super) kind: MotionKind,
    /// The placement of the thing at the start.
    pub(super) start: Placement,
}

impl PlaceCue {
    /// Returns whether it decides over the position.
    pub(super) fn moves(&self) -> bool {
        match &self.kind {
            MotionKind::Put { position, .. } => position.is_some(),
            MotionKind::Follow(_) | MotionKind::Travel { .. } => true,
            MotionKind::Turn { .. } => false,
        }
    }

    fn turns(&self, time: StageTime) -> bool {
        let counts = !(self.is_released && time >= self.stop);
        match &self.kind {
            MotionKind::Put { facing, .. } => facing.is_some(),
            MotionKind::Follow(_) | MotionKind::Travel { .. } => true,
            MotionKind::Turn { .. } => counts,
        }
    }

    /// Returns the placement by this motion alone.
    fn at(&self, time: StageTime) -> Placement {
        let after = time.min(self.stop) - self.begin;
        match &self.kind {
            MotionKind::Put { position, facing } => Placement {
                position: position.unwrap_or(self.start.position),
                facing: facing.unwrap_or(self.start.facing),
            },
            MotionKind::Follow(follower) => follower.placement(after, self.start.facing),
            MotionKind::Turn { to, dur, ease } => {
                let x = if *dur > StageTime::ZERO { after.ticks() as f64 / dur.ticks() as f64 } else { 1.0 };
                let turned = shortest(to - self.start.facing) * ease.at(x);
                Placement { facing: self.start.facing + turned, ..self.start }
            }
            MotionKind::Travel { model, take, clock, scale } => {
                let moved = model
                    .takes()
                    .get(*take)
                    .map_or_else(Placement::default, |take| clock.movement(take, after));
                self.start.then(&Placement { position: moved.position * *scale, ..moved })
            }
        }
    }

    /// Returns the share of the fade-in at `time`; 1 after it.
    fn fade(&self, time: StageTime) -> f64 {
        let is_fading = matches!(self.kind, MotionKind::Follow(_)) && time < self.begin + self.fade_in;
        if is_fading { (time - self.begin).ticks() as f64 / self.fade_in.ticks() as f64 } else { 1.0 }
    }
}

/// Number of fades that may overlap; further ones begin at once.
const MOST_FADES: usize = 4;

/// All motions of a thing, in the order of their begins.
#[derive(Clone, Debug, Default)]
pub(super) struct PlaceLane {
    /// The placement before all of them.
    pub(super) base: Placement,
    pub(super) cues: Vec<PlaceCue>,
}

impl PlaceLane {
    /// Returns the length of the way of an action, meters; `None` for one without a way.
    pub(super) fn way_length(&self, action: usize) -> Option<f64> {
        let cue = self.cues.iter().find(|cue| cue.action == action)?;
        match &cue.kind {
            MotionKind::Follow(follower) => Some(follower.path.length()),
            MotionKind::Put { .. } | MotionKind::Turn { .. } | MotionKind::Travel { .. } => None,
        }
    }

    /// Returns the placement at `time`.
    pub(super) fn at(&self, time: StageTime) -> Placement {
        self.before(self.cues.len(), time, MOST_FADES)
    }

    /// Returns the placement at `time` by the first `count` motions.
    fn before(&self, count: usize, time: StageTime, fades: usize) -> Placement {
        let begun = self.cues[..count.min(self.cues.len())].partition_point(|cue| cue.begin <= time);
        let last = |counts: &dyn Fn(&PlaceCue) -> bool| self.cues[..begun].iter().rposition(counts);
        let (moving, turning) = (last(&|cue| cue.moves()), last(&|cue| cue.turns(time)));
        let value = |at: Option<usize>| match at {
            Some(at) => self.faded(at, time, fades),
            None => self.base,
        };
        let moved = value(moving);
        let turned = if moving == turning { moved } else { value(turning) };
        Placement { position: moved.position, facing: turned.facing }
    }

    fn faded(&self, at: usize, time: StageTime, fades: usize) -> Placement {
        let cue = &self.cues[at];
        let own = cue.at(time);
        let x = cue.fade(time);
        if x >= 1.0 || fades == 0 {
            return own;
        }
        self.before(at, time, fades - 1).faded(&own, x)
    }

    /// Adds a motion that begins after all others, or with the last one. Its start is where the thing is then.
    pub(super) fn push(&mut self, cue: PlaceCue) {
        let start = self.at(cue.begin);
        self.cues.push(PlaceCue { start, ..cue });
    }

    /// Returns when the last motion that moves the thing has begun, with its action.
    pub(super) fn last_begin(&self, time: StageTime) -> Option<(StageTime, usize)> {
        let begun = self.cues.partition_point(|cue| cue.begin <= time);
        self.cues[..begun].iter().rfind(|cue| cue.moves()).map(|cue| (cue.begin, cue.action))
    }

    /// Returns the action that moves the thing along a path, or with its take, at `time`.
    pub(super) fn in_progress(&self, time: StageTime) -> Option<usize> {
        let begun = self.cues.partition_point(|cue| cue.begin <= time);
        let cue = self.cues[..begun].iter().rfind(|cue| cue.moves())?;
        let travels = match &cue.kind {
            MotionKind::Follow(_) | MotionKind::Travel { .. } => true,
            MotionKind::Put { .. } | MotionKind::Turn { .. } => false,
        };
        (travels && time < cue.stop).then_some(cue.action)
    }

    /// Returns the motion of an action that begins at `begin`.
    pub(super) fn cue_of(&self, action: usize, begin: StageTime) -> Option<&PlaceCue> {
        let begun = self.cues.partition_point(|cue| cue.begin <= begin);
        self.cues[..begun].iter().rfind(|cue| cue.action == action)
    }

    /// Returns the placement at `time` by the motion at `at` with what fades into it.
    pub(super) fn by(&self, at: usize, time: StageTime) -> Placement {
        self.before(at + 1, time, MOST_FADES)
    }
}
