//! Sets weights and tangents of several keys of shape keys.

use super::kind::EditKind;
use super::map_references::{MapReferences, map_references};
use super::reference_map::ReferenceMap;
use super::set_shapes::arbitrary_shape;
use super::{Arbitrary, EditedBones, Example, MeshRef, Misfit, ShapeRef, TakeRef, cost};
use crate::adapter::plan::morph_given::{GivenWeight, WeightRules, give_weights};
use crate::adapter::plan::{Transaction, finite, key_at, key_time};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::{Interpolation, Skeleton};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Sets weights and tangents of shape keys at several times, as one step of the history. All shape keys of a mesh share their keys and
/// their interpolation: where a weight gets a new key, the other weights stay as they are there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetShapeKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys.
    pub keys: Vec<ShapeKeyAt>,
}

/// A key of a shape key with new numbers. What is absent stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShapeKeyAt {
    /// Seconds.
    pub time: f32,
    /// The mesh; without it, the first mesh that has the shape key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshRef>,
    /// The shape key.
    pub shape: ShapeRef,
    /// The weight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f32>,
    /// In-tangent of a cubic spline, per second.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub arrive: Option<f32>,
    /// Out-tangent.
    #[serde(default, rename = "out", skip_serializing_if = "Option::is_none")]
    pub leave: Option<f32>,
}

impl MapReferences for ShapeKeyAt {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let Self { time, mesh, shape, weight, arrive, leave } = self;
        let (mesh, shape) = map.shape(mesh.as_ref(), shape)?;
        Ok(Self { mesh, shape, time: *time, weight: *weight, arrive: *arrive, leave: *leave })
    }
}

map_references!(SetShapeKeys { take, keys });

impl EditKind for SetShapeKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_shape_keys","take":"Talk","keys":[{"time":0.5,"shape":"jawOpen","weight":0.8},{"time":1,"shape":"jawOpen","weight":0}]}"#,
        description: "Opens the jaw at 0.5 s and closes it at 1 s.",
    };

    fn label(&self) -> &'static str {
        if self.keys.iter().any(|key| key.weight.is_some()) {
            "Set shape keys"
        } else {
            "Set tangents of shape keys"
        }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::Named(Default::default())
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_shapes(adapter, &self.take) + cost::of_poses(self.keys.len()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let mut meshes: BTreeMap<u32, (WeightRules, Vec<GivenWeight>)> = BTreeMap::new();
        for key in &self.keys {
            let found = work.adapter().shapes().find(key.mesh.as_ref(), &key.shape);
            let (mesh, target) = found.ok_or_else(|| EditError::NoShape(key.shape.clone()))?;
            let instance = mesh.instance();
            let slot = work.slot(take);
            let time = key_time(key.time, slot)?;
            let number = |what, number: Option<f32>| number.map(|number| finite(what, number)).transpose();
            let weight = number("a weight", key.weight)?;
            let (arrive, leave) = (number("a tangent", key.arrive)?, number("a tangent", key.leave)?);
            if arrive.or(leave).is_some() {
                let track = slot.original.morphs.iter().find(|track| track.instance == instance);
                let track = track.filter(|track| weight.is_some() || key_at(&track.times, time).is_ok());
                let track = track.ok_or(EditError::Nothing("these shape keys have no key there"))?;
                if track.interpolation != Interpolation::CubicSpline {
                    return Err(EditError::Nothing("only keys of cubic splines have tangents"));
                }
            }
            if weight.or(arrive).or(leave).is_none() {
                return Err(EditError::Nothing("neither a weight nor a tangent is given"));
            }
            let rules = WeightRules { interpolation: Interpolation::Linear, smooth: false };
            let given = GivenWeight { time, target, weight, arrive, leave };
            meshes.entry(instance).or_insert_with(|| (rules, Vec::new())).1.push(given);
        }
        if meshes.is_empty() {
            return Err(EditError::Nothing("no shape key is given"));
        }
        give_weights(work, take, meshes)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let weight = |from: &mut Arbitrary<'_>| from.between(-0.5, 1.5);
        let key = |from: &mut Arbitrary<'_>| ShapeKeyAt {
            time: from.time(),
            mesh: from.optional(|from| MeshRef::Index(from.choice([0, 2]))),
            shape: arbitrary_shape(from),
            weight: if from.below(4) == 0 { None } else { Some(weight(from)) },
            arrive: if from.below(4) == 0 { Some(weight(from)) } else { None },
            leave: if from.below(4) == 0 { Some(weight(from)) } else { None },
        };
        let keys = (0..from.below(4)).map(|_| key(from)).collect();
        Self { take: from.take(), keys }
    }
}
