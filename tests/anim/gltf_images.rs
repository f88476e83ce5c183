//! Images in formats that glTF allows by an extension: WebP and KTX 2 are read and written.

use crate::fixture::Fixture;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::uri::DataUri;
use dragonfly_anim::format::{Imported, NoFiles, ReadOptions, gltf, read};
use dragonfly_kit::folder::data;
use serde_json::{Value, json};

/// Images of one pixel, made by the encoder of WebP: lossy, lossless, with alpha (those of Modernizr, MIT).
const ONE_PIXEL: [&str; 3] = [
    "UklGRiIAAABXRUJQVlA4IBYAAAAwAQCdASoBAAEADsD+JaQAA3AAAAAA",
    "UklGRhoAAABXRUJQVlA4TA0AAAAvAAAAEAcQERGIiP4HAA==",
    "UklGRkoAAABXRUJQVlA4WAoAAAAQAAAAAAAAAAAAQUxQSAwAAAARBxAR/Q9ERP8DAABWUDggGAAAABQBAJ0BKgEAAQAAAP4AAA3AAP7mtQAAAA==",
];

fn decoded(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    DataUri::parse(&format!("data:;base64,{text}")).unwrap().unwrap().decode(&mut bytes).unwrap();
    bytes
}

/// Returns the fixture with a second image, that of the texture's extension.
fn with_image(extension: &str, bytes: &[u8], mime: &str) -> Fixture {
    let mut fixture = Fixture::new();
    let view = fixture.view(bytes);
    fixture.set("/images/1", json!({"bufferView": view, "mimeType": mime}));
    fixture.set(&format!("/textures/0/extensions/{extension}/source"), json!(1));
    fixture.set("/extensionsUsed", json!([extension]));
    fixture
}

fn imported(fixture: &Fixture) -> Imported {
    read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default()).unwrap()
}

fn image_of(model: &ModelData) -> Option<u32> {
    model.materials[0].base_color_texture.map(|texture| texture.image)
}

#[test]
fn the_webp_image_of_a_texture_is_read_instead_of_the_plain_one() {
    for text in ONE_PIXEL {
        let bytes = decoded(text);
        let mut fixture = with_image("EXT_texture_webp", &bytes, "image/webp");
        let Imported { model, warnings, .. } = imported(&fixture);
        assert_eq!((warnings, image_of(&model)), (Vec::new(), Some(1)));
        let image = &model.images[1];
        assert_eq!(
            (&*image.mime, image.width, image.height, &image.bytes[..]),
            ("image/webp", 1, 1, &bytes[..])
        );
        // Without a plain image too.
        fixture.remove("/textures/0/source").set("/extensionsRequired", json!(["EXT_texture_webp"]));
        assert_eq!(imported(&fixture).model, model);
        // Written with the extension, it is the same image again.
        let written = gltf::write::glb(&model).unwrap();
        let again = read("b.glb", &written.bytes, &NoFiles, &ReadOptions::default()).unwrap();
        assert_eq!(again.warnings, []);
        let image = &again.model.images[image_of(&again.model).unwrap() as usize];
        assert_eq!((&*image.mime, &image.bytes[..]), ("image/webp", &bytes[..]));
        for length in 0..bytes.len() {
            let sized = gltf::measure_image(&bytes[..length]);
            assert!(sized.is_none_or(|sized| sized == ("image/webp", 1, 1)), "{length} bytes");
        }
    }
    let wide = [b"RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0".as_slice(), &[2, 0, 0, 4, 1, 0]].concat();
    assert_eq!(gltf::measure_image(&wide), Some(("image/webp", 3, 261)));
}

#[test]
fn the_ktx_2_image_of_a_texture_is_read_instead_of_the_plain_one() {
    for name in ["etc1s", "uastc", "uastc_zstd"] {
        let bytes = std::fs::read(data(&format!("ktx2/{name}.ktx2"))).unwrap();
        let mut fixture = with_image("KHR_texture_basisu", &bytes, "image/ktx2");
        let Imported { model, warnings, .. } = imported(&fixture);
        assert_eq!((warnings, image_of(&model)), (Vec::new(), Some(1)), "{name}");
        let image = &model.images[1];
        assert_eq!((&*image.mime, image.width, image.height), ("image/ktx2", 40, 24), "{name}");
        assert!(image.bytes[..] == bytes, "{name}");
        fixture.remove("/textures/0/source").set("/extensionsRequired", json!(["KHR_texture_basisu"]));
        assert_eq!(imported(&fixture).model, model, "{name}");
        // Written with the extension, it is the same image again.
        let written = gltf::write::glb(&model).unwrap();
        let again = read("b.glb", &written.bytes, &NoFiles, &ReadOptions::default()).unwrap();
        assert_eq!(again.warnings, [], "{name}");
        assert!(again.model.images[image_of(&again.model).unwrap() as usize].bytes[..] == bytes, "{name}");
        for length in 0..bytes.len() {
            let sized = gltf::measure_image(&bytes[..length]);
            assert!(sized.is_none_or(|sized| sized == ("image/ktx2", 40, 24)), "{length} bytes");
        }
    }
}

#[test]
fn a_broken_ktx_2_image_is_left_empty_with_a_warning_and_saved_as_it_is() {
    // With a format of Vulkan, it is not compressed by Basis Universal.
    let vulkan = [b"\xabKTX 20\xbb\r\n\x1a\n\x25\0\0\0".as_slice(), &[1; 64]].concat();
    for ktx in [b"\xabKTX 20\xbb\r\n\x1a\n and".as_slice(), &vulkan] {
        let mut fixture = with_image("KHR_texture_basisu", ktx, "image/ktx2");
        fixture.set("/extensionsRequired", json!(["KHR_texture_basisu"]));
        let got = imported(&fixture);
        assert_eq!(image_of(&got.model), Some(1));
        let codes: Vec<&str> = got.warnings.iter().map(|it| it.code).collect();
        assert_eq!(codes, ["IMAGE_DATA_INVALID"], "{:?}", got.warnings);
        assert!(got.model.images[1].bytes.is_empty());
        // A save keeps both.
        let opened = crate::save_support::OpenedFile::alone("a.glb", &fixture.glb());
        assert!(opened.saved(&opened.takes(), &NoFiles).bytes() == fixture.glb());
    }
}

#[test]
fn a_texture_of_an_image_that_is_not_there_is_an_error() {
    for source in [json!(9), json!(u64::MAX)] {
        let mut fixture = with_image("EXT_texture_webp", &decoded(ONE_PIXEL[0]), "image/webp");
        fixture.set("/textures/0/extensions/EXT_texture_webp/source", source);
        assert!(read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default()).is_err());
    }
    // A source that is no number is ignored.
    let mut fixture = with_image("EXT_texture_webp", &decoded(ONE_PIXEL[0]), "image/webp");
    fixture.set("/textures/0/extensions/EXT_texture_webp", Value::Null);
    assert_eq!(image_of(&imported(&fixture).model), Some(0));
}
