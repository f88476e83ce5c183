//! Images of written files: in the file, or in files of their own next to it.

use crate::support::{data, read_with};
use dragonfly_anim::data::{Image, ModelData};
use dragonfly_anim::format::{AssetError, AssetFs, Conventions, Formats, NoFiles, ReadOptions, SavePlan};
use dragonfly_fbx::{FbxOptions, TexturePlacement, export_with, read_in_process};
use std::collections::HashSet;

/// The files of a plan, as a folder.
struct PlannedFolder(SavePlan);

impl AssetFs for PlannedFolder {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
        let file = self.0.files.iter().find(|file| file.name == path);
        file.map(|file| file.bytes.clone()).ok_or(AssetError::Missing)
    }
}

/// Returns the fox with three more materials, whose images have names that collide, or none.
fn model() -> ModelData {
    let bytes = std::fs::read(data().join("gltf/Fox.glb")).expect("a file");
    let fox = Formats::builtin().read("Fox.glb", &bytes, &NoFiles, &ReadOptions::default());
    let mut model = fox.expect("a good file").model;
    let first = model.images[0].clone();
    assert_eq!(first.mime, "image/png");
    for (number, name) in ["skin.png", "SKIN.png", ""].into_iter().enumerate() {
        // A trailing byte makes the images different; decoders ignore it.
        let mut bytes = first.bytes.to_vec();
        bytes.push(number as u8);
        let file_name = (!name.is_empty()).then(|| format!("textures\\{name}"));
        model.images.push(Image { name: name.to_owned(), file_name, bytes: bytes.into(), ..first.clone() });
        let mut material = model.materials[0].clone();
        material.name = format!("material {number}");
        if let Some(texture) = &mut material.base_color_texture {
            texture.image = number as u32 + 1;
        }
        model.materials.push(material);
    }
    for (number, material) in (0_u32..).zip(model.materials.clone()) {
        let primitive = &mut model.meshes[0].primitives;
        let mut copy = primitive[0].clone();
        copy.material = Some(number);
        assert!(material.base_color_texture.is_some());
        if number > 0 {
            primitive.push(copy);
        }
    }
    model
}

fn plan(model: &ModelData, textures: TexturePlacement) -> SavePlan {
    let options = FbxOptions { textures, ..FbxOptions::default() };
    export_with(model, "Hero.fbx", &options).expect("a model that can be written")
}

/// Returns the bytes of the image of each material that has one, by the name of the material.
fn images(model: &ModelData) -> Vec<(String, Vec<u8>)> {
    let mut images: Vec<(String, Vec<u8>)> = model
        .materials
        .iter()
        .filter_map(|material| {
            let texture = material.base_color_texture?;
            Some((material.name.clone(), model.images.get(texture.image as usize)?.bytes.to_vec()))
        })
        .collect();
    images.sort();
    images
}

fn read(plan: SavePlan) -> (ModelData, usize) {
    let bytes = plan.files.last().expect("the file itself").bytes.clone();
    let folder = PlannedFolder(plan);
    let read = read_with(|context| read_in_process(&bytes, context), &bytes, &folder, Conventions::default());
    let read = read.expect("a file that can be read");
    (read.model, read.warnings.len())
}

#[test]
fn images_beside_a_file_are_found_by_its_name_and_have_the_same_bytes() {
    let model = model();
    let plan = plan(&model, TexturePlacement::Beside);
    let names: Vec<&str> = plan.files.iter().map(|file| &*file.name).collect();
    assert_eq!(names.last(), Some(&"Hero.fbx"), "the file that refers to the others is written last");
    assert!(names[..4].iter().all(|name| name.starts_with("Hero_") && name.ends_with(".png")), "{names:?}");
    let different: HashSet<String> = names.iter().map(|name| name.to_lowercase()).collect();
    assert_eq!(different.len(), 5, "{names:?}");
    let main = &plan.files[4].bytes;
    assert!(!main.windows(8).any(|bytes| bytes == b"\x89PNG\r\n\x1a\n"), "no image is in the file as well");
    let (read, warnings) = read(plan);
    assert_eq!(warnings, 0);
    assert_eq!(images(&read), images(&model));
    // The names stay when the file is written again.
    let again = self::plan(&read, TexturePlacement::Beside);
    let mut again: Vec<String> = again.files.into_iter().map(|file| file.name).collect();
    let mut first: Vec<String> = different.into_iter().collect();
    again.iter_mut().for_each(|name| *name = name.to_lowercase());
    again.sort();
    first.sort();
    assert_eq!(again, first);
}

#[test]
fn images_in_the_file_are_in_no_other_file() {
    let model = model();
    let plan = plan(&model, TexturePlacement::Embedded);
    assert_eq!(plan.files.len(), 1);
    let (read, warnings) = read(plan);
    assert_eq!(warnings, 0);
    assert_eq!(images(&read), images(&model));
}

#[test]
fn an_image_without_bytes_keeps_its_name_and_is_no_file() {
    let mut model = model();
    model.images[1].bytes = Vec::new().into();
    let plan = plan(&model, TexturePlacement::Beside);
    assert_eq!(plan.files.len(), 4);
    let (read, warnings) = read(plan);
    assert_eq!(warnings, 1, "the image that was not there");
    assert!(read.images.iter().any(|image| image.bytes.is_empty() && image.name.contains("skin")));
}
