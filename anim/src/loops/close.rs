//! Closing a loop over the last frames of a take.
//!
//! Over the last `d` seconds each channel gets a correction that starts with value and slope zero and ends with the gap of
//! the value `G` and the gap of the slope `S` (both: start of the take minus end). It is the cubic Hermite polynomial,
//! with `u` from 0 to 1:
//!
//! ```text
//! c(u) = G (3u² − 2u³) + S d (u³ − u²)          c(0) = 0, c'(0) = 0, c(1) = G, c'(1) = S d
//! translation, scale   x(t) + c
//! rotation             exp(c) q(t)               G = log(q(start) q(end)⁻¹), S the difference of angular velocities
//! ```
//!
//! so that position and velocity of the repeated take are continuous. The bone that travels keeps its way on the ground. Slopes are
//! measured over one frame. Feet are kept by locking the contacts of the closed take again
//! ([`crate::contact::lock_contacts`]).

use crate::contact::{Contact, LockError, LockSettings, lock_contacts};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take};
use crate::motion::Axis;
use crate::sample::{rest_pose, sample_channel};
use glam::{Quat, Vec3};

/// How a loop is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseSettings {
    /// Frames per second of the new keys.
    pub rate: f32,
    /// Number of frames before the end over which the take is corrected.
    pub frames: u32,
    /// The bone that travels: its way on the ground is kept. No bone above it may move.
    pub travel: Option<BoneIndex>,
    /// The axis that points up.
    pub up: Axis,
}

/// Reasons why a loop cannot be closed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CloseError {
    /// The frame rate or the number of frames is not positive, or the take has more than a million frames.
    #[error("a take of {length} s cannot be closed over {frames} frames at {rate} frames per second")]
    Range {
        /// Seconds.
        length: f32,
        /// The number of frames that was given.
        frames: u32,
        /// The rate that was given.
        rate: f32,
    },
    /// The feet cannot be locked.
    #[error(transparent)]
    Lock(#[from] LockError),
}

/// Returns `take` with its last frames changed so that it repeats without a jump, with linear keys at every frame there.
/// Channels that already repeat in value and slope stay as they are. `contacts` are held.
///
/// # Errors
///
/// The range has no frame, or a contact has no limb. Nothing is changed then.
pub fn close_loop(
    take: &Take,
    skeleton: &Skeleton,
    contacts: &[Contact],
    settings: &CloseSettings,
) -> Result<Take, CloseError> {
    let (rate, frames) = (settings.rate, settings.frames);
    let seconds = frames as f32 / rate;
    let usable = rate.is_finite() && rate > 0.0 && frames > 0;
    if !(usable && take.length * rate <= 1e6 && seconds <= take.length + 0.5 / rate) {
        return Err(CloseError::Range { length: take.length, frames, rate });
    }
    let window = CloseWindow {
        start: take.start,
        from: (take.end() - seconds).max(take.start),
        end: take.end(),
        step: 1.0 / rate,
        frames,
    };
    let mut closed = take.clone();
    for (index, (track, bone)) in closed.tracks.iter_mut().zip(&skeleton.bones).enumerate() {
        let rest = rest_pose(bone);
        let travels = settings.travel == Some(index as BoneIndex);
        let up = settings.up.to_vec3();
        let kept = |gap: Vec3| if travels { up * gap.dot(up) } else { gap };
        track.translation = window.close(&track.translation, rest.translation, kept);
        track.scale = window.close(&track.scale, rest.scale, |gap| gap);
        track.rotation = window.close(&track.rotation, rest.rotation, |gap| gap);
    }
    if contacts.is_empty() {
        return Ok(closed);
    }
    let lock = LockSettings { rate, ease: frames.min(6) };
    // Only contacts that the correction moved are held again; a contact that begins before it stays where it was.
    let moved: Vec<Contact> = contacts.iter().filter(|contact| contact.to > window.from).copied().collect();
    Ok(lock_contacts(&closed, skeleton, &moved, &lock)?.take)
}

/// A value to which a vector of correction can be added.
trait Correctable: crate::sample::Value {
    /// Returns the vector that leads from `self` to `other`.
    fn gap_to(self, other: Self) -> Vec3;
    /// Returns the value with a correction.
    fn corrected(self, by: Vec3) -> Self;
}

impl Correctable for Vec3 {
    fn gap_to(self, other: Self) -> Vec3 {
        other - self
    }

    fn corrected(self, by: Vec3) -> Self {
        self + by
    }
}

impl Correctable for Quat {
    fn gap_to(self, other: Self) -> Vec3 {
        let turn = other * self.conjugate();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        let sine = turn.xyz().length();
        let angle = 2.0 * libm::atan2f(sine, turn.w);
        // For small angles, angle / sine is 2 within rounding.
        turn.xyz() * if sine > 1e-6 { angle / sine } else { 2.0 }
    }

    fn corrected(self, by: Vec3) -> Self {
        (crate::trig::rotation_of_vector(by.as_dvec3()).as_quat() * self).normalize()
    }
}

/// The times between which a take is corrected.
struct CloseWindow {
    start: f32,
    from: f32,
    end: f32,
    step: f32,
    frames: u32,
}

impl CloseWindow {
    fn close<T: Correctable>(
        &self,
        channel: &Channel<T>,
        rest: T,
        kept: impl Fn(Vec3) -> Vec3,
    ) -> Channel<T> {
        if channel.is_empty() || matches!(channel.interpolation, Interpolation::Step | Interpolation::Closest)
        {
            return channel.clone();
        }
        let at = |time: f32| sample_channel(channel, rest, time);
        let first_step = at(self.start).gap_to(at(self.start + self.step));
        let last_step = at(self.end - self.step).gap_to(at(self.end));
        let gap = kept(at(self.end).gap_to(at(self.start)));
        let slope = kept(first_step - last_step) / self.step;
        if gap.length() < 1e-6 && slope.length() < 1e-4 {
            return channel.clone();
        }
        let duration = self.end - self.from;
        let correction = |time: f32| {
            let u = ((time - self.from) / duration).clamp(0.0, 1.0);
            gap * (u * u * (3.0 - 2.0 * u)) + slope * duration * (u * u * (u - 1.0))
        };
        let in_window = |time: f32| time >= self.from - 0.1 * self.step;
        let frame = |frame: u32| self.from + duration * (frame as f32 / self.frames as f32);
        let mut times: Vec<f32> = (0..=self.frames).map(frame).collect();
        if let Some(last) = times.last_mut() {
            *last = self.end;
        }
        if channel.interpolation == Interpolation::Linear {
            times.extend(channel.times.iter().filter(|&&time| !in_window(time)));
        } else {
            let count = ((self.from - self.start) / self.step + 1e-3) as usize;
            let frames = (0..=count).map(|frame| self.start + frame as f32 * self.step);
            times.extend(frames.filter(|&time| !in_window(time)));
        }
        times.sort_by(f32::total_cmp);
        times.dedup();
        let values: Vec<T> = times
            .iter()
            .map(|&time| if in_window(time) { at(time).corrected(correction(time)) } else { at(time) })
            .collect();
        Channel::new(times, values, Interpolation::Linear)
    }
}
