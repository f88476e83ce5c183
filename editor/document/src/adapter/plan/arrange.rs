//! Keys at other times, among the keys that stay.

use super::super::change::KeyChange;
use super::super::kind::Kind;
use super::super::op::{Op, Place};
use super::super::slot::Key;
use super::Work;
use crate::edit::SAME_TIME;

/// What happens to chosen keys.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    /// Do they stay where they were, too?
    pub(super) copy: bool,
    /// Time runs this much slower for them: tangents become as much flatter. Negative: backwards.
    pub(super) stretch: f32,
}

impl Moving {
    pub(super) const WHOLE: Self = Self { copy: false, stretch: 1.0 };
}

/// Puts chosen keys at new times: `chosen` are positions, ascending, each with its time to be.
///
/// A key that comes to lie on one that stays takes its place; of two that are moved to one time, the later in the list
/// stays.
pub(super) fn arrange<K: Kind>(work: &mut Work, place: Place, chosen: &[(u32, f32)], moving: Moving) {
    let slot = work.slot(place.take);
    let times = slot.times(place.bone, place.property);
    if !moving.copy && moving.stretch == 1.0 && stays_in_order(times, chosen) {
        return work.perform(Op::Times(place, chosen.to_vec()));
    }
    let key = |at: u32| slot.key::<K>(place.property, place.bone, at as usize);
    let mut moved: Vec<Key> = chosen
        .iter()
        .filter_map(|&(at, time)| Some(Key { time, ..stretched(key(at)?, moving.stretch) }))
        .collect();
    moved.sort_by(|a, b| a.time.total_cmp(&b.time));
    // Of neighbours at one time the last counts.
    moved.reverse();
    moved.dedup_by(|next, kept| (kept.time - next.time).abs() <= SAME_TIME);
    moved.reverse();
    let away = if moving.copy { Vec::new() } else { chosen.iter().map(|&(at, _)| at).collect() };
    lay(work, place, moved, away);
}

/// Puts keys, ascending and apart from each other, among those of a channel, of which those at `remove` go. What one comes
/// to lie on goes, too.
pub(super) fn lay(work: &mut Work, place: Place, keys: Vec<Key>, mut remove: Vec<u32>) {
    let times = work.slot(place.take).times(place.bone, place.property);
    for key in &keys {
        let near = times.partition_point(|&time| time < key.time - 2.0 * SAME_TIME);
        let there = times.iter().enumerate().skip(near);
        let there = there.take_while(|(_, time)| **time <= key.time + 2.0 * SAME_TIME);
        let covered = there.filter(|(_, time)| (key.time - **time).abs() <= SAME_TIME);
        remove.extend(covered.map(|(at, _)| at as u32));
    }
    remove.sort_unstable();
    remove.dedup();
    let before = |position: usize, time: f32| {
        let there = times.partition_point(|&other| other < time);
        let gone = remove.partition_point(|&at| (at as usize) < there);
        there - gone + position
    };
    let insert = keys
        .into_iter()
        .enumerate()
        .map(|(position, key)| (before(position, key.time) as u32, key))
        .collect();
    work.perform(Op::Splice(place, remove, insert));
}

/// Does no key come to another place among the others, nor on another one? Then its column of values stays as it is.
fn stays_in_order(times: &[f32], chosen: &[(u32, f32)]) -> bool {
    let apart = |before: f32, after: f32| after - before > SAME_TIME;
    chosen.iter().enumerate().all(|(index, &(at, time))| {
        let at = at as usize;
        let before = match index.checked_sub(1).map(|index| chosen[index]) {
            Some((key, time)) if key as usize + 1 == at => Some(time),
            _ => at.checked_sub(1).and_then(|key| times.get(key).copied()),
        };
        let after = match chosen.get(index + 1) {
            Some(&(key, time)) if key as usize == at + 1 => Some(time),
            _ => times.get(at + 1).copied(),
        };
        // Keys that were nearer than that before are no reason to rearrange, but are not worth a rule of their own.
        before.is_none_or(|before| apart(before, time)) && after.is_none_or(|after| apart(time, after))
    })
}

/// The same key where time runs `stretch` times slower.
pub(super) fn stretched(key: Key, stretch: f32) -> Key {
    if stretch == 1.0 {
        return key;
    }
    let scaled = |tangent: [f32; 4]| tangent.map(|number| number / stretch);
    let [arrive, value, leave] = key.original;
    let original = [scaled(arrive), value, scaled(leave)];
    let change = key.change.map(|change| change.with_tangents(1.0 / stretch));
    if stretch > 0.0 {
        return Key { original, change, ..key };
    }
    // Backwards, what arrived leaves.
    let [arrive, value, leave] = original;
    let change = change.map(|change| KeyChange { arrive: change.leave, leave: change.arrive, ..change });
    Key { original: [leave, value, arrive], change, ..key }
}
