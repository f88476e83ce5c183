//! Times to which a drag snaps: the ends of other bars, moments, the playhead, whole frames.

use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::time::{StageRate, StageTime};

/// Returns a time as a drag uses it: the nearest end of another bar, moment of a take or the playhead within `reach`, otherwise the nearest
/// frame. `dragged` are the actions that are dragged: their own ends do not count.
pub fn snapped_time(
    time: StageTime,
    lanes: &SceneLanes,
    dragged: &[usize],
    playhead: StageTime,
    reach: StageTime,
    rate: StageRate,
) -> StageTime {
    let others = lanes.list.iter().flat_map(|lane| &lane.bars).filter(|bar| !dragged.contains(&bar.action));
    let ends = others.flat_map(|bar| {
        let ends = [Some(bar.begin), (!bar.is_passive).then_some(bar.end)];
        ends.into_iter().flatten().chain(bar.marks.iter().map(|mark| mark.time))
    });
    let distance = |other: &StageTime| (other.ticks() - time.ticks()).abs();
    let nearest = ends.chain([playhead, StageTime::ZERO]).min_by_key(distance);
    match nearest.filter(|other| distance(other) <= reach.ticks()) {
        Some(time) => time,
        None => frame_at(time, rate),
    }
}

/// Returns the time of the nearest frame.
pub(super) fn frame_at(time: StageTime, rate: StageRate) -> StageTime {
    rate.frame(rate.nearest_frame(time))
}
