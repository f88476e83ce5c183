//! Moves and inserts keys among the other keys of a channel.

use super::super::change::KeyChange;
use super::super::kind::ChannelKind;
use super::super::op::{ChannelAddress, Op};
use super::super::slot::KeyContent;
use super::{EditError, Transaction, list};
use crate::edit::SAME_TIME;

/// How keys are moved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeyMove {
    /// Whether the keys also stay where they were.
    pub(crate) copy: bool,
    /// Factor by which time runs slower for them: tangents become flatter by it. Negative: backwards.
    pub(crate) stretch: f32,
}

impl KeyMove {
    /// A move to another time, and nothing else.
    pub(crate) const PLAIN: Self = Self { copy: false, stretch: 1.0 };
}

/// Moves keys of a channel: `chosen` are positions, ascending, each with its new time.
///
/// A key that is already at a new time is overwritten; of two keys that are moved to one time, the later in the list stays.
pub(crate) fn arrange<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    chosen: &[(u32, f32)],
    how: KeyMove,
) -> Result<(), EditError> {
    if how.copy {
        work.room_for(address, chosen.len())?;
    }
    let slot = work.slot(address.take);
    let times = slot.times(address.bone, address.property);
    if !how.copy && how.stretch == 1.0 && stays_in_order(times, chosen) {
        work.perform(Op::Times(address, chosen.to_vec()));
        return Ok(());
    }
    let key = |at: u32| slot.key::<K>(address.property, address.bone, at as usize);
    let mut moved: Vec<KeyContent> = list(chosen.len())?;
    let contents = chosen
        .iter()
        .filter_map(|&(at, time)| Some(KeyContent { time, ..stretched(key(at)?, [how.stretch; 2]) }));
    moved.extend(contents);
    moved.sort_by(|a, b| a.time.total_cmp(&b.time));
    // Of several keys at the same time, the last one wins.
    moved.reverse();
    moved.dedup_by(|next, kept| (kept.time - next.time).abs() <= SAME_TIME);
    moved.reverse();
    let away = if how.copy { Vec::new() } else { chosen.iter().map(|&(at, _)| at).collect() };
    insert_keys_overwriting(work, address, moved, away)
}

/// Inserts `keys` into a channel, and removes its keys at the positions `remove`. The times of `keys` ascend, and no
/// two are the same. Keys that the channel has at these times are overwritten.
pub(crate) fn insert_keys_overwriting(
    work: &mut Transaction,
    address: ChannelAddress,
    keys: Vec<KeyContent>,
    mut remove: Vec<u32>,
) -> Result<(), EditError> {
    let times = work.slot(address.take).times(address.bone, address.property);
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
    let mut insert = list(keys.len())?;
    let placed = keys.into_iter().enumerate();
    insert.extend(placed.map(|(position, key)| (before(position, key.time) as u32, key)));
    // The columns are made without a way back, so this finds out whether there is room for them.
    std::hint::black_box(list::<[f32; 16]>(times.len() + insert.len())?);
    work.perform(Op::Splice(address, remove, insert));
    Ok(())
}

/// Returns whether all keys keep their order and no two get the same time. The column of values then stays as it is.
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
        // Keys that were nearer than that already would keep their order too, but are too rare for a rule of their own.
        before.is_none_or(|before| apart(before, time)) && after.is_none_or(|after| apart(time, after))
    })
}

/// Returns the key with its tangents adapted to times that run slower by these factors before and after it; negative: backwards.
pub(crate) fn stretched(key: KeyContent, stretch: [f32; 2]) -> KeyContent {
    if stretch == [1.0; 2] {
        return key;
    }
    let [before, after] = stretch;
    let scaled = |tangent: [f32; 4], stretch: f32| tangent.map(|number| number / stretch);
    let [arrive, value, leave] = key.original;
    let original = [scaled(arrive, before), value, scaled(leave, after)];
    let change = key.change.map(|change| change.with_tangents([1.0 / before, 1.0 / after]));
    if before > 0.0 {
        return KeyContent { original, change, ..key };
    }
    // Backwards, in-tangents become out-tangents.
    let [arrive, value, leave] = original;
    let change = change.map(|change| KeyChange { arrive: change.leave, leave: change.arrive, ..change });
    KeyContent { original: [leave, value, arrive], change, ..key }
}
