//! Phase shift: the keys of a take that repeats move around the loop.
//!
//! With `L` the length of the take, `x(t)` a channel from `0` to `L`, and `d` the shift in `0..L`:
//!
//! ```text
//! y(t) = x(t − d)               d ≤ t
//! y(t) = x(t − d + L) − D       t < d
//! ```
//!
//! `D` is the way of the bone that travels, on the ground, and zero for all others: that bone goes on where it was. Where the take
//! repeats (`x(L) = x(0) + D`), so does the shifted one, and the pose at `d` is the pose of the old start. Where it
//! does not, the last key of the loop is left out, and the jump is spread over the time from the key before it to `d`: close
//! the loop first.
//!
//! Keys move to `t + d` or `t + d − L`, with their values and tangents; a key is added at both ends of the take, where the loop
//! is cut, and another one where a channel of the closest key switches beside it. With a frame rate, cubic splines and channels of the
//! closest key become linear keys at every frame instead.

use super::part::{Cuttable, PartKey, SAME, part};
use crate::data::{BoneIndex, Channel, Interpolation, MorphTrack, Skeleton, Take};
use crate::motion::Axis;
use crate::sample::{rest_pose, sample_channel};
use glam::Vec3;

/// Largest number of frames of a take.
const MOST_FRAMES: f32 = 1e6;

/// How a loop is shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftSettings {
    /// Seconds by which keys become later; negative for earlier. Whole lengths of the take change nothing.
    pub by: f32,
    /// Frames per second of linear keys that replace splines and channels of the closest key; `None`: they keep their kind.
    pub rate: Option<f32>,
    /// The bone that travels.
    pub travel: Option<BoneIndex>,
    /// The axis that points up.
    pub up: Axis,
}

/// Reasons why a loop cannot be shifted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ShiftError {
    /// The take has no length, or too many frames.
    #[error("a take of {length} s cannot be shifted{}", .rate.map_or(String::new(), |rate| format!(" at {rate} frames per second")))]
    Range {
        /// Length of the take in seconds.
        length: f32,
        /// The rate that was given.
        rate: Option<f32>,
    },
    /// The shift is not a number.
    #[error("a loop cannot be shifted by {by} s")]
    By {
        /// The shift that was given.
        by: f32,
    },
}

/// Returns `take` with its keys moved around the loop.
///
/// # Errors
///
/// The take has no length, the rate is not a positive number, or the shift is not finite.
pub fn shift_loop(take: &Take, skeleton: &Skeleton, settings: &ShiftSettings) -> Result<Take, ShiftError> {
    let ShiftSettings { by, rate, travel, up } = *settings;
    let length = take.length;
    let fits = |rate: f32| rate.is_finite() && rate > 0.0 && length * rate <= MOST_FRAMES;
    let usable = take.start.is_finite() && length.is_finite() && length > 0.0;
    if !(usable && rate.is_none_or(fits)) {
        return Err(ShiftError::Range { length, rate });
    }
    if !by.is_finite() {
        return Err(ShiftError::By { by });
    }
    let shift = by.rem_euclid(length);
    if shift < SAME || length - shift < SAME {
        return Ok(take.clone());
    }
    let window = ShiftWindow { start: take.start, end: take.end(), shift, rate };
    let mut shifted = take.clone();
    for (index, (track, bone)) in shifted.tracks.iter_mut().zip(&skeleton.bones).enumerate() {
        let rest = rest_pose(bone);
        let mut way = Vec3::ZERO;
        if travel == Some(index as BoneIndex) {
            let at = |time: f32| sample_channel(&track.translation, rest.translation, time);
            let up = up.to_vec3();
            way = at(window.end) - at(window.start);
            way -= up * way.dot(up);
        }
        let (translation, rotation, scale) = (rest.translation, rest.rotation, rest.scale);
        track.translation = window.channel(&track.translation, translation, |value| value - way);
        track.rotation = window.channel(&track.rotation, rotation, |value| value);
        track.scale = window.channel(&track.scale, scale, |value| value);
    }
    for (morph, before) in shifted.morphs.iter_mut().zip(&take.morphs) {
        *morph = window.morph(before);
    }
    Ok(shifted)
}

/// The times of the loop.
struct ShiftWindow {
    start: f32,
    end: f32,
    shift: f32,
    rate: Option<f32>,
}

impl ShiftWindow {
    /// Returns the time at which the loop is cut. A key there is meant, not what is just before it.
    fn cut(&self, times: &[f32]) -> f32 {
        let cut = self.end - self.shift;
        times.iter().copied().find(|time| (time - cut).abs() <= SAME).unwrap_or(cut)
    }

    /// Returns the keys after the shift. `around` changes the values of those that came around the end.
    fn keys<T: Cuttable>(
        &self,
        channel: &Channel<T>,
        rest: T,
        around: impl Fn(T) -> T,
    ) -> (Vec<PartKey<T>>, Interpolation) {
        let baked = [Interpolation::CubicSpline, Interpolation::Closest].contains(&channel.interpolation);
        if let Some(rate) = self.rate.filter(|_| baked) {
            return (self.baked(channel, rest, around, rate), Interpolation::Linear);
        }
        let (start, end, shift) = (self.start, self.end, self.shift);
        let cut = self.cut(&channel.times);
        let mut keys = part(channel, rest, cut, end);
        for key in &mut keys {
            key.time = if key.time == cut { start } else { key.time - end + shift + start };
            key.value = around(key.value);
        }
        // The end of the loop before and its start are one key.
        let before = keys.pop();
        for (index, key) in part(channel, rest, start, cut).into_iter().enumerate() {
            let arrive = before.filter(|_| index == 0).map_or(key.arrive, |before| before.arrive);
            let time = if key.time == cut { end } else { key.time + shift };
            keys.push(PartKey { time, arrive, ..key });
        }
        // Rounding may let keys meet. The last one is the end.
        let last = keys.pop();
        keys.dedup_by(|later, earlier| later.time <= earlier.time + SAME);
        keys.extend(last);
        (keys, channel.interpolation)
    }

    /// Returns a key at every frame.
    fn baked<T: Cuttable>(
        &self,
        channel: &Channel<T>,
        rest: T,
        around: impl Fn(T) -> T,
        rate: f32,
    ) -> Vec<PartKey<T>> {
        let (start, end) = (self.start, self.end);
        let cut = self.cut(&channel.times);
        let key = |time: f32, old: f32, wrapped: bool| {
            let value = sample_channel(channel, rest, old);
            let value = if wrapped { around(value) } else { value };
            PartKey { time, arrive: T::ZERO, value, leave: T::ZERO }
        };
        let mut keys = vec![key(start, cut, true)];
        let frames = ((end - start) * rate) as usize;
        let times = (1..=frames).map(|frame| start + frame as f32 / rate);
        for time in times.filter(|&time| time > start + SAME && time < end - SAME) {
            let old = time - self.shift;
            let wrapped = old < start;
            keys.push(key(time, if wrapped { old + (end - start) } else { old }, wrapped));
        }
        keys.push(key(end, cut, false));
        keys
    }

    fn channel<T: Cuttable>(&self, channel: &Channel<T>, rest: T, around: impl Fn(T) -> T) -> Channel<T> {
        if channel.is_empty() {
            return channel.clone();
        }
        let (keys, interpolation) = self.keys(channel, rest, around);
        let times: Vec<f32> = keys.iter().map(|key| key.time).collect();
        let values: Vec<T> = match interpolation {
            Interpolation::CubicSpline => {
                keys.iter().flat_map(|key| [key.arrive, key.value, key.leave]).collect()
            }
            Interpolation::Step | Interpolation::Linear | Interpolation::Closest => {
                keys.iter().map(|key| key.value).collect()
            }
        };
        Channel::new(times, values, interpolation)
    }

    fn morph(&self, track: &MorphTrack) -> MorphTrack {
        let targets = track.targets as usize;
        if track.times.is_empty() || targets == 0 {
            return track.clone();
        }
        // The keys of all targets are at the same times.
        let columns: Vec<Channel<f32>> = (0..targets)
            .map(|target| {
                let weights: Vec<f32> = track.weights.iter().skip(target).step_by(targets).copied().collect();
                let column = Channel {
                    times: track.times.clone(),
                    values: weights.into(),
                    interpolation: track.interpolation,
                };
                self.channel(&column, 0.0, |weight| weight)
            })
            .collect();
        let Some(first) = columns.first() else { return track.clone() };
        let rows = first.values.len();
        let weights: Vec<f32> =
            (0..rows).flat_map(|row| columns.iter().map(move |column| column.values[row])).collect();
        MorphTrack {
            times: first.times.clone(),
            weights: weights.into(),
            interpolation: first.interpolation,
            ..track.clone()
        }
    }
}
