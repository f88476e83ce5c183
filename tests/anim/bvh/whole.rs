//! A BVH file of any model has the positions of its bones.

use super::made::{files, import_in_meters};
use crate::doors::{TestFolder, model_files};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{Conventions, NoFiles, ReadOptions, bvh, read};
use std::sync::Arc;

/// Reads a written file; its lengths are in centimeters.
fn read_back(bytes: &[u8]) -> ModelData {
    let conventions = Conventions { meters_per_unit: Some(0.01), ..Conventions::default() };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    bvh::BVH.import(bytes, &NoFiles, &options).unwrap().model
}

/// Returns the largest distance of bones of the same name in several frames, relative to the size of the model.
fn distance(model: &ModelData, written: &ModelData) -> f32 {
    let bone_of = |index: usize| {
        let name = &written.animation.skeleton.bones[index].name;
        model.animation.skeleton.bones.iter().position(|bone| bone.name == *name)
    };
    let pairs: Vec<(usize, usize)> =
        (0..written.animation.skeleton.len()).filter_map(|index| Some((index, bone_of(index)?))).collect();
    assert!(pairs.len() >= model.animation.skeleton.len().min(written.animation.skeleton.len()) / 2);
    let take = model.animation.takes.first();
    let start = take.and_then(|take| take.range_of_keys()).unwrap_or_default().0;
    let tracks = &written.animation.takes[0].tracks;
    let times = &tracks.iter().find(|track| !track.rotation.is_empty()).unwrap().rotation.times;
    let [mut ours, mut theirs] = [model, written].map(|model| Evaluator::new(Arc::new(model.clone())));
    let (mut worst, mut size) = (0.0_f32, 1e-3_f32);
    for &time in times.iter().step_by((times.len() / 7).max(1)) {
        ours.pose(Some(0), start + time);
        theirs.pose(Some(0), time);
        for &(there, here) in &pairs {
            let positions =
                [ours.to_root()[here], theirs.to_root()[there]].map(|matrix| matrix.w_axis.truncate());
            worst = worst.max(positions[0].distance(positions[1]));
            size = size.max(positions[0].length());
        }
    }
    worst / size
}

#[test]
fn models_of_every_kind_have_their_joints_in_the_same_places_after_they_are_written() {
    let mut compared = 0;
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let door = TestFolder(path.parent().unwrap().to_owned());
        let model =
            read(&name, &std::fs::read(&path).unwrap(), &door, &ReadOptions::default()).unwrap().model;
        if model.animation.skeleton.is_empty() {
            assert!(bvh::write(&model).is_err());
            continue;
        }
        let file = bvh::write(&model).unwrap();
        assert!((bvh::BVH.sniff)(&file.bytes));
        let written = read_back(&file.bytes);
        let names: Vec<&str> = model.animation.skeleton.bones.iter().map(|bone| bone.name.as_str()).collect();
        let unique: std::collections::HashSet<&&str> = names.iter().collect();
        if unique.len() < names.len()
            || names.iter().any(|name| name.contains(char::is_whitespace) || name.is_empty())
        {
            continue;
        }
        let off = distance(&model, &written);
        println!("{name}: {off:.1e}");
        assert!(off < 1e-4, "{name}: {off}");
        compared += 1;
    }
    assert!(compared > 15, "{compared}");
}

#[test]
fn a_motion_that_is_written_again_has_the_same_joints_names_and_poses() {
    for path in files() {
        let model = import_in_meters(&std::fs::read(&path).unwrap());
        let file = bvh::write(&model).unwrap();
        let written = read_back(&file.bytes);
        let bones = |model: &ModelData| -> Vec<(String, Option<u32>)> {
            model.animation.skeleton.bones.iter().map(|bone| (bone.name.clone(), bone.parent)).collect()
        };
        let missing: Vec<_> =
            bones(&model).into_iter().filter(|bone| !bones(&written).contains(bone)).collect();
        assert_eq!(missing, [], "{}", path.display());
        let off = distance(&model, &written);
        assert!(off < 1e-5, "{}: {off}", path.display());
    }
}

#[test]
fn angles_are_continuous_and_losses_are_listed() {
    let fox = crate::doors::data().join("gltf/Fox.glb");
    let fox = read("Fox.glb", &std::fs::read(fox).unwrap(), &NoFiles, &ReadOptions::default()).unwrap().model;
    let file = bvh::write(&fox).unwrap();
    let lost: Vec<String> = file.lost.iter().map(ToString::to_string).collect();
    assert_eq!(
        lost,
        [
            "/meshes: only bones are stored: no meshes, skins, materials and images",
            "/animation/takes/1: take \"Walk\": a BVH file has one take",
            "/animation/takes/2: take \"Run\": a BVH file has one take",
            "/animation/skeleton: lengths are in centimeters, which the file does not contain, and the figure is not as large as a human",
        ]
    );
    let text = String::from_utf8(file.bytes).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip_while(|line| !line.starts_with("Frame Time"))
        .skip(1)
        .map(|row| row.split(' ').map(|number| number.parse().unwrap()).collect())
        .collect();
    assert_eq!(
        format!("Frames: {}", rows.len()),
        text.lines().find(|line| line.starts_with("Frames")).unwrap()
    );
    let jumps = rows
        .windows(2)
        .flat_map(|pair| pair[0].iter().zip(&pair[1]))
        .filter(|(a, b)| (*a - *b).abs() > 180.0);
    assert_eq!(jumps.count(), 0);
}
