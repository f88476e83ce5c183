//! The format as an importer: detected by content, stricter than the exact reader, within the memory budget.

use super::golden::{file, model};
use dragonfly_anim::data::{Bone, Image, ModelData, Skeleton, Take};
use dragonfly_anim::format::{ByteBudget, Formats, ImportError, NoFiles, ReadOptions, dfm, read};
use std::sync::Arc;

fn import(model: &ModelData) -> Result<ModelData, ImportError> {
    let bytes = dfm::write(model).unwrap();
    read("a.dfm", &bytes, &NoFiles, &ReadOptions::default()).map(|imported| imported.model)
}

#[test]
fn dfm_files_are_detected_by_content_and_by_name() {
    let formats = Formats::builtin();
    let name = |name: &str, bytes: &[u8]| formats.detect(name, bytes).map(|format| format.name);
    let file = file();
    assert_eq!(name("model", &file), Some("dfm"));
    assert_eq!(name("model", &file[..100]), Some("dfm"));
    assert_eq!(name("model.DFM", b""), Some("dfm"));
    assert_eq!(name("model.glb", &file), Some("dfm"));
    let empty = dfm::write(&ModelData::default()).unwrap();
    assert_eq!(name("model", &empty), Some("dfm"));
    // A container whose length happens to be the size of a vertex.
    assert_eq!(name("a", b"glTF\x02\0\0\0\x54\0\0\0"), Some("glb"));
}

#[test]
fn numbers_that_are_not_finite_are_read_exactly_but_not_imported() {
    let mut model = model();
    model.meshes[0].primitives[0].vertices.positions[1].y = f32::INFINITY;
    let error = import(&model).unwrap_err();
    assert_eq!(error.to_string(), "byte 96: vertices: a number is NaN or infinite");
    assert_eq!(dfm::read(&dfm::write(&model).unwrap()).unwrap(), model);
}

#[test]
fn times_that_do_not_increase_are_not_imported() {
    let mut model = model();
    let mut take = Take::clone(&model.animation.takes[0]);
    take.tracks[1].rotation.times = [2.0, 0.0].into();
    model.animation.takes[0] = Arc::new(take.clone());
    assert!(import(&model).unwrap_err().to_string().contains("a key at 0 s follows one at 2 s"));
    take.tracks[1].rotation.times = [2.0, 1e6].into();
    model.animation.takes[0] = Arc::new(take);
    assert!(import(&model).unwrap_err().to_string().contains("a key at 1000000 s"));
}

#[test]
fn the_limits_of_importers_apply() {
    let chain = |bones: u32| {
        let bone = |index: u32| Bone {
            name: String::new(),
            parent: index.checked_sub(1),
            node: None,
            ..self::model().animation.skeleton.bones[0].clone()
        };
        let mut model = ModelData::default();
        model.animation.skeleton = Arc::new(Skeleton { bones: (0..bones).map(bone).collect() });
        model
    };
    import(&chain(512)).unwrap();
    let error = import(&chain(513)).unwrap_err();
    assert!(error.to_string().ends_with("levels of bones: 513, at most 512"), "{error}");
    let large = |width, height| ModelData {
        images: vec![Image { width, height, ..Image::default() }],
        ..ModelData::default()
    };
    import(&large(8_000, 8_000)).unwrap();
    assert!(import(&large(16_385, 1)).is_err());
    assert!(import(&large(16_384, 16_384)).is_err());
}

#[test]
fn every_refused_charge_of_dfm_is_a_clear_error() {
    let bytes = file();
    let mut request = 0;
    loop {
        let options = ReadOptions { budget: ByteBudget::failing_at(request), ..ReadOptions::default() };
        match read("a.dfm", &bytes, &NoFiles, &options) {
            Err(ImportError::TooLarge { .. }) => request += 1,
            Err(other) => panic!("charge {request}: {other}"),
            Ok(_) => break,
        }
    }
    println!("{request} charges, each refused once");
    assert!(request > 20);
}

#[test]
fn reading_can_be_cancelled() {
    let mut model = model();
    let primitive = &mut model.meshes[0].primitives[0];
    primitive.indices = [0, 1, 2].repeat(200_000);
    let bytes = dfm::write(&model).unwrap();
    let asked = std::cell::Cell::new(0);
    let is_cancelled = || {
        asked.set(asked.get() + 1);
        asked.get() > 3
    };
    let options = ReadOptions { is_cancelled: &is_cancelled, ..ReadOptions::default() };
    assert_eq!(read("a.dfm", &bytes, &NoFiles, &options).unwrap_err(), ImportError::Cancelled);
}
