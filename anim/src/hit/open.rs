//! Queries that test every triangle: the naive method, and the reference for the tree (thesis §2.1.7.2).

use super::candidate::{RaySearch, SphereSearch, TriangleAddress, complete};
use super::triangle::UnitRay;
use super::{Hit, HitSettings, Ray};
use crate::data::Primitive;
use crate::evaluator::Evaluator;
use crate::skin::Movement;
use glam::Vec3;

/// Returns the nearest hit of `ray` on the model of `evaluator`; of two equally near hits, the one whose triangle comes
/// first in the file.
///
/// `positions` are those of [`Evaluator::all_positions`] in the same pose, so that many rays share them; triangles
/// whose corners are missing in it are left out. O(triangles). `None` when nothing is hit.
pub fn ray_open(evaluator: &Evaluator, positions: &[Vec3], ray: &Ray, settings: &HitSettings) -> Option<Hit> {
    let mut search = RaySearch { line: UnitRay::of(ray)?, settings: *settings, best: None };
    for_each_triangle(evaluator, positions, |primitive, movement, address, corners| {
        search.test(primitive, movement, address, corners);
    });
    search.best.map(|best| complete(evaluator, &best))
}

/// Returns the point of the model of `evaluator` nearest to `center`, at most `radius` scene units away; of two equally
/// near points, the one whose triangle comes first in the file.
///
/// `positions` as for [`ray_open`]. O(triangles). `None` when nothing is within the radius.
pub fn sphere_open(evaluator: &Evaluator, positions: &[Vec3], center: Vec3, radius: f32) -> Option<Hit> {
    let mut search = SphereSearch::of(center, radius)?;
    for_each_triangle(evaluator, positions, |primitive, movement, address, corners| {
        search.test(primitive, movement, address, corners);
    });
    search.best.map(|best| complete(evaluator, &best))
}

/// Calls `visit` with every triangle whose corners exist.
fn for_each_triangle(
    evaluator: &Evaluator,
    positions: &[Vec3],
    mut visit: impl FnMut(&Primitive, Movement<'_>, TriangleAddress, [Vec3; 3]),
) {
    let mut rest = positions;
    for instance in 0..evaluator.model().instances.len() {
        for (index, primitive) in evaluator.primitives(instance).iter().enumerate() {
            let (own, others) = rest.split_at(primitive.vertices.len().min(rest.len()));
            rest = others;
            let Some(movement) = evaluator.movement(instance, index) else { continue };
            for (triangle, corners) in primitive.indices.chunks_exact(3).enumerate() {
                let corner = |at: usize| own.get(corners[at] as usize).copied();
                let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else { continue };
                let address = TriangleAddress {
                    instance: instance as u32,
                    primitive: index as u32,
                    triangle: triangle as u32,
                };
                visit(primitive, movement, address, [a, b, c]);
            }
        }
    }
}
