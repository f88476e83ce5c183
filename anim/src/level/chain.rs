//! Levels of detail of a whole model.

use super::collapse::{SimplifySettings, simplify};
use super::error::{sample_poses, skinned_error};
use super::progression::Progression;
use crate::data::{Mesh, MeshInstance, ModelData};
use crate::evaluator::Evaluator;
use glam::Vec3;
use std::sync::Arc;

/// One level of detail of a model: other indices for the same vertices.
#[derive(Clone, Debug, PartialEq)]
#[doc(alias = "level of detail")]
pub struct Lod {
    /// Indices that replace those of [`ModelData::meshes`]: one list per mesh, in it one per primitive.
    pub indices: Vec<Vec<Vec<u32>>>,
    /// Number of triangles of all meshes together, each mesh counted once.
    pub triangles: usize,
    /// Error in scene units: the largest of [`skinned_error`]; 0 for the original.
    pub error: f32,
}

/// The levels to make.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSettings {
    /// Shares of the original's triangles, descending, each 0..1.
    pub ratios: Vec<f32>,
    /// As [`SimplifySettings::skin`].
    pub skin: f32,
    /// Number of poses of each take in which the error is measured, in addition to the rest pose.
    pub poses: usize,
}

impl Default for LevelSettings {
    /// Returns a half, a quarter, an eighth; measured in eight poses of each take.
    fn default() -> Self {
        Self { ratios: vec![0.5, 0.25, 0.125], skin: 0.1, poses: 8 }
    }
}

/// Returns the original and its levels, each with its error.
///
/// Each primitive by itself is reduced to the share; because of vertices that have to stay (see the [module](super)) it
/// may keep more triangles. A level that would have no fewer triangles than the one before is left out. A share that is
/// not between 0 and 1 counts as 1. O(n log n) for the collapses, and O(vertices × poses × log n) for the errors.
pub fn levels(model: &ModelData, settings: &LevelSettings) -> Vec<Lod> {
    let original =
        model.meshes.iter().map(|mesh| mesh.primitives.iter().map(|of| of.indices.clone()).collect());
    let mut levels = vec![level(original.collect(), 0.0)];
    let progressions = progressions(model, settings);
    let mut scratch = Vec::new();
    for &ratio in &settings.ratios {
        let ratio = if (0.0..=1.0).contains(&ratio) { f64::from(ratio) } else { 1.0 };
        let mut indices: Vec<Vec<Vec<u32>>> = Vec::with_capacity(model.meshes.len());
        for (mesh, progressions) in model.meshes.iter().zip(&progressions) {
            let of_mesh = mesh.primitives.iter().zip(progressions).map(|(primitive, progression)| {
                let triangles = (primitive.indices.len() as f64 / 3.0 * ratio).ceil() as usize;
                let mut out = Vec::new();
                progression.indices_after(primitive, progression.steps_to(triangles), &mut scratch, &mut out);
                out
            });
            indices.push(of_mesh.collect());
        }
        let mut coarser = level(indices, 0.0);
        if levels.last().is_some_and(|last| coarser.triangles < last.triangles) {
            coarser.error = skinned_error(model, &coarser.indices, settings.poses);
            levels.push(coarser);
        }
    }
    levels
}

fn level(indices: Vec<Vec<Vec<u32>>>, error: f32) -> Lod {
    let triangles = indices.iter().flatten().map(|indices| indices.len() / 3).sum();
    Lod { indices, triangles, error }
}

/// Number of poses for the costs of collapses, in addition to the stored one: more cost time and gain little.
const WEIGHED: usize = 4;

/// Returns the order of collapses of each primitive of each mesh; costs include a few of the measured poses.
fn progressions(model: &ModelData, settings: &LevelSettings) -> Vec<Vec<Progression>> {
    let poses = sample_poses(model, settings.poses);
    let mut evaluator = Evaluator::new(Arc::new(ModelData { images: Vec::new(), ..model.clone() }));
    let mut of_meshes: Vec<Vec<Vec<Vec<Vec3>>>> =
        model.meshes.iter().map(|mesh| vec![Vec::new(); mesh.primitives.len()]).collect();
    for weighed in 0..WEIGHED.min(poses.len()) {
        let (take, time) = poses[weighed * poses.len() / WEIGHED.min(poses.len())];
        evaluator.pose(take, time);
        for (mesh, of_mesh) in of_meshes.iter_mut().enumerate() {
            // Poses of the first instance of the mesh.
            let shows = |instance: &MeshInstance| instance.mesh as usize == mesh;
            let Some(instance) = model.instances.iter().position(shows) else { continue };
            for (index, of_primitive) in of_mesh.iter_mut().enumerate() {
                let mut positions = vec![Vec3::ZERO; model.meshes[mesh].primitives[index].vertices.len()];
                evaluator.positions(instance, index, &mut positions);
                of_primitive.push(positions);
            }
        }
    }
    model.meshes.iter().zip(of_meshes).map(|(mesh, poses)| of_mesh(mesh, &poses, settings)).collect()
}

/// Returns the order of collapses of each primitive; where two primitives meet, the vertices of both stay.
fn of_mesh(mesh: &Mesh, poses: &[Vec<Vec<Vec3>>], settings: &LevelSettings) -> Vec<Progression> {
    let bits = |primitive: usize, vertex: usize| {
        let position = mesh.primitives[primitive].vertices.positions.get(vertex).copied().unwrap_or_default();
        position.to_array().map(|number| (number + 0.0).to_bits())
    };
    let mut owners: Vec<([u32; 3], usize)> = Vec::new();
    if mesh.primitives.len() > 1 {
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            owners.extend(primitive.indices.iter().map(|&vertex| (bits(index, vertex as usize), index)));
        }
        owners.sort_unstable();
        owners.dedup();
    }
    let ratio =
        settings.ratios.iter().copied().filter(|ratio| ratio.is_finite()).fold(1.0, f32::min).max(0.0);
    let primitives = mesh.primitives.iter().enumerate();
    let simplified = primitives.map(|(index, primitive)| {
        let shared = |vertex: usize| {
            let place = bits(index, vertex);
            let first = owners.partition_point(|owner| owner.0 < place);
            owners[first..].iter().take(2).filter(|owner| owner.0 == place).count() > 1
        };
        let triangles = (primitive.indices.len() as f64 / 3.0 * f64::from(ratio)).ceil() as usize;
        let settings = SimplifySettings { triangles, skin: settings.skin };
        simplify(primitive, &poses[index], &shared, &settings)
    });
    simplified.collect()
}
