//! Merges a layer with the one below it, or all layers into their take.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, Property, TakeRef};
use crate::adapter::kind::{ChannelKind, with_kind};
use crate::adapter::plan::{Transaction, finite, layer, rewrite};
use crate::adapter::{EditError, LayerVersions, TakeId};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::layers::{
    AddedKeys, LayerChannel, LayerMode, LayerRule, LayerSettings, flatten_channel_with, flatten_with, played,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Largest number of frames per second on which keys are added.
const MOST_RATE: f32 = 1000.0;

/// Merges a layer into the one below it; the same is shown then at each frame. Keys are where take and layers have some, and on whole frames. Where the edit names a take, all its layers become keys of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MergeLayers {
    /// The layer to merge with the one below it, the lowest one with the take; or the take, to merge all.
    pub take: TakeRef,
    /// Frames per second on which keys are added that are needed between those of take and layers, at most 1000; if absent, they are
    /// added halfway between others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f32>,
}

map_references!(MergeLayers { take, rate });

impl EditKind for MergeLayers {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"merge_layers","take":"Walk"}"#,
        description: "Makes the take what is seen of it with its layers, which are gone then.",
    };
    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        if matches!(self.take, TakeRef::Layer { .. }) { "Merge layer down" } else { "Merge all layers" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        if !matches!(self.take, TakeRef::Layer { .. }) {
            let take = work.take(&self.take)?;
            let count = work.slot(take).layers().len();
            return if count > 0 {
                into_take(work, take, count, self.rate)
            } else {
                Err(EditError::Nothing("the take has no layers"))
            };
        }
        let (base, index) = layer::place(work, &self.take)?;
        let layers = work.slot(base).layers();
        if !played(layers.iter().map(|layer| &*layer.settings))[index] {
            return Err(EditError::Nothing("a layer that does nothing cannot be merged"));
        }
        if index == 0 {
            return into_take(work, base, 1, self.rate);
        }
        let (lower, upper) = (&layers[index - 1], &layers[index]);
        let (settings, take) = merged(work.skeleton(), lower, upper, added_keys(self.rate)?)?;
        let mut merged = layer::empty(work, base, settings);
        Arc::make_mut(&mut merged.keys).set_keys(take);
        layer::replace(work, base, |layers| {
            layers.splice(index - 1..=index, [merged]);
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let take = if from.flag() { from.layer() } else { from.take() };
        Self { take, rate: from.optional(|from| from.between(5.0, 60.0)) }
    }
}

/// Makes the lowest `count` layers keys of their take.
fn into_take(work: &mut Transaction, take: TakeId, count: usize, rate: Option<f32>) -> Result<(), EditError> {
    let slot = work.slot(take);
    let added = added_keys(rate)?;
    let layers: Vec<_> = slot.layers()[..count].iter().map(LayerVersions::flat).collect();
    let flat = flatten_with(&slot.result, &layers, work.skeleton(), added);
    layer::replace(work, take, |layers| {
        layers.drain(..count);
    })?;
    rewrite::channels(work, take, &flat)?;
    Ok(())
}

/// Returns where keys are added.
fn added_keys(rate: Option<f32>) -> Result<AddedKeys, EditError> {
    let Some(rate) = rate else { return Ok(AddedKeys::Halfway) };
    let rate = finite("the frame rate", rate)?;
    // More than this would be more than one key at a time of single precision.
    match rate > 0.0 && rate <= MOST_RATE {
        true => Ok(AddedKeys::OnFrames(rate)),
        false => Err(EditError::Number { what: "the frame rate", value: rate }),
    }
}

/// Returns the settings and the keys of one layer that does what two do.
fn merged(
    skeleton: &Skeleton,
    lower: &LayerVersions,
    upper: &LayerVersions,
    added: AddedKeys,
) -> Result<(LayerSettings, Take), EditError> {
    let (low, high) = (&lower.settings, &upper.settings);
    if low.is_muted || high.is_muted || low.is_solo != high.is_solo {
        return Err(EditError::Nothing("a muted layer, or a solo one with another, cannot be merged"));
    }
    let is_whole = |settings: &LayerSettings| settings.weights.is_empty() && settings.weight == 1.0;
    match (low.mode, high.mode) {
        (LayerMode::Additive, LayerMode::Additive) => {}
        (LayerMode::Override, LayerMode::Override) if is_whole(low) && is_whole(high) => {}
        (LayerMode::Override, LayerMode::Override) => {
            return Err(EditError::Nothing("layers of poses can be merged where their weights are 1"));
        }
        _ => {
            return Err(EditError::Nothing(
                "layers of offsets and of poses can only be merged into the take",
            ));
        }
    }
    let mut take = Take { tracks: lower.keys.result.tracks.clone(), ..Take::default() };
    for bone in 0..take.tracks.len().min(skeleton.len()) as u32 {
        for property in Property::ALL {
            with_kind!(
                property,
                merged_channel::<K>(&mut take.tracks[bone as usize], bone, (lower, upper), added)
            );
        }
    }
    let settings =
        LayerSettings { weight: 1.0, weights: Vec::new(), bones: None, ..LayerSettings::clone(low) };
    Ok((settings, take))
}

fn merged_channel<K: ChannelKind>(
    track: &mut Track,
    bone: u32,
    (lower, upper): (&LayerVersions, &LayerVersions),
    added: AddedKeys,
) {
    let none = Channel::default();
    let keys = |layer: &'_ LayerVersions| -> Channel<K::Value> {
        let track = layer.keys.result.tracks.get(bone as usize).filter(|_| layer.settings.moves(bone));
        track.map_or(none.clone(), |track| K::channel(track).clone())
    };
    let (low, high) = (keys(lower), keys(upper));
    let merged = match lower.settings.mode {
        LayerMode::Override if high.is_empty() => low,
        LayerMode::Override => high,
        LayerMode::Additive => {
            let layers = [
                LayerChannel { settings: &lower.settings, keys: &low },
                LayerChannel { settings: &upper.settings, keys: &high },
            ];
            let start: Arc<[f32]> = Arc::from([0.0]);
            let identity = Channel::new(start, [<K::Rule as LayerRule>::IDENTITY], Interpolation::Linear);
            // A channel without keys would add a key at 0 s where all layers begin later.
            let base = if low.len().max(high.len()) > 1 { &none } else { &identity };
            let identity = <K::Rule as LayerRule>::IDENTITY;
            flatten_channel_with::<K::Rule>(base, &layers, identity, added).unwrap_or(none.clone())
        }
    };
    *K::channel_mut(track) = merged;
}
