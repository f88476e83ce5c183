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
//! Step and linear keys move to `t + d` or `t + d − L`, with their values; a key is added at both ends of the take, where the loop
//! is cut. Cubic splines and channels of the closest key become linear keys at every frame.

use crate::data::{BoneIndex, Channel, Interpolation, MorphTrack, Skeleton, Take};
use crate::motion::Axis;
use crate::sample::{rest_pose, sample_channel, sample_morph_weights};
use glam::Vec3;

/// Seconds within which two keys are at the same time.
const SAME: f32 = 2e-5;

/// Largest number of frames of a take.
const MOST_FRAMES: f32 = 1e6;

/// How a loop is shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftSettings {
    /// Seconds by which keys become later; negative for earlier. Whole lengths of the take change nothing.
    pub by: f32,
    /// Frames per second of the keys that replace splines.
    pub rate: f32,
    /// The bone that travels.
    pub travel: Option<BoneIndex>,
    /// The axis that points up.
    pub up: Axis,
}

/// Reasons why a loop cannot be shifted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ShiftError {
    /// The take has no length, or too many frames.
    #[error("a take of {length} s at {rate} frames per second cannot be shifted")]
    Range {
        /// Length of the take in seconds.
        length: f32,
        /// The rate that was given.
        rate: f32,
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
    let usable = take.start.is_finite() && length > 0.0 && rate.is_finite() && rate > 0.0;
    if !(usable && length * rate <= MOST_FRAMES) {
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
        track.translation = window.channel(&track.translation, |channel, key| {
            sample_channel(channel, rest.translation, key.old) - if key.wrapped { way } else { Vec3::ZERO }
        });
        track.rotation =
            window.channel(&track.rotation, |channel, key| sample_channel(channel, rest.rotation, key.old));
        track.scale =
            window.channel(&track.scale, |channel, key| sample_channel(channel, rest.scale, key.old));
    }
    for (morph, before) in shifted.morphs.iter_mut().zip(&take.morphs) {
        *morph = window.morph(before);
    }
    Ok(shifted)
}

/// A key of the shifted loop: its time, and the time of its value in the loop before.
#[derive(Clone, Copy, Debug)]
struct ShiftedKey {
    new: f32,
    old: f32,
    /// Whether it came around the end of the loop.
    wrapped: bool,
}

/// The times of the loop.
struct ShiftWindow {
    start: f32,
    end: f32,
    shift: f32,
    rate: f32,
}

impl ShiftWindow {
    /// Returns the keys of a channel with keys at `times`; of one that becomes linear, a key at every frame.
    fn keys(&self, times: &[f32], interpolation: Interpolation) -> Vec<ShiftedKey> {
        let cut = self.end - self.shift;
        // A key at the cut itself is meant, not what is just before it.
        let at_cut = times.iter().find(|time| (**time - cut).abs() <= SAME);
        let cut = at_cut.copied().unwrap_or(cut);
        let mut keys = vec![ShiftedKey { new: self.start, old: cut, wrapped: true }];
        let mut add = |new: f32, old: f32, wrapped: bool| {
            let is_later = keys.last().is_none_or(|last| new > last.new + SAME);
            if is_later && new < self.end - SAME {
                keys.push(ShiftedKey { new, old, wrapped });
            }
        };
        match interpolation {
            Interpolation::Step | Interpolation::Linear => {
                let (before, after) = (self.start + SAME, self.end - SAME);
                for &time in times.iter().filter(|&&time| time > cut && time < after) {
                    add(time - self.end + self.shift + self.start, time, true);
                }
                // The start of the loop before: its first key, or the value that it holds until then.
                add(self.start + self.shift, self.start, false);
                for &time in times.iter().filter(|&&time| time > before && time < cut) {
                    add(time + self.shift, time, false);
                }
            }
            Interpolation::CubicSpline | Interpolation::Closest => {
                let frames = ((self.end - self.start) * self.rate) as usize;
                for new in (1..=frames).map(|frame| self.start + frame as f32 / self.rate) {
                    let old = new - self.shift;
                    let wrapped = old < self.start;
                    add(new, if wrapped { old + (self.end - self.start) } else { old }, wrapped);
                }
            }
        }
        keys.push(ShiftedKey { new: self.end, old: cut, wrapped: false });
        keys
    }

    fn channel<T: Copy>(
        &self,
        channel: &Channel<T>,
        value: impl Fn(&Channel<T>, &ShiftedKey) -> T,
    ) -> Channel<T> {
        if channel.is_empty() {
            return channel.clone();
        }
        let keys = self.keys(&channel.times, channel.interpolation);
        let times: Vec<f32> = keys.iter().map(|key| key.new).collect();
        let values: Vec<T> = keys.iter().map(|key| value(channel, key)).collect();
        Channel::new(times, values, shifted_kind(channel.interpolation))
    }

    fn morph(&self, track: &MorphTrack) -> MorphTrack {
        if track.times.is_empty() {
            return track.clone();
        }
        let keys = self.keys(&track.times, track.interpolation);
        let targets = track.targets as usize;
        let own = Take { morphs: vec![track.clone()], ..Take::default() };
        let mut weights = vec![0.0; keys.len() * targets];
        for (key, row) in keys.iter().zip(weights.chunks_mut(targets.max(1))) {
            sample_morph_weights(Some(&own), track.instance, &[], key.old, row);
        }
        MorphTrack {
            times: keys.iter().map(|key| key.new).collect(),
            weights: weights.into(),
            interpolation: shifted_kind(track.interpolation),
            ..track.clone()
        }
    }
}

/// Returns the interpolation of a channel after the shift.
fn shifted_kind(interpolation: Interpolation) -> Interpolation {
    match interpolation {
        Interpolation::Step => Interpolation::Step,
        Interpolation::Linear | Interpolation::CubicSpline | Interpolation::Closest => Interpolation::Linear,
    }
}
