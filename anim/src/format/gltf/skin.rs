//! Skins: the joints, and the transforms from bind space to them.

use super::accessor::{GltfDocument, invalid, unresolved};
use super::buffer::is_missing;
use super::check as code;
use super::node::{inverse, set_last_row};
use crate::data::{BoneIndex, Skin};
use crate::format::{ImportError, Place};
use crate::limits::JOINTS_PER_SKIN;
use glam::{Mat4, Vec4};
use gltf::json;
use gltf::json::accessor::{ComponentType, Type};
use std::collections::{HashMap, HashSet};

/// Checks the joints of every skin and sets `is_bone` for each of them.
pub(super) fn mark_joints(document: &GltfDocument<'_>, is_bone: &mut [bool]) -> Result<(), ImportError> {
    for (index, skin) in document.root.skins.iter().enumerate() {
        let path = format!("/skins/{index}/joints");
        if skin.joints.is_empty() {
            return Err(invalid(
                Place::Pointer(path),
                code::EMPTY_ENTITY,
                "the skin has no joint".to_owned(),
            ));
        }
        if skin.joints.len() > JOINTS_PER_SKIN {
            let (size, limit) = (skin.joints.len() as u64, JOINTS_PER_SKIN as u64);
            return Err(ImportError::TooLarge { place: Place::Pointer(path), what: "joints", size, limit });
        }
        document.context.work(skin.joints.len())?;
        let mut seen = document.context.vec(&Place::Pointer(path.clone()), skin.joints.len())?;
        for (number, joint) in skin.joints.iter().enumerate() {
            let marked = is_bone.get_mut(joint.value());
            *marked.ok_or_else(|| unresolved(&format!("{path}/{number}"), joint.value()))? = true;
            seen.push(joint.value());
        }
        seen.sort_unstable();
        if seen.windows(2).any(|pair| pair[0] == pair[1]) {
            document.context.warn(Place::Pointer(path), code::DUPLICATE_ELEMENTS, "a joint is listed twice");
        }
    }
    Ok(())
}

/// The skins of a model, and the number in this list for each skin of the file.
#[derive(Default)]
pub(super) struct Skins {
    pub(super) skins: Vec<Skin>,
    pub(super) numbers: Vec<u32>,
}

/// Bytes that posing one more joint needs after the import: its matrix on both processors. Charged here, because a file
/// lists a joint with two bytes.
const POSED_BYTES: usize = size_of::<Mat4>() + 12 * size_of::<f32>();

/// The nodes and the scene, as far as skins need them.
pub(super) struct SkinNodes<'a> {
    /// Bone of each node.
    pub(super) bones: &'a [Option<BoneIndex>],
    /// Transform of each node to the scene, at rest.
    pub(super) globals: &'a [Mat4],
    /// Whether each skin of the file is shown.
    pub(super) is_shown: &'a [bool],
}

/// Returns all skins. Skins of a file with the same name, joints and matrices become one. One that is not shown gets
/// matrices that deform nothing at rest, with a warning, if its buffer is missing.
pub(super) fn skins(document: &GltfDocument<'_>, nodes: &SkinNodes<'_>) -> Result<Skins, ImportError> {
    let context = document.context;
    let place = Place::Pointer("/skins".to_owned());
    let mut skins = Vec::new();
    let mut numbers = context.vec(&place, document.root.skins.len())?;
    let key = |skin: &'_ json::Skin| skin.inverse_bind_matrices.map(|accessor| accessor.value());
    let shown = document.root.skins.iter().zip(nodes.is_shown).filter(|(_, is_shown)| **is_shown);
    let shown: HashSet<_> = shown.map(|(skin, _)| (&skin.joints, key(skin), &skin.name)).collect();
    let mut known = HashMap::new();
    for (index, skin) in document.root.skins.iter().enumerate() {
        let place = Place::Pointer(format!("/skins/{index}/joints"));
        context.work(skin.joints.len())?;
        let next = skins.len() as u32;
        let number = *known.entry((&skin.joints, key(skin), &skin.name)).or_insert(next);
        numbers.push(number);
        if number != next {
            continue;
        }
        context.charge(&place, (2 * size_of::<Skin>() + POSED_BYTES * skin.joints.len()) as u64)?;
        let mut joints = context.vec(&place, skin.joints.len())?;
        joints.extend(
            skin.joints
                .iter()
                .map(|joint| nodes.bones[joint.value()].expect("every joint was marked as a bone")),
        );
        let name = skin.name.clone().unwrap_or_default();
        let offsets = match offsets(document, skin, index) {
            Err(error) if is_missing(&error) && !shown.contains(&(&skin.joints, key(skin), &skin.name)) => {
                let text = format!("the skin is not shown and deforms nothing at rest: {error}");
                context.warn(place.clone(), error.code(), text);
                let mut resting = context.vec(&place, skin.joints.len())?;
                let to_scene = skin.joints.iter().map(|joint| nodes.globals[joint.value()]);
                resting.extend(to_scene.map(|matrix| inverse(matrix).unwrap_or(Mat4::IDENTITY)));
                resting
            }
            offsets => offsets?,
        };
        skins.push(Skin { name, bones: joints, offsets });
    }
    Ok(Skins { skins, numbers })
}

/// Returns the inverse bind matrices, one per joint; identities if the skin has none.
fn offsets(document: &GltfDocument<'_>, skin: &json::Skin, index: usize) -> Result<Vec<Mat4>, ImportError> {
    let path = format!("/skins/{index}/inverseBindMatrices");
    let place = Place::Pointer(path.clone());
    let context = document.context;
    let Some(accessor) = skin.inverse_bind_matrices else {
        return context.filled(&place, skin.joints.len(), Mat4::IDENTITY);
    };
    let allowed = [(ComponentType::F32, Type::Mat4, false)];
    let source = document.source(accessor, &path, &allowed, code::SKIN_IBM_INVALID_FORMAT)?;
    if source.count < skin.joints.len() {
        let reason = format!("{} matrices for {} joints", source.count, skin.joints.len());
        return Err(invalid(place, code::INVALID_IBM_ACCESSOR_COUNT, reason));
    }
    let values = source.finite::<16>()?;
    let mut matrices = context.vec(&place, skin.joints.len())?;
    let (mut singular, mut skewed) = (0, 0);
    for value in values.iter().take(skin.joints.len()) {
        let mut matrix = Mat4::from_cols_array(value);
        skewed += usize::from(!matrix.row(3).abs_diff_eq(Vec4::W, 1e-5));
        set_last_row(&mut matrix);
        if inverse(matrix).is_none() {
            singular += 1;
            matrix = Mat4::IDENTITY;
        }
        matrices.push(matrix);
    }
    if singular > 0 {
        let text = format!("{singular} matrices cannot be inverted; the identity is used instead");
        context.warn(place.clone(), code::ACCESSOR_INVALID_IBM, text);
    }
    if skewed > 0 {
        let text = format!("the last row of {skewed} matrices should be 0 0 0 1 and was replaced by that");
        context.warn(place, code::ACCESSOR_INVALID_IBM, text);
    }
    Ok(matrices)
}
