//! The same offset for many keys.

use super::super::change::KeyChange;
use super::super::kind::{ChannelKind, RotationChannel, ScaleChannel, TranslationChannel};
use super::super::op::{ChannelAddress, Op};
use super::super::pending::PendingAt;
use super::super::slot::{ChannelChanges, KeyContent, TakeId, TakeVersions};
use super::arrange::insert_keys_overwriting;
use super::keys::current;
use super::pose::{rotation, vector};
use super::{EditError, ModelAdapter, Transaction, finite, key_at, rest};
use crate::edit::pose::BonePose;
use crate::edit::target::{BoneRef, Property, SAME_TIME, TakeRef};
use crate::edit::{OffsetKeys, OffsetScope};
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::offset::{Falloff, KeyOffset, KeyWeight, weights_of_keys, weights_of_range};
use dragonfly_anim::sample::sample_channel;
use std::sync::Arc;

/// Largest number of keys that are changed one by one; the changes of more keys replace those of their channel.
const FEW: usize = 32;

/// The keys that get the offset.
enum Scope {
    Take,
    Range([f32; 2]),
    Keys(Vec<(ChannelAddress, Vec<u32>)>),
}

/// An offset edit whose numbers were checked.
struct OffsetPlan {
    take: TakeId,
    scope: Scope,
    falloff: Option<Falloff>,
    /// Time at which the poses are wanted, seconds; `None` where they are offsets.
    at: Option<f32>,
}

/// Offsets the keys of the bones.
pub(crate) fn offset_keys(work: &mut Transaction, edit: &OffsetKeys) -> Result<(), EditError> {
    let take = work.take(&edit.take)?;
    let scope = match &edit.over {
        OffsetScope::Take => Scope::Take,
        OffsetScope::Range(range) => {
            let (from, to) = (finite("a time", range.from)?, finite("a time", range.to)?);
            Scope::Range(inside_take(work.slot(take), from.min(to), from.max(to))?)
        }
        OffsetScope::Keys(sets) => Scope::Keys(work.keys(take, sets)?),
    };
    let falloff = match edit.falloff {
        Some(falloff) if finite("the falloff", falloff.seconds)? > 4.0 * SAME_TIME => {
            Some(Falloff::from(falloff))
        }
        Some(_) | None => None,
    };
    let at = edit.at.map(|at| finite("a time", at)).transpose()?;
    let plan = OffsetPlan { take, scope, falloff, at };
    let (mut given, mut found) = (false, false);
    for pose in &edit.poses {
        let bone = work.track(take, &pose.bone)?;
        let address = |property| ChannelAddress { take, bone, property };
        let [translation, turn, scale] = Property::ALL.map(address);
        if let Some(numbers) = pose.translation {
            found |=
                plan.channel::<TranslationChannel>(work, translation, vector("a translation", numbers)?)?;
        }
        if let Some(numbers) = pose.rotation {
            found |= plan.channel::<RotationChannel>(work, turn, rotation(numbers)?)?;
        }
        if let Some(numbers) = pose.scale {
            found |= plan.channel::<ScaleChannel>(work, scale, vector("a scale", numbers)?)?;
        }
        given |= gives(pose).contains(&true);
    }
    match (given, found) {
        (true, true) => Ok(()),
        (true, false) => Err(EditError::Nothing("these bones have no key there")),
        (false, _) => Err(EditError::Nothing("no pose is given")),
    }
}

/// Returns which channels a pose names.
fn gives(pose: &BonePose) -> [bool; 3] {
    [pose.translation.is_some(), pose.rotation.is_some(), pose.scale.is_some()]
}

/// Returns the part of a range that is in the take.
fn inside_take(slot: &TakeVersions, from: f32, to: f32) -> Result<[f32; 2], EditError> {
    let (start, end) = slot.original.range_of_keys().unwrap_or((0.0, 0.0));
    if to < start - SAME_TIME || from > end + SAME_TIME {
        let time = if to < start { to } else { from };
        return Err(EditError::Outside { time, start, end });
    }
    Ok([from.max(start), to.min(end)])
}

/// Returns the number of keys that get the offset, without those of a falloff and new ones.
pub(crate) fn keys_of(
    adapter: &ModelAdapter,
    take: &TakeRef,
    poses: &[BonePose],
    over: &OffsetScope,
) -> usize {
    let Ok(slot) = adapter.take(take) else { return 0 };
    let bone =
        |bone: &BoneRef| adapter.bone(bone).ok().filter(|&bone| (bone as usize) < slot.original.tracks.len());
    let channels = poses.iter().flat_map(|pose| {
        let given = Property::ALL.into_iter().zip(gives(pose)).filter(|(_, given)| *given);
        let bone = bone(&pose.bone);
        given.filter_map(move |(property, _)| Some((bone?, property)))
    });
    match over {
        OffsetScope::Take => channels.map(|(bone, property)| slot.times(bone, property).len()).sum(),
        OffsetScope::Range(range) => {
            let (from, to) = (range.from.min(range.to) - SAME_TIME, range.from.max(range.to) + SAME_TIME);
            let inside = |times: &[f32]| {
                let end = times.partition_point(|&time| time <= to);
                end.saturating_sub(times.partition_point(|&time| time < from))
            };
            channels.map(|(bone, property)| inside(slot.times(bone, property))).sum()
        }
        OffsetScope::Keys(sets) => {
            let work = Transaction::on(adapter.clone());
            let Ok(keys) = work.keys(slot.id, sets) else { return 0 };
            let named: std::collections::BTreeSet<_> = channels.collect();
            let of_pose =
                keys.iter().filter(|(address, _)| named.contains(&(address.bone, address.property)));
            of_pose.map(|(_, keys)| keys.len()).sum()
        }
    }
}

impl OffsetPlan {
    /// Offsets the keys of a channel by `given`, or so that it has this value at the wanted time. Returns whether it has any.
    fn channel<K: ChannelKind>(
        &self,
        work: &mut Transaction,
        address: ChannelAddress,
        given: K::Value,
    ) -> Result<bool, EditError> {
        let bone = address.bone;
        let offset = match self.at {
            Some(at) => K::Offset::between(self.shown::<K>(work, address, at), given),
            None => K::Offset::between(K::value(K::IDENTITY), given),
        };
        let offset = offset.ok_or(EditError::ZeroScale { bone })?;
        // Without keys, the chosen ones are those of other channels.
        let chosen = match &self.scope {
            Scope::Take | Scope::Range(_) => None,
            Scope::Keys(keys) => match keys.iter().find(|(other, _)| *other == address) {
                Some((_, keys)) => Some(keys),
                None => return Ok(false),
            },
        };
        if offset == K::Offset::IDENTITY {
            return Ok(true);
        }
        self.make_keys::<K>(work, address)?;
        let slot = Arc::clone(work.slot(self.take));
        let times = slot.times(bone, address.property);
        let weights = match (&self.scope, chosen) {
            (Scope::Range(range), _) => {
                weights_of_range(times, range_with_tolerance(*range), self.shorter_falloff())
            }
            (_, Some(chosen)) => weights_of_keys(times, chosen, self.shorter_falloff()),
            (Scope::Take | Scope::Keys(_), None) => {
                (0..times.len() as u32).map(|key| KeyWeight { key, weight: 1.0 }).collect()
            }
        };
        change_keys::<K>(work, address, offset, &weights)?;
        let waits = self.offset_pending::<K>(work, address, offset, chosen)?;
        Ok(waits || !weights.is_empty())
    }

    /// Returns the falloff without the keys that are exactly where it ends.
    fn shorter_falloff(&self) -> Option<Falloff> {
        self.falloff.map(|falloff| Falloff { seconds: falloff.seconds - 2.0 * SAME_TIME, ..falloff })
    }

    /// Returns the value that a channel shows at a time.
    fn shown<K: ChannelKind>(&self, work: &Transaction, address: ChannelAddress, time: f32) -> K::Value {
        let slot = work.slot(self.take);
        let pending = slot.pending_at(time).and_then(|at| at.of(address.bone)?.get(address.property));
        pending.map(K::value).unwrap_or_else(|| {
            let rest = rest::<K>(work, address);
            let track = slot.result.tracks.get(address.bone as usize);
            track.map_or(rest, |track| K::as_key(sample_channel(K::channel(track), rest, time)))
        })
    }

    /// Makes the keys that a channel needs to get the offset where it is wanted and nowhere else.
    fn make_keys<K: ChannelKind>(
        &self,
        work: &mut Transaction,
        address: ChannelAddress,
    ) -> Result<(), EditError> {
        let slot = Arc::clone(work.slot(self.take));
        let Some(channel) = slot.original_of::<K>(address.bone) else { return Ok(()) };
        let (start, end) = slot.original.range_of_keys().unwrap_or((0.0, 0.0));
        let mut wanted: Vec<f32> = Vec::new();
        match (&self.scope, self.falloff) {
            (Scope::Take, _) if channel.is_empty() => wanted.push(start),
            (Scope::Range([from, to]), Some(Falloff { seconds, .. })) => {
                if channel.is_empty() {
                    wanted.push(*from);
                }
                let step = channel.interpolation == Interpolation::Step;
                if *from > start + SAME_TIME {
                    wanted.push(*from);
                    // A step holds the value before by itself.
                    if *from - seconds > start + SAME_TIME && (!step || channel.is_empty()) {
                        wanted.push(from - seconds);
                    } else if channel.is_empty() {
                        wanted.push(start);
                    }
                }
                if *to < end - SAME_TIME {
                    wanted.push(*to);
                    wanted.push((to + seconds).min(end));
                }
            }
            (Scope::Take | Scope::Range(_) | Scope::Keys(_), _) => {}
        }
        wanted.sort_by(f32::total_cmp);
        wanted.dedup_by(|next, kept| *next - *kept <= SAME_TIME);
        wanted.retain(|&time| key_at(&channel.times, time).is_err());
        if wanted.is_empty() {
            return Ok(());
        }
        work.room_for(address, wanted.len())?;
        let keys: Vec<KeyContent> =
            wanted.into_iter().map(|time| current::<K>(work, &slot, address, time)).collect();
        insert_keys_overwriting(work, address, keys, Vec::new())
    }

    /// Returns the part of the offset at a time of a pending pose. `chosen` are keys at `times`.
    fn weight_at(&self, time: f32, times: &[f32], chosen: Option<&Vec<u32>>) -> f32 {
        let falloff = self.shorter_falloff();
        let distance = match (&self.scope, chosen) {
            (Scope::Range(range), _) => {
                let [from, to] = range_with_tolerance(*range);
                (from - time).max(time - to).max(0.0)
            }
            (_, Some(chosen)) => {
                let keys = chosen.iter().filter_map(|&key| times.get(key as usize));
                let nearest = keys.map(|key| (key - time).abs()).fold(f32::INFINITY, f32::min);
                if nearest <= SAME_TIME { 0.0 } else { nearest }
            }
            (Scope::Take | Scope::Keys(_), None) => 0.0,
        };
        if distance == 0.0 { 1.0 } else { falloff.map_or(0.0, |falloff| falloff.weight(distance)) }
    }

    /// Offsets the pending values of a channel. Returns whether there are any.
    fn offset_pending<K: ChannelKind>(
        &self,
        work: &mut Transaction,
        address: ChannelAddress,
        offset: K::Offset,
        chosen: Option<&Vec<u32>>,
    ) -> Result<bool, EditError> {
        let slot = Arc::clone(work.slot(self.take));
        let times = slot.times(address.bone, address.property);
        let mut met = false;
        for at in slot.pending() {
            let Some(now) = at.of(address.bone).and_then(|pose| pose.get(address.property)) else { continue };
            let part = offset.part(self.weight_at(at.time, times, chosen));
            if part == K::Offset::IDENTITY {
                continue;
            }
            let value = K::numbers(part.value(K::value(now)));
            for number in value {
                finite("the result", number)?;
            }
            let mut at = PendingAt::clone(at);
            at.entry(address.bone).set(address.property, Some(value));
            work.perform(Op::Pending(self.take, at.time, Some(Arc::new(at))));
            met = true;
        }
        Ok(met)
    }
}

/// Returns the range with the tolerance of times.
fn range_with_tolerance([from, to]: [f32; 2]) -> [f32; 2] {
    [from - SAME_TIME, to + SAME_TIME]
}

/// Gives keys of a channel their parts of an offset.
fn change_keys<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    offset: K::Offset,
    weights: &[KeyWeight],
) -> Result<(), EditError> {
    let slot = Arc::clone(work.slot(address.take));
    let Some(original) = slot.original_of::<K>(address.bone) else { return Ok(()) };
    let before = slot.changes(address.bone, address.property);
    let new = |key: u32, weight: f32, now: Option<KeyChange>| {
        let part = offset.part(weight);
        if part == K::Offset::IDENTITY {
            Ok(now)
        } else {
            changed::<K>(address.bone, original, key, now, part)
        }
    };
    if weights.len() <= FEW {
        let mut changes = Vec::with_capacity(weights.len());
        for &KeyWeight { key, weight } in weights {
            let now = slot.key_change(address.bone, address.property, key as usize);
            changes.push((key, new(key, weight, now)?));
        }
        if !changes.is_empty() {
            work.perform(Op::Changes(address, changes));
        }
        return Ok(());
    }
    let mut changes: ChannelChanges = super::list(before.len() + weights.len())?;
    let mut old = before.iter().copied().peekable();
    for &KeyWeight { key, weight } in weights {
        while let Some(other) = old.next_if(|(other, _)| *other < key) {
            changes.push(other);
        }
        let now = old.next_if(|(other, _)| *other == key).map(|(_, change)| change);
        changes.extend(new(key, weight, now)?.map(|change| (key, change)));
    }
    changes.extend(old);
    changes.shrink_to_fit();
    work.perform(Op::AllChanges(address, Arc::new(changes)));
    Ok(())
}

/// Returns the change of a key whose result gets an offset; `None` where the key becomes the original again. The sign of a
/// quaternion stays, because keys that change their sign one by one would turn the long way.
fn changed<K: ChannelKind>(
    bone: u32,
    original: &Channel<K::Value>,
    key: u32,
    now: Option<KeyChange>,
    offset: K::Offset,
) -> Result<Option<KeyChange>, EditError> {
    let as_read = super::super::change::triple::<K>(original, key as usize);
    let before = now.map_or(as_read, |change| change.result::<K>(&as_read))[1];
    let wanted = offset.value(K::value(before));
    let first = K::value(as_read[1]);
    let value = if wanted == first {
        K::IDENTITY
    } else {
        K::change(first, wanted).ok_or(EditError::ZeroScale { bone })?
    };
    let mapped = |tangent| K::numbers(offset.tangent(K::value(tangent)));
    let change = match now {
        Some(now) => KeyChange { value, arrive: mapped(now.arrive), leave: mapped(now.leave) },
        None => KeyChange::of_value(value),
    };
    let result = change.result::<K>(&as_read);
    let largest = result.iter().flatten().fold(0.0_f32, |largest, number| largest.max(number.abs()));
    finite("the result", largest)?;
    Ok(change.some::<K>())
}
