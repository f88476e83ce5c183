//! The operations of which every edit consists. Performing one returns the one that undoes it.

use super::ModelAdapter;
use super::change::KeyChange;
use super::kind::{AnyChannel, ChannelKind, RotationChannel};
use super::pending::PendingAt;
use super::slot::{ChannelChanges, ChannelContent, KeyContent, LayerVersions, TakeId, TakeVersions};
use super::texts::TextFiles;
use super::times::SharedTimes;
use crate::edit::target::Property;
use dragonfly_anim::data::{Bone, MorphTrack, Skeleton, Track};
use dragonfly_anim::stage::splice::TextSplices;
use glam::Quat;
use std::sync::Arc;

/// The address of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ChannelAddress {
    pub(crate) take: TakeId,
    pub(crate) bone: u32,
    pub(crate) property: Property,
}

/// One operation. Its size is in proportion to what it touches.
#[derive(Clone, Debug)]
pub(crate) enum Op {
    /// Replaces the changes of some keys.
    Changes(ChannelAddress, Vec<(u32, Option<KeyChange>)>),
    /// Replaces all changes of a channel.
    AllChanges(ChannelAddress, Arc<ChannelChanges>),
    /// Removes keys (positions before the operation) and inserts keys (positions after the operation).
    Splice(ChannelAddress, Vec<u32>, Vec<(u32, KeyContent)>),
    /// Replaces the times of some keys, listed in ascending order. The order of the keys stays the same.
    Times(ChannelAddress, Vec<(u32, f32)>),
    /// Replaces a channel.
    Replace(ChannelAddress, Box<ChannelContent>),
    /// Replaces the morph tracks.
    Morphs(TakeId, Vec<MorphTrack>),
    /// Replaces the pending poses at a time; `None` for none.
    Pending(TakeId, f32, Option<Arc<PendingAt>>),
    /// Replaces the layers of a take.
    Layers(TakeId, Vec<LayerVersions>),
    /// Renames a take.
    Name(TakeId, String),
    /// Replaces a text of the extras of a take; `None` for none.
    Extras(TakeId, String, Option<Arc<str>>),
    /// Inserts a take at an index of the list.
    Insert(usize, Arc<TakeVersions>),
    /// Removes a take.
    Remove(TakeId),
    /// Moves a take in the list.
    Move(TakeId, usize),
    /// Replaces the skeleton and all takes, which are those of its bones.
    Skeleton(Arc<Skeleton>, Vec<Arc<TakeVersions>>),
    /// Replaces parts of a text.
    Text(usize, TextSplices),
    /// Replaces the list of texts.
    Texts(TextFiles),
}

impl ChannelContent {
    /// Returns the size of its columns in bytes.
    fn bytes(&self) -> usize {
        let columns = match &self.original {
            AnyChannel::Vector(channel) => channel.times.len() * 4 + channel.values.len() * 12,
            AnyChannel::Turn(channel) => channel.times.len() * 4 + channel.values.len() * 16,
        };
        columns + size_of_val(self.changes.as_slice())
    }
}

impl Op {
    /// Returns the operation with the rotations of new keys as files store them, so that a saved take is read as it was.
    pub(crate) fn with_made_keys(mut self) -> Self {
        if let Self::Splice(place, _, insert) = &mut self
            && place.property == Property::Rotation
        {
            for (_, KeyContent { original: [_, value, _], .. }) in insert {
                *value = RotationChannel::as_key(Quat::from_array(*value)).to_array();
            }
        } else if let Self::Replace(_, content) = &mut self {
            content.original.make_keys();
        }
        self
    }

    /// Returns its approximate size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of::<Self>()
            + match self {
                Self::Changes(_, changes) => size_of_val(changes.as_slice()),
                Self::AllChanges(_, changes) => size_of_val(changes.as_slice()),
                Self::Splice(_, remove, insert) => {
                    size_of_val(remove.as_slice()) + size_of_val(insert.as_slice())
                }
                Self::Times(_, times) => size_of_val(times.as_slice()),
                Self::Replace(_, content) => content.bytes(),
                Self::Morphs(_, morphs) => {
                    morphs.iter().map(|morph| 4 * (morph.times.len() + morph.weights.len())).sum()
                }
                Self::Pending(_, _, at) => at
                    .as_ref()
                    .map_or(0, |at| size_of_val(at.poses.as_slice()) + size_of_val(at.shapes.as_slice())),
                Self::Insert(_, slot) => slot.original.keys() * 16,
                Self::Layers(_, layers) => {
                    layers.iter().map(|layer| 256 + layer.keys.original.keys() * 16).sum()
                }
                Self::Extras(_, _, text) => text.as_ref().map_or(0, |text| text.len()),
                Self::Skeleton(skeleton, slots) => {
                    // The columns of the channels are shared.
                    let takes: usize = slots.iter().map(|slot| 2 + slot.layers().len()).sum();
                    skeleton.len() * (size_of::<Bone>() + takes * size_of::<Track>())
                }
                Self::Text(_, splices) => splices.list().iter().map(|splice| 48 + splice.text.len()).sum(),
                Self::Texts(texts) => texts.list().iter().map(|file| 64 + file.text.len()).sum(),
                Self::Name(..) | Self::Remove(_) | Self::Move(..) => 0,
            }
    }
}

impl Op {
    /// Returns the take whose keys it creates, moves or deletes.
    pub(crate) fn keys_of(&self) -> Option<TakeId> {
        match self {
            Self::Splice(place, ..) | Self::Times(place, _) | Self::Replace(place, _) => Some(place.take),
            Self::Morphs(take, _) | Self::Layers(take, _) => Some(*take),
            Self::Changes(..)
            | Self::AllChanges(..)
            | Self::Pending(..)
            | Self::Name(..)
            | Self::Extras(..)
            | Self::Insert(..)
            | Self::Remove(_)
            | Self::Move(..)
            | Self::Skeleton(..)
            | Self::Text(..)
            | Self::Texts(_) => None,
        }
    }
}

impl ModelAdapter {
    /// Performs an operation and returns the one that undoes it.
    pub(crate) fn perform(&mut self, op: Op, shared: &mut SharedTimes) -> Op {
        match op {
            Op::Changes(place, changes) => {
                let before = self.slot_mut(place.take).set_changes(place.bone, place.property, &changes);
                Op::Changes(place, before)
            }
            Op::AllChanges(place, changes) => {
                let slot = self.slot_mut(place.take);
                Op::AllChanges(place, slot.replace_changes(place.bone, place.property, changes))
            }
            Op::Splice(place, remove, insert) => {
                let slot = self.slot_mut(place.take);
                let (remove, insert) = slot.splice(place.bone, place.property, &remove, &insert, shared);
                Op::Splice(place, remove, insert)
            }
            Op::Times(place, times) => {
                let slot = self.slot_mut(place.take);
                Op::Times(place, slot.set_times(place.bone, place.property, &times, shared))
            }
            Op::Replace(place, content) => {
                let before = self.slot_mut(place.take).replace(place.bone, place.property, *content);
                Op::Replace(place, Box::new(before))
            }
            Op::Morphs(take, morphs) => Op::Morphs(take, self.slot_mut(take).set_morphs(morphs)),
            Op::Pending(take, time, at) => {
                let before = self.slot_mut(take).set_pending(time, at);
                Op::Pending(take, time, before)
            }
            Op::Name(take, name) => Op::Name(take, self.slot_mut(take).set_name(&name)),
            Op::Layers(take, layers) => Op::Layers(take, self.slot_mut(take).set_layers(layers)),
            Op::Extras(take, name, text) => {
                let before = self.slot_mut(take).set_extras(&name, text);
                Op::Extras(take, name, before)
            }
            Op::Insert(index, slot) => {
                let id = slot.id;
                self.slots.insert(index.min(self.slots.len()), slot);
                Op::Remove(id)
            }
            Op::Remove(take) => {
                let index = self.index_of(take);
                Op::Insert(index, self.slots.remove(index))
            }
            Op::Move(take, to) => {
                let from = self.index_of(take);
                let slot = self.slots.remove(from);
                self.slots.insert(to.min(self.slots.len()), slot);
                Op::Move(take, from)
            }
            Op::Skeleton(skeleton, slots) => {
                let skeleton = std::mem::replace(&mut self.skeleton, skeleton);
                Op::Skeleton(skeleton, std::mem::replace(&mut self.slots, slots))
            }
            Op::Text(index, splices) => Op::Text(index, self.texts.splice(index, &splices)),
            Op::Texts(texts) => Op::Texts(std::mem::replace(&mut self.texts, texts)),
        }
    }

    /// Computes start and length of takes whose keys have changed, if they still exist, and puts layers over the takes below them.
    pub(crate) fn measure(&mut self, takes: &[TakeId]) {
        for &take in takes {
            if self.place_of(take).is_some() {
                self.slot_mut(take).measure();
            }
        }
        let skeleton = Arc::clone(&self.skeleton);
        for slot in self.slots.iter_mut().filter(|slot| slot.is_flat_outdated()) {
            Arc::make_mut(slot).flatten(&skeleton);
        }
    }

    fn index_of(&self, take: TakeId) -> usize {
        match self.slots.iter().position(|slot| slot.id == take) {
            Some(index) => index,
            None => unreachable!("an operation names a take that is not there: {take:?}"),
        }
    }

    fn slot_mut(&mut self, take: TakeId) -> &mut TakeVersions {
        let Some((index, layer)) = self.place_of(take) else {
            unreachable!("an operation names a take that is not there: {take:?}");
        };
        let slot = Arc::make_mut(&mut self.slots[index]);
        match layer {
            None => slot,
            Some(layer) => match slot.layer_mut(layer) {
                Some(keys) => keys,
                None => unreachable!("layer {layer} was found in the take"),
            },
        }
    }
}
