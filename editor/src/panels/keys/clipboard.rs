//! Keys as text in the clipboard: copied with values and tangents, and inserted at the playhead.
//!
//! They are text, as poses are, so that they reach another take, another model and another program. The content of the
//! clipboard decides what a paste does; the command that copies takes keys or the pose, depending on what was used last, the
//! timeline or the viewport.

use super::channel::{self, BoneNames, ChannelId};
use super::selection::KeySelection;
use dragonfly_anim::data::{BoneIndex, Channel, Interpolation, MorphTrack, Skeleton, Take};
use dragonfly_document::ModelShapes;
use dragonfly_document::adapter::TakeVersions;
use dragonfly_document::edit::{
    BoneRef, CopiedChannel, CopiedKey, CopiedShapeKey, CopiedShapes, KeyInterpolation, MeshRef, Property,
    ShapeRef,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Maximum number of keys that are copied at once.
pub const MOST: usize = 100_000;
/// Maximum length of a text that is parsed, bytes: [`MOST`] keys fit in.
const LONGEST: usize = 64 << 20;

/// Keys that were pasted, and are selected once the document has them.
#[derive(Clone, Debug)]
pub(in crate::panels) struct Pasted {
    /// The document has them in a view newer than this.
    generation: u64,
    /// Number of keys that the take had before the paste.
    before: usize,
    parts: Vec<(ChannelId, Vec<[f32; 2]>)>,
    /// Times of the keys of shape keys.
    shapes: Vec<[f32; 2]>,
    /// Number of keys of shape keys.
    shape_keys: usize,
}

impl Pasted {
    /// Returns the keys that `channels`, whose bones are indices, and shape keys become at `time`. The take had `before` keys in the view with this
    /// generation.
    pub(in crate::panels) fn new(
        generation: u64,
        before: usize,
        (channels, shapes): (&[CopiedChannel], &[CopiedShapes]),
        time: f32,
    ) -> Self {
        let parts = channels.iter().filter_map(|channel| match channel.bone {
            BoneRef::Index(bone) => {
                let times = channel.keys.iter().map(|key| (f64::from(time) + key.after) as f32);
                Some(((bone, channel.property), times.map(|time| [time, time]).collect()))
            }
            BoneRef::Name(_) => None,
        });
        let keys = shapes.iter().flat_map(|mesh| &mesh.keys);
        let times: Vec<[f32; 2]> = keys.map(|key| [(f64::from(time) + key.after) as f32; 2]).collect();
        Self { generation, before, parts: parts.collect(), shape_keys: times.len(), shapes: times }
    }

    /// Returns whether `slot`, of a view with this generation, has the keys. A view that was sent before the paste does
    /// not have them.
    pub(super) fn is_in(&self, slot: &TakeVersions, generation: u64) -> bool {
        let is_key = |bone, property, time| slot.key_at(bone, property, time).is_some();
        let any =
            |times: &[[f32; 2]], bone, property| times.iter().any(|[time, _]| is_key(bone, property, *time));
        let times = |track: &MorphTrack| self.shapes.iter().any(|[time, _]| track.times.contains(time));
        generation != self.generation
            && (self.parts.iter().any(|((bone, property), times)| any(times, *bone, *property))
                || slot.original.morphs.iter().any(times))
    }

    /// Returns the times of the keys of each channel.
    pub(super) fn parts(&self) -> &[(ChannelId, Vec<[f32; 2]>)] {
        &self.parts
    }

    /// Returns the times of the keys of shape keys.
    pub(super) fn shapes(&self) -> &[[f32; 2]] {
        &self.shapes
    }

    /// Returns the number of keys that the take had before.
    pub(super) fn before(&self) -> usize {
        self.before
    }

    /// Returns the number of pasted keys.
    pub(super) fn count(&self) -> usize {
        self.shape_keys + self.parts.iter().map(|(_, times)| times.len()).sum::<usize>()
    }
}

/// The text as JSON.
#[derive(Serialize, Deserialize)]
struct Text {
    /// The kind of text: "keys".
    dragonfly: String,
    version: u32,
    #[serde(default)]
    values: CopiedValues,
    channels: Vec<CopiedChannel>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    shapes: Vec<CopiedShapes>,
}

/// The keys in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct CopiedKeys {
    /// Keys of bones.
    pub channels: Vec<CopiedChannel>,
    /// The meaning of their values.
    pub values: CopiedValues,
    /// Keys of shape keys.
    pub shapes: Vec<CopiedShapes>,
}

/// Meaning of the values of copied keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CopiedValues {
    /// Poses, of a take or an override layer.
    #[default]
    Poses,
    /// Offsets, of an additive layer.
    Offsets,
}

/// Returns the text of keys.
pub fn to_text(keys: CopiedKeys) -> String {
    let CopiedKeys { channels, values, shapes } = keys;
    // Plain data can always be serialized.
    serde_json::to_string(&Text { dragonfly: "keys".to_owned(), version: 1, values, channels, shapes })
        .unwrap_or_default()
}

/// Returns the keys in a text and what their values are; `None` if it is anything else.
pub fn from_text(text: &str) -> Option<CopiedKeys> {
    if text.len() > LONGEST {
        return None;
    }
    let text: Text = serde_json::from_str(text.trim()).ok()?;
    let some = text.channels.iter().any(|channel| !channel.keys.is_empty())
        || text.shapes.iter().any(|mesh| !mesh.keys.is_empty());
    let Text { channels, values, shapes, .. } = text;
    (text.dragonfly == "keys" && text.version == 1 && some).then_some(CopiedKeys { channels, values, shapes })
}

/// Returns the selected keys of a take, with their distances to the first.
pub fn copied(take: &Take, selection: &KeySelection, skeleton: &Skeleton) -> Vec<CopiedChannel> {
    let first = selection.extent(take).map_or(0.0, |[first, _]| first);
    let names = BoneNames::of(skeleton);
    let of = |((bone, property), keys): (ChannelId, &super::intervals::Intervals)| {
        let track = channel::track(take, bone)?;
        let keys = keys.keys(channel::times(take, (bone, property))).flatten();
        let (interpolation, keys) = match property {
            Property::Translation => column(&track.translation, keys, first, |value| value.to_array().into()),
            Property::Rotation => column(&track.rotation, keys, first, |value| value.to_array().into()),
            Property::Scale => column(&track.scale, keys, first, |value| value.to_array().into()),
        };
        let bone = names.reference(bone);
        (!keys.is_empty()).then_some(CopiedChannel { bone, property, interpolation, keys })
    };
    selection.channels().filter_map(of).collect()
}

/// Returns the selected keys of shape keys of a take, with their distances to the first of all selected keys.
pub fn copied_shapes(take: &Take, selection: &KeySelection, shapes: &ModelShapes) -> Vec<CopiedShapes> {
    let first = selection.extent(take).map_or(0.0, |[first, _]| first);
    let of = |track: &MorphTrack| {
        let mesh = shapes.mesh(track.instance)?;
        let same_name = shapes.meshes().iter().filter(|other| other.name() == mesh.name());
        let is_one = same_name.count() == 1;
        let (targets, spline) = (track.targets as usize, track.interpolation == Interpolation::CubicSpline);
        let width = targets * if spline { 3 } else { 1 };
        let row = |key: usize, row: usize| {
            let from = key * width + row * targets;
            track.weights.get(from..from + targets).map(<[f32]>::to_vec)
        };
        let key = |key: usize| {
            let after = f64::from(*track.times.get(key)?) - f64::from(first);
            let (arrive, leave) = if spline { (row(key, 0), row(key, 2)) } else { (None, None) };
            Some(CopiedShapeKey { after, weights: row(key, usize::from(spline))?, arrive, leave })
        };
        let keys: Vec<_> = selection.shapes().keys(&track.times).flatten().filter_map(key).collect();
        let names = (0..targets.min(mesh.shapes().len())).map(|shape| {
            let name = ShapeRef::Name(mesh.shapes()[shape].clone());
            // A name that several shape keys share means the first of them.
            if mesh.find(&name) == Some(shape) { name } else { ShapeRef::Index(shape as u32) }
        });
        (!keys.is_empty()).then(|| CopiedShapes {
            mesh: if is_one { MeshRef::Name(mesh.name().to_owned()) } else { MeshRef::Index(track.instance) },
            shapes: names.collect(),
            interpolation: between(track.interpolation),
            keys,
        })
    };
    take.morphs.iter().filter_map(of).collect()
}

/// Returns the interpolation as edits name it.
fn between(interpolation: Interpolation) -> KeyInterpolation {
    match interpolation {
        // Edits cannot set `Closest`. `Step` has the same values at the keys.
        Interpolation::Step | Interpolation::Closest => KeyInterpolation::Step,
        Interpolation::Linear => KeyInterpolation::Linear,
        Interpolation::CubicSpline => KeyInterpolation::CubicSpline,
    }
}

fn column<T: Copy>(
    channel: &Channel<T>,
    keys: impl Iterator<Item = usize>,
    first: f32,
    numbers: impl Fn(T) -> Vec<f32>,
) -> (KeyInterpolation, Vec<CopiedKey>) {
    let between = between(channel.interpolation);
    let key = |key: usize| {
        let tangent = |part: usize| {
            let value =
                channel.values.get(key * 3 + part).filter(|_| between == KeyInterpolation::CubicSpline);
            value.map(|&value| numbers(value))
        };
        Some(CopiedKey {
            after: f64::from(*channel.times.get(key)?) - f64::from(first),
            value: numbers(channel.value(key)?),
            arrive: tangent(0),
            leave: tangent(2),
        })
    };
    (between, keys.filter_map(key).collect())
}

/// Replaces the bones of `channels` by indices: the bones that the keys are of, or, where the same number of other bones is
/// selected, those in their order. Channels of bones that the skeleton does not have are removed.
pub(in crate::panels) fn retarget(
    channels: &mut Vec<CopiedChannel>,
    selected: &[BoneIndex],
    skeleton: &Skeleton,
) {
    let to = targets(channels, selected, skeleton);
    channels.retain_mut(|channel| match to.get(&name_of(&channel.bone)) {
        Some(&bone) => {
            channel.bone = BoneRef::Index(bone);
            true
        }
        None => false,
    });
}

/// Returns a sort key for a bone.
fn name_of(bone: &BoneRef) -> (u32, String) {
    match bone {
        BoneRef::Index(index) => (*index, String::new()),
        BoneRef::Name(name) => (u32::MAX, name.clone()),
    }
}

/// Returns the bone that gets the keys of each bone.
fn targets(
    channels: &[CopiedChannel],
    selected: &[BoneIndex],
    skeleton: &Skeleton,
) -> BTreeMap<(u32, String), BoneIndex> {
    let mut names: Vec<&BoneRef> = Vec::new();
    let mut own: BTreeMap<(u32, String), Option<BoneIndex>> = BTreeMap::new();
    for channel in channels {
        own.entry(name_of(&channel.bone)).or_insert_with(|| {
            names.push(&channel.bone);
            match &channel.bone {
                BoneRef::Index(bone) => Some(*bone).filter(|&bone| (bone as usize) < skeleton.len()),
                BoneRef::Name(name) => skeleton.find(name),
            }
        });
    }
    let mut selected = selected.to_vec();
    selected.sort_unstable();
    let mut same: Vec<Option<BoneIndex>> = own.values().copied().collect();
    same.sort_unstable();
    if selected.len() == names.len() && !same.iter().copied().eq(selected.iter().copied().map(Some)) {
        return names.into_iter().map(name_of).zip(selected).collect();
    }
    own.into_iter().filter_map(|(name, bone)| Some((name, bone?))).collect()
}
