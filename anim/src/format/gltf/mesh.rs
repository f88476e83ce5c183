//! Meshes: attributes become columns, each of the length of the positions.

use super::accessor::{ElementFormat, GltfDocument};
use super::attribute::{ANY_VEC3, QUANTIZED, UNIT_VEC3, attribute, formats, unequal};
use super::buffer::is_missing;
use super::check as code;
use super::influence::influences;
use super::morph::{morph_targets, morph_weights};
use super::node::largest;
use super::triangles::{direction, normals, triangles};
use crate::data::{Mesh, Primitive, Vertices};
use crate::format::{ImportError, Place};
use crate::limits::{HUGE, VERTICES};
use glam::{Vec2, Vec3, Vec4};
use gltf::json;
use gltf::json::accessor::ComponentType::{F32, I8, I16, U8, U16};
use gltf::json::accessor::Type;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;

/// A mesh, and what placing it in the scene requires.
pub(super) struct ReadMesh {
    pub(super) mesh: Mesh,
    /// Largest joint number in use in the mesh; `None` if no primitive has joints.
    pub(super) largest_joint: Option<u16>,
}

const TANGENT: &[ElementFormat] = &formats(Type::Vec4, [(F32, false), (I8, true), (I16, true)]);
const COORDINATES: &[ElementFormat] = &formats(Type::Vec2, QUANTIZED);
const COLOR_3: &[ElementFormat] = &formats(Type::Vec3, [(F32, false), (U8, true), (U16, true)]);
const COLOR_4: &[ElementFormat] = &formats(Type::Vec4, [(F32, false), (U8, true), (U16, true)]);
const COLOR: &[ElementFormat] = &[COLOR_3[0], COLOR_3[1], COLOR_3[2], COLOR_4[0], COLOR_4[1], COLOR_4[2]];
const WRONG: &str = code::MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT;

/// Returns all meshes. One that `is_shown` does not contain stays empty, with a warning, if its buffer is missing.
pub(super) fn meshes(document: &GltfDocument<'_>, is_shown: &[bool]) -> Result<Vec<ReadMesh>, ImportError> {
    let context = document.context;
    let count = document.root.meshes.len();
    let mut meshes = context.vec(&Place::Pointer("/meshes".to_owned()), count)?;
    let mut vertices = 0;
    for (index, mesh) in document.root.meshes.iter().enumerate() {
        let read = match read_mesh(document, mesh, index, &mut vertices) {
            Err(error) if is_missing(&error) && !is_shown.get(index).copied().unwrap_or_default() => {
                let place = Place::Pointer(format!("/meshes/{index}"));
                let text = format!("the mesh is not shown and stays empty: {error}");
                context.warn(place, error.code(), text);
                let name = mesh.name.clone().unwrap_or_default();
                ReadMesh { mesh: Mesh { name, ..Mesh::default() }, largest_joint: None }
            }
            read => read?,
        };
        meshes.push(read);
        context.progress(0.3 + 0.4 * (index + 1) as f32 / count as f32)?;
    }
    Ok(meshes)
}

fn read_mesh(
    document: &GltfDocument<'_>,
    mesh: &json::Mesh,
    index: usize,
    total: &mut usize,
) -> Result<ReadMesh, ImportError> {
    let path = format!("/meshes/{index}");
    if mesh.primitives.is_empty() {
        let place = Place::Pointer(format!("{path}/primitives"));
        document.context.warn(place, code::EMPTY_ENTITY, "the mesh has no primitive");
    }
    let mut largest_joint = None;
    let mut primitives = document.context.vec(&Place::Pointer(path.clone()), mesh.primitives.len())?;
    for (number, primitive) in mesh.primitives.iter().enumerate() {
        let path = format!("{path}/primitives/{number}");
        primitives.push(read_primitive(document, primitive, &path, total, &mut largest_joint)?);
    }
    let morph_weights = morph_weights(document, mesh, &mut primitives, &path)?;
    let name = mesh.name.clone().unwrap_or_default();
    Ok(ReadMesh { mesh: Mesh { name, primitives, morph_weights }, largest_joint })
}

fn read_primitive(
    document: &GltfDocument<'_>,
    primitive: &json::mesh::Primitive,
    path: &str,
    total: &mut usize,
    largest_joint: &mut Option<u16>,
) -> Result<Primitive, ImportError> {
    let material = primitive.material.map(|material| material.value() as u32);
    if let Some(index) = material.filter(|&index| index as usize >= document.root.materials.len()) {
        return Err(super::accessor::unresolved(&format!("{path}/material"), index as usize));
    }
    let Some(positions) = positions(document, primitive, path)? else {
        let text = "the primitive has no positions and stays empty";
        document.context.warn(Place::Pointer(path.to_owned()), code::MESH_PRIMITIVE_NO_POSITION, text);
        return Ok(Primitive { material, ..Primitive::default() });
    };
    let mut vertices = Vertices { positions, ..Vertices::default() };
    let count = vertices.len();
    *total = total.saturating_add(count);
    if *total > VERTICES {
        let (size, limit) = (*total as u64, VERTICES as u64);
        let place = Place::Pointer(path.to_owned());
        return Err(ImportError::TooLarge { place, what: "vertices", size, limit });
    }
    warn_unknown(document, primitive, path);
    let indices = triangles(document, primitive, count, path)?;
    if let Some(tangents) = column(document, primitive, Semantic::Tangents, TANGENT, count, path)? {
        vertices.tangents = unit_tangents(tangents, path, document);
    }
    for set in 0..2_u32 {
        let read = column(document, primitive, Semantic::TexCoords(set), COORDINATES, count, path)?;
        vertices.texture_coordinates[set as usize] =
            read.unwrap_or_default().into_iter().map(Vec2::from).collect();
    }
    vertices.colors = colors(document, primitive, count, path)?;
    vertices.normals = all_normals(document, primitive, &vertices.positions, &indices, path)?;
    let influences = influences(document, primitive, count, path)?;
    if influences.per_vertex > 0 {
        *largest_joint = (*largest_joint).max(Some(influences.largest_joint));
    }
    (vertices.influences, vertices.influences_per_vertex) = (influences.list, influences.per_vertex);
    let morph_targets = morph_targets(document, primitive, count, path)?;
    Ok(Primitive { vertices, indices, material, morph_targets })
}

/// Returns an attribute as finite floats, if the primitive has it.
fn column<const N: usize>(
    document: &GltfDocument<'_>,
    primitive: &json::mesh::Primitive,
    semantic: Semantic,
    allowed: &[ElementFormat],
    vertices: usize,
    path: &str,
) -> Result<Option<Vec<[f32; N]>>, ImportError> {
    let from = format!("{path}/attributes/{}", semantic.to_string());
    let Some(accessor) = attribute(primitive, semantic) else { return Ok(None) };
    let source = document.source(accessor, &from, allowed, WRONG)?;
    unequal(source.count, vertices, &from)?;
    source.finite().map(Some)
}

fn positions(
    document: &GltfDocument<'_>,
    primitive: &json::mesh::Primitive,
    path: &str,
) -> Result<Option<Vec<Vec3>>, ImportError> {
    let from = format!("{path}/attributes/POSITION");
    let Some(accessor) = attribute(primitive, Semantic::Positions) else { return Ok(None) };
    let positions = document.source(accessor, &from, ANY_VEC3, WRONG)?.finite::<3>()?;
    document.context.work(positions.len())?;
    let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from).collect();
    if positions.iter().any(|&position| largest(position) > HUGE) {
        let text = "a vertex is too far away for single precision";
        document.context.warn(Place::Pointer(from), code::HUGE_TRANSLATION, text);
    }
    Ok(Some(positions))
}

/// Returns normalized normals; those that the file lacks, and those of length zero, are computed from the triangles.
fn all_normals(
    document: &GltfDocument<'_>,
    primitive: &json::mesh::Primitive,
    positions: &[Vec3],
    indices: &[u32],
    path: &str,
) -> Result<Vec<Vec3>, ImportError> {
    let place = Place::Pointer(format!("{path}/attributes/NORMAL"));
    let context = document.context;
    let Some(read) = column::<3>(document, primitive, Semantic::Normals, UNIT_VEC3, positions.len(), path)?
    else {
        return normals(positions, indices, &place, context);
    };
    context.work(read.len())?;
    let mut odd = 0;
    let mut unit: Vec<Option<Vec3>> = context.vec(&place, read.len())?;
    unit.extend(read.into_iter().map(Vec3::from).map(|normal| {
        odd += usize::from((normal.length() - 1.0).abs() > UNIT_TOLERANCE);
        direction(normal)
    }));
    if odd > 0 {
        context.warn(
            place.clone(),
            code::ACCESSOR_VECTOR3_NON_UNIT,
            format!("{odd} normals are not of unit length"),
        );
    }
    let made = if unit.contains(&None) { normals(positions, indices, &place, context)? } else { Vec::new() };
    Ok(unit.into_iter().enumerate().map(|(vertex, normal)| normal.unwrap_or_else(|| made[vertex])).collect())
}

/// Tolerance of the Khronos validator, plus the step of 8-bit normals.
const UNIT_TOLERANCE: f32 = 0.00674 + 1.0 / 127.0;

fn unit_tangents(tangents: Vec<[f32; 4]>, path: &str, document: &GltfDocument<'_>) -> Vec<Vec4> {
    let place = Place::Pointer(format!("{path}/attributes/TANGENT"));
    if tangents.iter().any(|tangent| tangent[3].abs() != 1.0) {
        document.context.warn(
            place.clone(),
            code::ACCESSOR_INVALID_SIGN,
            "w should be 1 or -1; its sign is used",
        );
    }
    if tangents.iter().any(|t| (Vec3::new(t[0], t[1], t[2]).length() - 1.0).abs() > UNIT_TOLERANCE) {
        let text = "tangents are not of unit length";
        document.context.warn(place, code::ACCESSOR_VECTOR3_NON_UNIT, text);
    }
    let unit = |[x, y, z, w]: [f32; 4]| {
        let side = if w < 0.0 { -1.0 } else { 1.0 };
        direction(Vec3::new(x, y, z)).unwrap_or(Vec3::X).extend(side)
    };
    tangents.into_iter().map(unit).collect()
}

fn colors(
    document: &GltfDocument<'_>,
    primitive: &json::mesh::Primitive,
    count: usize,
    path: &str,
) -> Result<Vec<Vec4>, ImportError> {
    let from = format!("{path}/attributes/COLOR_0");
    let Some(accessor) = attribute(primitive, Semantic::Colors(0)) else { return Ok(Vec::new()) };
    let source = document.source(accessor, &from, COLOR, WRONG)?;
    unequal(source.count, count, &from)?;
    let colors: Vec<Vec4> = match source.format.1 {
        Type::Vec3 => source.finite::<3>()?.into_iter().map(|color| Vec3::from(color).extend(1.0)).collect(),
        _ => source.finite::<4>()?.into_iter().map(Vec4::from).collect(),
    };
    document.context.charge(&source.place, colors.len() as u64 * size_of::<Vec4>() as u64)?;
    let clamped = |color: &Vec4| color.clamp(Vec4::ZERO, Vec4::ONE);
    if colors.iter().any(|color| clamped(color) != *color) {
        document.context.warn(
            Place::Pointer(from),
            code::ACCESSOR_NON_CLAMPED,
            "colors outside 0..1 were clamped",
        );
    }
    Ok(colors.iter().map(clamped).collect())
}

/// Adds one warning for each attribute that is not used.
fn warn_unknown(document: &GltfDocument<'_>, primitive: &json::mesh::Primitive, path: &str) {
    for semantic in primitive.attributes.keys() {
        let name = match semantic {
            Checked::Invalid => "an attribute with an unknown name".to_owned(),
            Checked::Valid(semantic @ (Semantic::Colors(1..) | Semantic::TexCoords(2..))) => {
                semantic.to_string()
            }
            Checked::Valid(_) => continue,
        };
        let place = Place::Pointer(format!("{path}/attributes"));
        document.context.warn(place, code::MESH_PRIMITIVE_INVALID_ATTRIBUTE, format!("{name} is not used"));
    }
}
