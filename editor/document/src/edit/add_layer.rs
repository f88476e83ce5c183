//! Adds a layer to a take, or a copy of one.

use super::add_take::{GivenChannel, given_tracks};
use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, LayerKind, LayerRef, TakeRef};
use crate::adapter::plan::{Transaction, layer};
use crate::adapter::{EditError, LayerVersions, TakeId};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::layers::LayerSettings;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Colors of new layers, one after the other: red, green, blue.
pub const LAYER_COLORS: [[u8; 3]; 6] =
    [[90, 160, 220], [230, 160, 70], [120, 190, 110], [200, 110, 180], [220, 110, 100], [110, 190, 190]];

/// Adds a layer over a take. Its keys change what is seen; those of the take stay as they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddLayer {
    /// The take.
    pub take: TakeRef,
    /// Name of the layer.
    pub name: String,
    /// How the layer changes the values below; a copy has that of its source.
    #[serde(default)]
    pub kind: LayerKind,
    /// The bones that it may move; all where empty. A copy has those of its source.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// Index of the new layer, from 0 for the lowest; without it, the layer is the highest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<usize>,
    /// A layer of this take of which the new one is a copy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copy: Option<LayerRef>,
    /// A take whose keys the layer of poses gets, as they are seen with its layers; bones without keys in it stay as they are below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keys_of: Option<TakeRef>,
    /// Keys that the layer of poses gets, for example those of a take that was retargeted from another model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tracks: Vec<GivenChannel>,
}

map_references!(AddLayer { take, name, kind, bones, keys_of, tracks }, |edit, map| {
    at: edit.at.map(|at| map.layer_place(&edit.take, at, None)),
    copy: edit.copy.as_ref().map(|layer| map.layer(layer)).transpose()?,
});

impl EditKind for AddLayer {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"add_layer","take":"Walk","name":"Arm up","kind":"additive","bones":["Arm"]}"#,
        description: "Adds a layer; its keys are edited with {\"take\": \"Walk\", \"layer\": \"Arm up\"} as the take.",
    };
    const LAYERS: LayerUse = LayerUse::TakeOnly;

    fn label(&self) -> &'static str {
        let has_keys = self.keys_of.is_some() || !self.tracks.is_empty();
        match &self.copy {
            Some(_) => "Duplicate layer",
            None if has_keys => "Add layer from take",
            None => "Add layer",
        }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let name = layer::name(&self.name)?;
        let new = match &self.copy {
            Some(_) if self.keys_of.is_some() || !self.tracks.is_empty() => {
                return Err(EditError::Nothing("a copy of a layer has the keys of its source"));
            }
            Some(source) => {
                let layers = work.slot(take).layers();
                let found = source.find_in(layers).ok_or(EditError::Nothing("there is no such layer"))?;
                let LayerVersions { settings, keys } = layers[found].clone();
                let settings = LayerSettings { name, ..LayerSettings::clone(&settings) };
                LayerVersions { settings: Arc::new(settings), keys: Arc::new(work.copy_of(keys.id)) }
            }
            None => {
                let bones = layer::mask(work, &self.bones)?;
                let color = LAYER_COLORS[work.slot(take).layers().len() % LAYER_COLORS.len()];
                let settings =
                    LayerSettings { name, mode: self.kind.into(), bones, color, ..LayerSettings::default() };
                let mut new = layer::empty(work, take, settings);
                if let Some(keys) = self.keys(work, take)? {
                    Arc::make_mut(&mut new.keys).set_keys(keys);
                }
                new
            }
        };
        layer::replace(work, take, |layers| {
            layers.insert(self.at.unwrap_or(layers.len()).min(layers.len()), new)
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let copy = from.flag().then(|| LayerRef::Index(from.below(2)));
        let kind = from.choice([LayerKind::Additive, LayerKind::Override]);
        Self {
            take: from.take(),
            name: from.name(),
            kind,
            bones: from.bones(),
            at: from.optional(|from| from.below(3)),
            copy,
            keys_of: from.optional(Arbitrary::take),
            tracks: GivenChannel::arbitrary(from),
        }
    }
}

impl AddLayer {
    /// Returns the edit that adds the highest layer, for all bones and without keys.
    pub fn new(take: TakeRef, name: String, kind: LayerKind) -> Self {
        Self { take, name, kind, bones: Vec::new(), at: None, copy: None, keys_of: None, tracks: Vec::new() }
    }

    /// Returns the keys that the new layer gets; `None` where it gets none.
    fn keys(&self, work: &mut Transaction, take: TakeId) -> Result<Option<Take>, EditError> {
        let refused = |reason| Err(EditError::Nothing(reason));
        let tracks = match (&self.keys_of, self.tracks.is_empty()) {
            (None, true) => return Ok(None),
            (Some(_), false) => return refused("a layer has the keys of a take or given ones, not both"),
            (None, false) => given_tracks(work, &self.tracks)?,
            (Some(other), true) => {
                let other = work.take(other)?;
                if other == take {
                    return refused("a layer cannot have the keys of its own take");
                }
                work.slot(other).shown().tracks.clone()
            }
        };
        if self.kind != LayerKind::Override {
            return refused("only a layer of poses can have the keys of a take");
        }
        let keys = Take { tracks, ..Take::default() };
        work.room_for_take(keys.keys())?;
        Ok(Some(keys))
    }
}
