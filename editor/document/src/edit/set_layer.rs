//! Changes the settings of a layer.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, LayerKind, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, layer};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::layers::LayerMode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Changes settings of a layer; those that are not given stay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetLayer {
    /// The layer.
    pub take: TakeRef,
    /// Its name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// How it changes the values below. A layer with keys keeps its kind, because they mean something else in the other one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<LayerKind>,
    /// Its weight while the weight has no keys, 0 to 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f32>,
    /// Whether it does nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub muted: Option<bool>,
    /// Whether only it, and other solo layers, do something.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solo: Option<bool>,
    /// Red, green and blue of its color in lists.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<[u8; 3]>,
    /// The bones that it may move; an empty list means all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bones: Option<Vec<BoneRef>>,
}

map_references!(SetLayer { take, name, kind, weight, muted, solo, color, bones });

impl EditKind for SetLayer {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_layer","take":{"take":"Walk","layer":0},"weight":0.5,"muted":false}"#,
        description: "Halves the effect of the lowest layer of the take.",
    };
    const LAYERS: LayerUse = LayerUse::LayerOnly;

    fn label(&self) -> &'static str {
        match (self.muted, self.solo, self.weight, &self.name, &self.bones) {
            (Some(true), ..) => "Mute layer",
            (Some(false), ..) => "Unmute layer",
            (None, Some(_), ..) => "Solo layer",
            (None, None, Some(_), ..) => "Layer weight",
            (None, None, None, Some(_), _) => "Rename layer",
            (None, None, None, None, Some(_)) => "Layer mask",
            (None, None, None, None, None) => "Layer settings",
        }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (base, index) = layer::place(work, &self.take)?;
        let name = self.name.as_deref().map(layer::name).transpose()?;
        let weight = self.weight.map(layer::weight).transpose()?;
        let bones = self.bones.as_deref().map(|bones| layer::mask(work, bones)).transpose()?;
        let own = &work.slot(base).layers()[index];
        let mode = self.kind.map(LayerMode::from);
        if mode.is_some_and(|mode| mode != own.settings.mode) && own.keys.original.keys() > 0 {
            return Err(EditError::Nothing("a layer with keys keeps its kind"));
        }
        layer::set(work, base, index, |settings| {
            settings.name = name.unwrap_or(std::mem::take(&mut settings.name));
            settings.mode = mode.unwrap_or(settings.mode);
            settings.weight = weight.unwrap_or(settings.weight);
            settings.is_muted = self.muted.unwrap_or(settings.is_muted);
            settings.is_solo = self.solo.unwrap_or(settings.is_solo);
            settings.color = self.color.unwrap_or(settings.color);
            settings.bones = bones.unwrap_or(settings.bones.take());
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self {
            take: from.layer(),
            name: from.optional(Arbitrary::name),
            kind: from.optional(|from| from.choice([LayerKind::Additive, LayerKind::Override])),
            weight: from.optional(|from| from.between(-0.5, 2.0)),
            muted: from.optional(Arbitrary::flag),
            solo: from.optional(Arbitrary::flag),
            color: from.flag().then_some([1, 2, 3]),
            bones: from.optional(Arbitrary::bones),
        }
    }
}
