//! Keys at other times, among the keys that stay.

use super::super::change::KeyChange;
use super::super::kind::Kind;
use super::super::op::{Op, Place};
use super::super::slot::Key;
use super::Work;
use crate::document::edit::SAME_TIME;

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
    let is_chosen = |at: &u32| chosen.binary_search_by_key(at, |(at, _)| *at).is_ok();
    let covered = |time: f32| {
        let near = moved.partition_point(|key| key.time < time - SAME_TIME);
        moved.get(near).is_some_and(|key| (key.time - time).abs() <= SAME_TIME)
    };
    let (mut remove, mut kept) = (Vec::new(), Vec::new());
    for at in 0..times.len() as u32 {
        let time = times[at as usize];
        if (is_chosen(&at) && !moving.copy) || covered(time) {
            remove.push(at);
        } else {
            kept.push(time);
        }
    }
    let before = |position: usize, time: f32| kept.partition_point(|&other| other < time) + position;
    let insert = moved
        .into_iter()
        .enumerate()
        .map(|(position, key)| (before(position, key.time) as u32, key))
        .collect();
    work.perform(Op::Splice(place, remove, insert));
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
