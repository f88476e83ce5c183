//! Polygons become meshes: one for each object and group, with one primitive for each material.

use super::check as code;
use super::faces::{Corner, NONE, ObjText, Polygon};
use super::lines::places;
use super::vertices::{NormalKey, VertexFinder, VertexKey};
use crate::data::{Mesh, Primitive};
use crate::format::normals::unit;
use crate::format::triangulate::{Division, Triangulator, normal};
use crate::format::{AxisMap, ImportContext, ImportError, Place};
use glam::{DVec3, Vec3, Vec4};
use std::collections::HashMap;

/// Returns the meshes, in the order of the file; those without triangles are left out.
pub(super) fn meshes(
    bytes: &[u8],
    text: &ObjText,
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<Vec<Mesh>, ImportError> {
    let mut builder = MeshBuilder {
        text,
        context,
        triangulator: Triangulator::new(text.corners.len()),
        smooth: smooth_normals(text, context)?,
        finder: VertexFinder::new(text.positions.len(), context)?,
        mirrors: axes.mirrors(),
        corners: Vec::new(),
        triangles: Vec::new(),
        odd: [None, None],
    };
    let mut meshes: Vec<Mesh> = context.vec(&Place::File, text.parts.len())?;
    meshes.extend(text.parts.iter().map(|name| Mesh { name: name.clone(), ..Mesh::default() }));
    // The primitive of each mesh and material; polygons in a row mostly have the same.
    let mut known: HashMap<(u32, u32), usize> = HashMap::new();
    let mut latest = None;
    let mut drafts: Vec<(u32, Primitive)> = Vec::new();
    for (number, polygon) in text.polygons.iter().enumerate() {
        context.work(polygon.count as usize)?;
        let (next, owner) = (drafts.len(), (polygon.part, polygon.material));
        let draft = match latest {
            Some((latest, draft)) if latest == owner => draft,
            Some(_) | None => *known.entry(owner).or_insert(next),
        };
        latest = Some((owner, draft));
        if draft == next {
            context.charge(&Place::File, 4 * size_of::<Primitive>() as u64)?;
            let material = (polygon.material != NONE).then_some(polygon.material);
            drafts.push((polygon.part, Primitive { material, ..Primitive::default() }));
        }
        builder.add(number as u32, polygon, draft as u32, &mut drafts[draft].1)?;
    }
    builder.warn(bytes);
    for (part, mut primitive) in drafts {
        context.work(primitive.indices.len())?;
        if !primitive.indices.is_empty() {
            fill(&mut primitive);
            meshes[part as usize].primitives.push(primitive);
        }
    }
    meshes.retain(|mesh| !mesh.primitives.is_empty());
    Ok(meshes)
}

struct MeshBuilder<'a> {
    text: &'a ObjText,
    context: &'a ImportContext<'a>,
    triangulator: Triangulator,
    /// Sums of the normals of the polygons of a smoothing group at a position.
    smooth: HashMap<(u32, u32), DVec3>,
    finder: VertexFinder,
    mirrors: bool,
    /// Positions of the corners of the current polygon.
    corners: Vec<Vec3>,
    /// Triangles of the current polygon.
    triangles: Vec<[u32; 3]>,
    /// Number of degenerate and of approximate polygons, with the offset of the first one.
    odd: [Option<(usize, usize)>; 2],
}

impl MeshBuilder<'_> {
    /// Adds the triangles of a polygon to its primitive, which is number `draft`.
    fn add(
        &mut self,
        number: u32,
        polygon: &Polygon,
        draft: u32,
        primitive: &mut Primitive,
    ) -> Result<(), ImportError> {
        let (text, context) = (self.text, self.context);
        let corners = &text.corners[polygon.first as usize..][..polygon.count as usize];
        self.corners.clear();
        if self.corners.capacity() < corners.len() {
            // For these lists and those of the triangulator.
            context.charge(&Place::File, (corners.len() * 128) as u64)?;
        }
        self.corners.extend(corners.iter().map(|corner| text.positions[corner[0] as usize]));
        let across = normal(&self.corners);
        let mut triangles = std::mem::take(&mut self.triangles);
        triangles.clear();
        let division = self.triangulator.divide(&self.corners, across, |triangle| triangles.push(triangle));
        match division {
            Division::Exact => {}
            Division::Degenerate => count(&mut self.odd[0], polygon.at),
            Division::Approximate => count(&mut self.odd[1], polygon.at),
        }
        context.charge(&Place::File, triangles.len() as u64 * 36)?;
        for &triangle in &triangles {
            let [a, b, c] = if self.mirrors { [triangle[0], triangle[2], triangle[1]] } else { triangle };
            for corner in [a, b, c] {
                let corner = corners[corner as usize];
                let key = vertex_key(number, polygon, draft, corner);
                let next = primitive.vertices.len() as u32;
                let index = self.finder.number(key, next, context)?;
                if index == next {
                    let normal = self.normal_of(&key).or_else(|| direction(across, self.mirrors));
                    push_vertex(primitive, text, corner, normal.unwrap_or(Vec3::Y));
                }
                primitive.indices.push(index);
            }
        }
        self.triangles = triangles;
        Ok(())
    }

    /// Returns the normal of a vertex; `None` for that of its polygon.
    fn normal_of(&self, key: &VertexKey) -> Option<Vec3> {
        match key.normal {
            NormalKey::File(normal) => unit(self.text.normals[normal as usize].as_dvec3()),
            NormalKey::Smooth(group) => {
                self.smooth.get(&(key.position, group)).and_then(|sum| direction(*sum, self.mirrors))
            }
            NormalKey::Flat(_) => None,
        }
    }

    /// Warns once of polygons without area, and once of others that are not covered exactly.
    fn warn(&self, bytes: &[u8]) {
        let texts = [
            (code::POLYGON_DEGENERATE, "have no area; they are left out"),
            (code::POLYGON_APPROXIMATE, "cross themselves or are too large; their triangles may overlap"),
        ];
        for (odd, (code, what)) in self.odd.iter().zip(texts) {
            if let Some((count, at)) = odd {
                let text = format!("{count} polygons, this one the first, {what}");
                self.context.warn(places(bytes).place(*at), code, text);
            }
        }
    }
}

fn count(odd: &mut Option<(usize, usize)>, at: usize) {
    *odd = Some(odd.map_or((1, at), |(count, first)| (count + 1, first)));
}

fn vertex_key(number: u32, polygon: &Polygon, primitive: u32, corner: Corner) -> VertexKey {
    let [position, texture, normal] = corner;
    let normal = match (normal, polygon.smoothing) {
        (NONE, 0) => NormalKey::Flat(number),
        (NONE, group) => NormalKey::Smooth(group),
        (normal, _) => NormalKey::File(normal),
    };
    VertexKey { primitive, position, texture, normal }
}

fn push_vertex(primitive: &mut Primitive, text: &ObjText, corner: Corner, normal: Vec3) {
    let vertices = &mut primitive.vertices;
    let before = vertices.positions.len();
    vertices.positions.push(text.positions[corner[0] as usize]);
    vertices.normals.push(normal);
    if corner[1] != NONE {
        vertices.texture_coordinates[0].resize(before, glam::Vec2::ZERO);
        vertices.texture_coordinates[0].push(text.texture_coordinates[corner[1] as usize]);
    }
    if !text.colors.is_empty() {
        // The last positions may have no colors.
        vertices.colors.push(text.colors.get(corner[0] as usize).copied().unwrap_or(Vec4::ONE));
    }
}

/// Fills texture coordinates up to the number of vertices, if there are any.
fn fill(primitive: &mut Primitive) {
    let vertices = &mut primitive.vertices;
    let count = vertices.positions.len();
    if !vertices.texture_coordinates[0].is_empty() {
        vertices.texture_coordinates[0].resize(count, glam::Vec2::ZERO);
    }
}

/// Returns the sums of the normals of the polygons of each smoothing group at each position, for corners without normal.
fn smooth_normals(
    text: &ObjText,
    context: &ImportContext<'_>,
) -> Result<HashMap<(u32, u32), DVec3>, ImportError> {
    let mut sums: HashMap<(u32, u32), DVec3> = HashMap::new();
    let mut positions = Vec::new();
    for polygon in text.polygons.iter().filter(|polygon| polygon.smoothing != 0) {
        let corners = &text.corners[polygon.first as usize..][..polygon.count as usize];
        context.work(corners.len())?;
        if !corners.iter().any(|corner| corner[2] == NONE) {
            continue;
        }
        context.charge(&Place::File, corners.len() as u64 * 160)?;
        positions.clear();
        positions.extend(corners.iter().map(|corner| text.positions[corner[0] as usize]));
        let normal = normal(&positions);
        for corner in corners {
            *sums.entry((corner[0], polygon.smoothing)).or_default() += normal;
        }
    }
    Ok(sums)
}

/// Returns the direction of a normal that was computed from positions, which are mirrored where the axes are.
fn direction(normal: DVec3, mirrors: bool) -> Option<Vec3> {
    unit(if mirrors { -normal } else { normal })
}
