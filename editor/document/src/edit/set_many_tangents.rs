//! Sets the tangents of several keys.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, Property, TakeRef, cost};
use crate::adapter::plan::Transaction;
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sets the tangents of several keys of cubic splines at once, as one step of the history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetManyTangents {
    /// The take.
    pub take: TakeRef,
    /// The keys, each with its tangents.
    pub at: Vec<TangentsAt>,
}

/// A key and its tangents, in units per second. An absent tangent stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TangentsAt {
    /// Seconds: the time of the key.
    pub time: f32,
    /// The bone.
    pub bone: BoneRef,
    /// The channel.
    pub property: Property,
    /// In-tangent: three numbers, for rotations four.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub arrive: Option<Vec<f32>>,
    /// Out-tangent.
    #[serde(default, rename = "out", skip_serializing_if = "Option::is_none")]
    pub leave: Option<Vec<f32>>,
}

map_references!(TangentsAt { time, bone, property, arrive, leave });

map_references!(SetManyTangents { take, at });

impl EditKind for SetManyTangents {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_many_tangents","take":"Walk","at":[{"time":0.5,"bone":"Head","property":"translation","in":[0,1,0]},{"time":1,"bone":"Head","property":"translation","out":[0,1,0]}]}"#,
        description: "Sets the in-tangent of one key and the out-tangent of another, in one step.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Set tangents"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::named(self.at.iter().map(|at| &at.bone), skeleton)
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(self.at.len()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        if self.at.is_empty() {
            return Err(EditError::Nothing("no tangent is given"));
        }
        self.at.iter().try_for_each(|at| at.plan(work, &self.take))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let at = (0..from.below(3)).map(|_| {
            let property = from.property();
            let count = if property == Property::Rotation { 4 } else { 3 };
            let arrive = from.optional(|from| from.numbers(count));
            let leave = from.optional(|from| from.numbers(count));
            TangentsAt { time: from.time(), bone: from.bone(), property, arrive, leave }
        });
        let at = at.collect();
        Self { take: from.take(), at }
    }
}
