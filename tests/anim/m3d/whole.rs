//! A file of any model has its vertices in the same places.

use super::made::import;
use crate::doors::{TestFolder, model_files};
use crate::takes::windings;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::m3d::{M3D, M3dDialect, write};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use glam::Vec3;
use std::sync::Arc;

/// Returns all positions, sorted, so that they can be compared where vertices are in another order; every `step`th.
fn positions(model: &Arc<ModelData>, take: Option<usize>, time: f32) -> Vec<Vec3> {
    let mut evaluator = Evaluator::new(Arc::clone(model));
    evaluator.pose(take, time);
    evaluator.all_positions()
}

/// Returns the largest distance of a position from the nearest of the others, relative to the size of the model.
fn distance(ours: &[Vec3], theirs: &[Vec3]) -> f32 {
    let size = ours.iter().fold(1e-3_f32, |size, position| size.max(position.abs().max_element()));
    let sampled = ours.iter().step_by((ours.len() / 97).max(1));
    let nearest =
        |position: &Vec3| theirs.iter().map(|other| position.distance(*other)).fold(f32::INFINITY, f32::min);
    sampled.map(nearest).fold(0.0, f32::max) / size
}

#[test]
fn models_of_every_kind_keep_the_places_of_their_vertices_in_both_dialects() {
    let mut compared = 0;
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let door = TestFolder(path.parent().unwrap().to_owned());
        let model =
            read(&name, &std::fs::read(&path).unwrap(), &door, &ReadOptions::default()).unwrap().model;
        // Shape keys and eight influences are listed as lost, and change places.
        let loses = model
            .meshes
            .iter()
            .flat_map(|mesh| &mesh.primitives)
            .any(|part| !part.morph_targets.is_empty() || part.vertices.influences_per_vertex > 4);
        let vertices: usize =
            model.meshes.iter().flat_map(|mesh| &mesh.primitives).map(|part| part.vertices.len()).sum();
        if vertices > 5_000 {
            continue;
        }
        for dialect in [M3dDialect::Dx11, M3dDialect::Dx12] {
            let file = write(&model, dialect).unwrap();
            assert!((M3D.sniff)(&file.bytes));
            let imported = import(&file.bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
            let written = Arc::new(imported.model);
            let (right, wrong) = windings(&written);
            let own = windings(&model);
            assert!(wrong <= own.1.min(own.0) + right / 50, "{name}: {wrong} of {right}");
            let has_bind = !file.lost.iter().any(|lost| lost.code == "OFFSET_NOT_STORED");
            if loses || !has_bind || model.animation.skeleton.is_empty() {
                continue;
            }
            let original = Arc::new(model.clone());
            for (take, own) in model.animation.takes.iter().enumerate().take(2) {
                let (start, end) = own.range_of_keys().unwrap_or_default();
                for part in [0.0, 0.37, 1.0] {
                    let time = start + (end - start) * part;
                    let [ours, theirs] =
                        [&original, &written].map(|model| positions(model, Some(take), time));
                    let off = distance(&ours, &theirs);
                    assert!(off < 2e-3, "{name}, take {take} at {time}: {off}");
                    compared += 1;
                }
            }
        }
    }
    println!("{compared} poses compared");
    assert!(compared > 60);
}

#[test]
fn a_file_that_is_written_again_is_the_same_and_losses_are_listed() {
    let path = crate::doors::data().join("gltf/Fox.glb");
    let fox =
        read("Fox.glb", &std::fs::read(path).unwrap(), &NoFiles, &ReadOptions::default()).unwrap().model;
    let file = write(&fox, M3dDialect::Dx12).unwrap();
    let lost: Vec<String> = file.lost.iter().map(ToString::to_string).collect();
    assert_eq!(
        lost,
        [
            "/materials/0/texture: an image that is no file of its own, or whose name has blanks, is not stored",
        ]
    );
    let again = write(&import(&file.bytes).unwrap().model, M3dDialect::Dx12).unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    let head = |bytes: &[u8]| text(bytes).lines().take(6).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(head(&file.bytes), head(&again.bytes));
    let error = write(&fox, M3dDialect::Dx10).unwrap_err();
    assert_eq!(error.to_string(), "files of the dialect of 2008 have no bones; use that of 2012 or 2016");
    assert!(
        write(&ModelData::default(), M3dDialect::Dx11)
            .unwrap()
            .bytes
            .ends_with(b"Triangles*********************\n\n")
    );
}
