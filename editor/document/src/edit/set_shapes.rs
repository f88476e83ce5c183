//! Sets weights of shape keys at a time.

use super::kind::EditKind;
use super::map_references::{MapReferences, map_references};
use super::reference_map::ReferenceMap;
use super::{Arbitrary, EditedBones, Example, MeshRef, Misfit, ShapeRef, TakeRef, cost};
use crate::adapter::plan::morph_keys::MeshWeight;
use crate::adapter::plan::{Transaction, finite, key_time, morph_keys, pending};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sets weights of shape keys (morph targets) at a time. Where their mesh has no key there, one is added that keeps the other weights. A
/// mesh that the take does not animate then has its new weights in the whole take.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetShapes {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The shape keys with their new weights. Of one that occurs twice, the last weight counts.
    pub shapes: Vec<ShapeWeight>,
}

/// A shape key of a mesh, and a weight for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShapeWeight {
    /// The mesh; without it, the first mesh that has the shape key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshRef>,
    /// The shape key.
    pub shape: ShapeRef,
    /// The weight, usually 0 to 1.
    pub weight: f32,
}

impl MapReferences for ShapeWeight {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let Self { mesh, shape, weight } = self;
        let (mesh, shape) = map.shape(mesh.as_ref(), shape)?;
        Ok(Self { mesh, shape, weight: *weight })
    }
}

map_references!(SetShapes { take, time, shapes });

impl EditKind for SetShapes {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_shapes","take":"Talk","time":0.5,"shapes":[{"mesh":"Face","shape":"jawOpen","weight":0.8}]}"#,
        description: "Opens the jaw of the face by 80 % at 0.5 s.",
    };

    fn label(&self) -> &'static str {
        "Set shape keys"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        // Weights belong to meshes, so no lock of a bone concerns them.
        EditedBones::Named(Default::default())
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_shapes(adapter, &self.take))
    }

    fn detail(&self, _adapter: &ModelAdapter) -> Option<String> {
        names(&self.shapes)
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let time = key_time(self.time, work.slot(take))?;
        let weights = found(work, &self.shapes)?;
        morph_keys::set_weights(work, take, time, weights.iter().copied())?;
        let shapes = weights.iter().map(|&(instance, (shape, _))| (instance, shape as u32));
        pending::shapes_overwritten(work, take, time, shapes);
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), time: from.time(), shapes: arbitrary_weights(from) }
    }
}

/// Returns the meshes and shape keys of weights, whose numbers were checked.
///
/// # Errors
///
/// A shape key does not exist, a weight is no usable number, or none is given.
pub(super) fn found(work: &Transaction, shapes: &[ShapeWeight]) -> Result<Vec<MeshWeight>, EditError> {
    if shapes.is_empty() {
        return Err(EditError::Nothing("no shape key is given"));
    }
    let found = shapes.iter().map(|wanted| {
        let found = work.adapter().shapes().find(wanted.mesh.as_ref(), &wanted.shape);
        let (mesh, shape) = found.ok_or_else(|| EditError::NoShape(wanted.shape.clone()))?;
        Ok((mesh.instance(), (shape, finite("a weight", wanted.weight)?)))
    });
    found.collect()
}

/// Returns the names of shape keys for the list of the history.
pub(super) fn names(shapes: &[ShapeWeight]) -> Option<String> {
    match shapes {
        [ShapeWeight { shape: ShapeRef::Name(name), .. }] => Some(name.clone()),
        [] | [_] => None,
        shapes => Some(format!("{} shape keys", shapes.len())),
    }
}

/// Returns random weights.
pub(super) fn arbitrary_weights(from: &mut Arbitrary<'_>) -> Vec<ShapeWeight> {
    let shapes = (0..from.choice([1, 1, 2])).map(|_| ShapeWeight {
        mesh: from.optional(|from| MeshRef::Index(from.choice([0, 1, 3]))),
        shape: arbitrary_shape(from),
        weight: from.between(-0.5, 1.5),
    });
    shapes.collect()
}

/// Returns a random shape key.
pub(super) fn arbitrary_shape(from: &mut Arbitrary<'_>) -> ShapeRef {
    if from.flag() {
        ShapeRef::Index(from.choice([0, 1, 2]))
    } else {
        ShapeRef::Name(from.choice(["smile", "blink_L"]).to_owned())
    }
}
