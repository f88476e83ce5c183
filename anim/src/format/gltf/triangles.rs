//! Triangle indices: strips and fans become lists, lists are checked, and primitives without indices get them.

use super::accessor::{GltfDocument, invalid};
use super::check as code;
pub(super) use crate::format::normals::{direction, normals};
use crate::format::{ImportContext, ImportError, Place};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive};
use gltf::json::validation::Checked;

const INDEX_FORMATS: &[(ComponentType, Type, bool)] = &[
    (ComponentType::U8, Type::Scalar, false),
    (ComponentType::U16, Type::Scalar, false),
    (ComponentType::U32, Type::Scalar, false),
];

/// Returns three indices per triangle, each below `vertices`; none for points and lines.
pub(super) fn triangles(
    document: &GltfDocument<'_>,
    primitive: &Primitive,
    vertices: usize,
    path: &str,
) -> Result<Vec<u32>, ImportError> {
    let context = document.context;
    let from = format!("{path}/indices");
    let place = Place::Pointer(from.clone());
    let indices = match primitive.indices {
        Some(accessor) => {
            let wrong = code::MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT;
            let values = document.source(accessor, &from, INDEX_FORMATS, wrong)?.integers::<1>()?;
            check_indices(&values, vertices, &place, context)?;
            values.into_iter().map(|[index]| index).collect()
        }
        None => {
            let mut indices = context.vec(&place, vertices)?;
            context.work(vertices)?;
            indices.extend(0..vertices as u32);
            indices
        }
    };
    match primitive.mode {
        Checked::Valid(Mode::Triangles) => Ok(list(indices, &place, context)),
        Checked::Valid(Mode::TriangleStrip) => strip(&indices, &place, context),
        Checked::Valid(Mode::TriangleFan) => fan(&indices, &place, context),
        Checked::Valid(mode) => {
            let text = format!("{mode:?} are not shown");
            context.warn(Place::Pointer(format!("{path}/mode")), code::MESH_PRIMITIVE_MODE_NOT_SHOWN, text);
            Ok(Vec::new())
        }
        Checked::Invalid => {
            let reason = "the mode is not one of 0..6".to_owned();
            Err(invalid(Place::Pointer(format!("{path}/mode")), code::VALUE_NOT_IN_LIST, reason))
        }
    }
}

fn check_indices(
    indices: &[[u32; 1]],
    vertices: usize,
    place: &Place,
    context: &ImportContext<'_>,
) -> Result<(), ImportError> {
    context.work(indices.len())?;
    match indices.iter().position(|[index]| *index as usize >= vertices) {
        None => Ok(()),
        Some(number) => {
            let reason = format!("index {number} is {}, there are {vertices} vertices", indices[number][0]);
            Err(invalid(place.clone(), code::ACCESSOR_INDEX_OOB, reason))
        }
    }
}

fn list(mut indices: Vec<u32>, place: &Place, context: &ImportContext<'_>) -> Vec<u32> {
    if !indices.len().is_multiple_of(3) {
        let text = format!(
            "{} indices are not a whole number of triangles; the last ones are left out",
            indices.len()
        );
        context.warn(place.clone(), code::MESH_PRIMITIVE_INCOMPATIBLE_MODE, text);
        indices.truncate(indices.len() / 3 * 3);
    }
    indices
}

/// Converts a strip: triangle i is i, i + 1 + i % 2, i + 2 - i % 2 (glTF 2.0 §3.7.2.1).
fn strip(indices: &[u32], place: &Place, context: &ImportContext<'_>) -> Result<Vec<u32>, ImportError> {
    let count = indices.len().saturating_sub(2);
    let mut list = context.vec(place, count.saturating_mul(3))?;
    context.work(count)?;
    for i in 0..count {
        list.extend([indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]]);
    }
    Ok(list)
}

/// Converts a fan: triangle i is i + 1, i + 2, 0 (glTF 2.0 §3.7.2.1).
fn fan(indices: &[u32], place: &Place, context: &ImportContext<'_>) -> Result<Vec<u32>, ImportError> {
    let count = indices.len().saturating_sub(2);
    let mut list = context.vec(place, count.saturating_mul(3))?;
    context.work(count)?;
    for i in 0..count {
        list.extend([indices[i + 1], indices[i + 2], indices[0]]);
    }
    Ok(list)
}
