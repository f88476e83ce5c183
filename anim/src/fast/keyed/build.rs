//! Converts a take to the layout described in [`super`].

use super::super::key_table::KeyTable;
use super::super::pose::{Pose, blocks_of};
use super::super::rig::flushed_poses;
use super::super::simd::LANES;
use super::super::slerp::steps;
use super::super::still::StillPose;
use super::super::tiny::{flushed, largest};
use super::tracks::{BlockKey, Tracks};
use super::{FallbackChannel, KeyedTake};
use crate::data::{Channel, Interpolation, Skeleton, Take, Track, Transform};
use crate::sample::{Value, rest_pose, sample_channel};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// One property of one bone: its channel, and the value used where that is empty.
struct LaneChannel<'a, T> {
    channel: &'a Channel<T>,
    rest: T,
}

impl<T: Value + PartialEq> LaneChannel<'_, T> {
    fn at(&self, time: f32) -> T {
        sample_channel(self.channel, self.rest, time)
    }

    /// Returns the value if it is constant.
    fn constant(&self) -> Option<T> {
        let first = self.channel.times.first().map_or(self.rest, |&time| self.at(time));
        let is_first =
            |key| self.channel.value(key).map_or(self.rest, |value: T| value.healed(self.rest)) == first;
        let straight = self.channel.interpolation != Interpolation::CubicSpline;
        (self.channel.len() < 2 || straight && (0..self.channel.len()).all(is_first)).then_some(first)
    }

    /// Returns whether values between keys can be computed by linear interpolation or slerp.
    fn is_linear(&self) -> bool {
        self.channel.interpolation == Interpolation::Linear
            && KeyTable::new(self.channel.times.to_vec()).is_some()
    }
}

/// One property of all bones.
struct PropertyTracks<const N: usize, T> {
    tracks: Vec<Tracks<N>>,
    constant: Vec<u32>,
    /// Value of each bone where no track or fallback channel changes it.
    base: Vec<T>,
    /// Whether a bone's value changes.
    is_moving: Vec<bool>,
    fallback: Vec<usize>,
}

impl<const N: usize, T> PropertyTracks<N, T> {
    fn is_moving(&self, bone: usize) -> bool {
        self.is_moving.get(bone) == Some(&true)
    }
}

/// A value that can be stored in blocks of eight lanes.
trait LaneValue<const N: usize>: Value + PartialEq {
    /// Returns the number of steps into which the interval between two keys is cut.
    fn steps(from: Self, to: Self) -> usize;
    /// Returns this value in the hemisphere of `before`, the value it follows.
    fn following(self, before: Self) -> Self;
    fn numbers(self) -> [f32; N];
}

impl LaneValue<4> for Quat {
    fn steps(from: Self, to: Self) -> usize {
        steps(from, to)
    }

    fn following(self, before: Self) -> Self {
        if self.dot(before) < 0.0 { -self } else { self }
    }

    fn numbers(self) -> [f32; 4] {
        self.to_array()
    }
}

impl LaneValue<3> for Vec3 {
    fn steps(_: Self, _: Self) -> usize {
        1
    }

    fn following(self, _: Self) -> Self {
        self
    }

    fn numbers(self) -> [f32; 3] {
        self.to_array()
    }
}

pub(super) fn build(skeleton: &Skeleton, take: &Take) -> KeyedTake {
    let nothing = Track::default();
    let bones = skeleton.bones.iter().enumerate();
    let bones: Vec<(Transform, &Track)> =
        bones.map(|(bone, data)| (rest_pose(data), take.tracks.get(bone).unwrap_or(&nothing))).collect();
    let rotations = property::<4, Quat>(
        bones
            .iter()
            .map(|(rest, track)| LaneChannel { channel: &track.rotation, rest: rest.rotation })
            .collect(),
    );
    let translations = property::<3, Vec3>(
        bones
            .iter()
            .map(|(rest, track)| LaneChannel { channel: &track.translation, rest: rest.translation })
            .collect(),
    );
    let scales = property::<3, Vec3>(
        bones.iter().map(|(rest, track)| LaneChannel { channel: &track.scale, rest: rest.scale }).collect(),
    );
    let base = (0..bones.len()).map(|bone| Transform {
        translation: translations.base[bone],
        rotation: rotations.base[bone],
        scale: scales.base[bone],
    });
    let base = Pose::from_transforms(&flushed_poses(base.collect()));
    let track = |bone: usize| (bones[bone].1, bones[bone].0);
    let odd_rotations = rotations.fallback.iter().map(|&bone| {
        let (track, rest) = track(bone);
        FallbackChannel::Rotation(bone, track.rotation.clone(), rest.rotation)
    });
    let odd_translations = translations.fallback.iter().map(|&bone| {
        let (track, rest) = track(bone);
        FallbackChannel::Translation(bone, track.translation.clone(), rest.translation)
    });
    let odd_scales = scales.fallback.iter().map(|&bone| {
        let (track, rest) = track(bone);
        FallbackChannel::Scale(bone, track.scale.clone(), rest.scale)
    });
    let moves =
        |bone: usize| rotations.is_moving(bone) || translations.is_moving(bone) || scales.is_moving(bone);
    let turns = |block: u32| !rotations.constant.contains(&block);
    KeyedTake {
        start: take.start,
        length: take.length,
        bones: bones.len(),
        still: Arc::new(StillPose::of_blocks(base.blocks(), moves, turns)),
        fallback: odd_rotations.chain(odd_translations).chain(odd_scales).collect(),
        rotations: rotations.tracks,
        translations: translations.tracks,
        scales: scales.tracks,
    }
}

/// Sorts the lanes of a property into constants, tracks, and channels that the open path plays.
fn property<const N: usize, T: LaneValue<N>>(lanes: Vec<LaneChannel<'_, T>>) -> PropertyTracks<N, T> {
    let mut base: Vec<T> = Vec::with_capacity(lanes.len());
    let (mut fallback, mut is_track) = (Vec::new(), vec![false; lanes.len()]);
    let is_moving: Vec<bool> = lanes.iter().map(|lane| lane.constant().is_none()).collect();
    for (bone, lane) in lanes.iter().enumerate() {
        base.push(lane.constant().unwrap_or(lane.rest));
        if lane.constant().is_none() {
            is_track[bone] = lane.is_linear();
            if !is_track[bone] {
                fallback.push(bone);
            }
        }
    }
    let (mut tracks, mut constant) = (Vec::new(), Vec::new());
    for block in 0..blocks_of(lanes.len()) {
        let first = block * LANES;
        let bones = first..(first + LANES).min(lanes.len());
        let moving = |bone: &usize| is_track[*bone];
        let key_table = key_table_of(bones.clone().filter(moving).map(|bone| &lanes[bone]).collect());
        match key_table {
            Some(key_table) => {
                let value =
                    |bone: usize, time| if is_track[bone] { lanes[bone].at(time) } else { base[bone] };
                let keys = keys_of(key_table.times(), bones, value);
                tracks.push((block as u32, key_table, keys));
            }
            None => constant.push(block as u32),
        }
    }
    PropertyTracks { tracks: Tracks::collect(tracks), constant, base, is_moving, fallback }
}

/// Returns the times at which the block of `lanes` needs keys: all of theirs, and more in wide rotations. `None`
/// without lanes.
fn key_table_of<const N: usize, T: LaneValue<N>>(lanes: Vec<&LaneChannel<'_, T>>) -> Option<KeyTable> {
    let mut times: Vec<f32> = lanes.iter().flat_map(|lane| lane.channel.times.iter().copied()).collect();
    times.sort_by(f32::total_cmp);
    // 0.0 and -0.0 are the same time.
    times.dedup_by(|a, b| a == b);
    let mut all = Vec::with_capacity(times.len());
    for pair in times.windows(2) {
        let count = lanes.iter().map(|lane| T::steps(lane.at(pair[0]), lane.at(pair[1]))).max().unwrap_or(1);
        all.extend((0..count).map(|step| pair[0] + (pair[1] - pair[0]) * (step as f32 / count as f32)));
    }
    all.extend(times.last());
    // Steps between two times that are adjacent floats round to one of them.
    all.dedup();
    KeyTable::new(all)
}

/// Returns a key of eight bones for each time, with tiny numbers set to zero.
fn keys_of<const N: usize, T: LaneValue<N>>(
    times: &[f32],
    bones: std::ops::Range<usize>,
    value: impl Fn(usize, f32) -> T,
) -> Vec<BlockKey<N>> {
    let mut keys = vec![identity::<N>(); times.len()];
    let first = bones.start;
    for bone in bones {
        let mut before: Option<T> = None;
        for (key, &time) in keys.iter_mut().zip(times) {
            let value = value(bone, time);
            let value = before.map_or(value, |before| value.following(before));
            before = Some(value);
            for (row, number) in key.iter_mut().zip(value.numbers()) {
                row[bone - first] = number;
            }
        }
    }
    let size = largest(keys.iter().flatten().flatten().copied());
    for number in keys.iter_mut().flatten().flatten() {
        *number = flushed(*number, size);
    }
    keys
}

/// Returns values for the lanes past the last bone: no rotation. For vectors any finite number would do.
fn identity<const N: usize>() -> BlockKey<N> {
    let mut key = [[0.0; LANES]; N];
    if let Some(last) = key.last_mut() {
        *last = [1.0; LANES];
    }
    key
}
