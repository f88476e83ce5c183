//! Materials of MTL files, and their textures.

use super::import;
use crate::doors::MemoryFs;
use dragonfly_anim::data::{AlphaMode, Material};
use dragonfly_anim::format::{ReadOptions, obj::OBJ};
use glam::{Vec3, Vec4};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl one\nf 1 2 3\n";

/// Reads a triangle with the material `one` of this text; returns it, the warnings and the paths that were read.
fn read(mtllib: &str, files: &[(&str, &[u8])]) -> (Material, Vec<String>, Vec<String>) {
    let door = MemoryFs::with(files);
    let text = format!("mtllib {mtllib}\n{TRIANGLE}");
    let imported = OBJ.import(text.as_bytes(), &door, &ReadOptions::default()).unwrap();
    let warnings = imported.warnings.iter().map(ToString::to_string).collect();
    (imported.model.materials[0].clone(), warnings, door.asked())
}

#[test]
fn colors_exponents_and_transparency_become_phong_values() {
    let text = "newmtl other\nKd 9 9 9\nnewmtl one\nKa 1 1 1\nKd 0.5 0.25 0\nKs 0.1\nNs 50\nKe 0 0 2\nTr 0.25\nillum 2\n";
    let (material, warnings, _) = read("a.mtl", &[("a.mtl", text.as_bytes())]);
    assert_eq!(warnings, [""; 0]);
    assert_eq!(material.base_color, Vec4::new(0.5, 0.25, 0.0, 0.75));
    assert_eq!(
        (material.alpha_mode, material.use_phong, material.double_sided),
        (AlphaMode::Blend, true, true)
    );
    assert_eq!(material.phong.diffuse, Vec3::new(0.5, 0.25, 0.0));
    assert_eq!(material.phong.ambient, Vec3::new(0.1, 0.05, 0.0), "white means the color of Kd");
    assert_eq!((material.phong.specular, material.phong.specular_power), (Vec3::splat(0.1), 50.0));
    assert_eq!(material.emissive, Vec3::Z);
    assert!((material.metallic.roughness - 0.4429).abs() < 1e-3 && material.metallic.metallic == 0.0);
    let (material, ..) = read("a.mtl", &[("a.mtl", b"newmtl one\nPr 0.3\nPm 1\nd 1\n")]);
    assert_eq!((material.metallic.metallic, material.metallic.roughness), (1.0, 0.3));
    assert!(!material.use_phong && material.alpha_mode == AlphaMode::Opaque);
}

#[test]
fn textures_are_read_through_the_door_of_the_model_once_each() {
    // The head of an image of 2 × 3 pixels; nothing is decoded.
    let png = [b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".as_slice(), &[0, 0, 0, 2, 0, 0, 0, 3]].concat();
    let text = "newmtl one\nKd 0 0 0\nmap_Kd -s 1 1 1 -o 0.5 .\\textures\\the skin.png\nmap_Bump -bm 0.5 C:\\work\\n 100%.png\n\
                map_Ke textures/the skin.png\nmap_d alpha.png\n";
    let files: &[(&str, &[u8])] =
        &[("my file.mtl", text.as_bytes()), ("textures/the skin.png", &png), ("n 100%.png", &png)];
    let (material, warnings, asked) = read("my file.mtl", files);
    assert_eq!(asked, ["my file.mtl", "textures/the skin.png", "n 100%.png"]);
    assert_eq!(warnings, ["line 6 column 1: my file.mtl: the texture map_d is not shown"]);
    assert_eq!(material.base_color, Vec4::ONE, "black under a texture");
    assert_eq!(material.base_color_texture.unwrap().image, material.emissive_texture.unwrap().image);
    assert_eq!((material.normal_texture.unwrap().image, material.normal_scale), (1, 0.5));
}

#[test]
fn missing_files_and_bad_values_are_warnings() {
    let (material, warnings, asked) =
        read("a.mtl b.mtl", &[("b.mtl", b"newmtl one\nKd red\nmap_Kd no.png\nmap_Ke ../up.png\n")]);
    assert_eq!(asked, ["a.mtl b.mtl", "a.mtl", "b.mtl", "no.png"]);
    assert_eq!(
        warnings,
        [
            "line 2 column 1: b.mtl: the values of kd are not numbers in range",
            "line 3 column 1: \"no.png\": there is no such file; the image is left empty",
            "line 4 column 1: \"../up.png\": the path leaves the folder; the image is left empty",
        ]
    );
    assert_eq!(material.base_color, Vec4::new(0.8, 0.8, 0.8, 1.0));
    let imported = import(format!("mtllib gone.mtl\n{TRIANGLE}")).unwrap();
    let warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        warnings,
        [
            "line 1 column 1: \"gone.mtl\": there is no such file; its materials are gray",
            "line 5 column 1: no file has the material \"one\"; it is gray"
        ]
    );
}
