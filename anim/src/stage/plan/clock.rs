//! Times in a take while an action plays it.

use super::placement::Placement;
use crate::data::Transform;
use crate::sample::PlayMode;
use crate::stage::model::StageTake;
use crate::stage::script::StageRepeat;
use crate::stage::time::{Decimal, StageTime};

/// The part of a take that an action plays, how fast and how often.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlayClock {
    /// Start and end of the part, after the start of the take.
    pub(super) part: [StageTime; 2],
    /// Factor of the speed, not 0.
    pub(super) speed: Decimal,
    /// How often.
    pub(super) repeat: StageRepeat,
    /// Duration of one repetition.
    pub(super) once: StageTime,
    /// The part of the first repetition that is left out at its start: its duration in the scene.
    pub(super) skipped: StageTime,
    /// The same in the take.
    pub(super) start: StageTime,
}

/// The progress of an action in its take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::stage) struct PlayMoment {
    /// Number of completed repetitions; one of which the start is left out counts as whole.
    pub(in crate::stage) loops: u64,
    /// The time in the take, after its start.
    pub(in crate::stage) time: StageTime,
    /// Whether all repetitions are over, so that it holds the end of the last one.
    pub(in crate::stage) is_over: bool,
}

impl PlayClock {
    /// Returns the number of completed repetitions and the time since the start of the current one, in the take, for a time
    /// `after` the start of the action.
    ///
    /// Exact: the remainder is one of whole ticks, however long the action is.
    fn split(&self, after: StageTime) -> (u64, StageTime) {
        let length = (self.part[1] - self.part[0]).ticks();
        if length <= 0 {
            return (0, StageTime::ZERO);
        }
        let is_over = self.is_over(after);
        let played = match self.repeat {
            StageRepeat::Times(times) if is_over => StageTime::from_ticks(length).times(times),
            StageRepeat::Times(_) | StageRepeat::Fill => {
                let played = after.times(self.speed);
                self.start + if played < StageTime::ZERO { -played } else { played }
            }
        };
        let (loops, rest) = (played.ticks() / length, played.ticks() % length);
        // The end of the last repetition is not the start of another one.
        if is_over && rest == 0 && loops > 0 {
            return (loops as u64 - 1, StageTime::from_ticks(length));
        }
        (loops as u64, StageTime::from_ticks(rest))
    }

    /// Returns whether all repetitions are over `after` the start of the action.
    fn is_over(&self, after: StageTime) -> bool {
        match self.repeat {
            StageRepeat::Times(times) => after >= self.once.times(times) - self.skipped,
            StageRepeat::Fill => false,
        }
    }

    /// Returns the time in the take, after its start, of one after the start of a repetition there.
    fn in_take(&self, played: StageTime) -> StageTime {
        if self.speed.is_negative() { self.part[1] - played } else { self.part[0] + played }
    }

    /// Returns the time in the take, after its start.
    pub(super) fn time(&self, after: StageTime) -> StageTime {
        self.in_take(self.split(after).1)
    }

    /// Returns where in the take the action is.
    pub(super) fn moment(&self, after: StageTime) -> PlayMoment {
        let (loops, rest) = self.split(after);
        PlayMoment { loops, time: self.in_take(rest), is_over: self.is_over(after) }
    }

    /// Returns how far the take has moved the role, in its own space at the start and in lengths of the model.
    pub(super) fn movement(&self, take: &StageTake, after: StageTime) -> Placement {
        let Some(motion) = &take.motion else { return Placement::default() };
        let (loops, rest) = self.split(after);
        let [first, last] = if self.speed.is_negative() { [self.part[1], self.part[0]] } else { self.part };
        let between =
            |to: StageTime| placement_of(motion.delta(take.clock(first), take.clock(to), PlayMode::Clamp));
        let moved = between(last).repeated(loops).then(&between(self.in_take(rest)));
        match self.start > StageTime::ZERO {
            true => between(self.in_take(self.start)).inverse().then(&moved),
            false => moved,
        }
    }
}

/// Returns the part of a transform on the ground.
fn placement_of(transform: Transform) -> Placement {
    let rotation = transform.rotation.as_dquat();
    Placement {
        position: transform.translation.as_dvec3(),
        facing: 2.0 * libm::atan2(rotation.y, rotation.w),
    }
}
