//! Small models made in code: a ball, a sheet, and skeletons as tests need them.

use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::data::*;
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{Cancel, DecodedImage, LoadedModel};
use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use image::{ImageFormat, RgbaImage};
use std::f32::consts::{PI, TAU};
use std::io::Cursor;
use std::sync::Arc;

/// Returns `model` as if it had been loaded, with images of these pixels.
pub fn loaded(mut model: ModelData, images: Vec<DecodedImage>) -> Arc<LoadedModel> {
    model.images = images.into_iter().map(encoded).collect();
    let (images, warnings) = ImageSurvey::new(&model.images, u64::MAX, &Cancel::default());
    let model = Arc::new(model);
    Arc::new(LoadedModel {
        conversion: Default::default(),
        bounds: bounds_of_pose(&model, None, 0.0),
        title: "Made".to_owned(),
        path: None,
        format: None,
        model,
        images,
        warnings,
        notes: Vec::new(),
    })
}

/// Returns an image as a file has it.
fn encoded(image: DecodedImage) -> Image {
    let pixels = RgbaImage::from_raw(image.width, image.height, image.pixels).expect("all of its pixels");
    let mut png = Cursor::new(Vec::new());
    pixels.write_to(&mut png, ImageFormat::Png).expect("an image that can be encoded");
    Image { bytes: png.into_inner().into(), ..Image::default() }
}

/// Returns each primitive as a mesh that does not move.
pub fn standing(primitives: Vec<Primitive>, materials: Vec<Material>) -> ModelData {
    ModelData {
        instances: (0..primitives.len() as u32).map(|mesh| instance(mesh, None, None)).collect(),
        meshes: primitives.into_iter().map(mesh).collect(),
        materials,
        ..ModelData::default()
    }
}

/// Returns a mesh of one primitive.
pub fn mesh(primitive: Primitive) -> Mesh {
    Mesh { name: String::new(), primitives: vec![primitive], morph_weights: Vec::new() }
}

/// Returns an instance of a mesh.
pub fn instance(mesh: u32, skin: Option<u32>, bone: Option<BoneIndex>) -> MeshInstance {
    MeshInstance { mesh, node: None, skin, bone, to_bone: Mat4::IDENTITY, morph_weights: Vec::new() }
}

/// Returns a material that is not metallic and slightly shiny.
pub fn paint(base_color: Vec4) -> Material {
    Material { base_color, metallic: Metallic { metallic: 0.0, roughness: 0.5 }, ..Material::default() }
}

/// Returns a ball of radius 1 around the origin with every column except colors and influences; material 0.
pub fn ball() -> Primitive {
    const RINGS: u32 = 16;
    const SIDES: u32 = 24;
    let mut vertices = Vertices::default();
    let mut indices = Vec::new();
    for ring in 0..=RINGS {
        let v = ring as f32 / RINGS as f32;
        let (across, up) = (v * PI).sin_cos();
        for side in 0..=SIDES {
            let u = side as f32 / SIDES as f32;
            let (sin, cos) = (u * TAU).sin_cos();
            let normal = Vec3::new(across * cos, up, -across * sin);
            vertices.positions.push(normal);
            vertices.normals.push(normal);
            vertices.tangents.push(Vec4::new(-sin, 0.0, -cos, 1.0));
            vertices.texture_coordinates[0].push(Vec2::new(u, v));
            if ring < RINGS && side < SIDES {
                let a = ring * (SIDES + 1) + side;
                let c = a + SIDES + 1;
                indices.extend([a, c, a + 1, a + 1, c, c + 1]);
            }
        }
    }
    Primitive { vertices, indices, material: Some(0), morph_targets: Vec::new() }
}

/// Returns a square from -1 to 1 that faces +Z; texture coordinates start at its upper left; material 0.
pub fn sheet() -> Primitive {
    let corners = [Vec2::ZERO, Vec2::Y, Vec2::ONE, Vec2::X];
    let vertices = Vertices {
        positions: corners.map(|at| Vec3::new(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        texture_coordinates: [corners.to_vec(), Vec::new()],
        ..Vertices::default()
    };
    Primitive { vertices, indices: vec![0, 1, 2, 0, 2, 3], material: Some(0), morph_targets: Vec::new() }
}

/// Returns bones in a row, each the child of the one before and `step` away from it, and a take of one second in
/// which each moves from rest to `end(index)`.
pub fn chain(count: u32, step: Vec3, end: impl Fn(u32) -> Transform) -> AnimationData {
    let rest = |index| if index == 0 { Vec3::ZERO } else { step };
    let bones = (0..count).map(|index| Bone {
        name: format!("bone {index}"),
        parent: index.checked_sub(1),
        rest: Transform { translation: rest(index), ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::from_translation(-step * index as f32),
        node: None,
    });
    let track = |bone| {
        let end = end(bone);
        Track {
            bone,
            translation: channel([rest(bone), rest(bone) + end.translation]),
            rotation: channel([Quat::IDENTITY, end.rotation]),
            scale: channel([Vec3::ONE, end.scale]),
        }
    };
    let take = Take {
        name: "to the end".to_owned(),
        start: 0.0,
        length: 1.0,
        tracks: (0..count).map(track).collect(),
        ..Take::default()
    };
    AnimationData { skeleton: Arc::new(Skeleton { bones: bones.collect() }), takes: vec![Arc::new(take)] }
}

fn channel<T: Copy>(keys: [T; 2]) -> Channel<T> {
    Channel::new(vec![0.0, 1.0], keys.to_vec(), Interpolation::Linear)
}
