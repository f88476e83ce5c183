//! The frames of a movie by their numbers.

use dragonfly_anim::frames::frames_within;
use dragonfly_anim::stage::time::{StageRate, StageTime};
use std::num::NonZeroU64;
use std::ops::Range;

/// Frames of a movie, at least one. Frame `k` is at exactly `k` divided by the frames per second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MovieFrames {
    first: u64,
    end: u64,
    step: u64,
}

impl MovieFrames {
    /// Creates the frames of a range; `None` for an empty one.
    pub fn new(range: Range<u64>) -> Option<Self> {
        (!range.is_empty()).then_some(Self { first: range.start, end: range.end, step: 1 })
    }

    /// Returns the frames from one time of a scene up to, but without, another one; `None` where there is none.
    pub fn between(begin: StageTime, end: StageTime, rate: StageRate) -> Option<Self> {
        Self::new(first_at(begin, rate)..first_at(end, rate))
    }

    /// Returns the frames of a scene of a length: at least the first one.
    pub fn of_scene(length: StageTime, rate: StageRate) -> Self {
        Self { first: 0, end: first_at(length, rate).max(1), step: 1 }
    }

    /// Returns the frames of a take, `length` seconds long, from its first one to the last one at or just before its end.
    pub fn of_take(length: f64, rate: StageRate) -> Self {
        Self { first: 0, end: frames_within(length, rate.per_second()) as u64, step: 1 }
    }

    /// Returns every `step`-th of these frames, from the first one on.
    pub fn stepped(self, step: NonZeroU64) -> Self {
        Self { step: self.step.saturating_mul(step.get()), ..self }
    }

    /// Returns those of these frames that are in a range; `None` where none is.
    pub fn within(self, range: Range<u64>) -> Option<Self> {
        let later = range.start.saturating_sub(self.first).div_ceil(self.step);
        let first = self.first.saturating_add(later.saturating_mul(self.step));
        let end = self.end.min(range.end);
        (first < end).then_some(Self { first, end, step: self.step })
    }

    /// Returns the first frame.
    pub fn first(&self) -> u64 {
        self.first
    }

    /// Returns the last frame.
    pub fn last(&self) -> u64 {
        self.first + (self.count() - 1) * self.step
    }

    /// Returns the number of frames.
    pub fn count(&self) -> u64 {
        (self.end - self.first).div_ceil(self.step)
    }

    /// Returns the numbers of the frames, ascending.
    pub fn numbers(&self) -> impl Iterator<Item = u64> + use<> {
        let Self { first, step, .. } = *self;
        (0..self.count()).map(move |at| first + at * step)
    }

    /// Returns the frames as a range where none is left out.
    pub fn range(&self) -> Option<Range<u64>> {
        (self.step == 1).then_some(self.first..self.end)
    }
}

/// Returns the first frame at or after a time; frame 0 for times before it.
fn first_at(time: StageTime, rate: StageRate) -> u64 {
    let near = rate.nearest_frame(time).max(0);
    let first = if rate.frame(near) >= time { near } else { near + 1 };
    first.unsigned_abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(range: Range<u64>, step: u64) -> MovieFrames {
        MovieFrames::new(range).expect("frames").stepped(NonZeroU64::new(step).expect("a step"))
    }

    #[test]
    fn a_scene_has_the_frames_that_begin_before_its_end() {
        let rate = |text| StageRate::parse(text).expect("a rate");
        let count = |seconds, text| {
            MovieFrames::of_scene(StageTime::from_seconds(seconds), rate(text)).range().expect("a range")
        };
        assert_eq!(count(2.0, "24"), 0..48);
        assert_eq!(count(2.001, "24"), 0..49);
        assert_eq!(count(1.999, "24"), 0..48);
        assert_eq!(count(1.001, "24000/1001"), 0..24);
        assert_eq!(count(0.0, "24"), 0..1);
        assert_eq!(MovieFrames::of_take(1.0, rate("24")).range(), Some(0..25));
        assert_eq!(MovieFrames::of_take(f64::from(0.708_333_3_f32), rate("24")).range(), Some(0..18));
        assert_eq!(MovieFrames::of_take(0.0, rate("24")).range(), Some(0..1));
        let time = StageTime::from_seconds;
        assert_eq!(MovieFrames::between(time(0.5), time(1.0), rate("24")), MovieFrames::new(12..24));
        assert_eq!(MovieFrames::between(time(0.51), time(1.01), rate("24")), MovieFrames::new(13..25));
        assert_eq!(MovieFrames::between(time(0.51), time(0.52), rate("24")), None);
    }

    #[test]
    fn a_part_of_every_second_frame_has_those_of_the_whole() {
        let whole = frames(3..20, 2);
        assert_eq!((whole.first(), whole.last(), whole.count(), whole.range()), (3, 19, 9, None));
        let part = whole.within(8..14).expect("frames");
        assert_eq!(part.numbers().collect::<Vec<_>>(), [9, 11, 13]);
        assert_eq!(whole.within(0..4).map(|part| part.last()), Some(3));
        assert_eq!(whole.within(18..100).map(|part| part.first()), Some(19));
        assert_eq!((whole.within(20..30), whole.within(4..5), MovieFrames::new(5..5)), (None, None, None));
        assert_eq!(frames(3..20, 1).within(0..u64::MAX), MovieFrames::new(3..20));
    }
}
