//! Ray and sphere queries agree with testing every triangle of the animated mesh.

use crate::doors::model_files;
use crate::made::{Weights, direction, fox, load, model, times, vector};
use dragonfly_anim::data::{ModelData, Primitive, Vertices};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::{
    HitLeaf, HitNode, HitPose, HitSettings, HitTree, HitTreeError, Ray, ray_open, sphere_open,
};
use dragonfly_anim::skin::skin_position;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::Vec3;
use std::sync::Arc;

fn pose_of(model: &Arc<ModelData>) -> (Evaluator, HitPose) {
    let tree = HitTree::of(model).unwrap();
    (Evaluator::new(Arc::clone(model)), HitPose::new(Arc::new(tree)))
}

/// Returns a ray that starts near the model and passes roughly through it, sometimes along an axis, sometimes at a
/// vertex.
fn random_ray(random: &mut Random, evaluator: &Evaluator, positions: &[Vec3]) -> Ray {
    let bounds = evaluator.bounds();
    let size = bounds.sphere.radius.max(1e-3);
    let origin = bounds.sphere.center + direction(random) * size * random.choice(&[0.1, 1.0, 3.0, 50.0]);
    let target = match random.below(4) {
        0 => positions.get(random.below(positions.len())).copied().unwrap_or(Vec3::ZERO),
        _ => bounds.sphere.center + vector(random, 0.6) * size,
    };
    let along = random.choice(&[Vec3::X, Vec3::NEG_Y, Vec3::Z]);
    let direction = if random.below(5) == 0 { along } else { target - origin };
    Ray { origin, direction }
}

/// Compares `rays` rays and the same number of spheres in each pose, and returns the number of hits by rays.
fn agrees(random: &mut Random, model: &Arc<ModelData>, poses: usize, rays: usize, name: &str) -> usize {
    let (mut evaluator, mut pose) = pose_of(model);
    let mut hits = 0;
    for (take, time) in times(random, model, poses) {
        evaluator.pose(take, time);
        pose.refit(&evaluator);
        let positions = evaluator.all_positions();
        let size = evaluator.bounds().sphere.radius;
        for _ in 0..rays {
            let ray = random_ray(random, &evaluator, &positions);
            let max_distance = random.choice(&[f32::INFINITY, size, 0.0]);
            let settings = HitSettings { max_distance, back_faces: random.below(2) == 0 };
            let open = ray_open(&evaluator, &positions, &ray, &settings);
            let tree = pose.ray(&evaluator, &ray, &settings);
            assert_eq!(tree, open, "{name} {take:?} {time} {ray:?} {settings:?}");
            assert_eq!(pose.any(&evaluator, &ray, &settings), open.is_some(), "{name} {ray:?} {settings:?}");
            hits += usize::from(open.is_some());
            let radius = random.choice(&[0.01, 0.2, 1.0, f32::INFINITY]) * size;
            let open = sphere_open(&evaluator, &positions, ray.origin, radius);
            assert_eq!(pose.sphere(&evaluator, ray.origin, radius), open, "{name} {ray:?} {radius}");
        }
    }
    hits
}

#[test]
fn the_tree_and_every_triangle_agree_on_the_fox() {
    let seed = seed(21);
    println!("DRAGONFLY_SEED={seed}");
    let hits = agrees(&mut Random::new(seed), &fox(), 15, 120, "fox");
    println!("{hits} hits");
    assert!(hits > 1_000, "{hits}");
}

#[test]
fn the_tree_and_every_triangle_agree_on_made_models() {
    let seed = seed(22);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let mut hits = 0;
    for round in 0..150 {
        let weights = if round % 2 == 0 { Weights::Healthy } else { Weights::Wild };
        let model = model(&mut random, weights);
        hits += agrees(&mut random, &model, 4, 20, &format!("round {round}"));
    }
    assert!(hits > 2_000, "{hits}");
}

#[test]
fn the_tree_and_every_triangle_agree_on_all_files() {
    let mut random = Random::new(seed(23));
    for path in model_files() {
        agrees(&mut random, &load(&path), 1, 10, path.file_name().unwrap().to_str().unwrap());
    }
}

#[test]
fn the_fields_of_a_hit_agree_with_its_position() {
    let mut random = Random::new(seed(24));
    for round in 0..40 {
        let model = if round == 0 { fox() } else { model(&mut random, Weights::Healthy) };
        let (mut evaluator, mut pose) = pose_of(&model);
        evaluator.pose(Some(0), 0.7);
        pose.refit(&evaluator);
        let positions = evaluator.all_positions();
        let size = evaluator.bounds().sphere.radius;
        for _ in 0..60 {
            let ray = random_ray(&mut random, &evaluator, &positions);
            let Some(hit) = pose.ray(&evaluator, &ray, &HitSettings::default()) else { continue };
            let front = HitSettings { back_faces: false, ..HitSettings::default() };
            let from_front = pose.ray(&evaluator, &ray, &front);
            assert!(from_front.is_none_or(|hit| hit.front) && (!hit.front || from_front == Some(hit)));
            let along = ray.origin + ray.direction.normalize() * hit.distance;
            // f32 has seven digits of the distance from the origin.
            assert!(along.distance(hit.position) < 1e-5 * (size + hit.distance), "{hit:?}");
            let primitive = &evaluator.primitives(hit.instance as usize)[hit.primitive as usize];
            let mut own = vec![Vec3::ZERO; primitive.vertices.len()];
            evaluator.positions(hit.instance as usize, hit.primitive as usize, &mut own);
            let corners = corners(primitive, hit.triangle);
            let [a, b, c] = corners.map(|corner| own[corner]);
            let mixed = a * hit.barycentric.x + b * hit.barycentric.y + c * hit.barycentric.z;
            assert!(mixed.distance(hit.position) < 1e-5 * size);
            assert!(
                (hit.barycentric.element_sum() - 1.0).abs() < 1e-5 && hit.barycentric.min_element() >= 0.0
            );
            assert!(hit.normal.dot(b - a).abs() < 1e-4 * size && (hit.normal.length() - 1.0).abs() < 1e-5);
            assert_eq!(hit.front, hit.normal.dot(ray.direction) < 0.0, "{hit:?}");
            assert_eq!(hit.bone, heaviest(&model, hit.instance, primitive, corners, hit.barycentric));
        }
    }
}

fn corners(primitive: &Primitive, triangle: u32) -> [usize; 3] {
    [0, 1, 2].map(|corner| primitive.indices[triangle as usize * 3 + corner] as usize)
}

/// Returns the bone with the greatest mixed weight, looked up in a list of the length of the skeleton.
fn heaviest(
    model: &ModelData,
    instance: u32,
    primitive: &Primitive,
    at: [usize; 3],
    shares: Vec3,
) -> Option<u32> {
    let instance = &model.instances[instance as usize];
    let Some(skin) = instance.skin else { return instance.bone };
    let mut sums = vec![0.0_f64; model.animation.skeleton.len()];
    for (corner, share) in at.into_iter().zip(shares.to_array()) {
        for influence in primitive.vertices.influences_of(corner) {
            let bone = model.skins[skin as usize].bones[usize::from(influence.joint)];
            sums[bone as usize] += f64::from(influence.weight) * f64::from(share);
        }
    }
    (0..sums.len()).max_by(|&a, &b| sums[a].total_cmp(&sums[b])).map(|bone| bone as u32)
}

#[test]
fn a_single_vertex_has_the_same_position_as_among_all() {
    let mut random = Random::new(seed(27));
    for round in 0..60 {
        let weights = if round % 2 == 0 { Weights::Healthy } else { Weights::Wild };
        let mut model = model(&mut random, weights).as_ref().clone();
        model.meshes[0].primitives[0].vertices.positions[3] = Vec3::new(1e38, f32::NAN, 0.0);
        model.meshes[0].primitives[0].vertices.positions[4] = Vec3::splat(3e38);
        let mut evaluator = Evaluator::new(Arc::new(model));
        evaluator.pose(Some(0), random.between(0.0, 2.0));
        for instance in 0..3 {
            let primitive = &evaluator.primitives(instance)[0];
            let mut all = vec![Vec3::ZERO; primitive.vertices.len()];
            evaluator.positions(instance, 0, &mut all);
            let (movement, weights) =
                (evaluator.movement(instance, 0).unwrap(), evaluator.morph_weights(instance));
            for (index, position) in all.iter().enumerate() {
                let alone = skin_position(primitive, movement, weights, index).unwrap();
                assert_eq!(alone.to_array().map(f32::to_bits), position.to_array().map(f32::to_bits));
            }
            assert_eq!(skin_position(primitive, movement, weights, usize::MAX), None);
        }
    }
}

#[test]
fn a_tree_restored_from_its_parts_gives_the_same_results() {
    let model = fox();
    let tree = HitTree::of(&model).unwrap();
    let again = HitTree::from_parts(tree.parts().clone(), &model).unwrap();
    assert_eq!(tree.parts(), again.parts());
    assert_eq!(tree.parts(), HitTree::of(&model).unwrap().parts());
    let evaluator = Evaluator::new(model);
    let (mut a, mut b) = (HitPose::new(Arc::new(tree)), HitPose::new(Arc::new(again)));
    a.refit(&evaluator);
    b.refit(&evaluator);
    let mut random = Random::new(1);
    let positions = evaluator.all_positions();
    for _ in 0..200 {
        let ray = random_ray(&mut random, &evaluator, &positions);
        let settings = HitSettings::default();
        assert_eq!(a.ray(&evaluator, &ray, &settings), b.ray(&evaluator, &ray, &settings));
    }
}

#[test]
fn changed_parts_are_refused_or_still_find_every_hit() {
    let seed = seed(25);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let model = model(&mut random, Weights::Healthy);
    let sound = HitTree::of(&model).unwrap().into_parts();
    let (mut evaluator, mut refused) = (Evaluator::new(Arc::clone(&model)), 0);
    evaluator.pose(Some(0), 1.3);
    let positions = evaluator.all_positions();
    for round in 0..400 {
        let mut parts = sound.clone();
        let value = random.choice(&[0, 1, 2, 3, 7, u32::MAX]);
        let (node, leaf) = (random.below(parts.nodes.len()), random.below(parts.leaves.len()));
        match round % 8 {
            0 => parts.nodes[node] = HitNode::Leaf(value),
            1 => parts.nodes[node] = HitNode::Inner([value, random.below(9) as u32]),
            2 => parts.leaves[leaf].instance = value,
            3 => parts.leaves[leaf].count = value,
            4 => parts.leaves[leaf].first = value,
            5 => parts.triangles[random.below(40)] = value,
            6 => parts.triangles.truncate(random.below(60)),
            _ => parts.nodes.truncate(node),
        }
        match HitTree::from_parts(parts, &model) {
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
            Ok(tree) => {
                let mut pose = HitPose::new(Arc::new(tree));
                pose.refit(&evaluator);
                let ray = random_ray(&mut random, &evaluator, &positions);
                let settings = HitSettings::default();
                let open = ray_open(&evaluator, &positions, &ray, &settings);
                assert_eq!(pose.ray(&evaluator, &ray, &settings), open);
            }
        }
    }
    println!("{refused} of 400 refused");
    assert!(refused > 250);
    let fox_parts = HitTree::of(&fox()).unwrap().into_parts();
    assert!(HitTree::from_parts(fox_parts, &model).is_err());
    let nothing = HitTree::from_parts(Default::default(), &model);
    assert!(matches!(nothing, Err(HitTreeError::Missing { found: 0, .. })));
}

#[test]
fn refitting_and_queries_allocate_nothing() {
    let (mut evaluator, mut pose) = pose_of(&fox());
    let ray = Ray { origin: Vec3::new(0.0, 40.0, 500.0), direction: Vec3::NEG_Z };
    let (count, hits) = count(|| {
        let mut hits = 0;
        for step in 0..20 {
            evaluator.pose(Some(1), step as f32 * 0.05);
            pose.refit(&evaluator);
            hits += usize::from(pose.ray(&evaluator, &ray, &HitSettings::default()).is_some());
            hits += usize::from(pose.any(&evaluator, &ray, &HitSettings::default()));
            hits += usize::from(pose.sphere(&evaluator, Vec3::ZERO, 500.0).is_some());
        }
        hits
    });
    assert_eq!((count.allocations, hits), (0, 60));
}

#[test]
fn of_two_equally_near_hits_the_first_in_the_file_is_returned() {
    let mut model = model(&mut Random::new(6), Weights::Healthy).as_ref().clone();
    let primitive = &mut model.meshes[2].primitives[0];
    // Every triangle a second time, after all others.
    let count = primitive.indices.len();
    primitive.indices.extend_from_within(..);
    model.instances.drain(..2);
    let model = Arc::new(model);
    let (evaluator, mut pose) = pose_of(&model);
    pose.refit(&evaluator);
    let (positions, mut random, mut hits) = (evaluator.all_positions(), Random::new(8), 0);
    for _ in 0..300 {
        let ray = random_ray(&mut random, &evaluator, &positions);
        let open = ray_open(&evaluator, &positions, &ray, &HitSettings::default());
        let found = [
            open,
            pose.ray(&evaluator, &ray, &HitSettings::default()),
            pose.sphere(&evaluator, ray.origin, f32::INFINITY),
        ];
        for hit in found.into_iter().flatten() {
            assert!((hit.triangle as usize) < count / 3, "{hit:?}");
            hits += 1;
        }
    }
    assert!(hits > 400, "{hits}");
}

#[test]
fn empty_space_and_invalid_rays_give_no_hit() {
    let empty = Arc::new(ModelData::default());
    let (evaluator, mut pose) = pose_of(&empty);
    pose.refit(&evaluator);
    let ray = Ray { origin: Vec3::ZERO, direction: Vec3::X };
    assert_eq!(pose.ray(&evaluator, &ray, &HitSettings::default()), None);
    let (evaluator, mut pose) = pose_of(&fox());
    assert_eq!(pose.sphere(&evaluator, Vec3::ZERO, f32::INFINITY), None, "not refitted yet");
    pose.refit(&evaluator);
    let ray = Ray { origin: Vec3::new(0.0, 40.0, 500.0), direction: Vec3::NEG_Z };
    assert!(pose.any(&evaluator, &ray, &HitSettings::default()));
    for hostile in [f32::NAN, f32::INFINITY] {
        for ray in [
            Ray { origin: Vec3::splat(hostile), ..ray },
            Ray { direction: Vec3::new(0.0, hostile, 1.0), ..ray },
            Ray { direction: Vec3::ZERO, ..ray },
        ] {
            assert!(!pose.any(&evaluator, &ray, &HitSettings::default()));
        }
        assert_eq!(pose.sphere(&evaluator, Vec3::splat(hostile), 1.0), None);
    }
    for max_distance in [f32::NAN, -1.0] {
        assert!(!pose.any(&evaluator, &ray, &HitSettings { max_distance, back_faces: true }));
        assert_eq!(pose.sphere(&evaluator, Vec3::ZERO, max_distance), None);
    }
}

#[test]
fn damaged_geometry_gives_the_same_hits_with_and_without_the_tree() {
    let mut random = Random::new(seed(26));
    for _ in 0..40 {
        let mut model = model(&mut random, Weights::Wild).as_ref().clone();
        for mesh in &mut model.meshes {
            let primitive = &mut mesh.primitives[0];
            for _ in 0..6 {
                let at = random.below(primitive.indices.len());
                primitive.indices[at] = random.choice(&[0, 5, 6, u32::MAX, 1_000_000]);
                let at = random.below(primitive.vertices.len());
                primitive.vertices.positions[at] =
                    random.choice(&[Vec3::NAN, Vec3::INFINITY, Vec3::MAX, Vec3::ZERO, Vec3::splat(1e20)]);
            }
        }
        agrees(&mut random, &Arc::new(model), 2, 20, "damaged");
    }
    let lonely =
        Primitive { vertices: Vertices::default(), indices: vec![0, 1, 2, 3], ..Primitive::default() };
    let mut model = model(&mut random, Weights::Healthy).as_ref().clone();
    model.meshes[0].primitives = vec![lonely];
    model.instances[1].mesh = 77;
    agrees(&mut random, &Arc::new(model), 2, 20, "lonely");
}

#[test]
fn a_stored_tree_that_is_a_chain_is_refused() {
    let model = model(&mut Random::new(4), Weights::Healthy);
    let mut parts = HitTree::of(&model).unwrap().into_parts();
    let sound = std::mem::take(&mut parts.leaves);
    for leaf in sound {
        let one = |at| HitLeaf { first: leaf.first + at, count: 1, ..leaf };
        parts.leaves.extend((0..leaf.count).map(one));
    }
    let leaves = parts.leaves.len() as u32;
    parts.nodes.clear();
    for leaf in 0..leaves - 1 {
        parts.nodes.extend([HitNode::Inner([leaf * 2 + 1, leaf * 2 + 2]), HitNode::Leaf(leaf)]);
    }
    parts.nodes.push(HitNode::Leaf(leaves - 1));
    let error = HitTree::from_parts(parts, &model).unwrap_err();
    assert_eq!(error, HitTreeError::Deep { depth: leaves as usize });
}

#[path = "../../anim/examples/hit_test.rs"]
mod example;

#[test]
fn the_example_runs() {
    example::main();
}
