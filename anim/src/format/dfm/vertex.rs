//! Vertices as in the thesis, and the influences after the fourth.

use super::record::{DfmRecord, Put, RecordFields};
use crate::data::Influence;
use glam::{Vec2, Vec3};

/// Number of influences of a vertex in the thesis's part.
pub(super) const FIRST_INFLUENCES: usize = 4;

/// One vertex. The bones and the material repeat what other parts contain, for readers that do not read those.
#[derive(Clone, Debug)]
pub(super) struct VertexRecord {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) texture_coordinates: [Vec2; 2],
    pub(super) bones: [u32; FIRST_INFLUENCES],
    pub(super) material: u32,
    /// Joint and weight; the joint comes after the thesis's fields.
    pub(super) influences: [Influence; FIRST_INFLUENCES],
}

impl DfmRecord for VertexRecord {
    const SIZE: usize = 84;

    fn put(&self, out: &mut Vec<u8>) {
        out.floats(&self.position.to_array());
        out.floats(&self.normal.to_array());
        for set in self.texture_coordinates {
            out.floats(&set.to_array());
        }
        for bone in self.bones {
            out.u32(bone);
        }
        out.floats(&self.influences.map(|influence| influence.weight));
        out.u32(self.material);
        for influence in self.influences {
            out.extend_from_slice(&influence.joint.to_le_bytes());
        }
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (position, normal) = (fields.vec3(), fields.vec3());
        let texture_coordinates = [fields.vec2(), fields.vec2()];
        let bones = [(); FIRST_INFLUENCES].map(|()| fields.u32());
        let weights: [f32; FIRST_INFLUENCES] = fields.floats();
        let material = fields.u32();
        let influences = weights.map(|weight| Influence { joint: fields.u16(), weight });
        Ok(Self { position, normal, texture_coordinates, bones, material, influences })
    }
}

/// An influence after the fourth.
pub(super) struct InfluenceRecord(pub(super) Influence);

impl DfmRecord for InfluenceRecord {
    const SIZE: usize = 8;

    fn put(&self, out: &mut Vec<u8>) {
        out.u32(self.0.joint.into());
        out.floats(&[self.0.weight]);
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let (joint, weight) = (fields.u32(), fields.f32());
        let joint = u16::try_from(joint).map_err(|_| format!("joint {joint} does not fit 16 bits"))?;
        Ok(Self(Influence { joint, weight }))
    }
}
