//! The attributes of primitives and of morph targets: their formats and lengths.

use super::accessor::{ElementFormat, invalid};
use super::check as code;
use crate::format::{ImportError, Place};
use gltf::json;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;

/// Returns all combinations of a shape with component types.
pub(super) const fn formats<const N: usize>(
    shape: Type,
    kinds: [(ComponentType, bool); N],
) -> [ElementFormat; N] {
    let mut formats = [(ComponentType::F32, shape, false); N];
    let mut i = 0;
    while i < N {
        formats[i] = (kinds[i].0, shape, kinds[i].1);
        i += 1;
    }
    formats
}

use ComponentType::{F32, I8, I16, U8, U16};

/// Every format of KHR_mesh_quantization, allowed even if a file does not request the extension.
pub(super) const QUANTIZED: [(ComponentType, bool); 9] = [
    (F32, false),
    (I8, false),
    (I8, true),
    (U8, false),
    (U8, true),
    (I16, false),
    (I16, true),
    (U16, false),
    (U16, true),
];
pub(super) const ANY_VEC3: &[ElementFormat] = &formats(Type::Vec3, QUANTIZED);
pub(super) const UNIT_VEC3: &[ElementFormat] = &formats(Type::Vec3, [(F32, false), (I8, true), (I16, true)]);

/// Returns the accessor of an attribute.
pub(super) fn attribute(
    primitive: &json::mesh::Primitive,
    semantic: Semantic,
) -> Option<json::Index<Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

/// Refuses an attribute whose `count` is not the number of vertices.
pub(super) fn unequal(count: usize, vertices: usize, from: &str) -> Result<(), ImportError> {
    if count == vertices {
        return Ok(());
    }
    let reason = format!("{count} values for {vertices} vertices");
    Err(invalid(Place::Pointer(from.to_owned()), code::MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT, reason))
}
