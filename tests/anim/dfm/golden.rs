//! One small file written out number by number, so that the layout is fixed by something other than the code.

use super::frame::checksum;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Influence, Interpolation, Material, Mesh, MeshInstance, ModelData, Phong,
    Primitive, Skeleton, Skin, Take, Track, Transform, Vertices,
};
use dragonfly_anim::format::dfm;
use glam::{Mat4, Quat, Vec2, Vec3};
use std::sync::Arc;

/// A triangle, two bones, a skin, a material, and a take that rotates the second bone.
pub(crate) fn model() -> ModelData {
    let bone = |name: &str, parent, translation, offset| Bone {
        name: name.to_owned(),
        parent,
        rest: Transform { translation, ..Transform::IDENTITY },
        rest_matrix: None,
        offset,
        node: None,
    };
    let bones = vec![
        bone("hip", None, Vec3::ZERO, Mat4::IDENTITY),
        bone("knee", Some(0), Vec3::Y, Mat4::from_translation(Vec3::NEG_Y)),
    ];
    let influences = |joints: [u16; 2], weights: [f32; 2]| {
        [(joints[0], weights[0]), (joints[1], weights[1]), (0, 0.0), (0, 0.0)]
            .map(|(joint, weight)| Influence { joint, weight })
    };
    // The skin has its bones in reverse order: joint 0 is bone 1.
    let influences =
        [influences([1, 0], [1.0, 0.0]), influences([0, 1], [0.75, 0.25]), influences([0, 0], [1.0, 0.0])];
    let primitive = Primitive {
        vertices: Vertices {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            texture_coordinates: [vec![Vec2::ZERO, Vec2::X, Vec2::Y], Vec::new()],
            influences: influences.concat(),
            influences_per_vertex: 4,
            ..Vertices::default()
        },
        indices: vec![0, 1, 2],
        material: Some(0),
        morph_targets: Vec::new(),
    };
    let phong = Phong {
        ambient: Vec3::splat(0.25),
        diffuse: Vec3::new(1.0, 0.5, 0.0),
        specular: Vec3::ONE,
        specular_power: 8.0,
    };
    let knee = Track {
        bone: 1,
        translation: Channel::new([0.0], [Vec3::Y], Interpolation::Step),
        rotation: Channel::new(
            [0.0, 2.0],
            [Quat::IDENTITY, Quat::from_xyzw(1.0, 0.0, 0.0, 0.0)],
            Interpolation::Linear,
        ),
        scale: Channel::default(),
    };
    let take = Take {
        name: "bend".to_owned(),
        start: 0.0,
        length: 2.0,
        tracks: vec![Track::default(), knee],
        ..Take::default()
    };
    ModelData {
        avatar: Default::default(),
        name: "leg".to_owned(),
        meshes: vec![Mesh {
            name: "skin".to_owned(),
            primitives: vec![primitive],
            morph_weights: Vec::new(),
        }],
        instances: vec![MeshInstance {
            mesh: 0,
            node: Some(7),
            skin: Some(0),
            bone: None,
            to_bone: Mat4::IDENTITY,
            morph_weights: Vec::new(),
        }],
        skins: vec![Skin {
            name: String::new(),
            bones: vec![1, 0],
            offsets: vec![Mat4::from_translation(Vec3::NEG_Y), Mat4::IDENTITY],
        }],
        materials: vec![Material { name: "red".to_owned(), phong, use_phong: true, ..Material::default() }],
        images: Vec::new(),
        animation: AnimationData { skeleton: Arc::new(Skeleton { bones }), takes: vec![Arc::new(take)] },
    }
}

/// A file that is being written.
#[derive(Default)]
struct ByteFile {
    bytes: Vec<u8>,
    /// Tags and offsets of the parts.
    parts: Vec<([u8; 4], usize)>,
}

const NONE: u32 = 0xffff_ffff;

impl ByteFile {
    fn u(&mut self, numbers: &[u32]) -> &mut Self {
        self.bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        self
    }

    fn f(&mut self, numbers: &[f32]) -> &mut Self {
        self.bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        self
    }

    /// Starts a part of the thesis: no tag is written.
    fn thesis(&mut self, tag: &[u8; 4]) -> &mut Self {
        self.parts.push((*tag, self.bytes.len()));
        self
    }

    /// Starts a part with its tag, count and size.
    fn part(&mut self, tag: &[u8; 4], count: u32, size: u32) -> &mut Self {
        self.thesis(tag);
        self.bytes.extend_from_slice(tag);
        self.u(&[count, size])
    }

    fn identity(&mut self) -> &mut Self {
        self.f(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.])
    }

    /// Writes a matrix that moves one unit down.
    fn down(&mut self) -> &mut Self {
        self.f(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., -1., 0., 1.])
    }

    fn vertex(
        &mut self,
        position: [f32; 3],
        uv: [f32; 2],
        bones: [u32; 2],
        weights: [f32; 2],
        joints: [u32; 2],
    ) {
        self.f(&position).f(&[0., 0., 1.]).f(&uv).f(&[0., 0.]);
        self.u(&[bones[0], bones[1], 1, 1]).f(&[weights[0], weights[1], 0., 0.]).u(&[0]);
        // Four joints of 16 bits.
        self.u(&[joints[0] | joints[1] << 16, 0]);
    }
}

/// Returns the file of [`model`].
pub(crate) fn file() -> Vec<u8> {
    let mut out = ByteFile::default();
    // 1) The total number of bytes, overwritten at the end.
    out.u(&[0]);
    // 2) Vertices.
    out.thesis(b"VERT").u(&[3, 84]);
    out.vertex([0., 0., 0.], [0., 0.], [0, 1], [1., 0.], [1, 0]);
    out.vertex([1., 0., 0.], [1., 0.], [1, 0], [0.75, 0.25], [0, 1]);
    out.vertex([0., 1., 0.], [0., 1.], [1, 1], [1., 0.], [0, 0]);
    // 3) Indices.
    out.thesis(b"INDX").u(&[3, 4]).u(&[0, 1, 2]);
    // 4) Attributes.
    out.thesis(b"ATTR").u(&[3, 4]).u(&[0, 0, 0]);
    // 5) Materials: diffuse, ambient, specular, power, image; base color, metallic, roughness, emissive, normal scale,
    // occlusion strength, alpha mode and cut-off, flags, five textures.
    out.thesis(b"MATL").u(&[1, 280]);
    out.f(&[1., 0.5, 0.]).f(&[0.25, 0.25, 0.25]).f(&[1., 1., 1.]).f(&[8.]).u(&[NONE]);
    out.f(&[1., 1., 1., 1.]).f(&[1., 1.]).f(&[0., 0., 0.]).f(&[1., 1.]).u(&[0, 0]).u(&[1]);
    for _ in 0..5 {
        out.u(&[NONE, 0, 0, 0, 0, 0, 0, 0, 0]);
    }
    // 6) Bones: parent, index, offset; flags, node, translation, scale, rotation, rest matrix.
    out.thesis(b"BONE").u(&[2, 184]);
    out.u(&[NONE, 0]).identity().u(&[0, 0]).f(&[0., 0., 0., 1., 1., 1., 0., 0., 0., 1.]).f(&[0.; 16]);
    out.u(&[0, 1]).down().u(&[0, 0]).f(&[0., 1., 0., 1., 1., 1., 0., 0., 0., 1.]).f(&[0.; 16]);
    // 7) Takes: start, length, tracks; morph tracks. Tracks: bone, key-frames; interpolations.
    out.thesis(b"TAKE").u(&[1, 16, 12, 48]);
    out.f(&[0., 2.]).u(&[2, 0]);
    out.u(&[0, 0, 0x0001_0101]);
    out.u(&[1, 2, 0x0001_0100]);
    // Key-frames: time, translation, scale, rotation; which are keys. The second has no translation key: the value is
    // kept.
    out.f(&[0., 0., 1., 0., 1., 1., 1., 0., 0., 0., 1.]).u(&[3]);
    out.f(&[2., 0., 1., 0., 1., 1., 1., 1., 0., 0., 0.]).u(&[2]);
    // The rest: name of the model, material, bones, skin, mesh, take.
    out.part(b"TLEN", 7, 4).u(&[3, 3, 3, 4, 0, 4, 4]);
    out.part(b"TEXT", 21, 1).bytes.extend_from_slice(b"legredhipkneeskinbend");
    out.part(b"MESH", 1, 8).u(&[1, 0]);
    out.part(b"PRIM", 1, 20).u(&[3, 3, 0, 1 | 2, 4]);
    out.part(b"TANG", 0, 16)
        .part(b"COLR", 0, 16)
        .part(b"INFL", 0, 8)
        .part(b"MORF", 0, 4)
        .part(b"DIFF", 0, 12);
    out.part(b"WGHT", 0, 4);
    out.part(b"INST", 1, 84).u(&[0, 1, 7, 0, NONE]).identity();
    out.part(b"SKIN", 1, 4).u(&[2]);
    out.part(b"JOIN", 2, 68).u(&[1]).down().u(&[0]).identity();
    out.part(b"IMAG", 0, 16).part(b"IDAT", 0, 1).part(b"SLOP", 0, 4).part(b"MTRK", 0, 16).part(b"MKEY", 0, 4);
    // The directory of the parts, and the ending.
    let directory = out.bytes.len();
    let parts = std::mem::take(&mut out.parts);
    out.part(b"SUMS", 24, 16);
    for (index, (tag, at)) in parts.iter().enumerate() {
        let end = parts.get(index + 1).map_or(directory, |next| next.1);
        let sum = checksum(&out.bytes[*at..end]);
        out.bytes.extend_from_slice(tag);
        out.u(&[*at as u32, (end - at) as u32, sum]);
    }
    out.u(&[directory as u32, 1]);
    let sum = checksum(&out.bytes[directory..]);
    out.u(&[sum]).bytes.extend_from_slice(b"dfm\x1a");
    let total = out.bytes.len() as u32;
    out.bytes[..4].copy_from_slice(&total.to_le_bytes());
    out.bytes
}

#[test]
fn a_small_model_is_written_as_exactly_the_bytes_of_the_layout() {
    let (expected, got) = (file(), dfm::write(&model()).unwrap());
    let first = expected.iter().zip(&got).position(|(expected, got)| expected != got);
    assert_eq!(first, None, "the first byte that differs");
    assert_eq!(expected.len(), got.len());
    assert_eq!(dfm::read(&expected).unwrap(), model());
}
