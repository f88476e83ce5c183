//! Times to which a drag snaps: the ends of other bars, moments, the playhead, whole frames.

use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::schedule::TimesAlong;
use dragonfly_anim::stage::time::{StageRate, StageTime};

/// The ends of bars and the moments of takes to which something snaps, in their order.
#[derive(Clone, Debug, Default)]
pub(super) struct SnapTargets(Vec<StageTime>);

impl SnapTargets {
    /// Collects those of lanes, without those that move along with what is dragged.
    pub(super) fn of(lanes: &SceneLanes, moved: &TimesAlong) -> Self {
        let mut times: Vec<StageTime> = ends(lanes, moved).collect();
        times.sort_unstable();
        Self(times)
    }

    /// Returns the nearest of them, or the playhead, within `reach` of a time.
    pub(super) fn nearest(
        &self,
        time: StageTime,
        playhead: StageTime,
        reach: StageTime,
    ) -> Option<StageTime> {
        let after = self.0.partition_point(|other| *other < time);
        let around = self.0[after.saturating_sub(1)..].iter().take(2).copied();
        nearest(around.chain([playhead]), time, reach)
    }
}

/// Returns a time as a drag uses it: the nearest end of a bar, moment of a take or the playhead within `reach`, otherwise the nearest frame.
pub(super) fn snapped_time(
    time: StageTime,
    lanes: &SceneLanes,
    playhead: StageTime,
    reach: StageTime,
    rate: StageRate,
) -> StageTime {
    let none = TimesAlong::default();
    let found = nearest(ends(lanes, &none).chain([playhead]), time, reach);
    found.unwrap_or_else(|| frame_at(time, rate))
}

fn ends(lanes: &SceneLanes, moved: &TimesAlong) -> impl Iterator<Item = StageTime> {
    let bars = lanes.list.iter().flat_map(|lane| &lane.bars);
    let ends = bars.flat_map(move |bar| {
        let begin = (!moved.begin(bar.action)).then_some(bar.begin);
        let end = (!bar.is_passive && !moved.end(bar.action)).then_some(bar.end);
        let marks = bar.marks.iter().filter(move |_| begin.is_some()).map(|mark| mark.time);
        [begin, end].into_iter().flatten().chain(marks)
    });
    ends.chain([StageTime::ZERO])
}

fn nearest(times: impl Iterator<Item = StageTime>, time: StageTime, reach: StageTime) -> Option<StageTime> {
    let distance = |other: &StageTime| (other.ticks() - time.ticks()).abs();
    times.min_by_key(distance).filter(|other| distance(other) <= reach.ticks())
}

/// Returns the time of the nearest frame.
pub(super) fn frame_at(time: StageTime, rate: StageRate) -> StageTime {
    rate.frame(rate.nearest_frame(time))
}
