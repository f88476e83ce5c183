//! A pose of any model is written as OBJ and reads back as it was.

use crate::doors::{MemoryFs, TestFolder, model_files};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{ReadOptions, obj, read};
use dragonfly_kit::counting::count;
use glam::Vec3;
use std::sync::Arc;

#[test]
fn positions_triangles_and_materials_of_a_pose_read_back() {
    let mut compared = 0;
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let door = TestFolder(path.parent().unwrap().to_owned());
        let model =
            read(&name, &std::fs::read(&path).unwrap(), &door, &ReadOptions::default()).unwrap().model;
        if model.instances.is_empty() {
            continue;
        }
        let mut evaluator = Evaluator::new(Arc::new(model));
        let end = evaluator.model().animation.takes.first().map_or(0.0, |take| take.end());
        evaluator.pose(Some(0), end * 0.4);
        let plan = obj::write(&evaluator, "pose");
        assert_eq!(plan.files.last().unwrap().name, "pose.obj");
        let files: Vec<(&str, &[u8])> =
            plan.files.iter().map(|file| (file.name.as_str(), file.bytes.as_slice())).collect();
        let door = MemoryFs::with(&files);
        let again =
            read("pose.obj", &plan.files.last().unwrap().bytes, &door, &ReadOptions::default()).unwrap();
        for warning in &again.warnings {
            assert!(["POLYGON_DEGENERATE"].contains(&warning.code), "{name}: {warning}");
        }
        // Triangle by triangle, without those that have no area.
        let corners = |evaluator: &Evaluator| {
            let mut corners: Vec<[Vec3; 3]> = Vec::new();
            for instance in 0..evaluator.model().instances.len() {
                for (index, primitive) in evaluator.primitives(instance).iter().enumerate() {
                    let mut positions = vec![Vec3::ZERO; primitive.vertices.len()];
                    evaluator.positions(instance, index, &mut positions);
                    let triangles = primitive.indices.chunks_exact(3);
                    corners.extend(
                        triangles.map(|three| [0, 1, 2].map(|corner| positions[three[corner] as usize])),
                    );
                }
            }
            corners.retain(|[a, b, c]| {
                (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3()).length() > 0.0
            });
            let bits = |corners: &[Vec3; 3]| {
                corners.map(|corner| corner.to_array().map(|number| (number + 0.0).to_bits()))
            };
            corners.sort_by_key(bits);
            corners
        };
        let read_back = Evaluator::new(Arc::new(again.model));
        let (ours, theirs) = (corners(&evaluator), corners(&read_back));
        assert!(ours == theirs, "{name}: {} and {} triangles", ours.len(), theirs.len());
        compared += 1;
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn names_and_values_of_materials_read_back() {
    let text =
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0 1 0 0.5\nv 0 1 0\nvt 0.25 0.75\no a b\nusemtl one\nf 1/1 2/1 3/1\n";
    let mtl = "newmtl one\nKd 0.5 0.25 1\nKs 0.5 0.5 0.5\nNs 30\nKe 0 1 0\nd 0.5\n";
    let door = MemoryFs::with(&[("a.mtl", mtl.as_bytes())]);
    let model = read("a.obj", text.as_bytes(), &door, &ReadOptions::default()).unwrap().model;
    let plan = obj::write(&Evaluator::new(Arc::new(model.clone())), "out");
    let door = MemoryFs::with(&[("out.mtl", &plan.files[0].bytes)]);
    let again = read("out.obj", &plan.files[1].bytes, &door, &ReadOptions::default()).unwrap().model;
    assert_eq!(again.meshes[0].name, "a_b_0");
    assert_eq!(again.materials[0].name, "one_0");
    let mut material = again.materials[0].clone();
    material.name = "one".to_owned();
    assert_eq!(material, model.materials[0]);
    let (ours, theirs) = (&model.meshes[0].primitives[0].vertices, &again.meshes[0].primitives[0].vertices);
    assert_eq!(
        (&ours.positions, &ours.texture_coordinates),
        (&theirs.positions, &theirs.texture_coordinates)
    );
    assert!(ours.colors.iter().zip(&theirs.colors).all(|(a, b)| (*a - *b).length() < 1e-6));
}

#[test]
fn every_frame_of_a_sequence_is_the_pose_at_its_time_and_too_many_are_refused() {
    let door = TestFolder(crate::doors::data().join("gltf"));
    let bytes = std::fs::read(crate::doors::data().join("gltf/Fox.glb")).unwrap();
    let model = read("Fox.glb", &bytes, &door, &ReadOptions::default()).unwrap().model;
    let plan = obj::write_sequence(&model, "Fox.obj", 10.0).unwrap();
    let count = (model.animation.takes[0].length * 10.0).floor() as usize + 1;
    let is_frame = |name: &str| name.starts_with("Fox_") && name.ends_with(".obj");
    assert_eq!(plan.files.iter().filter(|file| is_frame(&file.name)).count(), count);
    assert_eq!(plan.files.last().unwrap().name, "Fox.obj");
    assert_eq!(plan.files.iter().filter(|file| file.name.ends_with(".mtl")).count(), 1);
    let start = model.animation.takes[0].start;
    let mut evaluator = Evaluator::new(Arc::new(model.clone()));
    for frame in [0, 7, count - 1] {
        evaluator.pose(Some(0), start + frame as f32 / 10.0);
        let expected = obj::write(&evaluator, "Fox").files.pop().unwrap().bytes;
        let file = plan.files.iter().find(|file| file.name == format!("Fox_{frame:04}.obj")).unwrap();
        assert!(file.bytes == expected, "frame {frame}");
    }
    let error = obj::write_sequence(&model, "Fox.obj", 1e9).unwrap_err();
    assert!(error.to_string().contains("fewer frames per second"), "{error}");
}

#[test]
fn the_images_of_a_sequence_are_copied_once() {
    let door = TestFolder(crate::doors::data().join("gltf"));
    let bytes = std::fs::read(crate::doors::data().join("gltf/Fox.glb")).unwrap();
    let mut model = read("Fox.glb", &bytes, &door, &ReadOptions::default()).unwrap().model;
    let allocated =
        |model: &ModelData| count(|| obj::write_sequence(model, "Fox.obj", 30.0).unwrap()).0.bytes;
    let small = allocated(&model);
    model.images[0].bytes = vec![7; 4 << 20].into();
    let large = allocated(&model);
    assert!(large - small < 7 << 20, "{} bytes more for an image of 4 MiB", large - small);
}
