//! From edits to operations: a transaction, and the algorithms that several kinds of edits share.
//!
//! Each kind of edit has its own plan in [`crate::edit`].

pub(crate) mod arrange;
mod chosen;
pub(crate) mod contacts;
pub(crate) mod cut;
pub(crate) mod events;
pub(crate) mod keys;
pub(crate) mod layer;
pub(crate) mod moments;
pub(crate) mod morph;
pub(crate) mod morph_given;
pub(crate) mod morph_keys;
pub(crate) mod morph_offset;
pub(crate) mod offset;
pub(crate) mod pending;
pub(crate) mod pose;
pub(crate) mod remap;
pub(crate) mod rewrite;
pub(crate) mod spline;
pub(crate) mod timing;
mod unstep;
pub(crate) mod values;

pub(crate) use super::slot::key_at;
pub(crate) use arrange::KeyMove;
pub(crate) use pose::PoseMode;

use super::key_bytes::KEY_BYTES;
use super::kind::{ChannelKind, ChannelValue};
use super::op::{ChannelAddress, Op};
use super::slot::{ChannelContent, TakeId, TakeVersions};
use super::times::SharedTimes;
use super::{EditError, ModelAdapter};
use crate::edit::target::{BoneRef, Property, TakeRef};
use dragonfly_anim::data::{Bone, Channel, MorphTrack, Skeleton};
use dragonfly_anim::layers::{LayerMode, LayerRule};
use dragonfly_anim::limits::{CLIP_SECONDS, KEYS_PER_CHANNEL};
use std::collections::BTreeSet;
use std::sync::Arc;

/// An edit that is being applied: the document as it is so far, and the operations that undo it.
pub(crate) struct Transaction {
    adapter: ModelAdapter,
    undo: Vec<Op>,
    shared: SharedTimes,
    /// Takes whose keys changed their times: their start and length are measured once, at the end.
    touched: Vec<TakeId>,
    /// Size in bytes of the keys that were copied so far, at least.
    added: u64,
}

/// Bones and channels as an edit names them; an empty list means all.
pub(crate) type NamedChannels<'a> = (&'a [BoneRef], &'a [Property]);

impl Transaction {
    pub(crate) fn on(adapter: ModelAdapter) -> Self {
        Self { adapter, undo: Vec::new(), shared: SharedTimes::default(), touched: Vec::new(), added: 0 }
    }

    /// Returns the document, the operations that undo the edit, in the order in which they were found, and the takes whose keys
    /// changed their times or their number.
    pub(crate) fn done(mut self) -> (ModelAdapter, Vec<Op>, Vec<TakeId>) {
        self.adapter.measure(&self.touched);
        (self.adapter, self.undo, self.touched)
    }

    /// Checks, before memory is allocated for them, that a channel may get `more` keys.
    pub(crate) fn room_for(&mut self, address: ChannelAddress, more: usize) -> Result<(), EditError> {
        let keys = self.slot(address.take).times(address.bone, address.property).len().saturating_add(more);
        if keys > KEYS_PER_CHANNEL {
            return Err(EditError::TooManyKeys { keys });
        }
        // A key has its time and at least three numbers.
        self.added += 16 * more as u64;
        let bytes = self.adapter.key_bytes() + self.added;
        if bytes > KEY_BYTES { Err(EditError::TooLarge { bytes }) } else { Ok(()) }
    }

    /// Checks that weights of shape keys may replace those of a track with `old` keys.
    pub(crate) fn room_for_weights(&mut self, new: &MorphTrack, old: usize) -> Result<(), EditError> {
        let keys = new.times.len();
        if keys > KEYS_PER_CHANNEL {
            return Err(EditError::TooManyKeys { keys });
        }
        let width = 4 * (1 + new.weights.len() / keys.max(1));
        self.added += (keys.saturating_sub(old) * width) as u64;
        let bytes = self.adapter.key_bytes() + self.added;
        if bytes > KEY_BYTES { Err(EditError::TooLarge { bytes }) } else { Ok(()) }
    }

    /// Checks that a take with this many keys may be added.
    pub(crate) fn room_for_take(&mut self, keys: usize) -> Result<(), EditError> {
        self.added += 16 * keys as u64;
        let bytes = self.adapter.key_bytes() + self.added;
        if bytes > KEY_BYTES { Err(EditError::TooLarge { bytes }) } else { Ok(()) }
    }

    pub(crate) fn perform(&mut self, op: Op) {
        if let Some(take) = op.keys_of()
            && !self.touched.contains(&take)
        {
            self.touched.push(take);
        }
        let inverse = self.adapter.perform(op.with_made_keys(), &mut self.shared);
        self.undo.push(inverse);
    }

    /// Replaces a channel. It shares its times with channels whose times were the same before and are the same now.
    pub(crate) fn replace<K: ChannelKind>(
        &mut self,
        address: ChannelAddress,
        mut content: ChannelContent,
        old_times: &Arc<[f32]>,
    ) {
        if let Some(channel) = K::Value::unwrap(&content.original) {
            let times = self.shared.times(old_times, channel.times.to_vec());
            content.original = K::Value::wrap(Channel { times, ..channel.clone() });
        }
        self.perform(Op::Replace(address, Box::new(content)));
    }

    /// Returns the document as it is so far.
    pub(crate) fn adapter(&self) -> &ModelAdapter {
        &self.adapter
    }

    pub(crate) fn take(&self, take: &TakeRef) -> Result<TakeId, EditError> {
        self.adapter.take(take).map(|slot| slot.id)
    }

    pub(crate) fn index(&self, take: TakeId) -> usize {
        self.adapter.slots.iter().position(|slot| slot.id == take).unwrap_or_default()
    }

    /// Returns the take as it is so far.
    pub(crate) fn slot(&self, take: TakeId) -> &Arc<TakeVersions> {
        match self.adapter.slot(take) {
            Some(slot) => slot,
            None => unreachable!("an edit names a take that is not there: {take:?}"),
        }
    }

    /// Returns the take of a reference; that of a layer is the take below it.
    pub(crate) fn base(&self, take: &TakeRef) -> Result<TakeId, EditError> {
        self.adapter.base(take).map(|slot| slot.id)
    }

    /// Returns a copy of a take with identifiers of its own.
    pub(crate) fn copy_of(&mut self, take: TakeId) -> TakeVersions {
        let slot = Arc::clone(self.slot(take));
        slot.copied(&mut || self.adapter.new_id())
    }

    pub(crate) fn bone(&self, bone: &BoneRef) -> Result<u32, EditError> {
        self.adapter.bone(bone)
    }

    /// Returns the bone if the take has a track for it.
    pub(crate) fn track(&self, take: TakeId, bone: &BoneRef) -> Result<u32, EditError> {
        let bone = self.bone(bone)?;
        let has_track = (bone as usize) < self.slot(take).original.tracks.len();
        if has_track { Ok(bone) } else { Err(EditError::NoTrack(bone)) }
    }

    pub(crate) fn skeleton(&self) -> &Skeleton {
        &self.adapter.skeleton
    }

    /// Returns the number of takes.
    pub(crate) fn takes(&self) -> usize {
        self.adapter.slots.len()
    }

    /// Returns an identifier that no take has had.
    pub(crate) fn new_id(&mut self) -> TakeId {
        self.adapter.new_id()
    }

    fn skeleton_bone(&self, bone: u32) -> &Bone {
        &self.adapter.skeleton.bones[bone as usize]
    }

    /// Returns the named channels, bone after bone.
    pub(crate) fn channels(
        &self,
        take: TakeId,
        (bones, properties): NamedChannels<'_>,
    ) -> Result<Vec<ChannelAddress>, EditError> {
        let slot = self.slot(take);
        let bones: Vec<u32> = if bones.is_empty() {
            (0..slot.original.tracks.len() as u32).collect()
        } else {
            let found: BTreeSet<u32> = bones.iter().map(|bone| self.bone(bone)).collect::<Result<_, _>>()?;
            found.into_iter().collect()
        };
        if let Some(&bone) = bones.iter().find(|&&bone| bone as usize >= slot.original.tracks.len()) {
            return Err(EditError::NoTrack(bone));
        }
        let wanted = |property: &Property| properties.is_empty() || properties.contains(property);
        let of_bone = |bone: u32| {
            let properties = Property::ALL.into_iter().filter(wanted);
            properties.map(move |property| ChannelAddress { take, bone, property })
        };
        Ok(bones.into_iter().flat_map(of_bone).collect())
    }
}

/// Returns the number if it is finite and small enough to be calculated with.
pub(crate) fn finite(what: &'static str, value: f32) -> Result<f32, EditError> {
    // Sums and products of two such numbers are finite, too.
    if value.is_finite() && value.abs() <= 1e18 { Ok(value) } else { Err(EditError::Number { what, value }) }
}

/// Returns the time if a key may have it.
pub(crate) fn key_time(time: f32, slot: &TakeVersions) -> Result<f32, EditError> {
    finite("a time", time)?;
    // A take that was read with keys before 0 s may keep them.
    if time < slot.original.start.min(0.0) {
        Err(EditError::BeforeZero(time))
    } else if time > CLIP_SECONDS {
        Err(EditError::TooLate(time))
    } else {
        Ok(time)
    }
}

/// Returns an empty list with room for `items`.
pub(crate) fn list<T>(items: usize) -> Result<Vec<T>, EditError> {
    let mut list = Vec::new();
    list.try_reserve_exact(items).map_err(|_| EditError::NoMemory)?;
    Ok(list)
}

/// Returns the rest value of a channel; that of an additive layer is the offset that changes nothing.
pub(crate) fn rest<K: ChannelKind>(work: &Transaction, address: ChannelAddress) -> K::Value {
    match layer::mode(work, address.take) {
        Some(LayerMode::Additive) => <K::Rule as LayerRule>::IDENTITY,
        Some(LayerMode::Override) | None => {
            K::of(&dragonfly_anim::sample::rest_pose(work.skeleton_bone(address.bone)))
        }
    }
}
