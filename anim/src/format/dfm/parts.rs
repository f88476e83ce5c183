//! The list of all parts, with the sizes of their elements.

use super::part::{DfmPart, PartLayout, PartList};
use super::record::DfmRecord;
use super::{bone, image, material, mesh, scene, take, vertex};

const fn layout(part: DfmPart, tag: &[u8; 4], name: &'static str, size: usize) -> PartLayout {
    PartLayout { part, tag: *tag, name, sizes: [size, 0, 0] }
}

/// Every part, in the order of the file.
pub(super) static PARTS: PartList = [
    layout(DfmPart::Vertices, b"VERT", "vertices", vertex::VertexRecord::SIZE),
    layout(DfmPart::Indices, b"INDX", "indices", u32::SIZE),
    layout(DfmPart::Attributes, b"ATTR", "attributes", u32::SIZE),
    layout(DfmPart::Materials, b"MATL", "materials", material::MaterialRecord::SIZE),
    layout(DfmPart::Bones, b"BONE", "bones", bone::BoneRecord::SIZE),
    PartLayout {
        part: DfmPart::Takes,
        tag: *b"TAKE",
        name: "takes",
        sizes: [take::TakeRecord::SIZE, take::TrackRecord::SIZE, take::KeyframeRecord::SIZE],
    },
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
