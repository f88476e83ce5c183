//! The layers of a take: settings, keys in their three forms, and the take that all of them give together.

use super::TakeVersions;
use crate::adapter::kind::{AnyChannel, ChannelKind, ChannelValue, with_kind};
use crate::edit::target::{LayerRef, Property};
use dragonfly_anim::data::{Channel, Skeleton, Take};
use dragonfly_anim::layers::{LayerChannel, LayerSettings, TakeLayer, flatten_channel, played};
use dragonfly_anim::sample::rest_pose;
use std::collections::BTreeMap;
use std::sync::Arc;

/// One layer of a take. A clone is cheap.
#[derive(Clone, Debug)]
pub struct LayerVersions {
    /// Everything but the keys.
    pub settings: Arc<LayerSettings>,
    /// Its keys in their three forms. Edits change them as they change those of a take.
    pub keys: Arc<TakeVersions>,
}

impl LayerRef {
    /// Returns the index of the layer; `None` where the take does not have it.
    pub fn find_in(&self, layers: &[LayerVersions]) -> Option<usize> {
        match self {
            Self::Index(index) => Some(*index).filter(|&index| index < layers.len()),
            Self::Name(name) => layers.iter().position(|layer| layer.settings.name == *name),
        }
    }
}

impl LayerVersions {
    /// Returns the layer for the functions of the library.
    pub fn flat(&self) -> TakeLayer {
        TakeLayer { settings: LayerSettings::clone(&self.settings), take: Arc::clone(&self.keys.result) }
    }

    /// Returns whether this is the same layer with the same keys; they are not compared one by one.
    fn is_same(&self, other: &Self) -> bool {
        self.settings == other.settings && Arc::ptr_eq(&self.keys.result, &other.keys.result)
    }
}

/// The take that base and layers give, and what it was computed from.
#[derive(Clone, Debug)]
pub(super) struct FlatTake {
    pub(super) take: Arc<Take>,
    pub(super) base: Arc<Take>,
    pub(super) layers: Vec<LayerVersions>,
    pub(super) channels: BTreeMap<(u32, Property), FlatChannel>,
}

/// One channel of it. Its sources are kept, so that it is computed again only where one of them differs.
#[derive(Clone, Debug)]
pub(super) struct FlatChannel {
    base: AnyChannel,
    pub(super) layers: Vec<(Arc<LayerSettings>, AnyChannel)>,
    flat: AnyChannel,
}

impl TakeVersions {
    /// Returns the layers, the lowest first.
    pub fn layers(&self) -> &[LayerVersions] {
        &self.layers
    }

    /// Returns the take that is shown and saved: the result, with all layers over it.
    pub fn shown(&self) -> &Arc<Take> {
        self.flat.as_ref().map_or(&self.result, |flat| &flat.take)
    }

    /// Replaces the layers. Returns the previous ones.
    pub(crate) fn set_layers(&mut self, layers: Vec<LayerVersions>) -> Vec<LayerVersions> {
        std::mem::replace(&mut self.layers, layers)
    }

    /// Returns the keys of the layer at `index`, to be modified.
    pub(crate) fn layer_mut(&mut self, index: usize) -> Option<&mut TakeVersions> {
        self.layers.get_mut(index).map(|layer| Arc::make_mut(&mut layer.keys))
    }

    /// Replaces all keys by those of another take, which become the originals.
    pub(crate) fn set_keys(&mut self, mut take: Take) {
        (take.start, take.length) = super::extent(&take);
        *self = Self::unchanged(self.id, self.origin, Arc::new(take));
    }

    /// Returns whether the take that is shown does not yet contain the last changes of the layers or the keys.
    pub(crate) fn is_flat_outdated(&self) -> bool {
        match &self.flat {
            None => !self.layers.is_empty(),
            Some(flat) => {
                let same = flat.layers.len() == self.layers.len()
                    && flat.layers.iter().zip(&self.layers).all(|(a, b)| a.is_same(b));
                !same || !Arc::ptr_eq(&flat.base, &self.result)
            }
        }
    }

    /// Computes the take that is shown. Channels whose sources are the same as before are kept.
    pub(crate) fn flatten(&mut self, skeleton: &Skeleton) {
        if self.layers.is_empty() {
            self.flat = None;
            return;
        }
        let mut old = self.flat.take().map(|flat| flat.channels).unwrap_or_default();
        let played = played(self.layers.iter().map(|layer| &*layer.settings));
        let layers: Vec<&LayerVersions> =
            self.layers.iter().zip(played).filter(|(_, played)| *played).map(|(layer, _)| layer).collect();
        let mut take = Take::clone(&self.result);
        let mut channels = BTreeMap::new();
        for bone in 0..take.tracks.len().min(skeleton.len()) as u32 {
            for property in Property::ALL {
                let old = old.remove(&(bone, property));
                let flat = with_kind!(property, flat_channel::<K>(&mut take, &layers, bone, skeleton, old));
                channels.extend(flat.map(|flat| ((bone, property), flat)));
            }
        }
        (take.start, take.length) = super::extent(&take);
        let flat = FlatTake {
            take: Arc::new(take),
            base: Arc::clone(&self.result),
            layers: self.layers.clone(),
            channels,
        };
        self.flat = Some(flat);
    }

    /// Puts channels that were read from a file in place of those that were computed, where they are nearly the same, so that a
    /// file that is not edited keeps its bytes. Returns whether all were.
    pub(crate) fn adopt_flat(&mut self, read: &Arc<Take>, near: &dyn Fn(&Take, &Take) -> bool) -> bool {
        let Some(flat) = self.flat.as_mut().filter(|flat| near(&flat.take, read)) else { return false };
        for (&(bone, property), channel) in &mut flat.channels {
            with_kind!(property, adopt::<K>(channel, read, bone));
        }
        let mut take = Take::clone(read);
        take.extras = self.result.extras.clone();
        flat.take = Arc::new(take);
        true
    }
}

fn adopt<K: ChannelKind>(channel: &mut FlatChannel, read: &Take, bone: u32) {
    if let Some(track) = read.tracks.get(bone as usize) {
        channel.flat = K::Value::wrap(K::channel(track).clone());
    }
}

/// Puts all layers over a channel of `take`. Returns it with its sources; `None` where no layer moves it.
fn flat_channel<K: ChannelKind>(
    take: &mut Take,
    layers: &[&LayerVersions],
    bone: u32,
    skeleton: &Skeleton,
    old: Option<FlatChannel>,
) -> Option<FlatChannel> {
    let moving: Vec<(&Arc<LayerSettings>, &Channel<K::Value>)> = layers
        .iter()
        .filter(|layer| layer.settings.moves(bone))
        .filter_map(|layer| {
            let keys = K::channel(layer.keys.result.tracks.get(bone as usize)?);
            (!keys.is_empty()).then_some((&layer.settings, keys))
        })
        .collect();
    if moving.is_empty() {
        return None;
    }
    let base = K::channel_mut(&mut take.tracks[bone as usize]);
    if let Some(old) = old
        && is_shared(&old.base, base)
        && old.layers.len() == moving.len()
        && old
            .layers
            .iter()
            .zip(&moving)
            .all(|(old, new)| (Arc::ptr_eq(&old.0, new.0) || old.0 == *new.0) && is_shared(&old.1, new.1))
    {
        if let Some(flat) = K::Value::unwrap(&old.flat) {
            *base = flat.clone();
        }
        return Some(old);
    }
    let over: Vec<LayerChannel<'_, K::Value>> =
        moving.iter().map(|&(settings, keys)| LayerChannel { settings, keys }).collect();
    let rest = K::of(&rest_pose(&skeleton.bones[bone as usize]));
    let flat = flatten_channel::<K::Rule>(base, &over, rest)?;
    let kept = FlatChannel {
        base: K::Value::wrap(base.clone()),
        layers: moving
            .iter()
            .map(|&(settings, keys)| (Arc::clone(settings), K::Value::wrap(keys.clone())))
            .collect(),
        flat: K::Value::wrap(flat.clone()),
    };
    *base = flat;
    Some(kept)
}

/// Returns whether two channels are the same columns in memory.
fn is_shared<V: ChannelValue>(old: &AnyChannel, new: &Channel<V>) -> bool {
    V::unwrap(old).is_some_and(|old| {
        Arc::ptr_eq(&old.times, &new.times)
            && Arc::ptr_eq(&old.values, &new.values)
            && old.interpolation == new.interpolation
    })
}
