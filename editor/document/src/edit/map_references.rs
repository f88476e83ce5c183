//! Rewrites an edit of one version of a model for another version: every kind of edit, and every part of one, lists what it refers
//! to.

use super::reference_map::ReferenceMap;
use super::take_event::TakeEvent;
use super::{
    BoneRef, CopiedKey, CopiedShapeKey, CopiedShapes, CurveFilter, KeyInterpolation, KeySet, KeyTangents,
    KeyTarget, LayerKind, LayerWeightKey, Misfit, NewKey, OffsetFalloff, OffsetScope, Property, RepeatCount,
    RepeatMode, ResetTo, ShapeRef, ShapeScope, TakeRef, TravelPart, TurnWay,
};
use crate::bones::BodySide;

/// An edit, or a part of one, that can be rewritten for another version of the model.
///
/// Kinds of edits and their parts implement it with [`map_references!`], which names all fields: a field that is added to one of them
/// later does not compile until it is named there. A place in a list, such as the index of a new take, has no implementation and is
/// mapped by the edit itself.
pub(crate) trait MapReferences: Sized {
    /// Returns the same for the new version of the model. Parts that do not fit it are left out and noted in `map`.
    ///
    /// # Errors
    ///
    /// The reason why nothing of it fits.
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit>;
}

/// Implements [`MapReferences`] for a struct: the named fields are mapped by their own implementations, those in parentheses by the
/// expressions given. Together they must be all fields.
macro_rules! map_references {
    ($Type:ident { $($field:ident),* $(,)? }) => {
        map_references!($Type { $($field),* }, |_edit, _map| {});
    };
    ($Type:ident { $($field:ident),* $(,)? }, |$edit:ident, $map:ident| { $($own:ident: $value:expr),* $(,)? }) => {
        impl $crate::edit::map_references::MapReferences for $Type {
            fn mapped(
                &self,
                $map: &mut $crate::edit::reference_map::ReferenceMap<'_>,
            ) -> Result<Self, $crate::edit::Misfit> {
                let $edit = self;
                Ok(Self {
                    $($field: $crate::edit::map_references::MapReferences::mapped(&$edit.$field, $map)?,)*
                    $($own: $value,)*
                })
            }
        }
    };
}
pub(crate) use map_references;

/// Implements [`MapReferences`] for types that refer to nothing in a model.
macro_rules! refer_to_nothing {
    ($($Type:ty),* $(,)?) => {
        $(impl MapReferences for $Type {
            fn mapped(&self, _map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
                Ok(self.clone())
            }
        })*
    };
}

refer_to_nothing!(
    bool,
    f32,
    i32,
    u32,
    String,
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
    [f32; 2],
    [f32; 3],
    [f32; 4],
    [u8; 3],
    serde_json::Value,
);

impl<T: MapReferences> MapReferences for Option<T> {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        self.as_ref().map(|value| value.mapped(map)).transpose()
    }
}

impl<T: MapReferences> MapReferences for Vec<T> {
    /// Leaves out elements that do not fit. A list of which none fits is an error, because an empty one often means everything.
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let mut last = None;
        let mut mapped = Vec::with_capacity(self.len());
        for element in self {
            match element.mapped(map) {
                Ok(element) => mapped.push(element),
                Err(reason) => {
                    map.lose(reason.clone());
                    last = Some(reason);
                }
            }
        }
        match last {
            Some(reason) if mapped.is_empty() => Err(reason),
            _ => Ok(mapped),
        }
    }
}

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
