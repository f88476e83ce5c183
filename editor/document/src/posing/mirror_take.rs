//! Mirrors takes: key by key, the other side of the body gets the motion of one side.
//!
//! Mirroring a value is linear in its numbers ([`Mirror`]), so tangents of splines are mirrored like values, and the motion
//! between keys is mirrored exactly.

use super::mirror::Mirror;
use dragonfly_anim::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::sample::{Value, rest_pose, sample_channel};
use glam::{Quat, Vec3};

/// Seconds within which two keys are at the same time.
const SAME: f32 = crate::edit::SAME_TIME;

/// The range of time that is mirrored; outside of it the take stays as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorRange {
    /// Seconds.
    pub from: f32,
    /// Seconds.
    pub to: f32,
    /// Seconds before and after the range at which the take has its own pose again: one frame.
    pub frame: f32,
}

/// Returns the take with the mirrored motion. Of `targets` only these bones change; all where it is empty. `None` where a range
/// cuts a spline.
pub fn mirrored_take(
    mirror: &Mirror,
    skeleton: &Skeleton,
    take: &Take,
    range: Option<MirrorRange>,
    targets: &[BoneIndex],
) -> Option<Take> {
    let empty = Track::default();
    let mut mirrored = take.clone();
    for (index, source) in skeleton.bones.iter().enumerate() {
        let bone = index as BoneIndex;
        let Some(target) = mirror.target(bone) else { continue };
        if !(targets.is_empty() || targets.contains(&target)) {
            continue;
        }
        let (from, rest) = (take.tracks.get(index).unwrap_or(&empty), rest_pose(source));
        let own = rest_pose(&skeleton.bones[target as usize]);
        let Some(track) = mirrored.tracks.get_mut(target as usize) else { continue };
        let (start, end) = (take.start, take.end());
        let zero = mirror.translation(bone, Vec3::ZERO)?;
        let moved = MirroredChannel {
            rest: rest.translation,
            own: own.translation,
            start,
            end,
            value: |value| mirror.translation(bone, value),
            rate: |rate| Some(mirror.translation(bone, rate)? - zero),
            apart: |a: Vec3, b: Vec3| a.distance(b),
        };
        track.translation = moved.channel(&from.translation, &track.translation, range)?;
        let turned = MirroredChannel {
            rest: rest.rotation,
            own: own.rotation,
            start,
            end,
            value: |value| mirror.rotation(bone, value),
            rate: |rate| mirror.rotation_rate(bone, rate),
            apart: |a: Quat, b: Quat| (a - b).length().min((a + b).length()),
        };
        track.rotation = turned.channel(&from.rotation, &track.rotation, range)?;
        let scaled = MirroredChannel {
            rest: rest.scale,
            own: own.scale,
            start,
            end,
            value: |value| mirror.scale(bone, value),
            rate: |rate| mirror.scale(bone, rate),
            apart: |a: Vec3, b: Vec3| a.distance(b),
        };
        track.scale = scaled.channel(&from.scale, &track.scale, range)?;
    }
    Some(mirrored)
}

/// The maps of one channel from a bone to its mirror bone.
struct MirroredChannel<T, V, R, A> {
    /// Rest value of the bone.
    rest: T,
    /// Rest value of the mirror bone.
    own: T,
    /// Start and end of the take in seconds.
    start: f32,
    end: f32,
    value: V,
    rate: R,
    apart: A,
}

impl<T, V, R, A> MirroredChannel<T, V, R, A>
where
    T: Value,
    V: Fn(T) -> Option<T>,
    R: Fn(T) -> Option<T>,
    A: Fn(T, T) -> f32,
{
    /// Returns the new channel of the mirror bone, whose channel is `target`.
    fn channel(
        &self,
        from: &Channel<T>,
        target: &Channel<T>,
        range: Option<MirrorRange>,
    ) -> Option<Channel<T>> {
        match range {
            None => self.whole(from),
            Some(range) => self.part(from, target, range),
        }
    }

    fn whole(&self, from: &Channel<T>) -> Option<Channel<T>> {
        if from.is_empty() {
            // The mirror bone rests as well, unless the two do not rest symmetrically.
            let value = (self.value)(self.rest)?;
            let rests = (self.apart)(value, self.own) <= 1e-5;
            let still = || Channel::new(vec![self.start], vec![value], Interpolation::Linear);
            return Some(if rests { Channel::default() } else { still() });
        }
        let spline = from.interpolation == Interpolation::CubicSpline;
        let map = |(index, &value): (usize, &T)| {
            if spline && index % 3 != 1 { (self.rate)(value) } else { (self.value)(value) }
        };
        let values = from.values.iter().enumerate().map(map).collect::<Option<Vec<T>>>()?;
        Some(Channel { times: from.times.clone(), values: values.into(), interpolation: from.interpolation })
    }

    fn part(&self, from: &Channel<T>, target: &Channel<T>, range: MirrorRange) -> Option<Channel<T>> {
        let mirrored = self.whole(from)?;
        if mirrored.is_empty() && target.is_empty() {
            return Some(target.clone());
        }
        let spline = |channel: &Channel<T>| channel.interpolation == Interpolation::CubicSpline;
        if spline(&mirrored) || spline(target) {
            return None;
        }
        let inside = |time: f32| time >= range.from - SAME && time <= range.to + SAME;
        let near = |time: f32| time > range.from - range.frame + SAME && time < range.to + range.frame - SAME;
        let mut keys: Vec<(f32, T)> = Vec::new();
        let own = |time: f32| (time, sample_channel(target, self.own, time));
        keys.extend(target.times.iter().filter(|&&time| !near(time)).map(|&time| own(time)));
        let before = range.from - range.frame;
        keys.extend((before >= self.start).then(|| own(before)));
        let after = range.to + range.frame;
        keys.extend((after <= self.end).then(|| own(after)));
        let at = |time: f32| (time, sample_channel(&mirrored, self.own, time));
        keys.extend(mirrored.times.iter().filter(|&&time| inside(time)).map(|&time| at(time)));
        keys.extend([at(range.from), at(range.to)]);
        keys.sort_by(|a, b| a.0.total_cmp(&b.0));
        keys.dedup_by(|later, earlier| later.0 - earlier.0 <= SAME);
        let (times, values): (Vec<f32>, Vec<T>) = keys.into_iter().unzip();
        let interpolation = if target.is_empty() { mirrored.interpolation } else { target.interpolation };
        Some(Channel::new(times, values, interpolation))
    }
}
