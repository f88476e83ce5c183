//! Polygons become primitives: one for each material, with a vertex for each position and normal.

use super::check as code;
use super::mesh::XMesh;
use super::skin::XInfluences;
use crate::data::{Primitive, Vertices};
use crate::format::normals::{direction, normals};
use crate::format::triangulate::{Division, Triangulator, normal};
use crate::format::{AxisMap, ImportContext, ImportError, Place};
use glam::Vec3;
use std::collections::BTreeMap;

/// Number of a normal that the file does not have.
const COMPUTED: u32 = u32::MAX;

/// Triangles of one material: numbers of corners of the mesh.
type TriangleCorners = Vec<[u32; 3]>;

/// Returns the primitives of a mesh. `materials` are the numbers in the model of the materials of the mesh.
pub(super) fn primitives(
    mesh: &XMesh,
    materials: &[Option<u32>],
    influences: &XInfluences,
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<Vec<Primitive>, ImportError> {
    let parts = triangles(mesh, materials, axes, context)?;
    let count = mesh.positions.len();
    let mut positions = context.vec(&Place::File, count)?;
    context.work(count)?;
    positions.extend(mesh.positions.iter().map(|&position| axes.position(position)));
    let units: Vec<Option<Vec3>> = {
        context.charge(&Place::File, mesh.normals.len() as u64 * 16)?;
        context.work(mesh.normals.len())?;
        mesh.normals.iter().map(|&normal| direction(axes.direction(normal))).collect()
    };
    let needs_normals = mesh.normal_corners.is_empty() || units.contains(&None);
    let computed = if needs_normals {
        let all: usize = parts.values().map(Vec::len).sum();
        let mut indices = context.vec(&Place::File, all * 3)?;
        indices.extend(parts.values().flatten().flatten().map(|&corner| mesh.faces.corners[corner as usize]));
        normals(&positions, &indices, &Place::File, context)?
    } else {
        Vec::new()
    };
    let mut primitives = context.vec(&Place::File, parts.len())?;
    let sources =
        VertexSources { mesh, positions: &positions, units: &units, computed: &computed, influences };
    for (material, triangles) in parts {
        primitives.push(sources.primitive(material, &triangles, context)?);
    }
    Ok(primitives)
}

/// Returns the triangles of each material, counter-clockwise in the model.
fn triangles(
    mesh: &XMesh,
    materials: &[Option<u32>],
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<BTreeMap<Option<u32>, TriangleCorners>, ImportError> {
    let mut parts: BTreeMap<Option<u32>, TriangleCorners> = BTreeMap::new();
    let mut triangulator = Triangulator::new(mesh.faces.corners.len());
    // The lists grow by doubling, and the triangulator has lists of its own.
    context.charge(&Place::File, mesh.faces.corners.len() as u64 * (3 * 12 + 32))?;
    let (mut degenerate, mut approximate) = (0, 0);
    let mut corners = Vec::new();
    for face in 0..mesh.faces.len() {
        let range = mesh.faces.range(face);
        context.work(range.len())?;
        let slot = mesh.face_materials.get(face).or(mesh.face_materials.last());
        let material = slot.and_then(|&slot| materials.get(slot as usize).copied().flatten());
        corners.clear();
        corners.extend(mesh.faces.corners[range.clone()].iter().map(|&index| mesh.positions[index as usize]));
        let first = range.start as u32;
        let list = parts.entry(material).or_default();
        let division = triangulator.divide(&corners, normal(&corners), |[a, b, c]| {
            let triangle = if axes.mirrors() { [a, c, b] } else { [a, b, c] };
            list.push(triangle.map(|corner| corner + first));
        });
        match division {
            Division::Exact => {}
            Division::Approximate => approximate += 1,
            Division::Degenerate => degenerate += 1,
        }
    }
    for (count, what) in [(degenerate, "have no area and are left out"), (approximate, "cross themselves")] {
        if count > 0 {
            let text = format!("{count} polygons of the mesh \"{}\" {what}", mesh.name);
            context.warn(Place::File, code::POLYGON_INVALID, text);
        }
    }
    parts.retain(|_, triangles| !triangles.is_empty());
    Ok(parts)
}

/// The columns of the file from which vertices are made.
struct VertexSources<'a> {
    mesh: &'a XMesh,
    positions: &'a [Vec3],
    /// Normals of the file; `None` for one without length.
    units: &'a [Option<Vec3>],
    /// A normal for each position; empty where none is needed.
    computed: &'a [Vec3],
    influences: &'a XInfluences,
}

impl VertexSources<'_> {
    fn primitive(
        &self,
        material: Option<u32>,
        triangles: &[[u32; 3]],
        context: &ImportContext<'_>,
    ) -> Result<Primitive, ImportError> {
        let mut keys: Vec<(u32, u32)> = context.vec(&Place::File, triangles.len() * 3)?;
        keys.extend(triangles.iter().flatten().map(|&corner| self.key(corner)));
        context.work(keys.len() * 8)?;
        let mut indices = context.vec(&Place::File, keys.len())?;
        keys.sort_unstable();
        keys.dedup();
        for &corner in triangles.iter().flatten() {
            let key = self.key(corner);
            indices.push(keys.binary_search(&key).unwrap_or(0) as u32);
        }
        Ok(Primitive {
            vertices: self.vertices(&keys, context)?,
            indices,
            material,
            morph_targets: Vec::new(),
        })
    }

    /// Returns the numbers of the position and the normal of a corner.
    fn key(&self, corner: u32) -> (u32, u32) {
        let corner = corner as usize;
        let normal = self.mesh.normal_corners.get(corner).copied();
        let normal = normal.filter(|&normal| self.units[normal as usize].is_some());
        (self.mesh.faces.corners[corner], normal.unwrap_or(COMPUTED))
    }

    fn vertices(&self, keys: &[(u32, u32)], context: &ImportContext<'_>) -> Result<Vertices, ImportError> {
        let place = Place::File;
        context.work(keys.len())?;
        let mut vertices = Vertices {
            positions: context.vec(&place, keys.len())?,
            normals: context.vec(&place, keys.len())?,
            influences_per_vertex: self.influences.per_vertex,
            ..Vertices::default()
        };
        let positions = || keys.iter().map(|&(position, _)| position as usize);
        vertices.positions.extend(positions().map(|position| self.positions[position]));
        vertices.normals.extend(keys.iter().map(|&(position, normal)| {
            let unit = self.units.get(normal as usize).copied().flatten();
            unit.unwrap_or_else(|| self.computed[position as usize])
        }));
        if !self.mesh.texture_coordinates.is_empty() {
            let mut list = context.vec(&place, keys.len())?;
            list.extend(positions().map(|position| self.mesh.texture_coordinates[position]));
            vertices.texture_coordinates[0] = list;
        }
        if !self.mesh.colors.is_empty() {
            let mut list = context.vec(&place, keys.len())?;
            list.extend(positions().map(|position| self.mesh.colors[position]));
            vertices.colors = list;
        }
        let per_vertex = self.influences.per_vertex;
        let mut list = context.vec(&place, keys.len() * per_vertex)?;
        for position in positions() {
            list.extend_from_slice(&self.influences.list[position * per_vertex..(position + 1) * per_vertex]);
        }
        vertices.influences = list;
        Ok(vertices)
    }
}
