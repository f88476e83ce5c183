//! The parts of a file, in their order: the six of the thesis, then those with a tag.

use super::record::DfmRecord;
use super::{bone, image, material, mesh, scene, take, vertex};

/// A part of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DfmPart {
    Vertices,
    Indices,
    Attributes,
    Materials,
    Bones,
    Takes,
    TextLengths,
    Text,
    Meshes,
    Primitives,
    Tangents,
    Colors,
    Influences,
    MorphTargets,
    Differences,
    Weights,
    Instances,
    Skins,
    Joints,
    Images,
    ImageBytes,
    Slopes,
    MorphTracks,
    MorphKeys,
}

/// Name and element size of a part.
pub(super) struct PartLayout {
    pub(super) part: DfmPart,
    /// Tag before the part (except for those of the thesis) and in the directory.
    pub(super) tag: [u8; 4],
    /// Name in messages.
    pub(super) name: &'static str,
    /// Size of one element in bytes; for takes: of the fixed part of one.
    pub(super) size: usize,
}

const fn layout(part: DfmPart, tag: &[u8; 4], name: &'static str, size: usize) -> PartLayout {
    PartLayout { part, tag: *tag, name, size }
}

/// Every part, in the order of the file.
pub(super) const PARTS: [PartLayout; 24] = [
    layout(DfmPart::Vertices, b"VERT", "vertices", vertex::VertexRecord::SIZE),
    layout(DfmPart::Indices, b"INDX", "indices", u32::SIZE),
    layout(DfmPart::Attributes, b"ATTR", "attributes", u32::SIZE),
    layout(DfmPart::Materials, b"MATL", "materials", material::MaterialRecord::SIZE),
    layout(DfmPart::Bones, b"BONE", "bones", bone::BoneRecord::SIZE),
    layout(DfmPart::Takes, b"TAKE", "takes", take::TakeRecord::SIZE),
    layout(DfmPart::TextLengths, b"TLEN", "text lengths", u32::SIZE),
    layout(DfmPart::Text, b"TEXT", "text bytes", u8::SIZE),
    layout(DfmPart::Meshes, b"MESH", "meshes", mesh::MeshRecord::SIZE),
    layout(DfmPart::Primitives, b"PRIM", "primitives", mesh::PrimitiveRecord::SIZE),
    layout(DfmPart::Tangents, b"TANG", "tangents", glam::Vec4::SIZE),
    layout(DfmPart::Colors, b"COLR", "colors", glam::Vec4::SIZE),
    layout(DfmPart::Influences, b"INFL", "further influences", vertex::InfluenceRecord::SIZE),
    layout(DfmPart::MorphTargets, b"MORF", "morph targets", u32::SIZE),
    layout(DfmPart::Differences, b"DIFF", "differences", glam::Vec3::SIZE),
    layout(DfmPart::Weights, b"WGHT", "morph weights", f32::SIZE),
    layout(DfmPart::Instances, b"INST", "instances", scene::InstanceRecord::SIZE),
    layout(DfmPart::Skins, b"SKIN", "skins", u32::SIZE),
    layout(DfmPart::Joints, b"JOIN", "joints", scene::JointRecord::SIZE),
    layout(DfmPart::Images, b"IMAG", "images", image::ImageRecord::SIZE),
    layout(DfmPart::ImageBytes, b"IDAT", "image bytes", u8::SIZE),
    layout(DfmPart::Slopes, b"SLOP", "tangents of keys", f32::SIZE),
    layout(DfmPart::MorphTracks, b"MTRK", "morph tracks", take::MorphTrackRecord::SIZE),
    layout(DfmPart::MorphKeys, b"MKEY", "numbers of morph keys", f32::SIZE),
];

impl DfmPart {
    /// Returns the layout of the part.
    pub(super) fn layout(self) -> &'static PartLayout {
        &PARTS[self as usize]
    }

    /// Returns whether the part is one of the thesis, which have no tag.
    pub(super) fn is_of_thesis(self) -> bool {
        self as usize <= Self::Takes as usize
    }

    /// Returns the number of bytes before the first element: the tag if there is one, the count, the size; takes have
    /// three sizes.
    pub(super) fn header_bytes(self) -> usize {
        match self {
            Self::Takes => 16,
            part if part.is_of_thesis() => 8,
            _ => 12,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::PARTS;

    #[test]
    fn the_list_is_in_the_order_of_the_parts_and_tags_differ() {
        for (index, layout) in PARTS.iter().enumerate() {
            assert_eq!(layout.part as usize, index, "{}", layout.name);
            assert!(PARTS[..index].iter().all(|other| other.tag != layout.tag), "{}", layout.name);
        }
    }
}
