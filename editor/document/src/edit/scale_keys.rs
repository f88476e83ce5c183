//! Scales the times of keys.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{KeyMove, Transaction, finite, timing::move_keys};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scales the times of keys about a time; tangents keep their shape. A negative factor reverses their order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScaleKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of shape keys are scaled.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
    /// Seconds: the time that stays where it is.
    pub about: f32,
    /// Factor, not zero.
    pub factor: f32,
}

map_references!(ScaleKeys { take, shapes, about, factor }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for ScaleKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"scale_keys","take":"Walk","keys":[{"from":0,"to":1}],"about":0,"factor":2}"#,
        description: "Slows the first second down to half speed.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Scale keys"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::of_keys(&self.keys, skeleton)
    }

    fn keys(&self) -> &[KeySet] {
        &self.keys
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (about, factor) = (finite("the time", self.about)?, finite("the factor", self.factor)?);
        if factor == 0.0 {
            return Err(EditError::Number { what: "the factor", value: factor });
        }
        let scaled = KeyMove { copy: false, stretch: factor };
        move_keys(work, &self.take, (&self.keys, &self.shapes), scaled, |time| {
            about + (time - about) * factor
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let factor = from.choice([0.5, 2.0, -1.0, 0.01]);
        Self { take: from.take(), keys: from.keys(), shapes: from.shapes(), about: from.time(), factor }
    }
}
