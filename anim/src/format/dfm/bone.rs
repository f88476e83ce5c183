//! Bones: the thesis's parent, index and binding pose, then the rest pose and the node.

use super::code::DFM_INDEX;
use super::part::DfmPart;
use super::reader::DfmReader;
use super::record::{DfmRecord, Put, RecordFields, only_bits, or_none, some};
use super::writer::DfmWriter;
use crate::data::{Bone, ModelData, Skeleton, Transform};
use crate::format::ImportError;
use crate::limits::{NODE_DEPTH, NODES};
use glam::Mat4;

const HAS_NODE: u32 = 1;
const HAS_REST_MATRIX: u32 = 2;

/// A bone without its name.
pub(super) struct BoneRecord {
    index: u32,
    bone: Bone,
}

impl DfmRecord for BoneRecord {
    const SIZE: usize = 184;

    fn put(&self, out: &mut Vec<u8>) {
        let bone = &self.bone;
        out.u32(or_none(bone.parent));
        out.u32(self.index);
        out.floats(&bone.offset.to_cols_array());
        let flags = [(bone.node.is_some(), HAS_NODE), (bone.rest_matrix.is_some(), HAS_REST_MATRIX)];
        out.u32(flags.iter().filter(|(set, _)| *set).map(|(_, bit)| bit).sum());
        out.u32(bone.node.unwrap_or(0));
        put_pose(&bone.rest, out);
        out.floats(&bone.rest_matrix.unwrap_or(Mat4::ZERO).to_cols_array());
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (parent, index, offset) = (some(fields.u32()), fields.u32(), fields.mat4());
        let (flags, node) = (only_bits(fields.u32(), HAS_NODE | HAS_REST_MATRIX)?, fields.u32());
        let rest = get_pose(fields);
        let rest_matrix = fields.mat4();
        let bone = Bone {
            name: String::new(),
            parent,
            rest,
            rest_matrix: (flags & HAS_REST_MATRIX != 0).then_some(rest_matrix),
            offset,
            node: (flags & HAS_NODE != 0).then_some(node),
        };
        Ok(Self { index, bone })
    }
}

/// Writes translation, scale and rotation, in the thesis's order.
pub(super) fn put_pose(pose: &Transform, out: &mut Vec<u8>) {
    out.floats(&pose.translation.to_array());
    out.floats(&pose.scale.to_array());
    out.floats(&pose.rotation.to_array());
}

/// Reads what [`put_pose`] wrote.
pub(super) fn get_pose(fields: &mut RecordFields<'_>) -> Transform {
    let (translation, scale, rotation) = (fields.vec3(), fields.vec3(), fields.quat());
    Transform { translation, rotation, scale }
}

/// Writes the skeleton of `model`.
pub(super) fn write(model: &ModelData, writer: &mut DfmWriter) {
    for (index, bone) in model.animation.skeleton.bones.iter().enumerate() {
        writer.text(&bone.name);
        let bone = Bone { name: String::new(), ..bone.clone() };
        writer.put(DfmPart::Bones, &BoneRecord { index: index as u32, bone });
    }
}

/// Reads the skeleton, in which every parent must come before its children, so that there is no cycle.
pub(super) fn read(reader: &mut DfmReader<'_, '_>) -> Result<Skeleton, ImportError> {
    let count = reader.count(DfmPart::Bones);
    reader.limit("bones", count, NODES)?;
    let mut bones: Vec<Bone> = reader.vec(DfmPart::Bones, 0, count)?;
    let mut depths: Vec<u32> = reader.vec(DfmPart::Bones, 0, count)?;
    for position in 0..count {
        let name = reader.text()?;
        let BoneRecord { index, bone } = reader.get(DfmPart::Bones)?;
        if index as usize != position {
            return Err(reader.wrong(DFM_INDEX, format!("bone {position} has the index {index}")));
        }
        let depth = match bone.parent {
            None => 1,
            Some(parent) => match depths.get(parent as usize) {
                Some(depth) => depth + 1,
                None => {
                    let reason = format!("parent {parent} does not come before its child {position}");
                    return Err(reader.wrong(DFM_INDEX, reason));
                }
            },
        };
        reader.limit("levels of bones", depth, NODE_DEPTH)?;
        depths.push(depth);
        bones.push(Bone { name, ..bone });
    }
    Ok(Skeleton { bones })
}
