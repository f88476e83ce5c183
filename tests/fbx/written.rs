//! Files that are written, read again: every model of the test data, and those of the collection.

use crate::round_trip::RoundTrip;
use crate::support::{data, read_here};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{AssetError, AssetFs, Formats, ReadOptions};
use dragonfly_anim::frames::frame_rate;
use dragonfly_fbx::{FbxOptions, export_with, looks_like_fbx, preset};
use dragonfly_kit::skip::models;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest difference between keys, relative to the size of a model.
const BETWEEN_KEYS: f32 = 1e-3;

/// Largest difference on keys, relative to the size of a model.
const ON_KEYS: f32 = 2e-5;

/// Times of one take that are compared on keys.
const TIMES: usize = 12;

/// The folder of a file.
struct Beside(PathBuf);

impl AssetFs for Beside {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
        std::fs::read(self.0.join(path)).map_err(|_| AssetError::Missing)
    }
}

/// Returns the model of a file; `None` if it is none, or a broken one.
fn model(path: &Path) -> Option<ModelData> {
    let bytes = std::fs::read(path).ok()?;
    if looks_like_fbx(&bytes) {
        return read_here(&bytes).ok().map(|read| read.model);
    }
    let name = path.file_name()?.to_str()?;
    let files = Beside(path.parent()?.to_owned());
    let read = Formats::builtin().read(name, &bytes, &files, &ReadOptions::default());
    read.ok().map(|imported| imported.model)
}

/// Returns all files below a folder, by name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(folder) = waiting.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                waiting.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Returns at most `most` of the key times of a take.
fn key_times(model: &ModelData, take: usize, most: usize) -> Vec<f32> {
    let take = &model.animation.takes[take];
    let mut times: Vec<f32> = take.tracks.iter().flat_map(|track| track.key_times()).collect();
    times.extend(take.morphs.iter().flat_map(|morph| morph.times.iter()));
    times.sort_by(f32::total_cmp);
    times.dedup();
    let step = times.len().div_ceil(most).max(1);
    times.into_iter().step_by(step).collect()
}

/// Writes a model, reads it again and compares. Returns the largest differences on and between keys.
fn compare(name: &str, model: ModelData) -> (f32, f32) {
    let mut trip = RoundTrip::of(model, None);
    let size = trip.size();
    let mut worst = (0.0_f32, 0.0_f32);
    let is_sheared = trip.loses("shear");
    let mut check = |trip: &mut RoundTrip, take, time, is_key: bool| {
        if is_sheared {
            return;
        }
        let (difference, place) = trip.bone_difference(take, time, size);
        let vertices = trip.vertex_difference(size);
        let limit = if is_key { ON_KEYS } else { BETWEEN_KEYS };
        let found = difference.max(vertices);
        assert!(difference <= limit, "{name}: {difference:e} at {place}");
        let is_below_zero = trip.loses("below zero");
        assert!(is_below_zero || vertices <= limit, "{name}: vertices {vertices:e} at {time} s of {take:?}");
        let worst = if is_key { &mut worst.0 } else { &mut worst.1 };
        *worst = worst.max(found);
    };
    check(&mut trip, None, 0.0, true);
    trip.compare_vertices(name);
    trip.compare_materials(name);
    let model = trip.before.model().clone();
    let after = trip.after.model().clone();
    assert_eq!(model.animation.takes.len(), after.animation.takes.len(), "{name}");
    let bones = trip.bones();
    for (bone, after_bone) in bones.iter().enumerate() {
        let (was, is) =
            (&model.animation.skeleton.bones[bone].name, &after.animation.skeleton.bones[*after_bone].name);
        assert!(was == is || trip.loses("is called"), "{name}: bone {was:?} is {is:?}");
    }
    for (take, (was, is)) in model.animation.takes.iter().zip(&after.animation.takes).enumerate() {
        assert!(
            was.name == is.name || trip.loses("is called"),
            "{name}: take {:?} is {:?}",
            was.name,
            is.name
        );
        if was.length > 0.0 {
            let differences = [was.start - is.start, was.end() - is.end()].map(f32::abs);
            assert!(
                differences < [1e-5; 2],
                "{name}: take {take} {} to {}, then {} to {}",
                was.start,
                was.end(),
                is.start,
                is.end()
            );
        }
        for time in key_times(&model, take, TIMES) {
            check(&mut trip, Some(take), time, true);
        }
        for step in 0..8 {
            let time = was.start + was.length * (step as f32 + 0.37) / 8.0;
            check(&mut trip, Some(take), time, false);
            for (instance, read) in trip.instances().into_iter().enumerate() {
                let pairs = trip.before.morph_weights(instance).iter().zip(trip.after.morph_weights(read));
                for (was, is) in pairs {
                    assert!(
                        *was < 0.0 || (was - is).abs() < 2e-3,
                        "{name}: weights {was} and {is} at {time} s"
                    );
                }
            }
        }
    }
    worst
}

/// Compares all models below a folder. Returns their number.
fn compare_all(folder: &Path) -> usize {
    let mut count = 0;
    for path in files(folder) {
        let Some(model) = model(&path) else { continue };
        let name = path.strip_prefix(folder).unwrap().display().to_string();
        let start = std::time::Instant::now();
        let (on, between) = compare(&name, model);
        println!("{name}: {on:.1e} on keys, {between:.1e} between ({:?})", start.elapsed());
        count += 1;
    }
    count
}

#[test]
fn every_model_of_the_test_data_is_read_again_as_it_was() {
    let mut count = 0;
    for folder in ["gltf", "collection", "fbx", "bvh", "x", "m3d", "obj"] {
        count += compare_all(&data().join(folder));
    }
    assert!(count >= 35, "only {count} models");
}

#[test]
fn every_model_of_the_collection_is_read_again_as_it_was() {
    let Some(folder) = models() else { return };
    let count = compare_all(&folder);
    assert!(count >= 50, "only {count} models");
}

#[test]
fn the_unreal_preset_keeps_the_origins_of_bones_in_every_frame() {
    let mut compared = 0;
    for folder in ["gltf", "collection", "fbx", "bvh"] {
        for path in files(&data().join(folder)) {
            let Some(model) = model(&path) else { continue };
            let rest_is_sheared =
                model.animation.skeleton.bones.iter().any(|bone| bone.rest_matrix.is_some());
            if rest_is_sheared {
                continue;
            }
            let mut trip = RoundTrip::of(model, preset("unreal"));
            let size = trip.size();
            let (bones, added) = trip.bones_below_root();
            for take in 0..trip.before.model().animation.takes.len() {
                let own = Arc::clone(&trip.before.model().animation.takes[take]);
                let rate = match frame_rate(&own) {
                    rate if rate < 24.0 => 2.0 * rate,
                    rate => rate,
                };
                let last = (own.length * rate).floor();
                for part in [0.0, 0.3, 0.5, 1.0] {
                    let time = own.start + (last * part).round() / rate;
                    trip.before.pose(Some(take), time);
                    trip.after.pose(Some(take), time);
                    for (bone, &after) in bones.iter().enumerate() {
                        let (was, is) =
                            (trip.before.to_root()[bone].w_axis, trip.after.to_root()[after].w_axis);
                        let difference = was.distance(is) / size;
                        let name = &trip.before.model().animation.skeleton.bones[bone].name;
                        let place = format!("{}: {name} at {time} s of {}", path.display(), own.name);
                        assert!(difference < 1e-3, "{place}: {was} and {is}, a root was added: {added}");
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > 5_000, "only {compared}");
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let model = model(&data().join("collection/RobotExpressive.glb")).expect("a model");
    let write =
        || export_with(&model, "a.fbx", &FbxOptions::default()).expect("a file").files[0].bytes.clone();
    assert!(write() == write());
}
