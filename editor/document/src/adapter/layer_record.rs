//! Layers in a file: the keys of the animation are those of the take that is seen, which every program plays, and the extras have
//! the layers and the channels below them, from which the document is made again.
//!
//! ```json
//! {"version": 1, "numbers": ["AAAAAA…"],
//!  "base":   [{"bone": "Arm", "path": "rotation", "interpolation": "linear", "times": 0, "values": 1}],
//!  "layers": [{"name": "Arm up", "kind": "additive", "weight": 1, "weights": [[0.5, 1]], "bones": ["Arm"],
//!              "muted": false, "solo": false, "color": [90, 160, 220], "keys": [{"bone": "Arm", …}]}]}
//! ```
//!
//! `base` has the channels that layers change. `times` and `values` are indices of `numbers`: little-endian floats in Base64. If the
//! layers do not give the keys of the animation, another program has changed these: then the layers are left out, and
//! the take stays as it was read.

use super::kind::{ChannelKind, with_kind};
use super::record_bone::{RecordBone, RecordBones};
use super::slot::{LayerVersions, TakeVersions};
use super::{KEY_BYTES, ModelAdapter, TakeId};
use crate::edit::LayerKind;
use crate::edit::target::Property;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use dragonfly_anim::data::{AnimationData, Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::layers::{LayerSettings, WeightKey};
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::Arc;

/// Name of the layers in the extras of a take.
pub(crate) const LAYERS: &str = "layers";

/// Version of the record. It grows when an older program could misunderstand a newer record.
const VERSION: u32 = 1;

/// Radians, meters or factors by which the keys of a file may differ from those that its layers give.
const NEAR: f32 = 2e-3;

#[derive(Serialize, Deserialize)]
struct LayersRecord {
    version: u32,
    numbers: Vec<String>,
    base: Vec<ChannelRecord>,
    layers: Vec<LayerRecord>,
}

#[derive(Serialize, Deserialize)]
struct ChannelRecord {
    #[serde(flatten)]
    bone: RecordBone,
    path: Property,
    interpolation: InterpolationRecord,
    times: usize,
    values: usize,
}

#[derive(Serialize, Deserialize)]
struct LayerRecord {
    name: String,
    kind: LayerKind,
    weight: f32,
    weights: Vec<(f32, f32)>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bones: Option<Vec<RecordBone>>,
    muted: bool,
    solo: bool,
    color: [u8; 3],
    keys: Vec<ChannelRecord>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum InterpolationRecord {
    Step,
    Linear,
    CubicSpline,
    Closest,
}

impl From<Interpolation> for InterpolationRecord {
    fn from(kind: Interpolation) -> Self {
        match kind {
            Interpolation::Step => Self::Step,
            Interpolation::Linear => Self::Linear,
            Interpolation::CubicSpline => Self::CubicSpline,
            Interpolation::Closest => Self::Closest,
        }
    }
}

impl From<InterpolationRecord> for Interpolation {
    fn from(kind: InterpolationRecord) -> Self {
        match kind {
            InterpolationRecord::Step => Self::Step,
            InterpolationRecord::Linear => Self::Linear,
            InterpolationRecord::CubicSpline => Self::CubicSpline,
            InterpolationRecord::Closest => Self::Closest,
        }
    }
}

impl ModelAdapter {
    /// Returns the takes as a file has them: as they are shown, the layers in their extras.
    pub(crate) fn saved_takes(&self) -> Vec<Arc<Take>> {
        self.slots.iter().map(|slot| saved(slot, &self.skeleton)).collect()
    }

    /// Makes the layers of the takes from their extras. A take whose layers do not fit it stays as it was read.
    pub(super) fn restore_layers(&mut self) {
        for index in 0..self.slots.len() {
            let slot = Arc::clone(&self.slots[index]);
            let Some(text) = slot.original.extras.get(LAYERS) else { continue };
            let skeleton = Arc::clone(&self.skeleton);
            let next = self.next;
            match restored(&slot, text, &skeleton, &mut || self.new_id()) {
                Some(slot) => self.slots[index] = Arc::new(slot),
                None => self.next = next,
            }
        }
    }
}

/// Returns one sentence for each take whose layers in the file cannot be used.
pub(crate) fn unused_layers(animation: &AnimationData) -> Vec<String> {
    if animation.takes.iter().all(|take| take.extras.get(LAYERS).is_none()) {
        return Vec::new();
    }
    let adapter = ModelAdapter::new(animation);
    let unused = adapter.slots.iter().filter(|slot| slot.original.extras.get(LAYERS).is_some());
    let text = |slot: &Arc<TakeVersions>| {
        let name = &slot.original.name;
        format!(
            "take \"{name}\": its layers do not fit its keys, which another program has changed; they are left out"
        )
    };
    unused.map(text).collect()
}

fn saved(slot: &TakeVersions, skeleton: &Skeleton) -> Arc<Take> {
    if slot.layers().is_empty() {
        return Arc::clone(slot.shown());
    }
    let mut numbers = Numbers::default();
    let mut base = Vec::new();
    for bone in 0..skeleton.len() as u32 {
        for property in Property::ALL {
            let is_moved = slot.layers().iter().any(|layer| !layer.keys.times(bone, property).is_empty());
            if is_moved {
                base.extend(with_kind!(
                    property,
                    written::<K>(&slot.result, bone, property, skeleton, &mut numbers)
                ));
            }
        }
    }
    let layers = slot.layers().iter().map(|layer| layer_record(layer, skeleton, &mut numbers)).collect();
    let record = LayersRecord { version: VERSION, numbers: numbers.texts, base, layers };
    let mut take = Take::clone(slot.shown());
    if let Ok(text) = serde_json::to_string(&record) {
        take.extras.set(LAYERS, Some(Arc::from(text)));
    }
    Arc::new(take)
}

fn layer_record(layer: &LayerVersions, skeleton: &Skeleton, numbers: &mut Numbers) -> LayerRecord {
    let settings = &*layer.settings;
    let mut keys = Vec::new();
    for bone in 0..skeleton.len() as u32 {
        for property in Property::ALL {
            keys.extend(with_kind!(
                property,
                written::<K>(&layer.keys.result, bone, property, skeleton, numbers)
            ));
        }
    }
    let name = |bone: &u32| RecordBone::of(skeleton, *bone);
    LayerRecord {
        name: settings.name.clone(),
        kind: settings.mode.into(),
        weight: settings.weight,
        weights: settings.weights.iter().map(|key| (key.time, key.weight)).collect(),
        bones: settings.bones.as_ref().map(|bones| bones.iter().filter_map(name).collect()),
        muted: settings.is_muted,
        solo: settings.is_solo,
        color: settings.color,
        keys,
    }
}

/// Lists of floats, each once.
#[derive(Default)]
struct Numbers {
    texts: Vec<String>,
    found: HashMap<String, usize>,
}

impl Numbers {
    fn index(&mut self, floats: impl Iterator<Item = f32>) -> usize {
        let bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
        let text = STANDARD.encode(bytes);
        let next = self.texts.len();
        let index = *self.found.entry(text.clone()).or_insert(next);
        if index == next {
            self.texts.push(text);
        }
        index
    }
}

/// Returns the record of a channel; `None` where it has no keys.
fn written<K: ChannelKind>(
    take: &Take,
    bone: u32,
    property: Property,
    skeleton: &Skeleton,
    numbers: &mut Numbers,
) -> Option<ChannelRecord> {
    let channel = K::channel(take.tracks.get(bone as usize)?);
    if channel.is_empty() {
        return None;
    }
    let width = width(property);
    let values = channel.values.iter().flat_map(|value| K::numbers(*value).into_iter().take(width));
    Some(ChannelRecord {
        bone: RecordBone::of(skeleton, bone)?,
        path: property,
        interpolation: channel.interpolation.into(),
        times: numbers.index(channel.times.iter().copied()),
        values: numbers.index(values),
    })
}

/// Returns the number of floats of a value.
fn width(property: Property) -> usize {
    if property == Property::Rotation { 4 } else { 3 }
}

/// Returns the take with its layers; `None` where the text is not that of layers of this take.
fn restored(
    slot: &TakeVersions,
    text: &str,
    skeleton: &Skeleton,
    new_id: &mut dyn FnMut() -> TakeId,
) -> Option<TakeVersions> {
    let record: LayersRecord = serde_json::from_str(text).ok()?;
    if record.version != VERSION || record.layers.is_empty() {
        return None;
    }
    let read = Arc::clone(&slot.original);
    let mut base = Take::clone(&read);
    base.extras.set(LAYERS, None);
    let numbers: Vec<SharedNumbers> =
        record.numbers.iter().map(|text| SharedNumbers::of(text)).collect::<Option<_>>()?;
    let bones = RecordBones::of(skeleton);
    let keys = |records: &[ChannelRecord], tracks: &mut [Track]| -> Option<()> {
        for record in records {
            let bone = bones.find(&record.bone)?;
            read_channel(record, &numbers, tracks.get_mut(bone as usize)?)?;
        }
        Some(())
    };
    // A channel that layers move but the take does not has no keys in the take.
    for record in record.layers.iter().flat_map(|layer| &layer.keys) {
        let bone = bones.find(&record.bone)?;
        let track = base.tracks.get_mut(bone as usize)?;
        with_kind!(record.path, clear::<K>(track));
    }
    keys(&record.base, &mut base.tracks)?;
    (base.start, base.length) = super::slot::extent(&base);
    let mut layers = Vec::with_capacity(record.layers.len());
    for layer in &record.layers {
        let mut tracks: Vec<Track> =
            base.tracks.iter().map(|track| Track { bone: track.bone, ..Track::default() }).collect();
        keys(&layer.keys, &mut tracks)?;
        let mut take = Take { tracks, ..Take::default() };
        (take.start, take.length) = super::slot::extent(&take);
        let keys = Arc::new(TakeVersions::unchanged(new_id(), None, Arc::new(take)));
        layers.push(LayerVersions { settings: Arc::new(settings_of(layer, &bones)?), keys });
    }
    if !fits(&base, &layers) {
        return None;
    }
    let mut with_layers = TakeVersions::unchanged(slot.id, slot.origin, Arc::new(base));
    with_layers.set_layers(layers);
    with_layers.flatten(skeleton);
    with_layers.adopt_flat(&read, &|made, read| is_near(made, read)).then_some(with_layers)
}

fn settings_of(record: &LayerRecord, all: &RecordBones<'_>) -> Option<LayerSettings> {
    let bones = record.bones.as_ref().map(|names| {
        let mut bones = names.iter().map(|name| all.find(name)).collect::<Option<Vec<_>>>()?;
        bones.sort_unstable();
        Some(bones.into())
    });
    let weights: Vec<WeightKey> =
        record.weights.iter().map(|&(time, weight)| WeightKey { time, weight }).collect();
    let is_usable = |weight: f32| weight.is_finite() && weight >= 0.0;
    let in_order = weights.windows(2).all(|pair| pair[0].time < pair[1].time);
    let usable = is_usable(record.weight)
        && in_order
        && weights.iter().all(|key| key.time.is_finite() && is_usable(key.weight));
    usable.then_some(LayerSettings {
        name: record.name.clone(),
        mode: record.kind.into(),
        weight: record.weight,
        weights,
        bones: match bones {
            Some(bones) => Some(bones?),
            None => None,
        },
        is_muted: record.muted,
        is_solo: record.solo,
        color: record.color,
    })
}

fn clear<K: ChannelKind>(track: &mut Track) {
    *K::channel_mut(track) = Channel::default();
}

/// A list of floats, in all forms in which channels use it. Channels share each form, so that many references to a long list cost no
/// memory.
struct SharedNumbers {
    times: Arc<[f32]>,
    vectors: Arc<[Vec3]>,
    rotations: Arc<[Quat]>,
}

impl SharedNumbers {
    fn of(text: &str) -> Option<Self> {
        let bytes = STANDARD.decode(text).ok()?;
        let (chunks, rest) = bytes.as_chunks::<4>();
        let times: Arc<[f32]> = chunks.iter().map(|chunk| f32::from_le_bytes(*chunk)).collect();
        let vectors = times.as_chunks::<3>().0.iter().map(|numbers| Vec3::from_array(*numbers)).collect();
        let rotations = times.as_chunks::<4>().0.iter().map(|numbers| Quat::from_array(*numbers)).collect();
        let usable = rest.is_empty() && times.iter().all(|number| number.is_finite());
        usable.then_some(Self { times, vectors, rotations })
    }
}

/// Puts a channel of a record into its track; `None` where the numbers are not those of keys.
fn read_channel(record: &ChannelRecord, numbers: &[SharedNumbers], track: &mut Track) -> Option<()> {
    let (times, values) = (&numbers.get(record.times)?.times, numbers.get(record.values)?);
    let interpolation = Interpolation::from(record.interpolation);
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let fits = values.times.len() == times.len() * width(record.path) * per_key;
    if !fits || times.is_empty() || !times.windows(2).all(|pair| pair[0] < pair[1]) {
        return None;
    }
    let vectors = || Channel { times: Arc::clone(times), values: Arc::clone(&values.vectors), interpolation };
    match record.path {
        Property::Translation => track.translation = vectors(),
        Property::Scale => track.scale = vectors(),
        Property::Rotation => {
            let is_unit = |rotation: &Quat| (rotation.length() - 1.0).abs() < 1e-4;
            let of_keys = values.rotations.iter().skip(per_key / 2).step_by(per_key);
            if !of_keys.into_iter().all(is_unit) {
                return None;
            }
            track.rotation =
                Channel { times: Arc::clone(times), values: Arc::clone(&values.rotations), interpolation };
        }
    }
    Some(())
}

/// Returns whether the take that the layers give stays within the limit of the keys of a document.
fn fits(base: &Take, layers: &[LayerVersions]) -> bool {
    let keys = |take: &Take| take.tracks.iter().map(|track| track.keys() as u64).sum::<u64>();
    let all = keys(base) + layers.iter().map(|layer| keys(&layer.keys.result)).sum::<u64>();
    // Lines between keys may need the same number again.
    all.saturating_mul(2 * 20) <= KEY_BYTES
}

/// Returns whether two takes have the same channels with nearly the same keys.
fn is_near(made: &Take, read: &Take) -> bool {
    // A file must have a key where a take has none.
    made.tracks.len() == read.tracks.len() && made.keys() == 0
        || made.tracks.len() == read.tracks.len()
            && made.tracks.iter().zip(&read.tracks).all(|(made, read)| {
                Property::ALL
                    .into_iter()
                    .all(|property| with_kind!(property, is_channel_near::<K>(made, read)))
            })
}

fn is_channel_near<K: ChannelKind>(made: &Track, read: &Track) -> bool {
    let (made, read) = (K::channel(made), K::channel(read));
    if Arc::ptr_eq(&made.values, &read.values) && Arc::ptr_eq(&made.times, &read.times) {
        return true;
    }
    let near = |a: &K::Value, b: &K::Value| {
        let (a, b) = (K::numbers(*a), K::numbers(*b));
        let apart = |sign: f32| {
            a.iter().zip(b).map(|(a, b)| (a - sign * b).abs() / a.abs().max(1.0)).fold(0.0, f32::max)
        };
        // The quaternions q and -q are the same rotation.
        apart(1.0) < NEAR || (K::IDENTITY[3] == 1.0 && apart(-1.0) < NEAR)
    };
    if let ([time], [other]) = (&made.times[..], &read.times[..]) {
        // A spline of one key is a line of one key in a file.
        let value = |channel: &Channel<K::Value>| channel.values.get(channel.values_per_key() / 2).copied();
        return time == other && value(made).zip(value(read)).is_some_and(|(a, b)| near(&a, &b));
    }
    made.interpolation == read.interpolation
        && made.times == read.times
        && made.values.len() == read.values.len()
        && made.values.iter().zip(read.values.iter()).all(|(a, b)| near(a, b))
}
