//! Bounds computed from one box per bone contain every vertex.

use crate::doors::model_files;
use crate::made::{Weights, fox, load, model, times};
use dragonfly_anim::bounds::{AxisBox, BoneBoxes};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::Vec3;
use std::sync::Arc;

/// Returns the largest ratios of the size to the exact size, for box and sphere, over `each` random times of every
/// take.
fn never_misses(random: &mut Random, model: &Arc<ModelData>, each: usize, name: &str) -> [f32; 2] {
    let boxes = BoneBoxes::of(model);
    let mut evaluator = Evaluator::new(Arc::clone(model));
    let (mut sums, mut count) = ([0.0, 0.0], 0.0);
    for (take, time) in times(random, model, each) {
        evaluator.pose(take, time);
        let (got, exact) = (boxes.bounds(&evaluator), evaluator.bounds());
        for position in evaluator.all_positions() {
            assert!(got.contains(position), "{name} {take:?} {time}: {position} {got:?}");
            // Larger numbers cannot be represented.
            let largest = got.sphere.radius == f32::MAX;
            assert!(largest || got.sphere.contains(position), "{name} {take:?} {time}: {position} {got:?}");
        }
        if exact.sphere.radius > 0.0 {
            sums[0] += (got.max - got.min).length() / (exact.max - exact.min).length();
            sums[1] += got.sphere.radius / exact.sphere.radius;
            count += 1.0;
        }
    }
    sums.map(|sum| if count > 0.0 { sum / count } else { 1.0 })
}

#[test]
fn no_vertex_of_any_file_is_outside_of_its_bounds_at_any_time() {
    let seed = seed(11);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let [by_box, by_sphere] = never_misses(&mut random, &load(&path), 9, name);
        println!("{name:<40} box {by_box:.3} sphere {by_sphere:.3} times the exact one");
        assert!((1.0..3.0).contains(&by_box) && by_sphere < 4.0, "{name} {by_box} {by_sphere}");
    }
}

#[test]
fn no_vertex_of_any_random_model_is_outside_of_its_bounds() {
    let seed = seed(12);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..400 {
        let weights = if round % 2 == 0 { Weights::Healthy } else { Weights::Wild };
        let model = model(&mut random, weights);
        never_misses(&mut random, &model, 5, &format!("round {round}"));
    }
}

#[test]
fn the_box_of_the_fox_is_tight() {
    let [by_box, by_sphere] = never_misses(&mut Random::new(1), &fox(), 40, "fox");
    println!("box {by_box:.3} sphere {by_sphere:.3}");
    assert!(by_box < 1.15 && by_sphere < 1.35, "{by_box} {by_sphere}");
}

#[test]
fn bounds_from_boxes_allocate_nothing() {
    let model = fox();
    let boxes = BoneBoxes::of(&model);
    let mut evaluator = Evaluator::new(model);
    let (count, _) = count(|| {
        for step in 0..20 {
            evaluator.pose(Some(1), step as f32 * 0.05);
            std::hint::black_box(boxes.bounds(&evaluator));
        }
    });
    assert_eq!(count.allocations, 0);
}

#[test]
fn bounds_contain_the_largest_floats() {
    let mut random = Random::new(5);
    for size in [1e19, 1e30, 1e38, f32::MAX, 1e-42] {
        for _ in 0..40 {
            let mut model = model(&mut random, Weights::Wild).as_ref().clone();
            for mesh in &mut model.meshes {
                for vertex in &mut mesh.primitives[0].vertices.positions {
                    *vertex *= size / 4.0;
                }
                mesh.primitives[0].vertices.positions[3] = Vec3::new(f32::NAN, 1.0, 2.0);
            }
            never_misses(&mut random, &Arc::new(model), 3, &format!("{size}"));
        }
    }
}

#[test]
fn a_model_without_vertices_has_the_bounds_of_its_bones_and_missing_parts_are_empty() {
    let mut model = model(&mut Random::new(3), Weights::Healthy).as_ref().clone();
    model.meshes.clear();
    let model = Arc::new(model);
    let (boxes, evaluator) = (BoneBoxes::of(&model), Evaluator::new(model));
    assert_eq!(boxes.bounds(&evaluator), evaluator.bounds());
    assert_eq!(boxes.of_primitive(&evaluator, 0, 0), AxisBox::EMPTY);
    assert_eq!(boxes.of_primitive(&evaluator, 99, 99), AxisBox::EMPTY);
}
