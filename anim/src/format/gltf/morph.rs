//! Morph targets and their weights.

use super::accessor::{GltfDocument, invalid};
use super::attribute::{ANY_VEC3, UNIT_VEC3};
use super::check as code;
use crate::data::{MorphTarget, Primitive};
use crate::format::{ImportError, Place};
use glam::Vec3;
use gltf::json;
use gltf::json::accessor::Accessor;
use serde_json::value::RawValue;
use std::collections::HashMap;

/// Returns the morph targets of a primitive; each column is empty or of the length of the primitive.
pub(super) fn morph_targets(
    document: &GltfDocument<'_>,
    primitive: &json::mesh::Primitive,
    vertices: usize,
    path: &str,
) -> Result<Vec<MorphTarget>, ImportError> {
    let targets = primitive.targets.as_deref().unwrap_or(&[]);
    let mut read = document.context.vec(&Place::Pointer(format!("{path}/targets")), targets.len())?;
    for (number, target) in targets.iter().enumerate() {
        let column = |accessor: Option<json::Index<Accessor>>, name: &str, allowed| {
            let from = format!("{path}/targets/{number}/{name}");
            let Some(accessor) = accessor else { return Ok(Vec::new()) };
            let wrong = code::MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT;
            let source = document.source(accessor, &from, allowed, wrong)?;
            if source.count != vertices {
                let reason = format!("{} values for {vertices} vertices", source.count);
                let code = code::MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT;
                return Err(invalid(Place::Pointer(from), code, reason));
            }
            Ok(source.finite::<3>()?.into_iter().map(Vec3::from).collect())
        };
        read.push(MorphTarget {
            name: String::new(),
            positions: column(target.positions, "POSITION", ANY_VEC3)?,
            normals: column(target.normals, "NORMAL", ANY_VEC3)?,
            tangents: column(target.tangents, "TANGENT", UNIT_VEC3)?,
        });
    }
    Ok(read)
}

/// Returns the default weights of the mesh, one per target. Gives all primitives the same number of targets, and the
/// targets their names.
pub(super) fn morph_weights(
    document: &GltfDocument<'_>,
    mesh: &json::Mesh,
    primitives: &mut [Primitive],
    path: &str,
) -> Result<Vec<f32>, ImportError> {
    let context = document.context;
    let targets = primitives.iter().map(|primitive| primitive.morph_targets.len()).max().unwrap_or(0);
    let names = target_names(mesh);
    for (number, primitive) in primitives.iter_mut().enumerate() {
        if primitive.morph_targets.len() != targets {
            let place = Place::Pointer(format!("{path}/primitives/{number}/targets"));
            let text = format!("{} morph targets, {targets} in the mesh", primitive.morph_targets.len());
            context.charge(&place, (targets * size_of::<MorphTarget>()) as u64)?;
            context.warn(place, code::MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT, text);
            primitive.morph_targets.resize_with(targets, MorphTarget::default);
        }
        for (target, name) in primitive.morph_targets.iter_mut().zip(&names) {
            context.charge(&Place::Pointer(path.to_owned()), name.len() as u64)?;
            target.name.clone_from(name);
        }
    }
    let place = Place::Pointer(format!("{path}/weights"));
    fitted(mesh.weights.as_deref(), targets, &[], place, code::MESH_INVALID_WEIGHTS_COUNT, document)
}

/// Returns `weights` with one value per target; missing ones are taken from `default`, then zero.
pub(super) fn fitted(
    weights: Option<&[f32]>,
    targets: usize,
    default: &[f32],
    place: Place,
    code: &'static str,
    document: &GltfDocument<'_>,
) -> Result<Vec<f32>, ImportError> {
    let given = weights.unwrap_or(default);
    if given.iter().any(|weight| !weight.is_finite()) {
        return Err(invalid(place, code::VALUE_NOT_IN_RANGE, "a weight is not finite".to_owned()));
    }
    let mut fitted = document.context.vec(&place, targets)?;
    fitted.extend(given.iter().copied().chain(std::iter::repeat(0.0)).take(targets));
    if weights.is_some_and(|weights| weights.len() != targets) {
        document.context.warn(place, code, format!("{} weights for {targets} morph targets", given.len()));
    }
    Ok(fitted)
}

/// Longest extras that are searched for names.
const EXTRAS_BYTES: usize = 1 << 20;

/// Returns `extras.targetNames`, which is not in the specification, but which most exporters write.
fn target_names(mesh: &json::Mesh) -> Vec<String> {
    let names = |text: &str| -> Option<Vec<String>> {
        let members: HashMap<String, &RawValue> = serde_json::from_str(text).ok()?;
        let names: Vec<&RawValue> = serde_json::from_str(members.get("targetNames")?.get()).ok()?;
        Some(names.iter().map(|name| serde_json::from_str(name.get()).unwrap_or_default()).collect())
    };
    let extras = mesh.extras.as_ref().map(|extras| extras.get()).filter(|text| text.len() <= EXTRAS_BYTES);
    extras.and_then(names).unwrap_or_default()
}
