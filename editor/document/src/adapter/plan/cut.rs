//! A take cut down to a range of time.

use super::super::kind::{ChannelKind, with_kind};
use super::super::op::{ChannelAddress, Op};
use super::super::slot::{KeyContent, TakeId};
use super::keys::current;
use super::{EditError, Transaction, contacts, layer, moments, morph};
use crate::edit::SAME_TIME;

/// Deletes everything outside two times, in all channels, also those of its layers, and in its contacts and events.
pub(crate) fn cut(work: &mut Transaction, take: TakeId, from: f32, to: f32) -> Result<(), EditError> {
    for address in work.channels(take, (&[], &[]))? {
        with_kind!(address.property, channel::<K>(work, address, from, to));
    }
    for layer in layer::ids(work, take) {
        cut(work, layer, from, to)?;
    }
    let inside = |time: f32| time >= from - SAME_TIME && time <= to + SAME_TIME;
    moments::remap(work, take, |time| inside(time).then_some(time))?;
    contacts::follow(work, take, |track| track.between(from, to))?;
    let slot = work.slot(take);
    if !slot.original.morphs.is_empty() {
        let morphs = slot.original.morphs.iter().map(|track| morph::between(track, from, to)).collect();
        work.perform(Op::Morphs(take, morphs));
    }
    Ok(())
}

/// Deletes the keys outside of a range. A channel that continues outside gets keys at the ends of the range with its
/// values there. A channel without a key inside gets one.
fn channel<K: ChannelKind>(work: &mut Transaction, address: ChannelAddress, from: f32, to: f32) {
    let slot = work.slot(address.take);
    let times = slot.times(address.bone, address.property);
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return };
    let inside = |time: f32| time >= from - SAME_TIME && time <= to + SAME_TIME;
    let on = |wanted: f32| times.iter().any(|&time| (time - wanted).abs() <= SAME_TIME);
    let remove: Vec<u32> = (0..times.len() as u32).filter(|&key| !inside(times[key as usize])).collect();
    let kept = times.len() - remove.len();
    let mut insert: Vec<(u32, KeyContent)> = Vec::new();
    if !on(from) && (first < from || kept == 0) {
        insert.push((0, current::<K>(work, slot, address, from)));
    }
    // A range of length zero needs only one key.
    if !on(to) && first < to && last > to && to - from > SAME_TIME {
        insert.push(((kept + insert.len()) as u32, current::<K>(work, slot, address, to)));
    }
    if !remove.is_empty() || !insert.is_empty() {
        work.perform(Op::Splice(address, remove, insert));
    }
}
