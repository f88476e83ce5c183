//! Textures of materials are those of the file, for every texture slot.

use crate::fixture::Fixture;
use dragonfly_anim::data::{TextureRef, TextureTransform};
use dragonfly_anim::format::{self, NoFiles, ReadOptions};
use glam::Vec2;
use serde_json::json;

fn textures(transform: serde_json::Value) -> Result<[Option<TextureRef>; 5], format::ImportError> {
    let mut fixture = Fixture::new();
    let texture = json!({"index": 0, "extensions": {"KHR_texture_transform": transform}});
    fixture.set("/extensionsUsed", json!(["KHR_texture_transform"]));
    fixture.set(
        "/materials",
        json!([{"pbrMetallicRoughness": {"baseColorTexture": texture, "metallicRoughnessTexture": texture},
            "normalTexture": texture, "occlusionTexture": texture, "emissiveTexture": texture}]),
    );
    let read = format::read("fixture.glb", &fixture.glb(), &NoFiles, &ReadOptions::default())?;
    let material = read.model.materials[0].clone();
    Ok([
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.occlusion_texture,
        material.emissive_texture,
    ])
}

#[test]
fn every_texture_of_a_material_keeps_its_transform() {
    let transform = json!({"offset": [0.25, 0.5], "rotation": 0.75, "scale": [2.0, 3.0], "texCoord": 1});
    let expected =
        TextureTransform { offset: Vec2::new(0.25, 0.5), rotation: 0.75, scale: Vec2::new(2.0, 3.0) };
    for texture in textures(transform).expect("a valid file") {
        let texture = texture.expect("the texture is there");
        assert_eq!(texture.transform, expected);
        assert_eq!(texture.set, 1);
    }
}

#[test]
fn a_transform_of_the_wrong_type_is_refused_with_its_place() {
    let error = textures(json!({"offset": "left"})).expect_err("a text is not an offset");
    assert!(error.to_string().contains("/materials/0"), "{error}");
}
