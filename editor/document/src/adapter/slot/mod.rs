//! One take in its three forms: original, changes, result.

mod channel;
mod layers;
mod shifted;

use super::change::{KeyChange, Triple, triple};
use super::key_bytes::key_bytes;
use super::kind::{AnyChannel, ChannelKind, ChannelNumbers, with_kind};
use super::pending::{Pending, PendingAt, place_of};
use super::times::SharedTimes;
use crate::edit::target::{Property, SAME_TIME};
use channel::{exchange, merge, refresh, replaced, retimed, spliced};
use dragonfly_anim::data::{Channel, MorphTrack, Take};
use std::collections::BTreeMap;
use std::sync::Arc;

pub use layers::LayerVersions;

/// Identifies a take among all takes that its document has or had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub struct TakeId(pub u32);

/// The changes of one channel: key index and change, ascending by index. Identities are left out.
pub type ChannelChanges = Vec<(u32, KeyChange)>;

/// Largest number of changes that are replaced one by one, each of which may move all later ones in the list.
const FEW: usize = 16;

/// A key with its original and its change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KeyContent {
    /// Seconds.
    pub(crate) time: f32,
    pub(crate) original: Triple,
    pub(crate) change: Option<KeyChange>,
}

/// A whole channel: its original and its changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ChannelContent {
    pub(crate) original: AnyChannel,
    pub(crate) changes: ChannelChanges,
}

/// One take in its three forms. Without changes, original and result are shared.
#[derive(Clone, Debug)]
pub struct TakeVersions {
    /// Its identifier.
    pub id: TakeId,
    /// Its index among the takes of the file; `None` for a created one.
    pub origin: Option<usize>,
    /// The take as it was read. Keys that are created or deleted are created or deleted in it, too.
    pub original: Arc<Take>,
    /// Original + changes, without layers. Shown and saved is [`Self::shown`].
    pub result: Arc<Take>,
    /// Size of its keys in bytes.
    pub(crate) key_bytes: u64,
    changes: BTreeMap<(u32, Property), Arc<ChannelChanges>>,
    pending: Pending,
    layers: Vec<LayerVersions>,
    /// The result with all layers over it; `None` without layers.
    flat: Option<layers::FlatTake>,
}

impl TakeVersions {
    pub(crate) fn unchanged(id: TakeId, origin: Option<usize>, take: Arc<Take>) -> Self {
        Self {
            id,
            origin,
            key_bytes: key_bytes(&take),
            original: Arc::clone(&take),
            result: take,
            changes: BTreeMap::new(),
            pending: Vec::new(),
            layers: Vec::new(),
            flat: None,
        }
    }

    /// Returns a copy of the take, including its pending poses and layers, with other identifiers. The copy is not from the file.
    pub(crate) fn copied(&self, new_id: &mut impl FnMut() -> TakeId) -> Self {
        let mut copy = Self { id: new_id(), origin: None, ..self.clone() };
        for layer in &mut copy.layers {
            layer.keys = Arc::new(TakeVersions { id: new_id(), ..TakeVersions::clone(&layer.keys) });
        }
        copy
    }

    /// Returns the changes of a channel.
    pub fn changes(&self, bone: u32, property: Property) -> &[(u32, KeyChange)] {
        self.changes.get(&(bone, property)).map_or(&[], |changes| changes.as_slice())
    }

    /// Returns the change of the value of one key, or the identity.
    pub fn change(&self, bone: u32, property: Property, key: usize) -> ChannelNumbers {
        self.key_change(bone, property, key).map_or(property.identity(), |change| change.value)
    }

    /// Returns the index of the key of a channel at `time` seconds, if there is one.
    pub fn key_at(&self, bone: u32, property: Property, time: f32) -> Option<usize> {
        ((bone as usize) < self.original.tracks.len())
            .then(|| key_at(self.times(bone, property), time).ok())
            .flatten()
    }

    /// Returns the poses that are shown at their times but are in no key, ascending in time.
    pub fn pending(&self) -> &[Arc<PendingAt>] {
        &self.pending
    }

    /// Returns the pending poses at `time` seconds, if there are any.
    pub fn pending_at(&self, time: f32) -> Option<&Arc<PendingAt>> {
        place_of(&self.pending, time).ok().map(|at| &self.pending[at])
    }

    /// Returns the number of pending poses: of bones, and of meshes with shape keys, summed over all times.
    pub fn pending_poses(&self) -> usize {
        self.pending.iter().map(|at| at.count()).sum()
    }

    /// Removes all pending poses.
    pub(crate) fn forget_pending(&mut self) {
        self.pending.clear();
    }

    /// Replaces the pending poses at a time; `None` removes them. Returns the previous ones.
    pub(crate) fn set_pending(&mut self, time: f32, poses: Option<Arc<PendingAt>>) -> Option<Arc<PendingAt>> {
        match (place_of(&self.pending, time), poses) {
            (Ok(at), Some(poses)) => Some(std::mem::replace(&mut self.pending[at], poses)),
            (Ok(at), None) => Some(self.pending.remove(at)),
            (Err(at), Some(poses)) => {
                self.pending.insert(at, poses);
                None
            }
            (Err(_), None) => None,
        }
    }

    pub(crate) fn key_change(&self, bone: u32, property: Property, key: usize) -> Option<KeyChange> {
        let changes = self.changes(bone, property);
        let at = changes.binary_search_by_key(&(key as u32), |(key, _)| *key).ok()?;
        Some(changes[at].1)
    }

    /// Returns the channels that have changes.
    pub fn changed(&self) -> impl Iterator<Item = (u32, Property)> + '_ {
        self.changes.keys().copied()
    }

    pub(crate) fn original_of<K: ChannelKind>(&self, bone: u32) -> Option<&Channel<K::Value>> {
        self.original.tracks.get(bone as usize).map(K::channel)
    }

    pub(crate) fn key<K: ChannelKind>(
        &self,
        property: Property,
        bone: u32,
        key: usize,
    ) -> Option<KeyContent> {
        let channel = self.original_of::<K>(bone)?;
        let time = *channel.times.get(key)?;
        let change = self.key_change(bone, property, key);
        Some(KeyContent { time, original: triple::<K>(channel, key), change })
    }

    /// Returns the times of a channel's keys.
    pub(crate) fn times(&self, bone: u32, property: Property) -> &Arc<[f32]> {
        let track = &self.original.tracks[bone as usize];
        match property {
            Property::Translation => &track.translation.times,
            Property::Rotation => &track.rotation.times,
            Property::Scale => &track.scale.times,
        }
    }

    /// Replaces the changes of keys; `None` removes a change. Returns the previous ones.
    pub(crate) fn set_changes(
        &mut self,
        bone: u32,
        property: Property,
        wanted: &[(u32, Option<KeyChange>)],
    ) -> Vec<(u32, Option<KeyChange>)> {
        let changes = Arc::make_mut(self.changes.entry((bone, property)).or_default());
        let before = if wanted.len() > FEW && wanted.is_sorted_by(|a, b| a.0 < b.0) {
            merge(changes, wanted)
        } else {
            wanted.iter().map(|&(key, change)| (key, exchange(changes, key, change))).collect()
        };
        if changes.is_empty() {
            self.changes.remove(&(bone, property));
        }
        with_kind!(property, refresh::<K>(self, property, bone, Some(wanted)));
        before
    }

    /// Replaces all changes of a channel. Returns the previous ones.
    pub(crate) fn replace_changes(
        &mut self,
        bone: u32,
        property: Property,
        changes: Arc<ChannelChanges>,
    ) -> Arc<ChannelChanges> {
        let channel = (bone, property);
        let before = if changes.is_empty() {
            self.changes.remove(&channel)
        } else {
            self.changes.insert(channel, changes)
        };
        with_kind!(property, refresh::<K>(self, property, bone, None));
        before.unwrap_or_default()
    }

    /// Removes keys (ascending positions before the operation) and inserts others (ascending positions after it).
    /// Returns the positions and keys that undo it.
    pub(crate) fn splice(
        &mut self,
        bone: u32,
        property: Property,
        remove: &[u32],
        insert: &[(u32, KeyContent)],
        shared: &mut SharedTimes,
    ) -> (Vec<u32>, Vec<(u32, KeyContent)>) {
        let taken = with_kind!(property, spliced::<K>(self, property, bone, remove, insert, shared));
        (insert.iter().map(|(at, _)| *at).collect(), taken)
    }

    /// Replaces the times of keys, which keep their order. Returns the previous times.
    pub(crate) fn set_times(
        &mut self,
        bone: u32,
        property: Property,
        wanted: &[(u32, f32)],
        shared: &mut SharedTimes,
    ) -> Vec<(u32, f32)> {
        let old = Arc::clone(self.times(bone, property));
        let before = wanted.iter().filter_map(|&(key, _)| Some((key, *old.get(key as usize)?))).collect();
        let times = shared.moved(&old, wanted);
        with_kind!(property, retimed::<K>(self, bone, &times));
        before
    }

    /// Replaces a whole channel. Returns the previous one.
    pub(crate) fn replace(
        &mut self,
        bone: u32,
        property: Property,
        content: ChannelContent,
    ) -> ChannelContent {
        with_kind!(property, replaced::<K>(self, property, bone, content))
    }

    /// Replaces the morph tracks. Returns the previous ones.
    pub(crate) fn set_morphs(&mut self, morphs: Vec<MorphTrack>) -> Vec<MorphTrack> {
        let before = self.original.morphs.clone();
        self.both(|take| take.morphs.clone_from(&morphs));
        before
    }

    pub(crate) fn set_name(&mut self, name: &str) -> String {
        let before = self.original.name.clone();
        self.both(|take| take.name = name.to_owned());
        before
    }

    /// Replaces a text of the extras; `None` removes it. Returns the previous one.
    pub(crate) fn set_extras(&mut self, name: &str, text: Option<Arc<str>>) -> Option<Arc<str>> {
        let mut before = None;
        self.both(|take| before = take.extras.set(name, text.clone()));
        before
    }

    /// Returns the original, to be modified. The caller must set the result afterwards: without changes, the result is
    /// the original itself and is released here, because a take that both share would be copied for each channel of an
    /// edit.
    fn original_mut(&mut self) -> &mut Take {
        if self.changes.is_empty() {
            self.result = Arc::default();
        }
        Arc::make_mut(&mut self.original)
    }

    /// Makes the same modification in the original and in the result.
    fn both(&mut self, mut change: impl FnMut(&mut Take)) {
        change(self.original_mut());
        if self.changes.is_empty() {
            self.result = Arc::clone(&self.original);
        } else {
            change(Arc::make_mut(&mut self.result));
        }
    }

    /// Sets start, length and size to those of the keys.
    pub(crate) fn measure(&mut self) {
        self.key_bytes = key_bytes(&self.original);
        let (start, length) = extent(&self.original);
        for take in [&mut self.original, &mut self.result] {
            if take.start.to_bits() != start.to_bits() || take.length.to_bits() != length.to_bits() {
                let take = Arc::make_mut(take);
                (take.start, take.length) = (start, length);
            }
        }
        if self.changes.is_empty() {
            self.result = Arc::clone(&self.original);
        }
    }
}

/// Returns the position of the key at `time`, or the position at which to insert one.
pub(crate) fn key_at(times: &[f32], time: f32) -> Result<usize, usize> {
    let after = times.partition_point(|&key| key < time - SAME_TIME);
    match times.get(after) {
        Some(&key) if (key - time).abs() <= SAME_TIME => Ok(after),
        _ => Err(times.partition_point(|&key| key < time)),
    }
}

/// Returns the time of the first key of all channels, and the duration from it to the last key, in seconds.
pub(crate) fn extent(take: &Take) -> (f32, f32) {
    take.range_of_keys().map_or((0.0, 0.0), |(start, end)| (start, end - start))
}
