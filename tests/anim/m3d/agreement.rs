//! Matrices and vertices agree with those of an independent evaluator.

use super::made::import;
use crate::doors::data;
use dragonfly_anim::evaluator::Evaluator;
use glam::{Mat4, Vec3};
use serde_json::Value;
use std::path::PathBuf;
use std::sync::Arc;

/// Largest difference, relative to the largest number of the pose or 1.
const TOLERANCE: f32 = 1e-5;

/// Returns the files with expected poses.
pub(crate) fn pairs(folder: &str) -> Vec<(PathBuf, PathBuf)> {
    let own = data().join(folder);
    let mut pairs: Vec<(PathBuf, PathBuf)> = Vec::new();
    for entry in std::fs::read_dir(own.join("expected")).unwrap() {
        let expected = entry.unwrap().path();
        pairs.push((own.join(expected.file_stem().unwrap()), expected.clone()));
    }
    if let Some(models) = dragonfly_kit::skip::models() {
        for entry in std::fs::read_dir(models.join("../expected")).unwrap() {
            let expected = entry.unwrap().path();
            let name = expected.file_name().unwrap().to_str().unwrap();
            let start = format!("{folder}__");
            if let Some(name) = name.strip_prefix(&start).and_then(|name| name.strip_suffix(".json")) {
                pairs.push((models.join(folder).join(name), expected.clone()));
            }
        }
    }
    pairs.sort();
    pairs
}

/// Returns a list of numbers.
pub(crate) fn numbers(list: &Value) -> Vec<f32> {
    list.as_array().unwrap().iter().map(|number| number.as_f64().unwrap() as f32).collect()
}

/// Returns lists of numbers as matrices.
pub(crate) fn matrices(list: &Value) -> Vec<Mat4> {
    list.as_array().unwrap().iter().map(|matrix| Mat4::from_cols_slice(&numbers(matrix))).collect()
}

#[test]
fn bones_offsets_and_vertices_are_where_an_independent_evaluator_finds_them() {
    let mut compared = 0;
    for (file, expected) in pairs("m3d") {
        let imported = import(&std::fs::read(&file).unwrap()).unwrap();
        let axes = imported.conversion.axes();
        let model = Arc::new(imported.model);
        let expected: Value = serde_json::from_slice(&std::fs::read(expected).unwrap()).unwrap();
        let counts = [
            model
                .meshes
                .iter()
                .flat_map(|mesh| &mesh.primitives)
                .map(|part| part.vertices.len())
                .sum::<usize>(),
            model.meshes.iter().flat_map(|mesh| &mesh.primitives).map(|part| part.indices.len() / 3).sum(),
            model.animation.skeleton.len(),
            model.animation.takes.len(),
        ];
        let wanted = ["vertices", "triangles", "bones"].map(|name| expected[name].as_u64().unwrap() as usize);
        assert_eq!(counts[..3], wanted, "{}", file.display());
        assert_eq!(counts[3], expected["clips"].as_array().unwrap().len());
        for (bone, (offset, parent)) in model
            .animation
            .skeleton
            .bones
            .iter()
            .zip(matrices(&expected["offsets"]).iter().zip(expected["parents"].as_array().unwrap()))
        {
            assert!(bone.offset.abs_diff_eq(axes.matrix(*offset), 1e-6));
            assert_eq!(bone.parent.map_or(-1, i64::from), parent.as_i64().unwrap());
        }
        let mut evaluator = Evaluator::new(Arc::clone(&model));
        let mut worst = 0.0_f32;
        for (take, clip) in expected["clips"].as_array().unwrap().iter().enumerate() {
            assert_eq!(model.animation.takes[take].name, clip["name"].as_str().unwrap());
            for sample in clip["samples"].as_array().unwrap() {
                evaluator.pose(Some(take), sample["t"].as_f64().unwrap() as f32);
                let [world, skin] = ["world", "skin"].map(|name| matrices(&sample[name]));
                for (ours, theirs) in
                    evaluator.to_root().iter().zip(&world).chain(evaluator.final_poses(0).iter().zip(&skin))
                {
                    let theirs = axes.matrix(*theirs).to_cols_array();
                    worst = worst.max(crate::takes::difference(&theirs, &ours.to_cols_array()));
                }
                assert_eq!((world.len(), skin.len()), (counts[2], counts[2]));
                let theirs: Vec<Vec3> = sample["verts"]
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|vertex| axes.position(Vec3::from_slice(&numbers(vertex))))
                    .collect();
                let mut ours = vec![Vec3::ZERO; theirs.len()];
                evaluator.positions(0, 0, &mut ours);
                let flat = |list: &[Vec3]| -> Vec<f32> { list.iter().flat_map(Vec3::to_array).collect() };
                worst = worst.max(crate::takes::difference(&flat(&theirs), &flat(&ours)));
                compared += 1;
            }
        }
        println!("{}: {worst:.1e}", file.file_name().unwrap().display());
        assert!(worst < TOLERANCE, "{}: {worst}", file.display());
    }
    assert!(compared >= 4);
}
