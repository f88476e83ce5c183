//! Keys of a layer: the pose that is wanted is one that is seen, so the key depends on what lies below and above.

use super::{EditError, Transaction};
use crate::adapter::kind::ChannelKind;
use crate::adapter::op::{ChannelAddress, Op};
use crate::adapter::slot::{LayerVersions, TakeId, TakeVersions};
use crate::edit::target::{BoneRef, TakeRef};
use dragonfly_anim::data::{BoneIndex, Channel, Take, Track};
use dragonfly_anim::layers::{self, LayerChannel, LayerMode, LayerSettings, played, seen};
use dragonfly_anim::sample::{rest_pose, sample_channel};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Returns the take with the layers of which `take` is one, and its index among them; `None` where it is no layer.
fn owner(work: &Transaction, take: TakeId) -> Option<(&Arc<TakeVersions>, usize)> {
    let (slot, layer) = work.adapter.place_of(take)?;
    Some((work.adapter.slots.get(slot)?, layer?))
}

/// Returns the mode of a layer; `None` where the take is no layer.
pub(crate) fn mode(work: &Transaction, take: TakeId) -> Option<LayerMode> {
    let (base, index) = owner(work, take)?;
    base.layers().get(index).map(|layer| layer.settings.mode)
}

/// Returns the take below a layer, or the take itself. It has the pending poses.
pub(crate) fn base_of(work: &Transaction, take: TakeId) -> TakeId {
    owner(work, take).map_or(take, |(base, _)| base.id)
}

/// Returns the identifiers of the layers of a take, the lowest first.
pub(crate) fn ids(work: &Transaction, take: TakeId) -> Vec<TakeId> {
    work.slot(take).layers().iter().map(|layer| layer.keys.id).collect()
}

/// Moves the keys of the weights of all layers to the times that `to` returns.
pub(crate) fn remap(work: &mut Transaction, take: TakeId, to: impl Fn(f32) -> f32) {
    let moved = |layer: &LayerVersions| {
        let mut settings = LayerSettings::clone(&layer.settings);
        for key in &mut settings.weights {
            key.time = to(key.time);
        }
        settings.weights.sort_by(|a, b| a.time.total_cmp(&b.time));
        LayerVersions { settings: Arc::new(settings), keys: Arc::clone(&layer.keys) }
    };
    let layers = work.slot(take).layers();
    if layers.iter().any(|layer| !layer.settings.weights.is_empty()) {
        let layers = layers.iter().map(moved).collect();
        work.perform(Op::Layers(take, layers));
    }
}

/// The layers that move a channel, and the value of the base at one time.
struct Stack<'a, V> {
    below: V,
    channels: Vec<LayerChannel<'a, V>>,
    /// Index of the layer that is edited.
    own: usize,
}

/// Collects the layers of a bone, those without keys included.
fn stack<'a, K: ChannelKind>(
    work: &'a Transaction,
    (base, index): (&'a Arc<TakeVersions>, usize),
    address: ChannelAddress,
    time: f32,
    none: &'a Channel<K::Value>,
) -> Result<Stack<'a, K::Value>, EditError> {
    let layers = base.layers();
    let all = played(layers.iter().map(|layer| &*layer.settings));
    let name = || layers[index].settings.name.clone();
    if !all[index] {
        return Err(EditError::MutedLayer(name()));
    }
    if !layers[index].settings.moves(address.bone) {
        return Err(EditError::Masked { bone: address.bone, layer: name() });
    }
    let is_played = |at: &usize| all[*at] && layers[*at].settings.moves(address.bone);
    let channel = |layer: &'a LayerVersions| LayerChannel {
        settings: &*layer.settings,
        keys: layer.keys.result.tracks.get(address.bone as usize).map_or(none, K::channel),
    };
    let own = (0..index).filter(is_played).count();
    let channels = (0..layers.len()).filter(is_played).map(|at| channel(&layers[at])).collect();
    let rest = K::of(&rest_pose(work.skeleton_bone(address.bone)));
    let below = base.result.tracks.get(address.bone as usize).map(K::channel);
    Ok(Stack { below: sample_channel(below.unwrap_or(none), rest, time), channels, own })
}

/// Returns the key that a layer needs at a time so that `wanted` is seen; `None` where the take is no layer. `wanted` gets the
/// value that is seen now.
///
/// # Errors
///
/// The layer is muted, its mask leaves the bone out, or no key gives that value.
pub(crate) fn key_for<K: ChannelKind>(
    work: &Transaction,
    address: ChannelAddress,
    time: f32,
    wanted: impl FnOnce(K::Value) -> K::Value,
) -> Result<Option<K::Value>, EditError> {
    let Some(owner) = owner(work, address.take) else { return Ok(None) };
    let none = Channel::default();
    let stack = stack::<K>(work, owner, address, time, &none)?;
    let wanted = wanted(seen::<K::Rule>(stack.below, &stack.channels, time));
    let key = layers::key_for::<K::Rule>(stack.below, &stack.channels, stack.own, time, wanted);
    let name = || owner.0.layers()[owner.1].settings.name.clone();
    key.map(Some).ok_or_else(|| EditError::HiddenByLayer(name()))
}

/// Returns what lies below a layer of poses at a time: the value of its channel while that has no key. `None` for all other takes.
pub(crate) fn below<K: ChannelKind>(
    work: &Transaction,
    address: ChannelAddress,
    time: f32,
) -> Option<K::Value> {
    let owner = owner(work, address.take)?;
    if owner.0.layers()[owner.1].settings.mode != LayerMode::Override {
        return None;
    }
    let none = Channel::default();
    let stack = stack::<K>(work, owner, address, time, &none).ok()?;
    Some(seen::<K::Rule>(stack.below, &stack.channels[..stack.own], time))
}

/// Colors of new layers, one after the other.
pub(crate) const COLORS: [[u8; 3]; 6] =
    [[90, 160, 220], [230, 160, 70], [120, 190, 110], [200, 110, 180], [220, 110, 100], [110, 190, 190]];

/// Largest weight of a layer.
const LARGEST_WEIGHT: f32 = 10.0;

/// Returns the take below a layer and the index of the layer.
pub(crate) fn place(work: &Transaction, take: &TakeRef) -> Result<(TakeId, usize), EditError> {
    let id = work.take(take)?;
    let (base, index) = owner(work, id).ok_or_else(|| EditError::NoTake(take.clone()))?;
    Ok((base.id, index))
}

/// Returns the name if a layer may have it.
pub(crate) fn name(name: &str) -> Result<String, EditError> {
    if name.trim().is_empty() { Err(EditError::NoName) } else { Ok(name.to_owned()) }
}

/// Returns the weight if a layer may have it.
pub(crate) fn weight(weight: f32) -> Result<f32, EditError> {
    let what = "the weight of a layer";
    if (0.0..=LARGEST_WEIGHT).contains(&weight) {
        Ok(weight)
    } else {
        Err(EditError::Number { what, value: weight })
    }
}

/// Returns the mask of bones; `None`, for all, where no bone is named.
pub(crate) fn mask(work: &Transaction, bones: &[BoneRef]) -> Result<Option<Arc<[BoneIndex]>>, EditError> {
    let found: BTreeSet<u32> = bones.iter().map(|bone| work.bone(bone)).collect::<Result<_, _>>()?;
    Ok((!found.is_empty()).then(|| found.into_iter().collect()))
}

/// Returns a layer without keys for a take.
pub(crate) fn empty(work: &mut Transaction, take: TakeId, settings: LayerSettings) -> LayerVersions {
    let tracks = work.slot(take).original.tracks.iter();
    let tracks = tracks.map(|track| Track { bone: track.bone, ..Track::default() }).collect();
    let keys = Arc::new(Take { tracks, ..Take::default() });
    let keys = TakeVersions::unchanged(work.new_id(), None, keys);
    LayerVersions { settings: Arc::new(settings), keys: Arc::new(keys) }
}

/// Changes the list of the layers of a take.
pub(crate) fn replace(
    work: &mut Transaction,
    take: TakeId,
    change: impl FnOnce(&mut Vec<LayerVersions>),
) -> Result<(), EditError> {
    let mut layers = work.slot(take).layers().to_vec();
    change(&mut layers);
    if layers.len() > MOST {
        return Err(EditError::Nothing("a take has at most 64 layers"));
    }
    work.perform(Op::Layers(take, layers));
    Ok(())
}

/// Number of layers that a take may have.
const MOST: usize = 64;

/// Changes the settings of a layer.
pub(crate) fn set(
    work: &mut Transaction,
    take: TakeId,
    index: usize,
    change: impl FnOnce(&mut LayerSettings),
) -> Result<(), EditError> {
    let old = &work.slot(take).layers()[index].settings;
    let mut settings = LayerSettings::clone(old);
    change(&mut settings);
    if settings == **old {
        return Err(EditError::Nothing("the layer has these settings already"));
    }
    replace(work, take, |layers| layers[index].settings = Arc::new(settings))
}
