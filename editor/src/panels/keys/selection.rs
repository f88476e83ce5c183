//! The selected keys: a few intervals of time for each channel, never a list of keys.

use super::channel::{self, ChannelId};
use super::intervals::{Intervals, WHOLE};
use super::shift::Shift;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BoneRef, KeySet, Property, SAME_TIME};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The selected keys of all channels. A copy is cheap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeySelection {
    channels: Arc<BTreeMap<ChannelId, Intervals>>,
    /// Keys of morph targets, of all tracks together.
    shapes: Arc<Intervals>,
}

static NONE: Intervals = Intervals::none();

impl KeySelection {
    /// Returns whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.channels.is_empty() && self.shapes.is_empty()
    }

    /// Returns the selected intervals of the keys of morph targets.
    pub fn shapes(&self) -> &Intervals {
        &self.shapes
    }

    /// Returns the selected intervals of a channel.
    pub fn of(&self, channel: ChannelId) -> &Intervals {
        self.channels.get(&channel).unwrap_or(&NONE)
    }

    /// Returns every channel with selected keys.
    pub fn channels(&self) -> impl Iterator<Item = (ChannelId, &Intervals)> {
        self.channels.iter().map(|(&channel, intervals)| (channel, intervals))
    }

    /// Returns the same keys of the bones of another skeleton.
    pub fn renumbered(&self, shift: BoneShift) -> Self {
        let channel = |(&(bone, property), intervals): (&ChannelId, &Intervals)| {
            Some(((shift.bone(bone)?, property), intervals.clone()))
        };
        let channels = self.channels.iter().filter_map(channel).collect();
        Self { channels: Arc::new(channels), shapes: Arc::clone(&self.shapes) }
    }

    /// Returns whether both share the same data.
    pub fn same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.channels, &other.channels) && Arc::ptr_eq(&self.shapes, &other.shapes)
    }

    /// Returns the number of selected keys.
    pub fn count(&self, take: &Take) -> usize {
        let shapes: usize = take.morphs.iter().map(|track| self.shapes.count(&track.times)).sum();
        let keys = self.channels().map(|(channel, intervals)| intervals.count(channel::times(take, channel)));
        shapes + keys.sum::<usize>()
    }

    /// Returns the times of the first and the last selected key, seconds.
    pub fn extent(&self, take: &Take) -> Option<[f32; 2]> {
        let shapes = take.morphs.iter().filter_map(|track| self.shapes.extent(&track.times));
        self.channels()
            .filter_map(|(channel, intervals)| intervals.extent(channel::times(take, channel)))
            .chain(shapes)
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Selects the keys of `channels` between two times, ends included; all of them with [`WHOLE`].
    ///
    /// A toggle deselects them if all of them are selected, and selects them otherwise.
    pub fn choose(&mut self, take: &Take, channels: &[ChannelId], stretch: [f32; 2], choice: Choice) {
        let all = choice == Choice::Toggle
            && channels.iter().all(|&channel| {
                let times = channel::times(take, channel);
                let keys = super::intervals::keys_between(times, stretch);
                let intervals = self.of(channel);
                keys.is_empty()
                    || (intervals.holds(times[keys.start])
                        && intervals.next(times, keys.start, false).is_none_or(|next| next >= keys.end))
            });
        if choice == Choice::Replace {
            *self = Self::default();
        }
        let map = Arc::make_mut(&mut self.channels);
        for &channel in channels {
            let times = channel::times(take, channel);
            let intervals = map.entry(channel).or_default();
            if all {
                intervals.remove(stretch, times);
            } else {
                intervals.add(stretch);
            }
            intervals.tidy(times);
            if intervals.is_empty() {
                map.remove(&channel);
            }
        }
    }

    /// Selects the keys of morph targets between two times in addition; a toggle deselects them if all of them are
    /// selected.
    pub fn choose_shapes(&mut self, take: &Take, stretch: [f32; 2], choice: Choice) {
        let times = shape_times(take);
        let keys = super::intervals::keys_between(&times, stretch);
        let all = times[keys].iter().all(|&time| self.shapes.holds(time));
        let shapes = Arc::make_mut(&mut self.shapes);
        if all && choice == Choice::Toggle {
            shapes.remove(stretch, &times);
        } else {
            shapes.add(stretch);
        }
        shapes.tidy(&times);
    }

    /// Selects intervals of the keys of morph targets in addition; a toggle deselects those that are selected already.
    pub fn choose_shape_parts(&mut self, take: &Take, stretches: &[[f32; 2]], choice: Choice) {
        let times = shape_times(take);
        let shapes = Arc::make_mut(&mut self.shapes);
        let (gone, new): (Vec<_>, Vec<_>) =
            stretches.iter().partition(|[from, _]| choice == Choice::Toggle && shapes.holds(*from));
        *shapes = Intervals::of(shapes.stretches().iter().copied().chain(new));
        gone.into_iter().for_each(|stretch| shapes.remove(stretch, &times));
        shapes.tidy(&times);
    }

    /// Deselects the keys of morph targets.
    pub fn drop_shapes(&mut self) {
        self.shapes = Arc::default();
    }

    /// Selects intervals of one channel in addition; a toggle deselects those that are selected already.
    pub fn choose_parts(&mut self, take: &Take, channel: ChannelId, stretches: &[[f32; 2]], choice: Choice) {
        let times = channel::times(take, channel);
        let map = Arc::make_mut(&mut self.channels);
        let intervals = map.entry(channel).or_default();
        let (gone, new): (Vec<_>, Vec<_>) =
            stretches.iter().partition(|[from, _]| choice == Choice::Toggle && intervals.holds(*from));
        *intervals = Intervals::of(intervals.stretches().iter().copied().chain(new));
        gone.into_iter().for_each(|stretch| intervals.remove(stretch, times));
        intervals.tidy(times);
        if intervals.is_empty() {
            map.remove(&channel);
        }
    }

    /// Deselects the keys of these bones.
    pub fn drop_bones(&mut self, gone: impl Fn(BoneIndex) -> bool) {
        if self.channels.keys().any(|&(bone, _)| gone(bone)) {
            Arc::make_mut(&mut self.channels).retain(|&(bone, _), _| !gone(bone));
        }
    }

    /// Returns the same keys after they were moved: `old` is the take in which they were selected, `new` the one they are in.
    pub fn shifted(&self, old: &Take, new: &Take, shift: Shift) -> Self {
        let moved = self.channels().filter_map(|(channel, intervals)| {
            let (before, after) = (channel::times(old, channel), channel::times(new, channel));
            let mut moved =
                Intervals::of(intervals.stretches().iter().map(|&stretch| shift.stretch(stretch)));
            // An interval may include keys now that were not selected: then each key gets an interval of its own.
            if moved.count(after) != intervals.count(before) {
                let keys = intervals.keys(before).flatten().map(|key| shift.apply(before[key]));
                moved = Intervals::singles(keys);
            }
            moved.tidy(after);
            (!moved.is_empty()).then_some((channel, moved))
        });
        let channels = Arc::new(moved.collect());
        Self { channels, shapes: Arc::new(self.shifted_shapes(old, new, shift)) }
    }

    fn shifted_shapes(&self, old: &Take, new: &Take, shift: Shift) -> Intervals {
        let [before, after] = [old, new].map(shape_times);
        let mut moved = Intervals::of(self.shapes.stretches().iter().map(|&stretch| shift.stretch(stretch)));
        if moved.count(&after) != self.shapes.count(&before) {
            let keys = self.shapes.keys(&before).flatten().map(|key| shift.apply(before[key]));
            moved = Intervals::singles(keys);
        }
        moved.tidy(&after);
        moved
    }

    /// Returns the selected intervals of the keys of morph targets, with ends that edits can name.
    pub fn finite_shapes(&self, take: &Take) -> Vec<[f32; 2]> {
        let [first, last] = take.range_of_keys().map_or([0.0; 2], |(first, last)| [first, last]);
        let end = |time: f32| {
            if time.is_finite() {
                time
            } else if time < 0.0 {
                first
            } else {
                last
            }
        };
        self.shapes.stretches().iter().map(|stretch| stretch.map(end)).collect()
    }

    /// Returns the same keys after all keys from time `from` on were moved by `by` seconds: `new` is the take with the
    /// moved keys.
    pub fn rippled(&self, new: &Take, from: f32, by: f32) -> Self {
        let from = from - SAME_TIME;
        let late = |time: f32| if time.is_finite() { time + by } else { time };
        let moved = self.channels().filter_map(|(channel, intervals)| {
            let times = channel::times(new, channel);
            let stretches = intervals.stretches().iter().flat_map(|&[begin, end]| {
                // Keys in a gap that was closed are gone, and other keys may be there now.
                let stays = end.min(from + by.min(0.0)).next_down();
                let before = (begin < from).then_some([begin, stays]);
                let behind = (end >= from).then(|| [late(begin.max(from)), late(end)]);
                [before, behind].into_iter().flatten()
            });
            let mut moved = Intervals::of(stretches);
            moved.tidy(times);
            (!moved.is_empty()).then_some((channel, moved))
        });
        Self { channels: Arc::new(moved.collect()), ..Self::default() }
    }

    /// Returns the same keys as edits name them, in as few sets as possible.
    pub fn key_sets(&self, take: &Take) -> Vec<KeySet> {
        // Channels with the same intervals are grouped: first the channels of a bone, then bones.
        let mut bones: BTreeMap<(BoneIndex, Vec<[u32; 2]>), u8> = BTreeMap::new();
        for (&(bone, property), intervals) in self.channels.iter() {
            if intervals.keys(channel::times(take, (bone, property))).next().is_some() {
                let bits = intervals.stretches().iter().map(|stretch| stretch.map(f32::to_bits)).collect();
                *bones.entry((bone, bits)).or_default() |= 1 << property as u8;
            }
        }
        let mut groups: BTreeMap<(Vec<[u32; 2]>, u8), Vec<BoneIndex>> = BTreeMap::new();
        for ((bone, bits), mask) in bones {
            groups.entry((bits, mask)).or_default().push(bone);
        }
        let everyone = take.tracks.len();
        let mut sets = Vec::new();
        for ((bits, mask), bones) in groups {
            let properties = Property::ALL.into_iter().filter(|&property| mask & (1 << property as u8) != 0);
            let set = KeySet {
                bones: if bones.len() == everyone {
                    Vec::new()
                } else {
                    bones.into_iter().map(BoneRef::Index).collect()
                },
                properties: if mask == 7 { Vec::new() } else { properties.collect() },
                ..KeySet::default()
            };
            let stretches: Vec<[f32; 2]> = bits.into_iter().map(|ends| ends.map(f32::from_bits)).collect();
            let at: Vec<f32> = stretches.iter().filter(|[from, to]| from == to).map(|[at, _]| *at).collect();
            if !at.is_empty() {
                sets.push(KeySet { at: Some(at), ..set.clone() });
            }
            for [from, to] in stretches.into_iter().filter(|[from, to]| from != to) {
                let end = |time: f32| time.is_finite().then_some(time);
                sets.push(KeySet { from: end(from), to: end(to), ..set.clone() });
            }
        }
        sets
    }

    /// Returns all keys of these channels.
    pub fn whole(take: &Take, channels: &[ChannelId]) -> Self {
        let mut all = Self::default();
        all.choose(take, channels, WHOLE, Choice::Replace);
        all
    }
}

/// Returns the times of the keys of all morph targets, ascending.
fn shape_times(take: &Take) -> Vec<f32> {
    let mut times: Vec<f32> = take.morphs.iter().flat_map(|track| track.times.iter().copied()).collect();
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}
