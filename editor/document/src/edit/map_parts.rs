//! Parts of edits that are rewritten for another version of a model, or refer to nothing in it.

use super::map_references::{MapReferences, refer_to_nothing};
use super::reference_map::ReferenceMap;
use super::take_event::TakeEvent;
use super::{
    BoneRef, CopiedKey, CopiedShapeKey, CopiedShapes, CurveFilter, KeyInterpolation, KeySet, KeyTangents,
    KeyTarget, LayerKind, LayerWeightKey, Misfit, NewKey, OffsetFalloff, OffsetScope, Property, RepeatCount,
    RepeatMode, ResetTo, ShapeRef, ShapeScope, TakeRef, TravelPart, TurnWay,
};
use crate::bones::BodySide;

refer_to_nothing!(
    BodySide,
    CopiedKey,
    CopiedShapeKey,
    CurveFilter,
    KeyInterpolation,
    KeyTangents,
    LayerKind,
    LayerWeightKey,
    NewKey,
    OffsetFalloff,
    Property,
    RepeatCount,
    RepeatMode,
    ResetTo,
    ShapeScope,
    TakeEvent,
    TravelPart,
    TurnWay,
);

impl MapReferences for TakeRef {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        map.take(self)
    }
}

impl MapReferences for BoneRef {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        map.bone(self)
    }
}

impl MapReferences for [BoneRef; 2] {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let [first, second] = self;
        Ok([map.bone(first)?, map.bone(second)?])
    }
}

impl MapReferences for KeySet {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let Self { bones, properties, at, from, to } = self;
        let bones = bones.mapped(map)?;
        map.note_missing_keys(self);
        Ok(Self { bones, properties: properties.clone(), at: at.clone(), from: *from, to: *to })
    }
}

impl MapReferences for KeyTarget {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        Ok(match self {
            Self::Pose(poses) => Self::Pose(poses.mapped(map)?),
            Self::OtherTake { take, later } => Self::OtherTake { take: take.mapped(map)?, later: *later },
            Self::Between(_)
            | Self::AwayFromLine
            | Self::Average
            | Self::Previous
            | Self::Next
            | Self::SlowStart
            | Self::SlowEnd
            | Self::Rest
            | Self::Delayed(_) => self.clone(),
        })
    }
}

impl MapReferences for OffsetScope {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        Ok(match self {
            Self::Keys(keys) => Self::Keys(keys.mapped(map)?),
            Self::Take | Self::Range(_) => self.clone(),
        })
    }
}

impl MapReferences for CopiedShapes {
    /// Leaves out the weights of shape keys that do not fit.
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let Self { mesh, shapes, interpolation, keys } = self;
        let (mut new_mesh, mut new_shapes, mut fitting) = (mesh.clone(), Vec::new(), Vec::new());
        let mut last = None;
        for shape in shapes {
            // Another mesh than the given one is searched for the name, but not for the index.
            let own = Some(mesh).filter(|mesh| map.has_shape(Some(mesh), shape));
            if own.is_none() && matches!(shape, ShapeRef::Index(_)) {
                fitting.push(false);
                continue;
            }
            match map.shape(own, shape) {
                Ok((mesh, shape)) => {
                    new_mesh = mesh.unwrap_or(new_mesh);
                    new_shapes.push(shape);
                    fitting.push(true);
                }
                Err(reason) => {
                    map.lose(reason.clone());
                    fitting.push(false);
                    last = Some(reason);
                }
            }
        }
        if let (Some(reason), true) = (last, new_shapes.is_empty()) {
            return Err(reason);
        }
        let fits = |(weight, fits): (&f32, &bool)| fits.then_some(*weight);
        let kept =
            |weights: &Vec<f32>| -> Vec<f32> { weights.iter().zip(&fitting).filter_map(fits).collect() };
        let key = |key: &CopiedShapeKey| CopiedShapeKey {
            after: key.after,
            weights: kept(&key.weights),
            arrive: key.arrive.as_ref().map(kept),
            leave: key.leave.as_ref().map(kept),
        };
        let keys = keys.iter().map(key).collect();
        Ok(Self { mesh: new_mesh, shapes: new_shapes, interpolation: *interpolation, keys })
    }
}
