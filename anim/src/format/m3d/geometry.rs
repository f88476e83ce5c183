//! Vertices, triangles and the subsets that they belong to.

use super::check as code;
use super::dialect::M3dDialect;
use super::scan::M3dScanner;
use crate::format::{ImportContext, ImportError};
use crate::limits::{HUGE, VERTICES};
use glam::{Vec2, Vec3, Vec4};
use std::ops::Range;

/// Vertices as columns, as in the file.
#[derive(Default)]
pub(super) struct M3dVertices {
    pub(super) positions: Vec<Vec3>,
    pub(super) tangents: Vec<Vec4>,
    pub(super) normals: Vec<Vec3>,
    pub(super) texture_coordinates: Vec<Vec2>,
    /// Empty without bones.
    pub(super) weights: Vec<[f32; 4]>,
    pub(super) bones: Vec<[u16; 4]>,
}

/// Bytes of the shortest vertex, triangle and row of the table of subsets.
pub(super) const VERTEX_BYTES: usize = 30;
pub(super) const TRIANGLE_BYTES: usize = 6;
const SUBSET_BYTES: usize = 20;

/// Reads the section of vertices. `bones` is the number of bones.
pub(super) fn vertices(
    scanner: &mut M3dScanner<'_>,
    count: usize,
    bones: usize,
    dialect: M3dDialect,
    context: &ImportContext<'_>,
) -> Result<M3dVertices, ImportError> {
    scanner.label("the section Vertices")?;
    let place = scanner.place(scanner.at());
    if count > VERTICES {
        let (size, limit) = (count as u64, VERTICES as u64);
        return Err(ImportError::TooLarge { place, what: "vertices", size, limit });
    }
    let skinned = if bones > 0 { count } else { 0 };
    let mut vertices = M3dVertices {
        positions: context.vec(&place, count)?,
        tangents: context.vec(&place, count)?,
        normals: context.vec(&place, count)?,
        texture_coordinates: context.vec(&place, count)?,
        weights: context.vec(&place, skinned)?,
        bones: context.vec(&place, skinned)?,
    };
    for _ in 0..count {
        context.work(16)?;
        scanner.label("a position")?;
        let at = scanner.at();
        let position = Vec3::from(scanner.floats::<3>("a position")?);
        if position.abs().max_element() > HUGE {
            return Err(scanner.invalid(at, code::HUGE_POSITION, "the position is too large"));
        }
        vertices.positions.push(position);
        let tangent = if dialect == M3dDialect::Dx10 {
            Vec3::from(scanner.labelled::<3>("a tangent")?).extend(1.0)
        } else {
            Vec4::from(scanner.labelled::<4>("a tangent")?)
        };
        vertices.tangents.push(tangent);
        vertices.normals.push(Vec3::from(scanner.labelled::<3>("a normal")?));
        vertices.texture_coordinates.push(Vec2::from(scanner.labelled::<2>("texture coordinates")?));
        if bones > 0 {
            let (weights, joints) = influences(scanner, bones)?;
            vertices.weights.push(weights);
            vertices.bones.push(joints);
        }
    }
    Ok(vertices)
}

/// Reads the weights and the bones of a vertex. A weight may be NaN, a bone of weight zero any number.
fn influences(scanner: &mut M3dScanner<'_>, bones: usize) -> Result<([f32; 4], [u16; 4]), ImportError> {
    scanner.label("weights")?;
    let mut weights = [0.0; 4];
    for weight in &mut weights {
        let token = scanner.word("a weight")?;
        let number = crate::format::decimal::parse_number(token.text);
        *weight = number.ok_or_else(|| {
            let reason = format!("{} is no number where a weight was expected", token.shown());
            scanner.invalid(token.at, crate::format::text::NUMBER_INVALID, reason)
        })? as f32;
    }
    scanner.label("the bones of a vertex")?;
    let mut joints = [0; 4];
    for joint in &mut joints {
        let (number, token) = scanner.whole("the number of a bone", u64::from(u32::MAX))?;
        if number >= bones as u64 {
            let reason = format!("a vertex refers to bone {number}, there are {bones} bones");
            return Err(scanner.invalid(token.at, code::INDEX_OUT_OF_RANGE, reason));
        }
        *joint = number as u16;
    }
    Ok((weights, joints))
}

/// Triangles, and for the dialect without a table the subset of each.
pub(super) struct M3dTriangles {
    /// Three vertices each, in the order of the file.
    pub(super) indices: Vec<[u32; 3]>,
    pub(super) subsets: Vec<u32>,
}

/// Reads the section of triangles.
pub(super) fn triangles(
    scanner: &mut M3dScanner<'_>,
    [count, vertices, materials]: [usize; 3],
    dialect: M3dDialect,
    context: &ImportContext<'_>,
) -> Result<M3dTriangles, ImportError> {
    scanner.label("the section Triangles")?;
    let place = scanner.place(scanner.at());
    let has_subset = dialect == M3dDialect::Dx10;
    let mut triangles = M3dTriangles {
        indices: context.vec(&place, count)?,
        subsets: context.vec(&place, if has_subset { count } else { 0 })?,
    };
    for _ in 0..count {
        context.work(4)?;
        let mut corners = [0; 3];
        for corner in &mut corners {
            *corner = index(scanner, "the vertex of a triangle", vertices)?;
        }
        triangles.indices.push(corners);
        if has_subset {
            triangles.subsets.push(index(scanner, "the subset of a triangle", materials)?);
        }
    }
    Ok(triangles)
}

fn index(scanner: &mut M3dScanner<'_>, what: &str, count: usize) -> Result<u32, ImportError> {
    let (index, token) = scanner.whole(what, u64::from(u32::MAX))?;
    if index < count as u64 {
        return Ok(index as u32);
    }
    let reason = format!("{what} is {index}, there are {count}");
    Err(scanner.invalid(token.at, code::INDEX_OUT_OF_RANGE, reason))
}

/// Reads the table of subsets: the range of triangles of each material.
pub(super) fn subsets(
    scanner: &mut M3dScanner<'_>,
    [count, triangles]: [usize; 2],
    context: &ImportContext<'_>,
) -> Result<Vec<Range<u32>>, ImportError> {
    scanner.label("the section SubsetTable")?;
    let place = scanner.place(scanner.at());
    if scanner.left() / SUBSET_BYTES < count.saturating_sub(1) {
        let reason = format!("the text is too short for {count} subsets");
        return Err(scanner.invalid(scanner.at(), crate::format::text::UNEXPECTED_END, reason));
    }
    let mut subsets = context.vec(&place, count)?;
    for _ in 0..count {
        context.work(16)?;
        let mut numbers = [0; 5];
        let mut at = 0;
        for number in &mut numbers {
            scanner.label("a subset")?;
            let (whole, token) = scanner.whole("a number of a subset", u64::from(u32::MAX))?;
            (*number, at) = (whole, token.at);
        }
        let [_, _, _, first, count] = numbers;
        if first + count > triangles as u64 {
            let reason = format!("a subset has {count} faces from face {first} on, there are {triangles}");
            return Err(scanner.invalid(at, code::INDEX_OUT_OF_RANGE, reason));
        }
        subsets.push(first as u32..(first + count) as u32);
    }
    Ok(subsets)
}
