//! Reading returns exactly what was written: every field, every float bit for bit.

use super::made::RandomModels;
use crate::doors::{TestFolder, model_files};
use crate::seeds::seeds;
use dragonfly_anim::data::{Channel, Interpolation, ModelData, Take, Track};
use dragonfly_anim::format::{NoFiles, ReadOptions, dfm, read};
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Quat, Vec3, Vec4};
use std::sync::Arc;

/// Fails unless `model` is read back the same; small models are compared field by field, with the signs of zeros.
#[track_caller]
fn reads_back(model: &ModelData, what: &str) -> Vec<u8> {
    let bytes = dfm::write(model).unwrap_or_else(|error| panic!("{what}: {error}"));
    let back = dfm::read(&bytes).unwrap_or_else(|error| panic!("{what}: {error}"));
    // Distinguishes -0 from 0, and treats NaN as equal to any NaN.
    if bytes.len() < 1 << 20 {
        assert!(format!("{model:?}") == format!("{back:?}"), "{what}: not the same model");
    } else {
        assert!(*model == back, "{what}: not the same model");
    }
    // A bit that reading lost would be missing now.
    assert!(dfm::write(&back).unwrap() == bytes, "{what}: not the same bytes");
    bytes
}

#[test]
fn every_model_of_the_test_data_comes_back_bit_for_bit() {
    let models = model_files();
    let mut read_in = 0;
    for path in &models {
        let name = path.file_name().unwrap().to_str().unwrap();
        let (bytes, door) = (std::fs::read(path).unwrap(), TestFolder(path.parent().unwrap().to_owned()));
        match read(name, &bytes, &door, &ReadOptions::default()) {
            Ok(imported) => {
                let file = reads_back(&imported.model, name);
                println!("{name}: {} bytes, {} as .dfm", bytes.len(), file.len());
                // The importer gives the same model.
                let again = read("a.dfm", &file, &NoFiles, &ReadOptions::default());
                let again = again.unwrap_or_else(|error| panic!("{name}: {error}"));
                assert!(
                    again.model == imported.model && again.warnings.is_empty() && again.format == dfm::DFM
                );
                read_in += 1;
            }
            Err(error) => println!("{name}: {error}"),
        }
    }
    println!("{read_in} of {} models", models.len());
    assert!(read_in == models.len());
}

#[test]
fn every_seed_of_the_damage_tests_reads_back() {
    for seed in seeds() {
        let imported = read(&seed.name, &seed.bytes, &NoFiles, &ReadOptions::default()).unwrap();
        reads_back(&imported.model, &seed.name);
    }
}

#[test]
fn random_models_with_any_numbers_read_back() {
    let first = seed(0xD0F1);
    for number in 0..2_000 {
        let seed = first + number;
        let odd = [0.0, 0.05, 0.5][(number % 3) as usize];
        let model = RandomModels { random: Random::new(seed), odd }.model();
        reads_back(&model, &format!("DRAGONFLY_SEED={seed}"));
    }
}

#[test]
fn the_empty_model_reads_back() {
    reads_back(&ModelData::default(), "nothing");
}

#[test]
fn times_that_do_not_increase_or_are_not_finite_read_back() {
    let times = [3.0, f32::NAN, -0.0, 0.0, 0.0, f32::NEG_INFINITY, 1.0, 1.0];
    let mut model = super::golden::model();
    let values: Vec<Vec3> = (0..8).map(|key| Vec3::splat(key as f32)).collect();
    let mut take = Take::clone(&model.animation.takes[0]);
    take.tracks[1] =
        Track { translation: Channel::new(times, values, Interpolation::Linear), ..take.tracks[1].clone() };
    model.animation.takes[0] = Arc::new(take);
    reads_back(&model, "times");
}

/// Returns a NaN that no calculation produces.
fn nan(number: u32) -> f32 {
    f32::from_bits(0xffa5_0000 | number)
}

#[test]
fn a_nan_keeps_its_sign_and_payload() {
    let mut model = super::golden::model();
    let n = |first: u32| [first, first + 1, first + 2].map(nan);
    let vertices = &mut model.meshes[0].primitives[0].vertices;
    vertices.positions[1] = n(0).into();
    vertices.normals[2] = n(3).into();
    vertices.influences[1].weight = nan(6);
    vertices.colors = vec![Vec4::splat(nan(7)); 3];
    vertices.tangents = vec![Vec4::splat(nan(8)); 3];
    model.skins[0].offsets[1] = Mat4::from_cols_array(&[nan(9); 16]);
    model.materials[0].base_color.w = nan(10);
    let mut take = Take::clone(&model.animation.takes[0]);
    take.start = nan(11);
    let spline: Vec<Quat> = (12..15).map(|number| Quat::from_array([nan(number); 4])).collect();
    take.tracks[0].rotation = Channel::new([nan(15)], spline, Interpolation::CubicSpline);
    model.animation.takes[0] = Arc::new(take);
    let mut skeleton = (*model.animation.skeleton).clone();
    skeleton.bones[0].rest.scale = n(16).into();
    skeleton.bones[1].rest_matrix = Some(Mat4::from_cols_array(&[nan(19); 16]));
    model.animation.skeleton = Arc::new(skeleton);
    let bytes = reads_back(&model, "NaN");
    for number in 0..20 {
        let bits = nan(number).to_bits().to_le_bytes();
        assert!(bytes.windows(4).any(|window| window == bits), "NaN {number} is not in the file");
    }
    let back = dfm::read(&bytes).unwrap();
    let value = back.animation.takes[0].tracks[0].rotation.values[2].to_array();
    assert_eq!(value.map(f32::to_bits), [nan(14).to_bits(); 4]);
    assert_eq!(back.animation.takes[0].tracks[0].rotation.times[0].to_bits(), nan(15).to_bits());
}
