//! The keys of one channel during their removal.

use crate::data::{BoneIndex, Channel};
use crate::sample::{Keys, Value, mix_factor, sample_between};

/// The property of a bone that a channel animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CurveKind {
    Translation,
    Rotation,
    Scale,
}

/// The keys of one channel: the remaining ones, and the neighbors of each among those.
pub(super) struct ChannelKeys {
    pub(super) bone: BoneIndex,
    pub(super) property: CurveKind,
    /// The frame of each key.
    pub(super) frames: Vec<u32>,
    /// Whether each key remains.
    pub(super) kept: Vec<bool>,
    before: Vec<Option<u32>>,
    after: Vec<Option<u32>>,
    /// Number of remaining keys.
    pub(super) count: usize,
}

impl ChannelKeys {
    /// Creates the list of all keys of `channel`, whose times are among `times`; `None` when the channel has no keys,
    /// or is not valid enough to be changed.
    pub(super) fn new<T: Value>(
        bone: BoneIndex,
        property: CurveKind,
        channel: &Channel<T>,
        times: &[f32],
    ) -> Option<Self> {
        let keys = &channel.times;
        let sound = keys.iter().all(|time| time.is_finite())
            && keys.windows(2).all(|pair| pair[0] < pair[1])
            && channel.values.len() == keys.len() * channel.values_per_key();
        if keys.is_empty() || !sound {
            return None;
        }
        let frame = |time: &f32| times.partition_point(|frame| frame < time) as u32;
        let count = keys.len();
        let last = count as u32 - 1;
        Some(Self {
            bone,
            property,
            frames: keys.iter().map(frame).collect(),
            kept: vec![true; count],
            before: (0..=last).map(|key| key.checked_sub(1)).collect(),
            after: (0..=last).map(|key| (key < last).then(|| key + 1)).collect(),
            count,
        })
    }

    /// Returns the gap that replaces key `key` when it is removed: its neighbors.
    pub(super) fn gap(&self, key: usize) -> Gap {
        Gap {
            before: self.before[key].map(|key| key as usize),
            after: self.after[key].map(|key| key as usize),
        }
    }

    /// Returns the frames inside `gap`, at which sampling uses its two keys.
    pub(super) fn window(&self, gap: Gap, frames: usize) -> std::ops::Range<usize> {
        let from = gap.before.map_or(0, |key| self.frames[key] as usize + 1);
        let to = gap.after.map_or(frames, |key| self.frames[key] as usize);
        from..to.max(from)
    }

    /// Removes every key inside `gap`.
    pub(super) fn remove(&mut self, gap: Gap) {
        let from = gap.before.map_or(0, |key| key + 1);
        let to = gap.after.unwrap_or(self.kept.len());
        for kept in &mut self.kept[from..to] {
            self.count -= usize::from(std::mem::replace(kept, false));
        }
        if let Some(key) = gap.before {
            self.after[key] = gap.after.map(|key| key as u32);
        }
        if let Some(key) = gap.after {
            self.before[key] = gap.before.map(|key| key as u32);
        }
    }

    /// Keeps exactly the keys of `kept`, ascending.
    pub(super) fn keep(&mut self, kept: &[usize]) {
        self.kept.fill(false);
        self.count = kept.len();
        for (place, &key) in kept.iter().enumerate() {
            self.kept[key] = true;
            self.before[key] = place.checked_sub(1).map(|place| kept[place] as u32);
            self.after[key] = kept.get(place + 1).map(|&key| key as u32);
        }
    }

    /// Iterates over the positions of the remaining keys, ascending.
    pub(super) fn keys(&self) -> impl Iterator<Item = usize> + '_ {
        self.kept.iter().enumerate().filter(|(_, kept)| **kept).map(|(key, _)| key)
    }
}

/// Two keys that are, or would be, neighbors; `None`: no key on that side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Gap {
    pub(super) before: Option<usize>,
    pub(super) after: Option<usize>,
}

impl Gap {
    /// Returns the value at `time`, which is inside the gap: the sampled value of a channel in which the two keys are
    /// neighbors.
    pub(super) fn sample<T: Value>(self, channel: &Channel<T>, rest: T, time: f32) -> T {
        let keys = match (self.before, self.after) {
            (Some(before), Some(after)) => {
                let mix = mix_factor(channel.times[before], channel.times[after], time);
                Keys { before, after, mix }
            }
            (Some(key), None) | (None, Some(key)) => Keys::on(key),
            (None, None) => return rest,
        };
        sample_between(channel, rest, keys)
    }
}
