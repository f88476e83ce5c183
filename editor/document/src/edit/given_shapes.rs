//! Keys of the shape keys of a mesh, in a take that is added.

use super::add_take::{check_numbers, check_times};
use super::map_references::MapReferences;
use super::reference_map::ReferenceMap;
use super::{KeyInterpolation, MeshRef, Misfit, ShapeRef};
use crate::ModelShapes;
use crate::adapter::EditError;
use dragonfly_anim::data::{Interpolation, MorphTrack};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The keys of shape keys of one mesh. The other shape keys of the mesh keep their weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GivenShapes {
    /// The mesh; without it, the first mesh that has the shape keys.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshRef>,
    /// The shape keys, each once.
    pub shapes: Vec<ShapeRef>,
    /// The interpolation between the keys.
    pub interpolation: KeyInterpolation,
    /// Seconds, ascending.
    pub times: Vec<f32>,
    /// The weights, one for each shape key at each time; for splines in-tangents, weights and out-tangents at each time.
    pub weights: Vec<f32>,
}

impl GivenShapes {
    /// Returns the keys of a track.
    pub fn of(track: &MorphTrack) -> Self {
        Self {
            mesh: Some(MeshRef::Index(track.instance)),
            shapes: (0..track.targets).map(ShapeRef::Index).collect(),
            interpolation: KeyInterpolation::of(track.interpolation),
            times: track.times.to_vec(),
            weights: track.weights.to_vec(),
        }
    }

    /// Returns the track of the mesh.
    pub(super) fn track(&self, shapes: &ModelShapes) -> Result<MorphTrack, EditError> {
        let interpolation = Interpolation::from(self.interpolation);
        let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        check_times(&self.times)?;
        check_numbers("the weights", &self.weights, self.times.len() * parts * self.shapes.len())?;
        let mut mesh = None;
        let mut places = Vec::with_capacity(self.shapes.len());
        for shape in &self.shapes {
            let (found, place) =
                shapes.find(self.mesh.as_ref(), shape).ok_or_else(|| EditError::NoShape(shape.clone()))?;
            if mesh.get_or_insert(found).instance() != found.instance() {
                return Err(EditError::NoShape(shape.clone()));
            }
            places.push(place);
        }
        let mesh = mesh.ok_or(EditError::LastKey)?;
        let mut weights = Vec::with_capacity(self.times.len() * parts * mesh.rest().len());
        for (row, given) in self.weights.chunks_exact(places.len()).enumerate() {
            let is_weight = parts == 1 || row % 3 == 1;
            let start = weights.len();
            weights.extend(mesh.rest().iter().map(|&rest| if is_weight { rest } else { 0.0 }));
            places.iter().zip(given).for_each(|(&place, &weight)| weights[start + place] = weight);
        }
        Ok(MorphTrack {
            instance: mesh.instance(),
            targets: mesh.rest().len() as u32,
            times: self.times.clone().into(),
            weights: weights.into(),
            interpolation,
        })
    }
}

impl MapReferences for GivenShapes {
    /// Leaves out shape keys that the new version lacks, with their weights.
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let Self { mesh, shapes, interpolation, times, weights } = self;
        let mut kept = Vec::with_capacity(shapes.len());
        let (mut new_mesh, mut last) = (mesh.clone(), None);
        for (column, shape) in shapes.iter().enumerate() {
            match map.shape(mesh.as_ref(), shape) {
                Ok((mesh, shape)) => {
                    new_mesh = mesh;
                    kept.push((column, shape));
                }
                Err(reason) => last = Some(reason),
            }
        }
        if let Some(reason) = last {
            if kept.is_empty() {
                return Err(reason);
            }
            map.lose(reason);
        }
        let rows = weights.chunks_exact(shapes.len().max(1));
        let weights = rows.flat_map(|row| kept.iter().map(|(column, _)| row[*column])).collect();
        let shapes = kept.into_iter().map(|(_, shape)| shape).collect();
        Ok(Self { mesh: new_mesh, shapes, interpolation: *interpolation, times: times.clone(), weights })
    }
}
