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
        let (played, is_over) = match self.repeat {
            StageRepeat::Times(times) if after >= self.once.times(times) => {
                (StageTime::from_ticks(length).times(times), true)
            }
            StageRepeat::Times(_) | StageRepeat::Fill => {
                let played = after.times(self.speed);
                (if played < StageTime::ZERO { -played } else { played }, false)
            }
        };
        let (loops, rest) = (played.ticks() / length, played.ticks() % length);
        // The end of the last repetition is not the start of another one.
        if is_over && rest == 0 && loops > 0 {
            return (loops as u64 - 1, StageTime::from_ticks(length));
        }
        (loops as u64, StageTime::from_ticks(rest))
    }

    /// Returns the time in the take, after its start.
    pub(super) fn time(&self, after: StageTime) -> StageTime {
        let (_, rest) = self.split(after);
        if self.speed.is_negative() { self.part[1] - rest } else { self.part[0] + rest }
    }

    /// Returns how far the take has moved the role, in its own space at the start and in lengths of the model.
    pub(super) fn movement(&self, take: &StageTake, after: StageTime) -> Placement {
        let Some(motion) = &take.motion else { return Placement::default() };
        let (loops, rest) = self.split(after);
        let [first, last] = if self.speed.is_negative() { [self.part[1], self.part[0]] } else { self.part };
        let now = if self.speed.is_negative() { first - rest } else { first + rest };
        let between =
            |to: StageTime| placement_of(motion.delta(take.clock(first), take.clock(to), PlayMode::Clamp));
        between(last).repeated(loops).then(&between(now))
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
