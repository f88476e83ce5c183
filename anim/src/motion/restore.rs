//! Restoring motion, and the formula that extraction and restoration share.

use super::extract::{map, map_turns, times_above, track_of, with_track};
use super::keys::{Refine, slopes, spins};
use super::parent_space::ParentSpace;
use super::{MotionError, RootMotion};
use crate::data::{Channel, Interpolation, Skeleton, Take, Track};
use crate::sample::{rest_pose, sample_channel};
use glam::{DQuat, DVec3, Quat, Vec3};

/// Restores `motion` in `take`: the inverse of [`extract`](super::extract()).
///
/// For the motion and the take in place of one extraction this gives the original again, within rounding, at keys and
/// between. Either may have been edited: the bone gets keys wherever the motion has some. Where only one of the two is
/// a cubic spline, or only one has steps, the result has the interpolation of the bone's own channel (the motion's,
/// where the bone has no keys) and follows the motion at its keys.
///
/// The take keeps its start and length; keys of the motion outside them are kept too.
pub fn restore(take: &Take, skeleton: &Skeleton, motion: &RootMotion) -> Result<Take, MotionError> {
    let bone = motion.bone;
    let rest = rest_pose(skeleton.bones.get(bone as usize).ok_or(MotionError::NoSuchBone { bone })?);
    let (mut track, above) = (track_of(take, bone), times_above(take, skeleton, bone));
    if !motion.rotation.is_empty() {
        let kind = motion.rotation.interpolation;
        track.rotation = keyed(&track.rotation, rest.rotation, &motion.rotation.times, kind);
        track.rotation = Quat::refined(&track.rotation, rest.rotation, &above);
    }
    if !motion.translation.is_empty() {
        let kind = motion.translation.interpolation;
        track.translation = keyed(&track.translation, rest.translation, &motion.translation.times, kind);
    }
    let turning = !motion.rotation.is_empty();
    if turning || !motion.translation.is_empty() {
        track.translation = Vec3::refined(&track.translation, rest.translation, &above);
    }
    // Whether the bone leaves the axis of rotation, so that its translation is rotated.
    let off_axis = !track.translation.is_empty() && has_horizontal(take, skeleton, &track, motion)?;
    if off_axis && turning {
        track.translation = Vec3::refined(&track.translation, rest.translation, &motion.rotation.times);
    }
    let track = apply(take, skeleton, &track, motion, MotionDirection::Restore)?;
    Ok(with_track(take, track))
}

/// Returns `channel` with keys at `times`; one without keys gets the interpolation `kind`.
pub(super) fn keyed<T: Refine>(
    channel: &Channel<T>,
    rest: T,
    times: &[f32],
    kind: Interpolation,
) -> Channel<T> {
    if !channel.is_empty() {
        return T::refined(channel, rest, times);
    }
    let channel = T::refined(&Channel::default(), rest, times);
    match kind {
        Interpolation::CubicSpline => {
            let values: Vec<T> = channel.values.iter().flat_map(|&value| [T::ZERO, value, T::ZERO]).collect();
            Channel { times: channel.times, values: values.into(), interpolation: kind }
        }
        kind => Channel { interpolation: kind, ..channel },
    }
}

/// Returns whether the bone in place ever leaves the axis of rotation by more than rounding.
fn has_horizontal(
    take: &Take,
    skeleton: &Skeleton,
    track: &Track,
    motion: &RootMotion,
) -> Result<bool, MotionError> {
    let (up, pivot) = (motion.up.to_vec3().as_dvec3(), motion.pivot.as_dvec3());
    for (key, &time) in track.translation.times.iter().enumerate() {
        let space = ParentSpace::at(take, skeleton, track.bone, time)?;
        let place = space.point_to_root(track.translation.value(key).unwrap_or_default().as_dvec3()) - pivot;
        let off = (place - up * place.dot(up)).length();
        if off > 1e-5 * (1.0 + place.length() + pivot.length()) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Direction of the conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum MotionDirection {
    /// Extracts motion from the take.
    Extract,
    /// Restores motion in the take.
    Restore,
}

/// Returns the track with the motion extracted from its keys, or restored in them.
pub(super) fn apply(
    take: &Take,
    skeleton: &Skeleton,
    track: &Track,
    motion: &RootMotion,
    direction: MotionDirection,
) -> Result<Track, MotionError> {
    let rest = rest_pose(&skeleton.bones[track.bone as usize]);
    let mut result = track.clone();
    let turning = !motion.rotation.is_empty();
    if turning || !motion.translation.is_empty() {
        result.translation = map(&track.translation, rest.translation, |time, value, rates| {
            let space = ParentSpace::at(take, skeleton, track.bone, time)?;
            let sample = MotionSample::of(motion, time);
            let sides = [0, 1].map(|side| sample.point(&space, value, rates[side], side, direction));
            Ok((sides[0].0, sides.map(|side| side.1)))
        })?;
    }
    if turning {
        result.rotation = map_turns(&track.rotation, rest.rotation, |time, value, rates| {
            let space = ParentSpace::at(take, skeleton, track.bone, time)?;
            let sample = MotionSample::of(motion, time);
            let sides = [0, 1].map(|side| sample.rotation(&space, value, rates[side], side, direction));
            Ok((sides[0].0, sides.map(|side| side.1)))
        })?;
    }
    Ok(result)
}

/// The motion at one time, and its derivatives before and after.
struct MotionSample {
    pivot: DVec3,
    moved: DVec3,
    turned: DQuat,
    rates: [(DVec3, DQuat); 2],
}

impl MotionSample {
    fn of(motion: &RootMotion, time: f32) -> Self {
        let speeds = slopes(&motion.translation, Vec3::ZERO, time);
        let turned = sample_channel(&motion.rotation, Quat::IDENTITY, time).as_dquat().normalize();
        // A unit quaternion only changes at a right angle to itself; the rest of a difference quotient is rounding.
        let spins = spins(&motion.rotation, time).map(|spin| spin.as_dquat());
        let spins = spins.map(|spin| spin - turned * turned.dot(spin));
        Self {
            pivot: motion.pivot.as_dvec3(),
            moved: sample_channel(&motion.translation, Vec3::ZERO, time).as_dvec3(),
            turned,
            rates: [0, 1].map(|side| (speeds[side].as_dvec3(), spins[side])),
        }
    }

    /// Converts a translation and its rate. With w = Y⁻¹ (p - c - m): p = c + m + Y w, and by the product rule p' = m'
    /// + Y' w + Y w'.
    fn point(
        &self,
        space: &ParentSpace,
        value: Vec3,
        rate: Vec3,
        side: usize,
        direction: MotionDirection,
    ) -> (Vec3, Vec3) {
        let (speed, spin) = self.rates[side];
        let (value, rate) = (space.point_to_root(value.as_dvec3()), space.vector_to_root(rate.as_dvec3()));
        let base = self.pivot + self.moved;
        let (value, rate) = match direction {
            MotionDirection::Extract => {
                let inner = self.turned.conjugate() * (value - base);
                let rate = self.turned.conjugate() * (rate - speed - swept(self.turned, spin, inner));
                (self.pivot + inner, rate)
            }
            MotionDirection::Restore => {
                let inner = value - self.pivot;
                (base + self.turned * inner, speed + swept(self.turned, spin, inner) + self.turned * rate)
            }
        };
        (space.point_from_root(value).as_vec3(), space.vector_from_root(rate).as_vec3())
    }

    /// Converts a rotation and its rate: q = S q' with S = R⁻¹ Y R, and by the product rule.
    fn rotation(
        &self,
        space: &ParentSpace,
        value: Quat,
        rate: Quat,
        side: usize,
        direction: MotionDirection,
    ) -> (Quat, Quat) {
        let (turned, spin) =
            (space.rotation_from_root(self.turned), space.rotation_from_root(self.rates[side].1));
        let (value, rate) = (value.as_dquat(), rate.as_dquat());
        let (value, rate) = match direction {
            MotionDirection::Extract => {
                let inner = turned.conjugate() * value;
                (inner, turned.conjugate() * (rate - spin * inner))
            }
            MotionDirection::Restore => (turned * value, spin * value + turned * rate),
        };
        (value.normalize().as_quat(), rate.as_quat())
    }
}

/// Returns the velocity of `vector` when it is rotated by `turned`, which changes by `spin`: the vector part of `Y' w
/// Y* + Y w Y'*`.
fn swept(turned: DQuat, spin: DQuat, vector: DVec3) -> DVec3 {
    let vector = DQuat::from_xyzw(vector.x, vector.y, vector.z, 0.0);
    (spin * vector * turned.conjugate() + turned * vector * spin.conjugate()).xyz()
}
