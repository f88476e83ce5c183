//! The error of a level of detail, measured in poses.

use crate::data::ModelData;
use crate::evaluator::Evaluator;
use crate::hit::{HitPose, HitTree};
use glam::Vec3;
use std::sync::Arc;

/// Returns the largest distance, in scene units, from a removed vertex to the surface of the level, both skinned in the
/// same pose.
///
/// ```text
/// error = max over poses, instances and vertices v of the original that the level does not use:
///             min over points q of the level's surface of that instance:  |skinned(v) - q|
/// ```
///
/// The one-sided Hausdorff distance from the original to the level, measured at the vertices. The poses are the rest
/// pose and `poses` of each take, from its start to its end at even distances. `indices` are those of a [`super::Lod`]
/// of `model`; zero where no vertex was removed. Infinite where nothing is left of an instance, or the model is larger
/// than a [`HitTree`] can be.
pub fn skinned_error(model: &ModelData, indices: &[Vec<Vec<u32>>], poses: usize) -> f32 {
    let removed = removed(model, indices);
    if removed.iter().flatten().all(Vec::is_empty) {
        return 0.0;
    }
    let coarse = Arc::new(with_indices(model, indices));
    let Ok(tree) = HitTree::of(&coarse) else { return f32::INFINITY };
    let mut hit_pose = HitPose::new(Arc::new(tree));
    let mut evaluator = Evaluator::new(coarse);
    let (mut largest, mut positions) = (0.0_f64, Vec::new());
    for (take, time) in sample_poses(model, poses) {
        evaluator.pose(take, time);
        hit_pose.refit(&evaluator);
        for (instance, of) in model.instances.iter().enumerate() {
            let of_mesh = removed.get(of.mesh as usize).map_or(&[][..], Vec::as_slice);
            for (primitive, vertices) in of_mesh.iter().enumerate().filter(|(_, list)| !list.is_empty()) {
                let count = evaluator.primitives(instance)[primitive].vertices.len();
                positions.resize(count, Vec3::ZERO);
                evaluator.positions(instance, primitive, &mut positions[..count]);
                for &vertex in vertices {
                    let position = positions[vertex as usize];
                    let distance = hit_pose.distance_to_instance(&evaluator, position, instance as u32);
                    largest = largest.max(distance.unwrap_or(f64::INFINITY));
                }
            }
        }
    }
    largest as f32
}

/// Returns the rest pose, and `poses` of each take.
pub(super) fn sample_poses(model: &ModelData, poses: usize) -> Vec<(Option<usize>, f32)> {
    let mut samples = vec![(None, 0.0)];
    for (index, take) in model.animation.takes.iter().enumerate() {
        let last = poses.saturating_sub(1).max(1) as f32;
        samples.extend((0..poses).map(|pose| (Some(index), take.start + take.length * (pose as f32 / last))));
    }
    samples
}

/// Returns, for each mesh and primitive, the vertices that the original uses and the level does not.
fn removed(model: &ModelData, indices: &[Vec<Vec<u32>>]) -> Vec<Vec<Vec<u32>>> {
    let of_primitive = |mesh: usize, index: usize| {
        let primitive = &model.meshes[mesh].primitives[index];
        let mut used = vec![0_u8; primitive.vertices.len()];
        let mut mark = |indices: &[u32], bit: u8| {
            for &vertex in indices {
                if let Some(used) = used.get_mut(vertex as usize) {
                    *used |= bit;
                }
            }
        };
        mark(&primitive.indices, 1);
        mark(indices.get(mesh).and_then(|of_mesh| of_mesh.get(index)).map_or(&[], Vec::as_slice), 2);
        (0..used.len() as u32).filter(|&vertex| used[vertex as usize] == 1).collect()
    };
    let meshes = model.meshes.iter().enumerate();
    meshes
        .map(|(mesh, of)| (0..of.primitives.len()).map(|index| of_primitive(mesh, index)).collect())
        .collect()
}

/// Returns a copy of `model` with other indices, without images.
fn with_indices(model: &ModelData, indices: &[Vec<Vec<u32>>]) -> ModelData {
    let mut coarse = ModelData { images: Vec::new(), ..model.clone() };
    for (mesh, indices) in coarse.meshes.iter_mut().zip(indices) {
        for (primitive, indices) in mesh.primitives.iter_mut().zip(indices) {
            primitive.indices.clone_from(indices);
        }
    }
    coarse
}
