//! Converts a take to the layout described in [`super`].

use super::super::between::steps;
use super::super::grid::Grid;
use super::super::pose::{Pose, blocks_of};
use super::super::rig::flushed_poses;
use super::super::simd::LANES;
use super::super::tiny::{flushed, largest};
use super::tracks::{Key, Tracks};
use super::{KeyedTake, Odd, Still};
use crate::data::{Channel, Interpolation, Skeleton, Take, Track, Transform};
use crate::sample::{Value, rest_pose, sample_channel};
use glam::{Quat, Vec3};

/// One property of one bone: its channel, and the value used where that is empty.
struct Lane<'a, T> {
    channel: &'a Channel<T>,
    rest: T,
}

impl<T: Value + PartialEq> Lane<'_, T> {
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
            && Grid::new(self.channel.times.to_vec()).is_some()
    }
}

/// One property of all bones.
struct Property<const N: usize, T> {
    tracks: Vec<Tracks<N>>,
    still: Vec<u32>,
    /// Value of each bone where no track or fallback channel changes it.
    base: Vec<T>,
    odd: Vec<usize>,
}

/// A value that can be stored in blocks of eight lanes.
trait Layout<const N: usize>: Value + PartialEq {
    /// Returns the number of steps into which the interval between two keys is cut.
    fn steps(from: Self, to: Self) -> usize;
    /// Returns this value in the hemisphere of `before`, the value it follows.
    fn following(self, before: Self) -> Self;
    fn numbers(self) -> [f32; N];
}

impl Layout<4> for Quat {
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

impl Layout<3> for Vec3 {
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
        bones.iter().map(|(rest, track)| Lane { channel: &track.rotation, rest: rest.rotation }).collect(),
    );
    let translations = property::<3, Vec3>(
        bones
            .iter()
            .map(|(rest, track)| Lane { channel: &track.translation, rest: rest.translation })
            .collect(),
    );
    let scales = property::<3, Vec3>(
        bones.iter().map(|(rest, track)| Lane { channel: &track.scale, rest: rest.scale }).collect(),
    );
    let base = (0..bones.len()).map(|bone| Transform {
        translation: translations.base[bone],
        rotation: rotations.base[bone],
        scale: scales.base[bone],
    });
    let base = Pose::from_transforms(&flushed_poses(base.collect()));
    let track = |bone: usize| (bones[bone].1, bones[bone].0);
    let odd_rotations = rotations.odd.iter().map(|&bone| {
        let (track, rest) = track(bone);
        Odd::Rotation(bone, track.rotation.clone(), rest.rotation)
    });
    let odd_translations = translations.odd.iter().map(|&bone| {
        let (track, rest) = track(bone);
        Odd::Translation(bone, track.translation.clone(), rest.translation)
    });
    let odd_scales = scales.odd.iter().map(|&bone| {
        let (track, rest) = track(bone);
        Odd::Scale(bone, track.scale.clone(), rest.scale)
    });
    KeyedTake {
        start: take.start,
        length: take.length,
        odd: odd_rotations.chain(odd_translations).chain(odd_scales).collect(),
        rotations: rotations.tracks,
        translations: translations.tracks,
        scales: scales.tracks,
        still: Still { rotations: rotations.still, translations: translations.still, scales: scales.still },
        base,
    }
}

/// Sorts the lanes of a property into constants, tracks, and channels that the open path plays.
fn property<const N: usize, T: Layout<N>>(lanes: Vec<Lane<'_, T>>) -> Property<N, T> {
    let mut base: Vec<T> = Vec::with_capacity(lanes.len());
    let (mut odd, mut is_track) = (Vec::new(), vec![false; lanes.len()]);
    for (bone, lane) in lanes.iter().enumerate() {
        base.push(lane.constant().unwrap_or(lane.rest));
        if lane.constant().is_none() {
            is_track[bone] = lane.is_linear();
            if !is_track[bone] {
                odd.push(bone);
            }
        }
    }
    let (mut tracks, mut still) = (Vec::new(), Vec::new());
    for block in 0..blocks_of(lanes.len()) {
        let first = block * LANES;
        let bones = first..(first + LANES).min(lanes.len());
        let moving = |bone: &usize| is_track[*bone];
        let grid = grid_of(bones.clone().filter(moving).map(|bone| &lanes[bone]).collect());
        match grid {
            Some(grid) => {
                let value =
                    |bone: usize, time| if is_track[bone] { lanes[bone].at(time) } else { base[bone] };
                let keys = keys_of(grid.times(), bones, value);
                tracks.push((block as u32, grid, keys));
            }
            None => still.push(block as u32),
        }
    }
    Property { tracks: Tracks::collect(tracks), still, base, odd }
}

/// Returns the times at which the block of `lanes` needs keys: all of theirs, and more in wide rotations. `None`
/// without lanes.
fn grid_of<const N: usize, T: Layout<N>>(lanes: Vec<&Lane<'_, T>>) -> Option<Grid> {
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
    // Between adjacent floats there is no other time.
    all.dedup();
    Grid::new(all)
}

/// Returns a key of eight bones for each time, with tiny numbers set to zero.
fn keys_of<const N: usize, T: Layout<N>>(
    times: &[f32],
    bones: std::ops::Range<usize>,
    value: impl Fn(usize, f32) -> T,
) -> Vec<Key<N>> {
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
fn identity<const N: usize>() -> Key<N> {
    let mut key = [[0.0; LANES]; N];
    if let Some(last) = key.last_mut() {
        *last = [1.0; LANES];
    }
    key
}
