//! Bones: offsets and parents.

use super::check as code;
use super::scan::M3dScanner;
use crate::data::{Bone, Skeleton, Transform};
use crate::format::matrices::{inverse, split};
use crate::format::{AxisMap, ImportContext, ImportError};
use crate::limits::HUGE;
use glam::{Mat4, Vec4};

/// Bytes of the shortest bone: its offset and its parent.
pub(super) const BONE_BYTES: usize = 38;

/// A bone, as in the file.
pub(super) struct M3dBone {
    /// Mesh space → bone space.
    pub(super) offset: Mat4,
    pub(super) parent: Option<u32>,
}

/// Reads the sections of the offsets and of the hierarchy.
pub(super) fn bones(
    scanner: &mut M3dScanner<'_>,
    count: usize,
    context: &ImportContext<'_>,
) -> Result<Vec<M3dBone>, ImportError> {
    scanner.label("the section BoneOffsets")?;
    let mut bones = context.vec(&scanner.place(scanner.at()), count)?;
    for number in 0..count {
        context.work(16)?;
        scanner.label("the offset of a bone")?;
        let at = scanner.at();
        let mut offset = Mat4::from_cols_array(&scanner.floats::<16>("the offset of a bone")?);
        if !offset.row(3).abs_diff_eq(Vec4::W, 1e-5) {
            let text =
                format!("the last column of offset {number} should be 0 0 0 1 and was replaced by that");
            context.warn(scanner.place(at), code::OFFSET_INVALID, text);
        }
        (offset.x_axis.w, offset.y_axis.w, offset.z_axis.w, offset.w_axis.w) = (0.0, 0.0, 0.0, 1.0);
        let largest =
            offset.to_cols_array().into_iter().fold(0.0_f32, |largest, number| largest.max(number.abs()));
        if largest > HUGE {
            return Err(scanner.invalid(at, code::HUGE_POSITION, "the offset is too large"));
        }
        bones.push(M3dBone { offset, parent: None });
    }
    scanner.label("the section BoneHierarchy")?;
    for number in 0..count {
        context.work(2)?;
        scanner.label("the parent of a bone")?;
        let token = scanner.word("the parent of a bone")?;
        if token.text == b"-1" {
            continue;
        }
        scanner.go_to(token.at);
        let (parent, _) = scanner.whole("the parent of a bone", u64::from(u32::MAX))?;
        if parent >= number as u64 {
            let (code, reason) = if parent < count as u64 {
                (
                    code::PARENT_LATER,
                    format!("the parent of bone {number} is bone {parent}, which has to come before it"),
                )
            } else {
                (
                    code::INDEX_OUT_OF_RANGE,
                    format!("the parent of bone {number} is bone {parent}, there are {count}"),
                )
            };
            return Err(scanner.invalid(token.at, code, reason));
        }
        bones[number].parent = Some(parent as u32);
    }
    Ok(bones)
}

/// Returns the skeleton. The file has no rest pose: at rest, every bone is where its offset leads to bone space from.
pub(super) fn skeleton(
    bones: &[M3dBone],
    axes: &AxisMap,
    scanner: &M3dScanner<'_>,
    context: &ImportContext<'_>,
) -> Result<Skeleton, ImportError> {
    let place = scanner.place(scanner.at());
    let mut list = context.vec(&place, bones.len())?;
    let mut to_roots = context.vec(&place, bones.len())?;
    for (number, bone) in bones.iter().enumerate() {
        context.work(4)?;
        context.charge(&place, 16)?;
        let offset = axes.matrix(bone.offset);
        let parent = bone.parent.map(|parent| &bones[parent as usize]);
        let to_root = inverse(offset);
        if to_root.is_none() {
            let text =
                format!("the offset of bone {number} has no inverse; the bone is at its parent at rest");
            context.warn(place.clone(), code::OFFSET_INVALID, text);
        }
        let parent_to_root = bone.parent.map_or(Mat4::IDENTITY, |parent| to_roots[parent as usize]);
        // The offset of the parent leads from the scene to the parent.
        let to_parent = match (parent, to_root) {
            (None, to_root) => to_root,
            (Some(parent), Some(to_root)) => {
                let back = inverse(parent_to_root).unwrap_or_else(|| axes.matrix(parent.offset));
                Some((back.as_dmat4() * to_root.as_dmat4()).as_mat4())
            }
            (Some(_), None) => None,
        };
        let parts = to_parent.filter(Mat4::is_finite).and_then(split);
        let (rest, rest_matrix) = parts.unwrap_or((Transform::IDENTITY, None));
        let own = rest_matrix.unwrap_or_else(|| rest.to_matrix());
        let to_root = to_root.unwrap_or(parent_to_root * own);
        if !to_root.is_finite() {
            let reason = format!("the rest pose of bone {number} is too large");
            return Err(scanner.invalid(scanner.at(), code::HUGE_POSITION, reason));
        }
        to_roots.push(to_root);
        list.push(Bone {
            name: format!("bone{number}"),
            parent: bone.parent,
            rest,
            rest_matrix,
            offset,
            node: None,
        });
    }
    Ok(Skeleton { bones: list })
}
