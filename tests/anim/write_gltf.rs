//! Whole glTF files written from models: they read back as the same model, bit for bit where glTF can hold it, and the
//! Khronos validator finds no error in them.

use crate::doors::{TestFolder, model_files};
use crate::save_judges::issues;
use crate::save_support::json_of;
use crate::soundness::faults;
use dragonfly_anim::check::{Severity, check};
use dragonfly_anim::data::{
    AlphaMode, AnimationData, Bone, Channel, Image, Interpolation, Material, Mesh, MeshInstance, ModelData,
    MorphTarget, Primitive, Skeleton, Take, Track, Transform, Vertices,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{ExportError, NoFiles, ReadOptions, WholeFile, gltf, read};
use dragonfly_kit::skip;
use glam::{Mat4, Quat, Vec3};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

type WriteModel = fn(&ModelData) -> Result<WholeFile, ExportError>;

const KINDS: [(&str, WriteModel); 2] = [("glb", gltf::write::glb), ("gltf", gltf::write::gltf)];

fn opened(path: &Path) -> Option<ModelData> {
    let bytes = std::fs::read(path).expect("a file of test data");
    let folder = TestFolder(path.parent()?.to_owned());
    let name = path.file_name()?.to_str()?;
    Some(read(name, &bytes, &folder, &ReadOptions::default()).ok()?.model)
}

fn read_back(kind: &str, bytes: &[u8]) -> ModelData {
    let name = format!("written.{kind}");
    read(&name, bytes, &NoFiles, &ReadOptions::default()).expect("a written file").model
}

/// Returns the bone of a written model for each bone of the model: node and bone have the same index there.
fn bones(written: &ModelData, count: usize) -> Vec<Option<usize>> {
    let bones = &written.animation.skeleton.bones;
    (0..count as u32).map(|node| bones.iter().position(|bone| bone.node == Some(node))).collect()
}

fn bits<T: Copy>(channel: &Channel<T>, numbers: fn(T) -> Vec<f32>) -> (Vec<u32>, Vec<u32>, Interpolation) {
    let times = channel.times.iter().map(|time| (time + 0.0).to_bits()).collect();
    let values =
        channel.values.iter().flat_map(|&value| numbers(value)).map(|number| (number + 0.0).to_bits());
    (times, values.collect(), channel.interpolation)
}

fn positions(model: &ModelData, take: Option<usize>, time: f32) -> (Vec<Mat4>, Vec<Vec3>) {
    let mut evaluator = Evaluator::new(Arc::new(model.clone()));
    evaluator.pose(take, time);
    (evaluator.to_root().to_vec(), evaluator.all_positions())
}

/// Asserts that a written model is the model.
fn same(model: &ModelData, written: &ModelData, name: &str) {
    assert_eq!(faults(written), Vec::<String>::new(), "{name}");
    let map = bones(written, model.animation.skeleton.len());
    for (bone, &found) in model.animation.skeleton.bones.iter().zip(&map) {
        // A bone that nothing animates and that is no joint is a node, and no bone, of the written file.
        let Some(found) = found else { continue };
        let found = &written.animation.skeleton.bones[found];
        assert_eq!((&bone.name, bone.rest_matrix), (&found.name, found.rest_matrix), "{name}");
        assert!((bone.rest.to_matrix() - found.rest.to_matrix()).abs_diff_eq(Mat4::ZERO, 1e-6), "{name}");
    }
    let takes = [&model.animation.takes, &written.animation.takes];
    assert_eq!(takes[0].len(), takes[1].len(), "{name}");
    for (before, after) in takes[0].iter().zip(takes[1]) {
        assert_eq!((&before.name, &before.extras), (&after.name, &after.extras), "{name}");
        for track in before.tracks.iter().filter(|track| !track.is_empty()) {
            let bone = map[track.bone as usize].expect("an animated bone");
            let found = &after.tracks[bone];
            let context = format!("{name}, {}, bone {}", before.name, track.bone);
            let vector = |value: Vec3| value.to_array().to_vec();
            assert_eq!(bits(&track.translation, vector), bits(&found.translation, vector), "{context}");
            assert_eq!(bits(&track.scale, vector), bits(&found.scale, vector), "{context}");
            let turn = |value: Quat| value.to_array().to_vec();
            assert_eq!(bits(&track.rotation, turn), bits(&found.rotation, turn), "{context}");
        }
        assert_eq!(before.morphs.len(), after.morphs.len(), "{name}");
    }
    let count = |model: &ModelData| {
        let primitives = model.instances.iter().map(|i| &model.meshes[i.mesh as usize].primitives);
        primitives.flatten().map(|primitive| primitive.indices.len()).sum::<usize>()
    };
    assert_eq!(count(model), count(written), "{name}");
    for take in std::iter::once(None).chain((0..takes[0].len()).map(Some)) {
        let range = take.map_or((0.0, 0.0), |take| (takes[0][take].start, takes[0][take].end()));
        for part in [0.0, 0.37, 1.0] {
            let time = range.0 + part * (range.1 - range.0);
            let ((before, mut old), (after, mut new)) =
                (positions(model, take, time), positions(written, take, time));
            for (bone, &found) in before.iter().zip(&map) {
                let Some(found) = found else { continue };
                let size = 1.0 + bone.to_cols_array().iter().fold(0.0_f32, |most, part| most.max(part.abs()));
                assert!(bone.abs_diff_eq(after[found], 1e-5 * size), "{name}, {take:?} at {time}");
            }
            // Instances may be in another order.
            let key = |point: &Vec3| point.to_array().map(|part| (part * 1e3).round() as i64);
            assert_eq!(old.len(), new.len(), "{name}");
            old.sort_by_key(key);
            new.sort_by_key(key);
            let sum = |points: &[Vec3]| points.iter().map(|point| point.as_dvec3()).sum::<glam::DVec3>();
            let size = old.iter().fold(1.0_f32, |most, point| most.max(point.abs().max_element()));
            let apart = (sum(&old) - sum(&new)).length() / old.len().max(1) as f64;
            assert!(apart < 1e-5 * f64::from(size), "{name}, {take:?} at {time}: {apart}");
        }
    }
}

/// Writes models in both kinds, compares what is read back, and returns the names and bytes.
fn written(paths: &[PathBuf]) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for (index, path) in paths.iter().enumerate() {
        let Some(model) = opened(path) else { continue };
        for (kind, write) in KINDS {
            let name = format!("{index}-{}.{kind}", path.file_stem().unwrap_or_default().to_string_lossy());
            let file = write(&model).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(file.bytes, write(&model).expect("the same model").bytes, "{name} is not determined");
            same(&model, &read_back(kind, &file.bytes), &name);
            files.push((name, file.bytes));
        }
    }
    files
}

#[test]
fn models_of_the_repository_written_as_gltf_read_back_as_the_same_models() {
    let files = written(&model_files());
    println!("{} files written", files.len());
    assert!(files.len() > 60, "{}", files.len());
}

#[test]
fn the_validator_finds_no_error_in_written_files() {
    let Some(evaluators) = skip::evaluators() else { return };
    let folder = std::env::temp_dir().join(format!("dragonfly-written-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let files = written(&model_files());
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.join(name)).collect();
    for (path, (_, bytes)) in paths.iter().zip(&files) {
        std::fs::write(path, bytes).expect("a file");
    }
    let found = issues(&evaluators, &paths);
    std::fs::remove_dir_all(&folder).expect("the folder");
    let all: BTreeMap<&String, &BTreeMap<String, usize>> =
        files.iter().map(|(name, _)| name).zip(&found).filter(|(_, found)| !found.is_empty()).collect();
    // These come from the model itself: its channels and vertices are written as they are.
    let own = ["ACCESSOR_ANIMATION_INPUT_NEGATIVE", "MESH_PRIMITIVE_GENERATED_TANGENT_SPACE"];
    let wrong: Vec<_> =
        all.iter().filter(|(_, found)| found.keys().any(|code| !own.contains(&code.as_str()))).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    println!("{} files judged", files.len());
}

/// Returns a model with what real files rarely have: two roots of a skin, a sheared bone, a mesh without triangles, a
/// take without keys, a target without columns, an image of another kind.
fn unusual() -> ModelData {
    let bone = |name: &str, parent, rest_matrix| Bone {
        name: name.to_owned(),
        parent,
        rest: Transform::IDENTITY,
        rest_matrix,
        offset: Mat4::IDENTITY,
        node: None,
    };
    let sheared = Mat4::from_cols_array(&[
        1.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 1.0,
    ]);
    let bones =
        vec![bone("left", None, None), bone("right", None, None), bone("skew", Some(1), Some(sheared))];
    let vertices = Vertices {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        influences: vec![dragonfly_anim::data::Influence { joint: 1, weight: 1.0 }; 12],
        influences_per_vertex: 4,
        ..Vertices::default()
    };
    let mut influences = vertices.influences.clone();
    influences.iter_mut().enumerate().filter(|(slot, _)| slot % 4 != 0).for_each(|(_, one)| one.weight = 0.0);
    let vertices = Vertices { influences, ..vertices };
    let target = MorphTarget { name: "nothing".to_owned(), ..MorphTarget::default() };
    let primitive =
        Primitive { vertices, indices: vec![0, 1, 2], material: Some(0), morph_targets: vec![target] };
    let mesh = Mesh { name: "one".to_owned(), primitives: vec![primitive], morph_weights: vec![0.0] };
    let empty = Mesh { name: "empty".to_owned(), primitives: vec![Primitive::default()], ..Mesh::default() };
    let instance = |mesh, skin| MeshInstance {
        mesh,
        node: None,
        skin,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: vec![0.0; 1 - mesh as usize],
    };
    let material = Material {
        emissive: Vec3::new(3.0, 1.5, 0.0),
        alpha_mode: AlphaMode::Mask(0.25),
        unlit: true,
        use_phong: true,
        ..Material::default()
    };
    let skin = dragonfly_anim::data::Skin {
        name: "both".to_owned(),
        bones: vec![0, 1],
        offsets: vec![Mat4::IDENTITY; 2],
    };
    let closest = Channel::new([0.0, 1.0, 3.0], [Vec3::X, Vec3::Y, Vec3::Z], Interpolation::Closest);
    let tracks = vec![Track { bone: 0, translation: closest, ..Track::default() }];
    let take = Take { name: "closest".to_owned(), length: 3.0, tracks, ..Take::default() };
    let still = Take { name: "still".to_owned(), ..Take::default() };
    ModelData {
        avatar: Default::default(),
        name: "unusual".to_owned(),
        meshes: vec![mesh, empty],
        instances: vec![instance(0, Some(0)), instance(1, None)],
        skins: vec![skin],
        materials: vec![material],
        images: vec![Image {
            mime: "image/bmp".to_owned(),
            bytes: b"BM".as_slice().into(),
            ..Image::default()
        }],
        animation: AnimationData {
            skeleton: Arc::new(Skeleton { bones }),
            takes: vec![Arc::new(take), Arc::new(still)],
        },
    }
}

#[test]
fn what_gltf_cannot_hold_is_listed_and_the_rest_is_written() {
    let model = unusual();
    let file = gltf::write::glb(&model).expect("a model");
    let lost: Vec<String> = file.lost.iter().map(|lost| lost.place.to_string()).collect();
    assert_eq!(lost, ["/meshes/1", "/images/0", "/materials/0/phong"]);
    let written = read_back("glb", &file.bytes);
    assert_eq!(faults(&written), Vec::<String>::new());
    let errors = check(&written).into_iter().filter(|finding| finding.severity == Severity::Error);
    assert_eq!(errors.count(), 0);
    let names: Vec<&str> = written.animation.skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
    assert_eq!(names, ["Skeleton", "left", "right"]);
    let material = &written.materials[0];
    assert_eq!((material.emissive, material.unlit), (Vec3::new(3.0, 1.5, 0.0), true));
    assert_eq!(material.alpha_mode, AlphaMode::Mask(0.25));
    assert_eq!(written.meshes[0].primitives[0].morph_targets[0].name, "nothing");
    for (time, place) in [(0.4, Vec3::X), (0.6, Vec3::Y), (1.9, Vec3::Y), (2.1, Vec3::Z)] {
        assert_eq!(positions(&written, Some(0), time).0[1].w_axis.truncate(), place, "at {time}");
    }
    assert_eq!(
        written.animation.takes[1].keys(),
        1,
        "a take that moves nothing keeps the first bone at rest"
    );
}

#[test]
fn every_accessor_has_a_view_that_is_long_enough() {
    let mut model = unusual();
    let more = Vertices { positions: vec![Vec3::Y; 7], ..Vertices::default() };
    let nothing = MorphTarget { normals: vec![Vec3::ZERO; 7], ..MorphTarget::default() };
    let primitive = Primitive {
        vertices: more,
        indices: vec![0, 1, 2],
        material: None,
        morph_targets: vec![nothing.clone(), nothing],
    };
    model.meshes[1] = Mesh { primitives: vec![primitive], morph_weights: vec![0.0; 2], ..Mesh::default() };
    model.instances[1].morph_weights = vec![0.0; 2];
    let file = gltf::write::glb(&model).expect("a model");
    let json = json_of(&file.bytes);
    let whole = |value: &serde_json::Value| value.as_u64().unwrap_or(0);
    let accessors = json["accessors"].as_array().expect("accessors");
    for accessor in accessors {
        let view = &json["bufferViews"][accessor["bufferView"].as_u64().expect("a view") as usize];
        let size = match whole(&accessor["componentType"]) {
            5121 => 1,
            5123 => 2,
            _ => 4,
        };
        let width = match accessor["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            _ => 16,
        };
        let needed = whole(&accessor["count"]) * size * width;
        assert!(whole(&view["byteLength"]) >= needed, "{accessor} {view}");
        assert!(whole(&view["byteOffset"]) + needed <= whole(&json["buffers"][0]["byteLength"]), "{view}");
    }
    // Five columns of zeros share one view.
    let zeros: Vec<u64> = accessors
        .iter()
        .filter(|accessor| accessor["max"] == serde_json::json!([0.0, 0.0, 0.0]))
        .map(|accessor| whole(&accessor["bufferView"]))
        .collect();
    assert!(zeros.len() == 5 && zeros.iter().all(|view| *view == zeros[0]), "{zeros:?}");
    let written = read_back("glb", &file.bytes);
    assert_eq!(faults(&written), Vec::<String>::new());
    assert_eq!(written.meshes[1].primitives[0].morph_targets[1].positions, vec![Vec3::ZERO; 7]);
    if let Some(folder) = skip::evaluators() {
        let path = std::env::temp_dir().join(format!("zeros-{}.glb", std::process::id()));
        std::fs::write(&path, &file.bytes).expect("a file");
        let found = issues(&folder, std::slice::from_ref(&path));
        std::fs::remove_file(&path).expect("the file");
        assert!(!found[0].keys().any(|code| code.starts_with("ACCESSOR")), "{found:?}");
    }
}

#[test]
fn keys_that_no_reader_accepts_are_refused() {
    let mut model = unusual();
    let take = Arc::make_mut(&mut model.animation.takes[0]);
    take.tracks[0].rotation =
        Channel::new([0.0], [Quat::from_xyzw(2.0, 0.0, 0.0, 0.0)], Interpolation::Linear);
    let error = gltf::write::glb(&model).expect_err("a rotation of length 2").to_string();
    assert!(error.contains("take \"closest\", bone \"left\", rotation"), "{error}");
}
