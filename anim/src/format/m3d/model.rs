//! Sections become a model: one mesh with one primitive for each material, one skin.

use super::check as code;
use super::clips::take;
use super::scan::M3dScanner;
use super::text::M3dText;
use super::{bones, weights};
use crate::data::{AnimationData, BoneIndex, Mesh, MeshInstance, ModelData, Primitive, Skin, Vertices};
use crate::format::image::NeighborImages;
use crate::format::normals::{direction, normals};
use crate::format::{AxisMap, ImportContext, ImportError, Place};
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Returns the model.
pub(super) fn model(
    bytes: &[u8],
    mut text: M3dText,
    context: &ImportContext<'_>,
) -> Result<ModelData, ImportError> {
    let scanner = M3dScanner::new(bytes);
    let axes = text.conversion.axes();
    let mut images = NeighborImages::new(context);
    let mut materials = context.vec(&Place::File, text.materials.len())?;
    for material in std::mem::take(&mut text.materials) {
        materials.push(material.finish(bytes, &scanner, &mut images)?);
    }
    let skeleton = bones::skeleton(&text.bones, &axes, &scanner, context)?;
    let skin = (!text.bones.is_empty()).then(|| Skin {
        name: String::new(),
        bones: (0..text.bones.len() as BoneIndex).collect(),
        offsets: skeleton.bones.iter().map(|bone| bone.offset).collect(),
    });
    context.charge(&Place::File, text.bones.len() as u64 * 80)?;
    let primitives = primitives(&text, &axes, context)?;
    context.progress(0.7)?;
    let mut takes = context.vec(&Place::File, text.clips.len())?;
    for clip in &text.clips {
        takes.push(Arc::new(take(clip, bytes, &axes, &scanner, context)?));
    }
    let mut model = ModelData {
        materials,
        images: images.into_images(),
        animation: AnimationData { skeleton: Arc::new(skeleton), takes },
        ..ModelData::default()
    };
    if !primitives.is_empty() {
        let skin_number = skin.is_some().then_some(0);
        model.meshes.push(Mesh { primitives, ..Mesh::default() });
        model.instances.push(MeshInstance {
            mesh: 0,
            node: None,
            skin: skin_number,
            bone: None,
            to_bone: Mat4::IDENTITY,
            morph_weights: Vec::new(),
        });
    }
    model.skins.extend(skin);
    Ok(model)
}

/// Triangles of one material.
struct Part {
    material: Option<u32>,
    triangles: Vec<u32>,
}

fn primitives(
    text: &M3dText,
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<Vec<Primitive>, ImportError> {
    let parts = parts(text, context)?;
    let vertices = all_vertices(text, axes, context)?;
    let count = vertices.positions.len();
    if let [part] = &parts[..] {
        // Every vertex keeps its number.
        let indices = indices(text, part, None, context)?;
        return Ok(vec![Primitive { vertices, indices, material: part.material, morph_targets: Vec::new() }]);
    }
    let mut primitives = context.vec(&Place::File, parts.len())?;
    let mut numbers = context.filled(&Place::File, count, UNUSED)?;
    for part in &parts {
        context.work(count + 3 * part.triangles.len())?;
        numbers.fill(UNUSED);
        for &triangle in &part.triangles {
            for corner in text.triangles.indices[triangle as usize] {
                numbers[corner as usize] = 0;
            }
        }
        let mut used: Vec<u32> =
            context.vec(&Place::File, numbers.iter().filter(|&&number| number != UNUSED).count())?;
        for (vertex, number) in numbers.iter_mut().enumerate().filter(|(_, number)| **number != UNUSED) {
            *number = used.len() as u32;
            used.push(vertex as u32);
        }
        let indices = indices(text, part, Some(&numbers), context)?;
        let vertices = chosen(&vertices, &used, context)?;
        primitives.push(Primitive { vertices, indices, material: part.material, morph_targets: Vec::new() });
    }
    Ok(primitives)
}

const UNUSED: u32 = u32::MAX;

/// Returns the triangles of each material, and last those of none.
fn parts(text: &M3dText, context: &ImportContext<'_>) -> Result<Vec<Part>, ImportError> {
    let count = text.triangles.indices.len();
    let mut parts: Vec<Part> = Vec::new();
    let mut is_used = context.filled(&Place::File, count, !text.triangles.subsets.is_empty())?;
    if text.triangles.subsets.is_empty() {
        for (material, range) in text.subsets.iter().enumerate() {
            context.charge(&Place::File, 64 + range.len() as u64 * 4)?;
            context.work(range.len())?;
            is_used[range.start as usize..range.end as usize].fill(true);
            parts.push(Part { material: Some(material as u32), triangles: range.clone().collect() });
        }
    } else {
        let most = text.triangles.subsets.iter().copied().max().unwrap_or(0) as usize;
        context.charge(&Place::File, most as u64 * 64 + count as u64 * 8)?;
        parts.extend(
            (0..=most).map(|material| Part { material: Some(material as u32), triangles: Vec::new() }),
        );
        for (triangle, &subset) in text.triangles.subsets.iter().enumerate() {
            parts[subset as usize].triangles.push(triangle as u32);
        }
    }
    let unused: Vec<u32> = (0..count as u32).filter(|&triangle| !is_used[triangle as usize]).collect();
    if !unused.is_empty() {
        context.charge(&Place::File, 64 + unused.len() as u64 * 4)?;
        let warning = format!("{} triangles belong to no subset; they have no material", unused.len());
        context.warn(Place::File, code::SUBSET_MISSING, warning);
        parts.push(Part { material: None, triangles: unused });
    }
    parts.retain(|part| !part.triangles.is_empty());
    Ok(parts)
}

/// Returns the indices of the triangles of a part; `numbers` are the new numbers of vertices.
fn indices(
    text: &M3dText,
    part: &Part,
    numbers: Option<&[u32]>,
    context: &ImportContext<'_>,
) -> Result<Vec<u32>, ImportError> {
    let mut indices = context.vec(&Place::File, part.triangles.len() * 3)?;
    context.work(indices.capacity())?;
    let reverses = text.reverses();
    for &triangle in &part.triangles {
        let [a, b, c] = text.triangles.indices[triangle as usize];
        let corners = if reverses { [a, c, b] } else { [a, b, c] };
        indices.extend(corners.map(|corner| numbers.map_or(corner, |numbers| numbers[corner as usize])));
    }
    Ok(indices)
}

/// Returns all vertices of the file in the space of the model.
fn all_vertices(
    text: &M3dText,
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<Vertices, ImportError> {
    let read = &text.vertices;
    let count = read.positions.len();
    context.work(count)?;
    let mut vertices = Vertices {
        positions: context.vec(&Place::File, count)?,
        normals: context.vec(&Place::File, count)?,
        tangents: context.vec(&Place::File, count)?,
        ..Vertices::default()
    };
    vertices.positions.extend(read.positions.iter().map(|&position| axes.position(position)));
    let units: Vec<Option<Vec3>> =
        read.normals.iter().map(|&normal| direction(axes.direction(normal))).collect();
    let made = if units.contains(&None) {
        let all: Vec<u32> = text.triangles.indices.iter().flatten().copied().collect();
        context.charge(&Place::File, all.len() as u64 * 4)?;
        let mut made = normals(&vertices.positions, &all, &Place::File, context)?;
        if !text.reverses() {
            made
        } else {
            made.iter_mut().for_each(|normal| *normal = -*normal);
            made
        }
    } else {
        Vec::new()
    };
    vertices
        .normals
        .extend(units.into_iter().enumerate().map(|(vertex, unit)| unit.unwrap_or_else(|| made[vertex])));
    vertices.tangents.extend(read.tangents.iter().map(|&tangent| {
        let side = if tangent.w < 0.0 { -1.0 } else { 1.0 };
        let mapped = axes.tangent(tangent.truncate().extend(side));
        direction(mapped.truncate()).unwrap_or(Vec3::X).extend(mapped.w)
    }));
    vertices.texture_coordinates[0] = context.vec(&Place::File, count)?;
    vertices.texture_coordinates[0].extend_from_slice(&read.texture_coordinates);
    if !read.weights.is_empty() {
        vertices.influences = weights::influences(read, context)?;
        vertices.influences_per_vertex = 4;
    }
    Ok(vertices)
}

/// Returns the vertices with these numbers.
fn chosen(all: &Vertices, used: &[u32], context: &ImportContext<'_>) -> Result<Vertices, ImportError> {
    context.charge(&Place::File, used.len() as u64 * 96)?;
    context.work(used.len())?;
    fn column<T: Copy>(all: &[T], used: &[u32]) -> Vec<T> {
        if all.is_empty() { Vec::new() } else { used.iter().map(|&vertex| all[vertex as usize]).collect() }
    }
    Ok(Vertices {
        positions: column(&all.positions, used),
        normals: column(&all.normals, used),
        tangents: column(&all.tangents, used),
        texture_coordinates: [column(&all.texture_coordinates[0], used), Vec::new()],
        colors: Vec::new(),
        influences: used.iter().flat_map(|&vertex| all.influences_of(vertex as usize)).copied().collect(),
        influences_per_vertex: all.influences_per_vertex,
    })
}
