//! A sum of base and layers as linear keys, or steps.

use super::rule::LayerRule;
use super::stack::StackSampler;
use super::times::{JUMP, all_times};
use super::{AddedKeys, LayerChannel, seen};
use crate::data::{Channel, Interpolation};
use crate::limits::KEYS_PER_CHANNEL;
use crate::sample::{Value, sample_channel};
use std::sync::Arc;

/// Radians or factors by which a channel may differ, between its keys, from what its layers give.
const TOLERANCE: f32 = 1e-4;

/// How often the time between two keys is halved at most.
const HALVINGS: u32 = 5;

/// Returns the channel with keys at all keys of base, layers and weights, and between them where a line would be off by more
/// than the tolerance, at the times that `added` allows; steps where there are only steps.
pub(super) fn in_lines<R: LayerRule>(
    base: &Channel<R::Value>,
    layers: &[LayerChannel<'_, R::Value>],
    rest: R::Value,
    added: AddedKeys,
) -> Channel<R::Value> {
    let at = |time: f32| seen::<R>(sample_channel(base, rest, time), layers, time);
    let mut stack = StackSampler::<R>::new(base, layers, rest);
    let is_stepped =
        |channel: &Channel<R::Value>| channel.len() <= 1 || channel.interpolation == Interpolation::Step;
    let all_stepped = is_stepped(base)
        && layers.iter().all(|layer| is_stepped(layer.keys) && layer.settings.has_constant_weight());
    let times = all_times(base, layers, !all_stepped);
    if all_stepped {
        let ends: Vec<R::Value> = times.iter().map(|&time| stack.at(time)).collect();
        return Channel { times: times.into(), values: ends.into(), interpolation: Interpolation::Step };
    }
    // Each value with how far the way to it, from the one before, may be from a line.
    let (mut ends, mut bends) = (Vec::with_capacity(times.len()), Vec::with_capacity(times.len()));
    for &time in &times {
        ends.push(stack.at(time));
        bends.push(stack.bend());
    }
    let way = ends.iter().fold(0.0_f32, |way, &value| way.max(R::distance(ends[0], value)));
    let tolerance = TOLERANCE * way.clamp(1e-3, 1.0);
    // A hostile file must not make a channel much longer than its sources.
    let mut room = KEYS_PER_CHANNEL.min(times.len() + 1000);
    let (mut all, mut values) = (Vec::with_capacity(times.len()), Vec::with_capacity(times.len()));
    for (index, (&time, &value)) in times.iter().zip(&ends).enumerate() {
        all.push(time);
        values.push(value);
        if let (Some(&next), Some(&after)) = (times.get(index + 1), ends.get(index + 1))
            && next - time > 2.0 * JUMP
            && bends[index + 1] > tolerance
        {
            let (ends, keys) = ([(time, value), (next, after)], (&mut room, &mut all, &mut values));
            match added {
                AddedKeys::Halfway => {
                    halve::<R>(&at, ends, (tolerance, HALVINGS), keys.0, keys.1, keys.2);
                }
                AddedKeys::OnFrames(rate) => {
                    let within = frames_between(time, next, rate);
                    on_frames::<R>(&at, ends, (tolerance, rate), within, keys);
                }
            }
        }
    }
    Channel { times: all.into(), values: hemisphere::<R>(values), interpolation: Interpolation::Linear }
}

/// Puts keys between two times where a line is off by more than the tolerance.
fn halve<R: LayerRule>(
    at: &dyn Fn(f32) -> R::Value,
    [from, to]: [(f32, R::Value); 2],
    (tolerance, halvings): (f32, u32),
    room: &mut usize,
    times: &mut Vec<f32>,
    values: &mut Vec<R::Value>,
) {
    let middle = from.0 + (to.0 - from.0) * 0.5;
    let quarter = from.0 + (to.0 - from.0) * 0.25;
    if halvings == 0 || *room == 0 || middle - from.0 <= JUMP {
        return;
    }
    let seen = at(middle);
    let off = |time: f32, seen: R::Value| {
        R::distance(R::Value::linear(from.1, to.1, (time - from.0) / (to.0 - from.0)), seen) > tolerance
    };
    if !off(middle, seen) && !off(quarter, at(quarter)) {
        return;
    }
    *room -= 1;
    halve::<R>(at, [from, (middle, seen)], (tolerance, halvings - 1), room, times, values);
    times.push(middle);
    values.push(seen);
    halve::<R>(at, [(middle, seen), to], (tolerance, halvings - 1), room, times, values);
}

/// Returns the first whole frame after a time and the last one before another, but none within half a millisecond of either.
fn frames_between(from: f32, to: f32, rate: f32) -> [i64; 2] {
    let frame = |time: f32| f64::from(time) * f64::from(rate);
    let near = f64::from(5.0 * JUMP) * f64::from(rate);
    // Frames beyond all numbers are none.
    let [first, last] = [(frame(from) + near).floor(), (frame(to) - near).ceil()];
    [(first as i64).saturating_add(1), (last as i64).saturating_sub(1)]
}

/// Puts keys on whole frames, `first` to `last`, between two times where a line is off by more than the tolerance.
fn on_frames<R: LayerRule>(
    at: &dyn Fn(f32) -> R::Value,
    [from, to]: [(f32, R::Value); 2],
    (tolerance, rate): (f32, f32),
    [first, last]: [i64; 2],
    (room, times, values): (&mut usize, &mut Vec<f32>, &mut Vec<R::Value>),
) {
    if first > last || *room == 0 {
        return;
    }
    let time = |frame: i64| (frame as f64 / f64::from(rate)) as f32;
    let off = |frame: i64| {
        let line = R::Value::linear(from.1, to.1, (time(frame) - from.0) / (to.0 - from.0));
        R::distance(line, at(time(frame))) > tolerance
    };
    let middle = first.midpoint(last);
    if ![middle, first.midpoint(middle), middle.midpoint(last)].into_iter().any(off) {
        return;
    }
    *room -= 1;
    let key = (time(middle), at(time(middle)));
    on_frames::<R>(at, [from, key], (tolerance, rate), [first, middle - 1], (room, times, values));
    times.push(key.0);
    values.push(key.1);
    on_frames::<R>(at, [key, to], (tolerance, rate), [middle + 1, last], (room, times, values));
}

/// Returns the values with neighboring rotations in one hemisphere, as the importers have them.
fn hemisphere<R: LayerRule>(mut values: Vec<R::Value>) -> Arc<[R::Value]> {
    for key in 1..values.len() {
        values[key] = R::near(values[key], values[key - 1]);
    }
    values.into()
}
