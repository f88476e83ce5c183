//! Repeats the keys of a channel.

use super::CycleValue;
use crate::data::{Channel, Interpolation};

/// How cycles follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleMode {
    /// The same values again.
    Repeat,
    /// Each cycle starts where the one before ends.
    Offset,
    /// Every other cycle runs backwards.
    Mirror,
}

/// The extent of cycles on one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleRange {
    /// This many cycles.
    Count(u32),
    /// Until this time, seconds.
    Until(f32),
}

/// How the keys of a channel are repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycles {
    /// How cycles follow each other.
    pub mode: CycleMode,
    /// Cycles before the keys.
    pub before: CycleRange,
    /// Cycles after the keys.
    pub after: CycleRange,
    /// Largest number of keys of the result; cycles beyond it are left out.
    pub most_keys: usize,
    /// Distance of times below which keys are at the same time, seconds.
    pub same_time: f32,
}

/// A key: its time, and in-tangent, value and out-tangent.
type CycleKey<T> = (f32, [T; 3]);

/// Returns the keys of `channel` from number `first` to number `last`, repeated before and after; see [the module](super). All other
/// keys where cycles are, are gone; those beyond the cycles stay.
///
/// `sample` returns the value and the slope of a channel at a time. `None` with fewer than two keys, and if there is nothing to repeat.
pub fn cycled<T: CycleValue>(
    channel: &Channel<T>,
    [first, last]: [usize; 2],
    cycles: &Cycles,
    sample: impl Fn(&Channel<T>, f32) -> [T; 2],
) -> Option<Channel<T>> {
    let (per_key, count) = (channel.values_per_key(), channel.len());
    if first >= last || last >= count || channel.values.len() != count * per_key {
        return None;
    }
    let key = |at: usize| -> CycleKey<T> {
        let own = &channel.values[at * per_key..(at + 1) * per_key];
        (channel.times[at], if per_key == 3 { [own[0], own[1], own[2]] } else { [own[0]; 3] })
    };
    let base: Vec<CycleKey<T>> = (first..=last).map(key).collect();
    let [start, end] = [channel.times[first], channel.times[last]].map(f64::from);
    let period = end - start;
    if period <= f64::from(cycles.same_time) {
        return None;
    }
    let offset = T::offset(base[0].1[1], base[base.len() - 1].1[1]);
    let room = cycles.most_keys.saturating_sub(count) / (base.len() - 1);
    let number = |range: CycleRange, edge: f64, sign: f64| match range {
        CycleRange::Count(count) => (count as usize, None),
        CycleRange::Until(time) => {
            let far = (f64::from(time) - edge) * sign;
            let cycles = libm::ceil(far / period - 1e-6).max(0.0);
            (cycles as usize, (cycles > 0.0).then_some(time))
        }
    };
    let (before, from) = number(cycles.before, start, -1.0);
    let (after, until) = number(cycles.after, end, 1.0);
    let (before, after) = (before.min(room), after.min(room.saturating_sub(before.min(room))));
    if before + after == 0 {
        return None;
    }
    let cycle = |number: i32| -> Vec<CycleKey<T>> {
        let is_backwards = cycles.mode == CycleMode::Mirror && number % 2 != 0;
        let shift = period * f64::from(number);
        let moved = |at: usize| {
            let (time, [arrive, value, leave]) = base[at];
            let time = f64::from(time);
            if is_backwards {
                // The value that a step channel holds backwards is that of the key before.
                let held = channel.interpolation == Interpolation::Step && at > 0;
                let value = if held { base[at - 1].1[1] } else { value };
                return ((start + end + shift - time) as f32, [leave * -1.0, value, arrive * -1.0]);
            }
            let parts = if cycles.mode == CycleMode::Offset {
                let tangent = |tangent| T::moved_tangent(tangent, offset, number);
                [tangent(arrive), T::moved(value, offset, number), tangent(leave)]
            } else {
                [arrive, value, leave]
            };
            ((time + shift) as f32, parts)
        };
        if is_backwards {
            (0..base.len()).rev().map(moved).collect()
        } else {
            (0..base.len()).map(moved).collect()
        }
    };
    let mut keys: Vec<CycleKey<T>> = Vec::new();
    for number in -(before as i32)..=after as i32 {
        let mut next = cycle(number);
        if let (Some((_, seam)), Some((_, own))) = (keys.last_mut(), next.first()) {
            // The key between two cycles leaves as the later one starts.
            seam[2] = own[2];
            if channel.interpolation == Interpolation::Step {
                seam[1] = own[1];
            }
            next.remove(0);
        }
        keys.extend(next);
    }
    keys.dedup_by(|next, kept| next.0 <= kept.0);
    let whole = of_keys(&keys, channel.interpolation);
    let cut = |time: f32| -> CycleKey<T> {
        let [value, slope] = sample(&whole, time);
        (time, [slope, value, slope])
    };
    if let Some(from) = from.filter(|&from| before > 0 && from > keys[0].0 + cycles.same_time) {
        let edge = cut(from);
        keys.retain(|key| key.0 > from + cycles.same_time);
        keys.insert(0, edge);
    }
    if let Some(until) =
        until.filter(|&until| after > 0 && keys.last().is_some_and(|last| last.0 > until + cycles.same_time))
    {
        let edge = cut(until);
        keys.retain(|key| key.0 < until - cycles.same_time);
        keys.push(edge);
    }
    // Keys beyond the cycles stay.
    let (low, high) = (keys.first()?.0, keys.last()?.0);
    let early = (0..first).map(key).filter(|key| key.0 < low - cycles.same_time);
    let late = (last + 1..count).map(key).filter(|key| key.0 > high + cycles.same_time);
    let all: Vec<CycleKey<T>> = early.chain(keys.iter().copied()).chain(late).collect();
    Some(of_keys(&all, channel.interpolation))
}

fn of_keys<T: Copy>(keys: &[CycleKey<T>], interpolation: Interpolation) -> Channel<T> {
    let times: Vec<f32> = keys.iter().map(|(time, _)| *time).collect();
    let values: Vec<T> = if interpolation == Interpolation::CubicSpline {
        keys.iter().flat_map(|(_, parts)| *parts).collect()
    } else {
        keys.iter().map(|(_, parts)| parts[1]).collect()
    };
    Channel { times: times.into(), values: values.into(), interpolation }
}
