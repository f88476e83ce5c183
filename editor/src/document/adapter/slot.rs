//! One take in its three forms: as it was read, what was changed, and what comes of both.

use super::change::{KeyChange, Triple, put, triple};
use super::kind::{AnyChannel, Held, Kind, Numbers, with_kind};
use super::pending::{Pending, PendingAt, place_of};
use super::times::Shared;
use crate::document::edit::{Property, SAME_TIME};
use dragonfly_anim::data::{Channel, Interpolation, MorphTrack, Take};
use dragonfly_anim::sample::Value;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Tells a take from all others of its document, also from those that are gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub struct TakeId(pub u32);

/// The changes of one channel: which key, and what of it; ascending, none that changes nothing.
pub type Changes = Vec<(u32, KeyChange)>;

/// A key with everything that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    /// Seconds.
    pub(super) time: f32,
    pub(super) original: Triple,
    pub(super) change: Option<KeyChange>,
}

/// A whole channel: its original and its changes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Content {
    pub(super) original: AnyChannel,
    pub(super) changes: Changes,
}

/// One take in its three forms. Where nothing was changed, all of it is shared: original and result are one.
#[derive(Clone, Debug)]
pub struct Slot {
    /// Which take.
    pub id: TakeId,
    /// Its place among the takes of the file; `None` for one made here.
    pub origin: Option<usize>,
    /// As it was read; keys and takes made or deleted since are made and deleted in it, too.
    pub original: Arc<Take>,
    /// Original + changes: what is shown and saved.
    pub result: Arc<Take>,
    changes: BTreeMap<(u32, Property), Arc<Changes>>,
    pending: Pending,
}

impl Slot {
    pub(super) fn unchanged(id: TakeId, origin: Option<usize>, take: Arc<Take>) -> Self {
        Self {
            id,
            origin,
            original: Arc::clone(&take),
            result: take,
            changes: BTreeMap::new(),
            pending: Vec::new(),
        }
    }

    /// The same take under another number, made here; pending poses come along.
    pub(super) fn copied(&self, id: TakeId) -> Self {
        Self { id, origin: None, ..self.clone() }
    }

    /// What was changed of a channel.
    pub fn changes(&self, bone: u32, property: Property) -> &[(u32, KeyChange)] {
        self.changes.get(&(bone, property)).map_or(&[], |changes| changes.as_slice())
    }

    /// What was changed of the value of one key; the change that changes nothing where nothing was.
    pub fn change(&self, bone: u32, property: Property, key: usize) -> Numbers {
        self.key_change(bone, property, key).map_or(property.identity(), |change| change.value)
    }

    /// The key of a channel at `time` seconds, if there is one.
    pub fn key_at(&self, bone: u32, property: Property, time: f32) -> Option<usize> {
        ((bone as usize) < self.original.tracks.len())
            .then(|| key_at(self.times(bone, property), time).ok())
            .flatten()
    }

    /// Poses that are shown at their times and held by no key, ascending in time.
    pub fn pending(&self) -> &[Arc<PendingAt>] {
        &self.pending
    }

    /// Those at `time` seconds, if there are any.
    pub fn pending_at(&self, time: f32) -> Option<&Arc<PendingAt>> {
        place_of(&self.pending, time).ok().map(|at| &self.pending[at])
    }

    /// How many poses are pending: bones, summed over times.
    pub fn pending_poses(&self) -> usize {
        self.pending.iter().map(|at| at.poses.len()).sum()
    }

    /// A take without anything pending.
    pub(super) fn forget_pending(&mut self) {
        self.pending.clear();
    }

    /// Puts in other pending poses at a time, `None` for none; those from before.
    pub(super) fn set_pending(&mut self, time: f32, poses: Option<Arc<PendingAt>>) -> Option<Arc<PendingAt>> {
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

    pub(super) fn key_change(&self, bone: u32, property: Property, key: usize) -> Option<KeyChange> {
        let changes = self.changes(bone, property);
        let at = changes.binary_search_by_key(&(key as u32), |(key, _)| *key).ok()?;
        Some(changes[at].1)
    }

    /// Channels of which something was changed.
    pub fn changed(&self) -> impl Iterator<Item = (u32, Property)> + '_ {
        self.changes.keys().copied()
    }

    pub(super) fn original_of<K: Kind>(&self, bone: u32) -> Option<&Channel<K::Value>> {
        self.original.tracks.get(bone as usize).map(K::channel)
    }

    pub(super) fn key<K: Kind>(&self, property: Property, bone: u32, key: usize) -> Option<Key> {
        let channel = self.original_of::<K>(bone)?;
        let time = *channel.times.get(key)?;
        let change = self.key_change(bone, property, key);
        Some(Key { time, original: triple::<K>(channel, key), change })
    }

    /// Times of a channel's keys.
    pub(super) fn times(&self, bone: u32, property: Property) -> &Arc<[f32]> {
        let track = &self.original.tracks[bone as usize];
        match property {
            Property::Translation => &track.translation.times,
            Property::Rotation => &track.rotation.times,
            Property::Scale => &track.scale.times,
        }
    }

    /// Gives keys other changes, `None` for none; what they had before.
    pub(super) fn set_changes(
        &mut self,
        bone: u32,
        property: Property,
        wanted: &[(u32, Option<KeyChange>)],
    ) -> Vec<(u32, Option<KeyChange>)> {
        let changes = Arc::make_mut(self.changes.entry((bone, property)).or_default());
        let before: Vec<_> =
            wanted.iter().map(|&(key, change)| (key, exchange(changes, key, change))).collect();
        if changes.is_empty() {
            self.changes.remove(&(bone, property));
        }
        with_kind!(property, refresh::<K>(self, property, bone, Some(wanted)));
        before
    }

    /// Takes keys out (ascending positions as they are) and puts others in (ascending positions as they will be);
    /// answers with the positions and keys that undo it.
    pub(super) fn splice(
        &mut self,
        bone: u32,
        property: Property,
        remove: &[u32],
        insert: &[(u32, Key)],
        shared: &mut Shared,
    ) -> (Vec<u32>, Vec<(u32, Key)>) {
        let taken = with_kind!(property, spliced::<K>(self, property, bone, remove, insert, shared));
        (insert.iter().map(|(at, _)| *at).collect(), taken)
    }

    /// Gives keys other times, without another order; their times from before.
    pub(super) fn set_times(
        &mut self,
        bone: u32,
        property: Property,
        wanted: &[(u32, f32)],
        shared: &mut Shared,
    ) -> Vec<(u32, f32)> {
        let old = Arc::clone(self.times(bone, property));
        let before = wanted.iter().filter_map(|&(key, _)| Some((key, *old.get(key as usize)?))).collect();
        let times = shared.moved(&old, wanted);
        with_kind!(property, retimed::<K>(self, bone, &times));
        before
    }

    /// Puts a whole channel in the place of another; the other.
    pub(super) fn replace(&mut self, bone: u32, property: Property, content: Content) -> Content {
        with_kind!(property, replaced::<K>(self, property, bone, content))
    }

    /// Puts in other morph tracks; those from before.
    pub(super) fn set_morphs(&mut self, morphs: Vec<MorphTrack>) -> Vec<MorphTrack> {
        let before = self.original.morphs.clone();
        self.both(|take| take.morphs.clone_from(&morphs));
        before
    }

    pub(super) fn set_name(&mut self, name: &str) -> String {
        let before = self.original.name.clone();
        self.both(|take| take.name = name.to_owned());
        before
    }

    /// Does the same to original and result.
    fn both(&mut self, mut change: impl FnMut(&mut Take)) {
        change(Arc::make_mut(&mut self.original));
        if self.changes.is_empty() {
            self.result = Arc::clone(&self.original);
        } else {
            change(Arc::make_mut(&mut self.result));
        }
    }

    /// Start and length are those of the keys.
    pub(super) fn measure(&mut self) {
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

/// Where the key at `time` is; else where one would come.
pub(super) fn key_at(times: &[f32], time: f32) -> Result<usize, usize> {
    let after = times.partition_point(|&key| key < time - SAME_TIME);
    match times.get(after) {
        Some(&key) if (key - time).abs() <= SAME_TIME => Ok(after),
        _ => Err(times.partition_point(|&key| key < time)),
    }
}

/// Seconds: the first key of any channel, and from it to the last one.
pub(super) fn extent(take: &Take) -> (f32, f32) {
    take.range_of_keys().map_or((0.0, 0.0), |(start, end)| (start, end - start))
}

/// Puts one change into a list; the one that was there.
fn exchange(changes: &mut Changes, key: u32, change: Option<KeyChange>) -> Option<KeyChange> {
    match (changes.binary_search_by_key(&key, |(key, _)| *key), change) {
        (Ok(at), Some(change)) => Some(std::mem::replace(&mut changes[at].1, change)),
        (Ok(at), None) => Some(changes.remove(at).1),
        (Err(at), Some(change)) => {
            changes.insert(at, (key, change));
            None
        }
        (Err(_), None) => None,
    }
}

/// Makes the result of a channel anew: of the keys in `touched`, or of all.
fn refresh<K: Kind>(
    slot: &mut Slot,
    property: Property,
    bone: u32,
    touched: Option<&[(u32, Option<KeyChange>)]>,
) {
    if slot.changes.is_empty() {
        slot.result = Arc::clone(&slot.original);
        return;
    }
    let Some(original) = slot.original_of::<K>(bone).cloned() else { return };
    let changes = slot.changes.get(&(bone, property)).map_or(&[][..], |changes| changes.as_slice());
    let result = K::channel_mut(&mut Arc::make_mut(&mut slot.result).tracks[bone as usize]);
    if changes.is_empty() {
        *result = original;
        return;
    }
    // Only the keys that were touched differ from the last result, if there is one of its own.
    let (mut values, keys): (Arc<[K::Value]>, Vec<u32>) = match touched {
        Some(touched) if !Arc::ptr_eq(&result.values, &original.values) => {
            // A column that nobody else has is written over.
            (std::mem::take(&mut result.values), touched.iter().map(|(key, _)| *key).collect())
        }
        _ => (Arc::from(&*original.values), changes.iter().map(|(key, _)| *key).collect()),
    };
    if Arc::get_mut(&mut values).is_none() {
        values = Arc::from(&*values);
    }
    if let Some(values) = Arc::get_mut(&mut values) {
        for key in keys {
            let as_read = triple::<K>(&original, key as usize);
            let change = changes.binary_search_by_key(&key, |(key, _)| *key).ok().map(|at| changes[at].1);
            let now = change.map_or(as_read, |change| change.result::<K>(&as_read));
            put::<K>(values, original.interpolation, key as usize, &now);
        }
    }
    *result = Channel { values, ..original };
}

fn spliced<K: Kind>(
    slot: &mut Slot,
    property: Property,
    bone: u32,
    remove: &[u32],
    insert: &[(u32, Key)],
    shared: &mut Shared,
) -> Vec<(u32, Key)> {
    let taken: Vec<(u32, Key)> =
        remove.iter().filter_map(|&at| Some((at, slot.key::<K>(property, bone, at as usize)?))).collect();
    let old = slot.original_of::<K>(bone).cloned().unwrap_or_default();
    let (per_key, keys) = (old.values_per_key(), (old.len() + insert.len()).saturating_sub(taken.len()));
    let mut times = Vec::with_capacity(keys);
    let mut values: Vec<K::Value> = Vec::with_capacity(keys * per_key);
    let mut changes = Changes::new();
    let mut old_changes = slot.changes(bone, property).iter().peekable();
    let mut inserted = insert.iter().peekable();
    // What stays stays in runs, and a run is copied as a whole.
    for (mut from, end) in runs(old.len(), remove) {
        while from < end {
            put_in::<K>(&mut inserted, &mut times, &mut values, &mut changes, old.interpolation);
            let before_next = inserted.peek().map_or(end - from, |(place, _)| *place as usize - times.len());
            let until = end.min(from + before_next);
            while let Some((key, change)) = old_changes.next_if(|(key, _)| (*key as usize) < until) {
                if (*key as usize) >= from {
                    changes.push(((*key as usize - from + times.len()) as u32, *change));
                }
            }
            times.extend_from_slice(&old.times[from..until]);
            values.extend_from_slice(&old.values[from * per_key..until * per_key]);
            from = until;
        }
    }
    put_in::<K>(&mut inserted, &mut times, &mut values, &mut changes, old.interpolation);
    let times = shared.times(&old.times, times);
    let original = Channel { times, values: values.into(), interpolation: old.interpolation };
    put_channel::<K>(slot, property, bone, original, changes);
    taken
}

/// Runs of keys between those at ascending `gone`, as begin and end.
fn runs(keys: usize, gone: &[u32]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let ends = gone.iter().map(move |&gone| (gone as usize).min(keys)).chain([keys]);
    let begins = [0].into_iter().chain(gone.iter().map(|&gone| gone as usize + 1));
    begins.zip(ends).filter(|(begin, end)| begin < end)
}

/// Puts in the keys whose place has come.
fn put_in<K: Kind>(
    inserted: &mut std::iter::Peekable<std::slice::Iter<'_, (u32, Key)>>,
    times: &mut Vec<f32>,
    values: &mut Vec<K::Value>,
    changes: &mut Changes,
    interpolation: Interpolation,
) {
    while let Some((at, key)) = inserted.next_if(|(place, _)| *place as usize <= times.len()) {
        let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        times.push(key.time);
        values.extend(std::iter::repeat_n(K::Value::ZERO, per_key));
        put::<K>(values, interpolation, *at as usize, &key.original);
        changes.extend(key.change.map(|change| (*at, change)));
    }
}

/// Other times for some keys, which stay in their order; the times from before.
fn retimed<K: Kind>(slot: &mut Slot, bone: u32, times: &Arc<[f32]>) {
    let original = Arc::make_mut(&mut slot.original);
    K::channel_mut(&mut original.tracks[bone as usize]).times = Arc::clone(times);
    if slot.changes.is_empty() {
        slot.result = Arc::clone(&slot.original);
    } else {
        let result = Arc::make_mut(&mut slot.result);
        K::channel_mut(&mut result.tracks[bone as usize]).times = Arc::clone(times);
    }
}

fn replaced<K: Kind>(slot: &mut Slot, property: Property, bone: u32, content: Content) -> Content {
    let before = Content {
        original: K::Value::wrap(slot.original_of::<K>(bone).cloned().unwrap_or_default()),
        changes: slot.changes(bone, property).to_vec(),
    };
    if let Some(original) = K::Value::unwrap(&content.original) {
        put_channel::<K>(slot, property, bone, original.clone(), content.changes);
    }
    before
}

/// Puts an original channel and its changes in, and makes the result.
fn put_channel<K: Kind>(
    slot: &mut Slot,
    property: Property,
    bone: u32,
    original: Channel<K::Value>,
    changes: Changes,
) {
    if changes.is_empty() {
        slot.changes.remove(&(bone, property));
    } else {
        slot.changes.insert((bone, property), Arc::new(changes));
    }
    *K::channel_mut(&mut Arc::make_mut(&mut slot.original).tracks[bone as usize]) = original.clone();
    if !slot.changes.is_empty() {
        *K::channel_mut(&mut Arc::make_mut(&mut slot.result).tracks[bone as usize]) = original;
    }
    refresh::<K>(slot, property, bone, None);
}
