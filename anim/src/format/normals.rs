//! Normals of vertices whose file has none.

use super::{ImportContext, ImportError, Place};
use glam::{DVec3, Vec3};

/// Returns normals from the triangles around each vertex, weighted by area; +Y for a vertex without a proper triangle.
///
/// The specification requires flat normals. Those need separate vertices for each triangle, whereas vertices keep the
/// number and order of the file here, so that edits and comparisons can refer to them.
pub(super) fn normals(
    positions: &[Vec3],
    indices: &[u32],
    place: &Place,
    context: &ImportContext<'_>,
) -> Result<Vec<Vec3>, ImportError> {
    let mut normals = context.filled(place, positions.len(), Vec3::ZERO)?;
    context.work(indices.len())?;
    for corners in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| positions[corners[corner] as usize]);
        let across = (b - a).cross(c - a);
        // Huge positions overflow; such a triangle has no direction.
        if across.is_finite() {
            for &corner in corners {
                normals[corner as usize] += across;
            }
        }
    }
    context.work(normals.len())?;
    for normal in &mut normals {
        *normal = direction(*normal).unwrap_or(Vec3::Y);
    }
    Ok(normals)
}

/// Returns `vector` normalized, however long or short; `None` for zero.
pub(super) fn direction(vector: Vec3) -> Option<Vec3> {
    unit(vector.as_dvec3())
}

/// Returns `vector` normalized; `None` for zero, and for one that is too long for double precision.
pub(super) fn unit(vector: DVec3) -> Option<Vec3> {
    let length = vector.length();
    if length > 0.0 && length.is_finite() { Some((vector / length).as_vec3()) } else { None }
}
