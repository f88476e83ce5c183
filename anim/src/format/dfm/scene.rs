//! Skins, and the instances of meshes.

use super::code::DFM_INDEX;
use super::error::{WriteError, refuse};
use super::part::DfmPart;
use super::reader::DfmReader;
use super::record::{DfmRecord, Put, RecordFields, only_bits, or_none, some};
use super::writer::DfmWriter;
use crate::data::{BoneIndex, Mesh, MeshInstance, ModelData, Skin};
use crate::format::ImportError;
use crate::limits::JOINTS_PER_SKIN;
use glam::Mat4;

/// A joint of a skin.
pub(super) struct JointRecord {
    bone: BoneIndex,
    offset: Mat4,
}

impl DfmRecord for JointRecord {
    const SIZE: usize = 68;

    fn put(&self, out: &mut Vec<u8>) {
        out.u32(self.bone);
        out.floats(&self.offset.to_cols_array());
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        Ok(Self { bone: fields.u32(), offset: fields.mat4() })
    }
}

/// A mesh in the scene; its morph weights are stored elsewhere.
pub(super) struct InstanceRecord(MeshInstance);

impl DfmRecord for InstanceRecord {
    const SIZE: usize = 84;

    fn put(&self, out: &mut Vec<u8>) {
        let instance = &self.0;
        out.u32(instance.mesh);
        out.u32(instance.node.is_some().into());
        out.u32(instance.node.unwrap_or(0));
        out.u32(or_none(instance.skin));
        out.u32(or_none(instance.bone));
        out.floats(&instance.to_bone.to_cols_array());
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let mesh = fields.u32();
        let (flags, node) = (only_bits(fields.u32(), 1)?, fields.u32());
        let (skin, bone, to_bone) = (some(fields.u32()), some(fields.u32()), fields.mat4());
        let node = (flags == 1).then_some(node);
        Ok(Self(MeshInstance { mesh, node, skin, bone, to_bone, morph_weights: Vec::new() }))
    }
}

/// Writes every skin of `model`.
pub(super) fn write_skins(model: &ModelData, writer: &mut DfmWriter) -> Result<(), WriteError> {
    for (number, skin) in model.skins.iter().enumerate() {
        if skin.bones.len() != skin.offsets.len() {
            let reason = format!("{} offsets for {} joints", skin.offsets.len(), skin.bones.len());
            return Err(refuse(format!("/skins/{number}"), reason));
        }
        writer.text(&skin.name);
        writer.put(DfmPart::Skins, &(skin.bones.len() as u32));
        for (&bone, &offset) in skin.bones.iter().zip(&skin.offsets) {
            writer.put(DfmPart::Joints, &JointRecord { bone, offset });
        }
    }
    Ok(())
}

/// Reads every skin.
pub(super) fn read_skins(reader: &mut DfmReader<'_, '_>) -> Result<Vec<Skin>, ImportError> {
    let (count, of_skeleton) = (reader.count(DfmPart::Skins), reader.count(DfmPart::Bones));
    let mut skins = reader.vec(DfmPart::Skins, 0, count)?;
    for _ in 0..count {
        let name = reader.text()?;
        let joints = reader.get::<u32>(DfmPart::Skins)? as usize;
        reader.limit("joints", joints, JOINTS_PER_SKIN)?;
        let mut bones = reader.vec(DfmPart::Joints, 0, joints)?;
        let mut offsets = reader.vec(DfmPart::Joints, 0, joints)?;
        for _ in 0..joints {
            let joint: JointRecord = reader.get(DfmPart::Joints)?;
            if joint.bone as usize >= of_skeleton {
                return Err(reader.wrong(DFM_INDEX, format!("there is no bone {}", joint.bone)));
            }
            bones.push(joint.bone);
            offsets.push(joint.offset);
        }
        skins.push(Skin { name, bones, offsets });
    }
    Ok(skins)
}

/// Writes every instance of `model`.
pub(super) fn write_instances(model: &ModelData, writer: &mut DfmWriter) -> Result<(), WriteError> {
    for (number, instance) in model.instances.iter().enumerate() {
        let targets = model.meshes.get(instance.mesh as usize).map(|mesh| mesh.morph_weights.len());
        if targets != Some(instance.morph_weights.len()) {
            let (mesh, weights) = (instance.mesh, instance.morph_weights.len());
            let reason =
                format!("there are {weights} morph weights for the {targets:?} targets of mesh {mesh}");
            return Err(refuse(format!("/instances/{number}"), reason));
        }
        writer.put(
            DfmPart::Instances,
            &InstanceRecord(MeshInstance { morph_weights: Vec::new(), ..instance.clone() }),
        );
        writer.put_all(DfmPart::Weights, &instance.morph_weights);
    }
    Ok(())
}

/// Reads every instance; `largest_joints` contains the largest joint that each mesh refers to.
pub(super) fn read_instances(
    reader: &mut DfmReader<'_, '_>,
    meshes: &[Mesh],
    skins: &[Skin],
    largest_joints: &[Option<u16>],
) -> Result<Vec<MeshInstance>, ImportError> {
    let (count, bones) = (reader.count(DfmPart::Instances), reader.count(DfmPart::Bones));
    let mut instances = reader.vec(DfmPart::Instances, 0, count)?;
    for _ in 0..count {
        let InstanceRecord(instance) = reader.get(DfmPart::Instances)?;
        let Some(mesh) = meshes.get(instance.mesh as usize) else {
            return Err(reader.wrong(DFM_INDEX, format!("there is no mesh {}", instance.mesh)));
        };
        if let Some(bone) = instance.bone.filter(|&bone| bone as usize >= bones) {
            return Err(reader.wrong(DFM_INDEX, format!("there is no bone {bone}")));
        }
        if let Some(skin) = instance.skin {
            let joints = skins.get(skin as usize).map(|skin| skin.bones.len());
            let joints = joints.ok_or_else(|| reader.wrong(DFM_INDEX, format!("there is no skin {skin}")))?;
            let largest = largest_joints.get(instance.mesh as usize).copied().flatten();
            if let Some(largest) = largest.filter(|&largest| usize::from(largest) >= joints) {
                let reason = format!("a vertex refers to joint {largest}, skin {skin} has {joints} joints");
                return Err(reader.wrong(DFM_INDEX, reason));
            }
        }
        let morph_weights = reader.list(DfmPart::Weights, mesh.morph_weights.len())?;
        instances.push(MeshInstance { morph_weights, ..instance });
    }
    Ok(instances)
}
