//! World matrices of every joint agree with those of an independent evaluator.

use super::made::import_in_meters;
use crate::doors::data;
use dragonfly_anim::evaluator::Evaluator;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::Arc;

/// Largest difference, relative to the largest number of the pose or 1.
const TOLERANCE: f64 = 1e-5;

/// Returns the files with expected poses.
fn pairs() -> Vec<(PathBuf, PathBuf)> {
    let own = data().join("bvh");
    let mut pairs: Vec<(PathBuf, PathBuf)> = Vec::new();
    for entry in std::fs::read_dir(own.join("expected")).unwrap() {
        let expected = entry.unwrap().path();
        let name = expected.file_stem().unwrap().to_str().unwrap();
        pairs.push((own.join(format!("{name}.bvh")), expected.clone()));
    }
    if let Some(models) = dragonfly_kit::skip::models() {
        for entry in std::fs::read_dir(models.join("../expected")).unwrap() {
            let expected = entry.unwrap().path();
            let name = expected.file_name().unwrap().to_str().unwrap();
            if let Some(name) = name.strip_prefix("bvh__").and_then(|name| name.strip_suffix(".json")) {
                pairs.push((models.join("bvh").join(name), expected.clone()));
            }
        }
    }
    pairs.sort();
    assert!(pairs.len() >= 4);
    pairs
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn joints_and_end_sites_are_where_an_independent_evaluator_finds_them_in_every_file() {
    for (file, expected) in pairs() {
        let model = import_in_meters(&std::fs::read(&file).unwrap());
        let expected: Value = serde_json::from_slice(&std::fs::read(expected).unwrap()).unwrap();
        let bones = &model.animation.skeleton.bones;
        let (ends, joints): (Vec<usize>, Vec<usize>) =
            (0..bones.len()).partition(|&bone| bones[bone].name.ends_with("_end"));
        let names = expected["joints"].as_array().unwrap().iter().map(|joint| joint[0].as_str().unwrap());
        assert!(names.eq(joints.iter().map(|&joint| bones[joint].name.as_str())), "{}", file.display());
        let take = Arc::clone(&model.animation.takes[0]);
        let times = Arc::clone(&take.tracks[0].translation.times);
        assert_eq!(times.len() as u64, expected["frames"].as_u64().unwrap());
        assert!((f64::from(take.length) - expected["duration"].as_f64().unwrap()).abs() < 1e-4);
        let mut evaluator = Evaluator::new(Arc::new(model));
        let mut worst = 0.0_f64;
        for sample in expected["samples"].as_array().unwrap() {
            let time = times[sample["frame"].as_u64().unwrap() as usize];
            assert!((f64::from(time) - sample["t"].as_f64().unwrap()).abs() < 1e-5);
            evaluator.pose(Some(0), time);
            let world = sample["world"].as_array().unwrap().iter().map(numbers);
            let mut compared: Vec<(f64, f64)> = Vec::new();
            for (matrix, &joint) in world.zip(&joints) {
                let ours = evaluator.to_root()[joint].to_cols_array().map(f64::from);
                compared.extend(ours.into_iter().zip(matrix));
            }
            for (position, &end) in sample["endSites"].as_array().unwrap().iter().zip(&ends) {
                let ours = evaluator.to_root()[end].w_axis.truncate().to_array().map(f64::from);
                compared.extend(ours.into_iter().zip(numbers(position)));
            }
            assert_eq!(compared.len(), 16 * joints.len() + 3 * ends.len());
            let largest = compared.iter().fold(1.0_f64, |largest, (_, theirs)| largest.max(theirs.abs()));
            worst = compared.iter().fold(worst, |worst, (a, b)| worst.max((a - b).abs() / largest));
        }
        println!("{}: {worst:.1e}", file.file_name().unwrap().display());
        assert!(worst < TOLERANCE, "{}: {worst}", file.display());
    }
}
