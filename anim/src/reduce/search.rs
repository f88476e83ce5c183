//! The search for removable keys: the cheapest first, each tried on every frame that it affects before it is removed.

use super::channel_keys::{ChannelKeys, CurveKind, Gap};
use super::frames::SampledTake;
use super::measure::deviation_above;
use super::settings::Lengths;
use crate::animation::{child_to_root, to_parent};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Transform};
use crate::sample::{Value, rest_pose};
use glam::Mat4;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Resolution of costs as a fraction of the tolerance, by which removals are ordered; among those of equal cost the
/// shortest gap is removed first, so that gaps grow evenly.
const STEPS: f64 = 64.0;

/// Number of rounds over all keys: a key that could not be removed in one may be in the next, because errors also
/// cancel.
const ROUNDS: usize = 3;

/// A take that is losing keys, and the matrices of every bone on every frame for the remaining ones.
pub(super) struct KeySearch<'a> {
    pub(super) take: &'a Take,
    skeleton: &'a Skeleton,
    pub(super) source: &'a SampledTake,
    lengths: Lengths,
    children: Vec<Vec<BoneIndex>>,
    rests: Vec<Transform>,
    /// As [`SampledTake::poses`], for the remaining keys.
    poses: Vec<Transform>,
    /// As [`SampledTake::to_root`], for the remaining keys.
    to_root: Vec<Mat4>,
    pub(super) columns: Vec<ChannelKeys>,
    /// Number of keys left on the first and on the last frame; `usize::MAX` where other keys mark that end.
    ends: [usize; 2],
    /// Matrices of one frame, while a removal is tried.
    trial: Vec<Mat4>,
    open: Vec<BoneIndex>,
    /// Number of bones moved on a frame so far.
    pub(super) work: u64,
}

impl<'a> KeySearch<'a> {
    pub(super) fn new(
        take: &'a Take,
        skeleton: &'a Skeleton,
        source: &'a SampledTake,
        lengths: Lengths,
    ) -> Self {
        let bones = skeleton.len();
        let mut children = vec![Vec::new(); bones];
        for (index, bone) in skeleton.bones.iter().enumerate() {
            if let Some(parent) = bone.parent.filter(|&parent| (parent as usize) < index) {
                children[parent as usize].push(index as BoneIndex);
            }
        }
        let columns = columns(take, skeleton, &source.times);
        Self {
            take,
            skeleton,
            source,
            lengths,
            children,
            rests: skeleton.bones.iter().map(rest_pose).collect(),
            poses: source.poses.clone(),
            to_root: source.to_root.clone(),
            ends: ends(take, &columns, source.times.len()),
            columns,
            trial: vec![Mat4::IDENTITY; bones],
            open: Vec::new(),
            work: 0,
        }
    }

    /// Removes all redundant keys.
    pub(super) fn run(&mut self) {
        for column in 0..self.columns.len() {
            self.flatten(column);
        }
        for _ in 0..ROUNDS {
            if !self.round() {
                break;
            }
        }
    }

    /// Keeps only the first key of a channel whose values are all equal.
    fn flatten(&mut self, column: usize) {
        let last = self.columns[column].frames.len() - 1;
        let gap = Gap { before: Some(0), after: None };
        let on_last = self.columns[column].frames[last] as usize + 1 == self.source.times.len();
        if last > 0
            && self.is_constant(column)
            && !(on_last && self.ends[1] == 1)
            && self.cost(column, gap).is_some()
        {
            self.commit(column, gap);
        }
    }

    fn is_constant(&self, column: usize) -> bool {
        let ChannelKeys { bone, property, .. } = self.columns[column];
        let track = &self.take.tracks[bone as usize];
        match property {
            CurveKind::Translation => is_constant(&track.translation),
            CurveKind::Rotation => is_constant(&track.rotation),
            CurveKind::Scale => is_constant(&track.scale),
        }
    }

    /// Tries every remaining key. Returns whether any was removed.
    fn round(&mut self) -> bool {
        let mut queue = BinaryHeap::new();
        for column in 0..self.columns.len() {
            let keys: Vec<usize> = self.columns[column].keys().collect();
            queue.extend(keys.into_iter().filter_map(|key| self.candidate(column, key)).map(Reverse));
        }
        let mut removed = false;
        while let Some(Reverse(tried)) = queue.pop() {
            let (column, key) = (tried.column as usize, tried.key as usize);
            match self.candidate(column, key) {
                None => {}
                // Its surroundings have changed since: it is queued again with its new cost.
                Some(now) if now > tried => queue.push(Reverse(now)),
                Some(_) => {
                    self.commit(column, self.columns[column].gap(key));
                    removed = true;
                }
            }
        }
        removed
    }

    /// Returns the cost of removing a key; `None` when it cannot be removed.
    fn candidate(&mut self, column: usize, key: usize) -> Option<RemovalCandidate> {
        if !self.columns[column].kept[key] || self.holds_an_end(column, key) || self.switches_at(column, key)
        {
            return None;
        }
        let gap = self.columns[column].gap(key);
        let cost = (self.cost(column, gap)? * STEPS) as u32;
        let window = self.columns[column].window(gap, self.source.times.len()).len() as u32;
        Some(RemovalCandidate { cost, window, column: column as u32, key: key as u32 })
    }

    /// Returns whether the key is the last one that marks the start or the end of the take.
    fn holds_an_end(&self, column: usize, key: usize) -> bool {
        let frame = self.columns[column].frames[key] as usize;
        (frame == 0 && self.ends[0] == 1) || (frame + 1 == self.source.times.len() && self.ends[1] == 1)
    }

    /// Returns whether a gap here would move the time at which the closest key changes. That time is between frames,
    /// where nothing is measured.
    fn switches_at(&self, column: usize, key: usize) -> bool {
        let ChannelKeys { bone, property, .. } = self.columns[column];
        let (track, gap) = (&self.take.tracks[bone as usize], self.columns[column].gap(key));
        match property {
            CurveKind::Translation => switches(&track.translation, key, gap),
            CurveKind::Rotation => switches(&track.rotation, key, gap),
            CurveKind::Scale => switches(&track.scale, key, gap),
        }
    }

    /// Returns the largest share of a tolerance, 0..=1, that is used anywhere in the subtree of the column's bone if
    /// only the two keys of `gap` are left there; `None` when a tolerance is exceeded.
    pub(super) fn cost(&mut self, column: usize, gap: Gap) -> Option<f64> {
        let mut largest = 0.0_f64;
        for frame in self.columns[column].window(gap, self.source.times.len()) {
            if let Some(pose) = self.changed_pose(column, gap, frame) {
                largest = largest.max(self.cost_of_frame(self.columns[column].bone, pose, frame)?);
            }
        }
        Some(largest)
    }

    /// Returns the pose of the column's bone on `frame` with only the keys of `gap`; `None` when that changes nothing.
    fn changed_pose(&self, column: usize, gap: Gap, frame: usize) -> Option<Transform> {
        let ChannelKeys { bone, property, .. } = self.columns[column];
        let (bone, time) = (bone as usize, self.source.times[frame]);
        let (track, rest) = (&self.take.tracks[bone], self.rests[bone]);
        let now = self.poses[frame * self.skeleton.len() + bone];
        let mut pose = now;
        match property {
            CurveKind::Translation => {
                pose.translation = gap.sample(&track.translation, rest.translation, time)
            }
            CurveKind::Rotation => pose.rotation = gap.sample(&track.rotation, rest.rotation, time),
            CurveKind::Scale => pose.scale = gap.sample(&track.scale, rest.scale, time),
        }
        (pose != now).then_some(pose)
    }

    fn cost_of_frame(&mut self, bone: BoneIndex, pose: Transform, frame: usize) -> Option<f64> {
        let row = frame * self.skeleton.len();
        let mut largest = 0.0_f64;
        self.open.clear();
        self.open.push(bone);
        while let Some(next) = self.open.pop() {
            let index = next as usize;
            let at = row + index;
            let matrix = if next == bone {
                let parent = self.parent(index).map(|parent| self.to_root[row + parent]);
                child_to_root(parent, to_parent(&self.skeleton.bones[index], pose))
            } else {
                let parent = self.parent(index).map(|parent| self.trial[parent]);
                child_to_root(parent, to_parent(&self.skeleton.bones[index], self.poses[at]))
            };
            self.trial[index] = matrix;
            self.work += 1;
            let tolerance = self.source.tolerance(at, self.lengths);
            let known = largest * tolerance;
            let error = deviation_above(self.source.to_root[at], matrix, self.lengths.shell, known);
            if error > tolerance || error.is_nan() {
                return None;
            }
            largest = largest.max(if error > 0.0 { error / tolerance } else { 0.0 });
            self.open.extend_from_slice(&self.children[index]);
        }
        Some(largest)
    }

    /// Removes every key inside `gap`, whose cost is known to be allowed.
    pub(super) fn commit(&mut self, column: usize, gap: Gap) {
        let frames = self.source.times.len();
        self.apply(column, gap);
        let changed = &self.columns[column];
        let keys = gap.before.map_or(0, |key| key + 1)..gap.after.unwrap_or(changed.frames.len());
        for key in keys.filter(|&key| changed.kept[key]) {
            for (end, ends) in [0, frames - 1].into_iter().zip(&mut self.ends) {
                if changed.frames[key] as usize == end && *ends != usize::MAX {
                    *ends -= 1;
                }
            }
        }
        self.columns[column].remove(gap);
    }

    /// Returns whether the column's channel has closest-key interpolation.
    pub(super) fn is_closest(&self, column: usize) -> bool {
        let ChannelKeys { bone, property, .. } = self.columns[column];
        let track = &self.take.tracks[bone as usize];
        let interpolation = match property {
            CurveKind::Translation => track.translation.interpolation,
            CurveKind::Rotation => track.rotation.interpolation,
            CurveKind::Scale => track.scale.interpolation,
        };
        interpolation == Interpolation::Closest
    }

    /// Returns whether every tolerance is kept on the frame of `key` if the column has that key and the other channels
    /// stay as they are.
    pub(super) fn can_have_key(&mut self, column: usize, key: usize) -> bool {
        let (frame, on_key) = self.on_key(column, key);
        let Some(pose) = self.changed_pose(column, on_key, frame) else { return true };
        self.cost_of_frame(self.columns[column].bone, pose, frame).is_some()
    }

    /// Keeps exactly `keys` in a column, whose gaps are known to be allowed.
    pub(super) fn set_keys(&mut self, column: usize, keys: &[usize]) {
        self.columns[column].keep(keys);
        for pair in keys.windows(2) {
            self.apply(column, Gap { before: Some(pair[0]), after: Some(pair[1]) });
        }
        for &key in keys {
            let (frame, on_key) = self.on_key(column, key);
            self.apply_on(column, on_key, frame);
        }
    }

    /// Returns the frame of a key, and the gap that is sampled as that key's value there.
    fn on_key(&self, column: usize, key: usize) -> (usize, Gap) {
        (self.columns[column].frames[key] as usize, Gap { before: Some(key), after: None })
    }

    /// Moves the bone and its descendants on every frame of `gap`.
    fn apply(&mut self, column: usize, gap: Gap) {
        for frame in self.columns[column].window(gap, self.source.times.len()) {
            self.apply_on(column, gap, frame);
        }
    }

    fn apply_on(&mut self, column: usize, gap: Gap, frame: usize) {
        let Some(pose) = self.changed_pose(column, gap, frame) else { return };
        let (bone, row) = (self.columns[column].bone, frame * self.skeleton.len());
        self.poses[row + bone as usize] = pose;
        self.open.push(bone);
        while let Some(next) = self.open.pop() {
            let index = next as usize;
            let parent = self.parent(index).map(|parent| self.to_root[row + parent]);
            let matrix = to_parent(&self.skeleton.bones[index], self.poses[row + index]);
            self.to_root[row + index] = child_to_root(parent, matrix);
            self.open.extend_from_slice(&self.children[index]);
        }
    }

    fn parent(&self, bone: usize) -> Option<usize> {
        self.skeleton.bones[bone].parent.map(|parent| parent as usize).filter(|&parent| parent < bone)
    }
}

/// A removable key. Compared field by field, in this order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct RemovalCandidate {
    cost: u32,
    window: u32,
    column: u32,
    key: u32,
}

/// Returns every channel of the take that can lose keys, in an order in which those of versions of a model are alike: of keys of equal cost, the first one is
/// removed first.
fn columns(take: &Take, skeleton: &Skeleton, times: &[f32]) -> Vec<ChannelKeys> {
    let mut columns = Vec::new();
    for bone in skeleton.by_depth_and_name() {
        let Some(track) = take.tracks.get(bone as usize) else { continue };
        columns.extend(ChannelKeys::new(bone, CurveKind::Translation, &track.translation, times));
        columns.extend(ChannelKeys::new(bone, CurveKind::Rotation, &track.rotation, times));
        columns.extend(ChannelKeys::new(bone, CurveKind::Scale, &track.scale, times));
    }
    columns
}

/// Returns the number of keys of the columns on the first and on the last frame; `usize::MAX` for an end on which morph
/// weights have a key.
fn ends(take: &Take, columns: &[ChannelKeys], frames: usize) -> [usize; 2] {
    [0, frames - 1].map(|end| {
        let on_end = |column: &&ChannelKeys| column.frames.iter().any(|&frame| frame as usize == end);
        let bound = take.morphs.iter().any(|morph| match end {
            0 => morph.times.first() == Some(&take.start),
            _ => morph.times.last() == Some(&take.end()),
        });
        if bound { usize::MAX } else { columns.iter().filter(on_end).count() }
    })
}

/// Returns whether the channel has closest-key interpolation and this key differs from one of its neighbors.
fn switches<T: Value + PartialEq>(channel: &Channel<T>, key: usize, gap: Gap) -> bool {
    let same = |neighbor: Option<usize>| {
        neighbor.is_none_or(|neighbor| channel.value(neighbor) == channel.value(key))
    };
    channel.interpolation == Interpolation::Closest && !(same(gap.before) && same(gap.after))
}

/// Returns whether all values of the channel are equal, and its tangents zero.
fn is_constant<T: Value + PartialEq>(channel: &Channel<T>) -> bool {
    let Some(first) = channel.value(0) else { return false };
    let cubic = channel.values_per_key() == 3;
    channel
        .values
        .iter()
        .enumerate()
        .all(|(at, &value)| if cubic && at % 3 != 1 { value == T::ZERO } else { value == first })
}
