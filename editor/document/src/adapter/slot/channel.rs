//! The channels of a take: their columns, their changes, and the results.

use super::{ChannelChanges, ChannelContent, KeyContent, TakeVersions};
use crate::adapter::change::{KeyChange, put, triple};
use crate::adapter::kind::{ChannelKind, ChannelValue};
use crate::adapter::times::SharedTimes;
use crate::edit::target::Property;
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::Value;
use std::sync::Arc;

/// Replaces the change of a key in a list; `None` removes it. Returns the previous change.
pub(super) fn exchange(
    changes: &mut ChannelChanges,
    key: u32,
    change: Option<KeyChange>,
) -> Option<KeyChange> {
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

/// Replaces the changes of many keys, which ascend, as [`exchange`] does one by one. Takes time in proportion to both lists.
pub(super) fn merge(
    changes: &mut ChannelChanges,
    wanted: &[(u32, Option<KeyChange>)],
) -> Vec<(u32, Option<KeyChange>)> {
    let mut old = std::mem::take(changes).into_iter().peekable();
    let mut before = Vec::with_capacity(wanted.len());
    for &(key, change) in wanted {
        while let Some(earlier) = old.next_if(|(other, _)| *other < key) {
            changes.push(earlier);
        }
        before.push((key, old.next_if(|(other, _)| *other == key).map(|(_, change)| change)));
        changes.extend(change.map(|change| (key, change)));
    }
    changes.extend(old);
    before
}

/// Computes the result of a channel again, for the keys in `touched` or for all keys.
pub(super) fn refresh<K: ChannelKind>(
    slot: &mut TakeVersions,
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
    // If the last result has a column of its own, only the touched keys differ from it.
    let touched = touched.filter(|_| !Arc::ptr_eq(&result.values, &original.values));
    let mut values: Arc<[K::Value]> = match touched {
        // A column that is not shared is overwritten in place.
        Some(_) => std::mem::take(&mut result.values),
        None => Arc::from(&*original.values),
    };
    if Arc::get_mut(&mut values).is_none() {
        values = Arc::from(&*values);
    }
    if let Some(values) = Arc::get_mut(&mut values) {
        let mut set = |key: u32, change: Option<&KeyChange>| {
            let as_read = triple::<K>(&original, key as usize);
            let now = change.map_or(as_read, |change| change.result::<K>(&as_read));
            put::<K>(values, original.interpolation, key as usize, &now);
        };
        match touched {
            Some(touched) => {
                for &(key, _) in touched {
                    let at = changes.binary_search_by_key(&key, |(key, _)| *key).ok();
                    set(key, at.map(|at| &changes[at].1));
                }
            }
            None => changes.iter().for_each(|(key, change)| set(*key, Some(change))),
        }
    }
    *result = Channel { values, ..original };
}

pub(super) fn spliced<K: ChannelKind>(
    slot: &mut TakeVersions,
    property: Property,
    bone: u32,
    remove: &[u32],
    insert: &[(u32, KeyContent)],
    shared: &mut SharedTimes,
) -> Vec<(u32, KeyContent)> {
    let taken: Vec<(u32, KeyContent)> =
        remove.iter().filter_map(|&at| Some((at, slot.key::<K>(property, bone, at as usize)?))).collect();
    let old = slot.original_of::<K>(bone).cloned().unwrap_or_default();
    let (per_key, keys) = (old.values_per_key(), (old.len() + insert.len()).saturating_sub(taken.len()));
    let mut times = Vec::with_capacity(keys);
    let mut values: Vec<K::Value> = Vec::with_capacity(keys * per_key);
    let mut changes = ChannelChanges::new();
    let mut old_changes = slot.changes(bone, property).iter().peekable();
    let mut inserted = insert.iter().peekable();
    // Unchanged keys are copied in runs.
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

/// Returns the runs of keys between those that are removed, each as start and end. The positions `gone` ascend.
fn runs(keys: usize, gone: &[u32]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let ends = gone.iter().map(move |&gone| (gone as usize).min(keys)).chain([keys]);
    let begins = [0].into_iter().chain(gone.iter().map(|&gone| gone as usize + 1));
    begins.zip(ends).filter(|(begin, end)| begin < end)
}

/// Appends the inserted keys whose position has been reached.
fn put_in<K: ChannelKind>(
    inserted: &mut std::iter::Peekable<std::slice::Iter<'_, (u32, KeyContent)>>,
    times: &mut Vec<f32>,
    values: &mut Vec<K::Value>,
    changes: &mut ChannelChanges,
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

/// Replaces the times of a channel. The order of its keys stays the same.
pub(super) fn retimed<K: ChannelKind>(slot: &mut TakeVersions, bone: u32, times: &Arc<[f32]>) {
    K::channel_mut(&mut slot.original_mut().tracks[bone as usize]).times = Arc::clone(times);
    if slot.changes.is_empty() {
        slot.result = Arc::clone(&slot.original);
    } else {
        let result = Arc::make_mut(&mut slot.result);
        K::channel_mut(&mut result.tracks[bone as usize]).times = Arc::clone(times);
    }
}

pub(super) fn replaced<K: ChannelKind>(
    slot: &mut TakeVersions,
    property: Property,
    bone: u32,
    content: ChannelContent,
) -> ChannelContent {
    let before = ChannelContent {
        original: K::Value::wrap(slot.original_of::<K>(bone).cloned().unwrap_or_default()),
        changes: slot.changes(bone, property).to_vec(),
    };
    if let Some(original) = K::Value::unwrap(&content.original) {
        put_channel::<K>(slot, property, bone, original.clone(), content.changes);
    }
    before
}

/// Replaces a channel by an original and its changes, and computes the result.
fn put_channel<K: ChannelKind>(
    slot: &mut TakeVersions,
    property: Property,
    bone: u32,
    original: Channel<K::Value>,
    changes: ChannelChanges,
) {
    if changes.is_empty() {
        slot.changes.remove(&(bone, property));
    } else {
        slot.changes.insert((bone, property), Arc::new(changes));
    }
    *K::channel_mut(&mut slot.original_mut().tracks[bone as usize]) = original.clone();
    if !slot.changes.is_empty() {
        *K::channel_mut(&mut Arc::make_mut(&mut slot.result).tracks[bone as usize]) = original;
    }
    refresh::<K>(slot, property, bone, None);
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    #[test]
    fn many_changes_are_replaced_as_they_would_be_one_by_one_and_undone_in_the_same_way() {
        let first = seed(65);
        for number in first..first + 200 {
            let mut random = Random::new(number);
            let change = |random: &mut Random| KeyChange::of_value([random.unit(); 4]);
            let some =
                |random: &mut Random| -> Vec<u32> { (0..40).filter(|_| random.below(2) == 0).collect() };
            let keys = some(&mut random);
            let changes: ChannelChanges = keys.into_iter().map(|key| (key, change(&mut random))).collect();
            let keys = some(&mut random);
            let wanted: Vec<(u32, Option<KeyChange>)> = keys
                .into_iter()
                .map(|key| (key, (random.below(3) > 0).then(|| change(&mut random))))
                .collect();
            let (mut merged, mut exchanged) = (changes.clone(), changes.clone());
            let before = merge(&mut merged, &wanted);
            let one_by_one: Vec<_> =
                wanted.iter().map(|&(key, change)| (key, exchange(&mut exchanged, key, change))).collect();
            assert_eq!((&merged, &before), (&exchanged, &one_by_one), "seed {number}");
            merge(&mut merged, &before);
            assert_eq!(merged, changes, "seed {number}");
        }
    }
}
