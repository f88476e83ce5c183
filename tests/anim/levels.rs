//! Levels of detail keep their invariants, and their stated errors are correct.

use crate::doors::model_files;
use crate::made::{Weights, fox, load, model, vector};
use dragonfly_anim::bounds::Sphere;
use dragonfly_anim::data::{Influence, Mesh, MeshInstance, ModelData, Primitive, Vertices};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::nearest_on_triangle;
use dragonfly_anim::level::{
    LevelSettings, Lod, Progression, Screen, SimplifySettings, choose_level, error_in_pixels, levels,
    radius_in_pixels, simplify,
};
use dragonfly_kit::random::{Random, seed};
use glam::{DVec3, Mat4, Vec2, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Instant;

/// A wavy sheet of `side × side` squares, skinned along x by two joints.
fn sheet(side: usize) -> Primitive {
    let mut vertices = Vertices { influences_per_vertex: 4, ..Vertices::default() };
    for row in 0..=side {
        for column in 0..=side {
            let [x, y] = [column, row].map(|at| at as f32 / side as f32);
            vertices.positions.push(Vec3::new(x, y, (x * 6.0).sin() * 0.1 + (y * 5.0).cos() * 0.05));
            vertices.normals.push(Vec3::Z);
            vertices.texture_coordinates[0].push(Vec2::new(x, y));
            let right = Influence { joint: 1, weight: x };
            let left = Influence { joint: 0, weight: 1.0 - x };
            vertices.influences.extend([left, right, Influence::default(), Influence::default()]);
        }
    }
    let (mut indices, width) = (Vec::new(), side as u32 + 1);
    for row in 0..side as u32 {
        for column in 0..side as u32 {
            let a = row * width + column;
            indices.extend([a, a + 1, a + width, a + 1, a + width + 1, a + width]);
        }
    }
    Primitive { vertices, indices, ..Primitive::default() }
}

fn free(_: usize) -> bool {
    false
}

fn after(progression: &Progression, primitive: &Primitive, steps: usize) -> Vec<u32> {
    let mut out = Vec::new();
    progression.indices_after(primitive, steps, &mut Vec::new(), &mut out);
    out
}

fn normal(primitive: &Primitive, corners: &[u32]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|at| primitive.vertices.positions[corners[at] as usize].as_dvec3());
    (b - a).cross(c - a)
}

/// Checks the invariants of `progression` after different numbers of steps.
fn is_sound(primitive: &Primitive, progression: &Progression, name: &str) {
    let steps = progression.steps();
    assert_eq!(after(progression, primitive, 0), primitive.indices, "{name}");
    for part in 1..=4 {
        let steps = steps * part / 4;
        let indices = after(progression, primitive, steps);
        if steps > 0 {
            assert_eq!(indices.len() / 3, progression.left[steps] as usize, "{name}");
        }
        assert!(indices.iter().all(|&index| (index as usize) < primitive.vertices.len()));
        let original: BTreeSet<u32> = primitive.indices.iter().copied().collect();
        assert!(
            indices.iter().all(|index| original.contains(index)),
            "{name}: a vertex that no triangle used"
        );
        // Every remaining triangle still faces the same side.
        let gone = |triangle: &usize| progression.gone_after[*triangle] as usize <= steps;
        let survivors = (0..primitive.indices.len() / 3).filter(|triangle| steps == 0 || !gone(triangle));
        for (triangle, now) in survivors.zip(indices.chunks_exact(3)) {
            let before = normal(primitive, &primitive.indices[triangle * 3..triangle * 3 + 3]);
            let after = normal(primitive, now);
            let kept =
                before.length() < 1e-12 || after.dot(before) > -1e-9 * after.length() * before.length();
            assert!(kept, "{name} triangle {triangle}: {before} {after}");
        }
    }
    assert!(progression.left.windows(2).all(|pair| pair[1] < pair[0] || pair[0] == progression.left[0]));
    let vertices: BTreeSet<u32> = progression.moves.iter().map(|one| one.vertex).collect();
    assert_eq!(vertices.len(), progression.moves.len(), "{name}: a vertex moves once");
}

/// Returns the number of edges with only one triangle, as pairs of positions.
fn border(primitive: &Primitive, indices: &[u32]) -> usize {
    let mut edges: BTreeMap<[[u32; 3]; 2], usize> = BTreeMap::new();
    let bits =
        |index: u32| primitive.vertices.positions[index as usize].to_array().map(|n| (n + 0.0).to_bits());
    for corners in indices.chunks_exact(3) {
        for at in 0..3 {
            let mut edge = [bits(corners[at]), bits(corners[(at + 1) % 3])];
            edge.sort_unstable();
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges.values().filter(|&&count| count == 1).count()
}

#[test]
fn a_sheet_is_reduced_to_an_eighth_and_stays_a_sheet() {
    let primitive = sheet(40);
    let progression = simplify(&primitive, &[], &free, &SimplifySettings::default());
    is_sound(&primitive, &progression, "sheet");
    let steps = progression.steps_to(400);
    let indices = after(&progression, &primitive, steps);
    assert!(indices.len() / 3 <= 400, "{}", indices.len() / 3);
    // The corners of the sheet remain, and its area as seen from above is the same.
    for corner in [0, 40, 41 * 40, 41 * 41 - 1] {
        assert!(indices.contains(&corner), "{corner}");
    }
    let area: f64 = indices.chunks_exact(3).map(|corners| normal(&primitive, corners).z / 2.0).sum();
    assert!((area - 1.0).abs() < 1e-6, "{area}");
    // No vertex is far from the remaining surface.
    let far = furthest(&primitive.vertices.positions, &primitive.vertices.positions, &indices);
    println!("{} triangles, {far} away", indices.len() / 3);
    assert!(far < 0.01, "{far}");
}

/// Returns the largest distance from one of `points` to the triangles of `indices` over `positions`; every triangle is
/// tested.
fn furthest(points: &[Vec3], positions: &[Vec3], indices: &[u32]) -> f64 {
    let mut largest = 0.0_f64;
    for point in points {
        let nearest = indices.chunks_exact(3).filter_map(|corners| {
            let corners = [0, 1, 2].map(|at| positions[corners[at] as usize]);
            Some(nearest_on_triangle(point.as_dvec3(), corners)?.1)
        });
        largest = largest.max(nearest.fold(f64::INFINITY, f64::min));
    }
    largest
}

#[test]
fn a_seam_stays_closed_and_its_sides_stay_apart() {
    let seed = seed(31);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..60 {
        let model = model(&mut random, Weights::Healthy);
        let primitive = &model.meshes[0].primitives[0];
        let progression = simplify(primitive, &[], &free, &SimplifySettings::default());
        is_sound(primitive, &progression, &format!("round {round}"));
        assert!(progression.steps() > 10, "{round}: {}", progression.steps());
        for steps in [progression.steps() / 2, progression.steps()] {
            let indices = after(&progression, primitive, steps);
            // A tube is open at its two ends, and nowhere else.
            let ends = border(primitive, &indices);
            assert!((6..=14).contains(&ends), "{round}: {ends} edges with one triangle");
            for corners in indices.chunks_exact(3) {
                // Across the seam the coordinate jumps by 1: a triangle with both would show the whole texture.
                let u = [0, 1, 2].map(|at| primitive.vertices.texture_coordinates[0][corners[at] as usize].x);
                let (low, high) =
                    (u.iter().copied().fold(1.0, f32::min), u.iter().copied().fold(0.0, f32::max));
                assert!(high - low < 0.75, "{round}: {u:?}");
            }
        }
    }
}

/// Returns a sheet of 16 × 16 squares with a slit in its texture coordinates from the lower edge to the middle, and the
/// vertices on the right of the slit.
fn slit() -> (Primitive, std::ops::Range<u32>) {
    let mut primitive = sheet(16);
    let first = primitive.vertices.len() as u32;
    for row in 0..8 {
        let on_slit = row * 17 + 8;
        let vertices = &mut primitive.vertices;
        vertices.positions.push(vertices.positions[on_slit]);
        vertices.normals.push(Vec3::Z);
        vertices.texture_coordinates[0].push(vertices.texture_coordinates[0][on_slit] + Vec2::X * 0.3);
        let influences = vertices.influences_of(on_slit).to_vec();
        vertices.influences.extend(influences);
    }
    let right = |corners: &[u32]| {
        let x = corners.iter().map(|&corner| primitive.vertices.positions[corner as usize].x);
        x.fold(0.0, f32::max) > 0.5
    };
    let mut indices = primitive.indices.clone();
    for corners in indices.chunks_exact_mut(3).filter(|corners| right(corners)) {
        for corner in corners.iter_mut().filter(|corner| **corner % 17 == 8 && **corner / 17 < 8) {
            *corner = first + *corner / 17;
        }
    }
    primitive.indices = indices;
    (primitive, first..first + 8)
}

#[test]
fn a_seam_that_ends_within_the_surface_keeps_its_sides() {
    let (primitive, right) = slit();
    for skin in [0.0, 0.1, 1.0] {
        let progression = simplify(&primitive, &[], &free, &SimplifySettings { triangles: 20, skin });
        is_sound(&primitive, &progression, "slit");
        for part in 1..=20 {
            let steps = progression.steps() * part / 20;
            let indices = after(&progression, &primitive, steps);
            let stays = |triangle: &usize| progression.gone_after[*triangle] as usize > steps;
            let survivors = (0..progression.gone_after.len()).filter(stays);
            for (triangle, now) in survivors.zip(indices.chunks_exact(3)) {
                let before = &primitive.indices[triangle * 3..triangle * 3 + 3];
                let x = before.iter().map(|&corner| primitive.vertices.positions[corner as usize].x);
                let was_right = x.fold(0.0, f32::max) > 0.5;
                let left = |corner: u32| corner % 17 == 8 && corner / 17 < 8 && corner < right.start;
                let wrong = |&corner: &u32| if was_right { left(corner) } else { right.contains(&corner) };
                assert!(!now.iter().any(wrong), "{before:?} became {now:?} after part {part}");
            }
        }
    }
}

#[test]
fn locked_vertices_stay() {
    let primitive = sheet(12);
    let locked = |vertex: usize| vertex.is_multiple_of(3);
    let progression = simplify(&primitive, &[], &locked, &SimplifySettings::default());
    assert!(progression.steps() > 20);
    assert!(progression.moves.iter().all(|one| !locked(one.vertex as usize)));
}

#[test]
fn the_same_input_gives_the_same_levels() {
    let model = fox();
    let primitive = &model.meshes[0].primitives[0];
    let first = simplify(primitive, &[], &free, &SimplifySettings::default());
    assert_eq!(first, simplify(primitive, &[], &free, &SimplifySettings::default()));
    assert!(first.steps() > 0);
}

#[test]
fn a_sheet_that_bends_keeps_its_vertices_where_it_bends() {
    // Flat as stored, so only the influences and the poses determine where vertices are needed: in the middle.
    let mut primitive = sheet(20);
    for (index, position) in primitive.vertices.positions.iter_mut().enumerate() {
        position.z = 0.0;
        let right = if position.x > 0.5 { 1.0 } else { 0.0 };
        primitive.vertices.influences[index * 4].weight = 1.0 - right;
        primitive.vertices.influences[index * 4 + 1].weight = right;
    }
    let stored = &primitive.vertices.positions;
    let bent = |position: &Vec3| {
        let turned = Vec3::new(0.5, position.y, position.x - 0.5);
        if position.x > 0.5 { turned } else { *position }
    };
    let bent: Vec<Vec3> = stored.iter().map(bent).collect();
    let error = |poses: &[Vec<Vec3>], skin: f32| {
        let progression = simplify(&primitive, poses, &free, &SimplifySettings { skin, triangles: 60 });
        let indices = after(&progression, &primitive, progression.steps());
        assert!(indices.len() / 3 <= 60);
        furthest(&bent, &bent, &indices)
    };
    let (without, with_skin) = (error(&[], 0.0), error(&[], 1.0));
    let with_pose = error(std::slice::from_ref(&bent), 0.1);
    println!("bent by 90 degrees: {without} off, {with_skin} with influences, {with_pose} with a pose");
    assert!(with_skin < without && with_pose < 0.03, "{without} {with_skin} {with_pose}");
}

#[test]
fn levels_of_the_fox_have_their_stated_error() {
    let model = fox();
    let begin = Instant::now();
    let chain = levels(&model, &LevelSettings { poses: 3, ..LevelSettings::default() });
    let size = Evaluator::new(Arc::clone(&model)).bounds().sphere.radius;
    for level in &chain {
        println!(
            "{} triangles, error {} = {:.4} of the radius",
            level.triangles,
            level.error,
            level.error / size
        );
    }
    println!("{:?}", begin.elapsed());
    assert_eq!((chain[0].triangles, chain[0].error), (576, 0.0));
    assert!(chain.len() >= 3, "{}", chain.len());
    let primitive = &model.meshes[0].primitives[0];
    let mut evaluator = Evaluator::new(Arc::clone(&model));
    for level in &chain[1..] {
        // The same poses, every vertex against every triangle.
        let indices = &level.indices[0][0];
        let mut largest = 0.0_f64;
        for take in [None, Some(0), Some(1), Some(2)] {
            for pose in 0..3 {
                let time = take.map_or(0.0, |take: usize| {
                    let take = &model.animation.takes[take];
                    take.start + take.length * (pose as f32 / 2.0)
                });
                evaluator.pose(take, time);
                let mut positions = vec![Vec3::ZERO; primitive.vertices.len()];
                evaluator.positions(0, 0, &mut positions);
                largest = largest.max(furthest(&positions, &positions, indices));
            }
        }
        assert!((f64::from(level.error) - largest).abs() < 1e-4 * largest, "{} {largest}", level.error);
        assert!(level.error < 0.25 * size);
    }
}

#[test]
fn every_file_gets_levels_with_finite_errors_and_no_level_loses_a_primitive() {
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let model = load(&path);
        let begin = Instant::now();
        // Models with many takes would take long.
        let poses = if model.animation.takes.len() > 4 { 1 } else { 2 };
        let chain = levels(&model, &LevelSettings { poses, ..LevelSettings::default() });
        let size = Evaluator::new(Arc::clone(&model)).bounds().sphere.radius;
        let described: Vec<String> = chain
            .iter()
            .map(|level| format!("{} ({:.2} %)", level.triangles, level.error / size * 100.0))
            .collect();
        println!("{name:<40} {} in {:?}", described.join(", "), begin.elapsed());
        for (mesh, (of, indices)) in model.meshes.iter().zip(&chain[chain.len() - 1].indices).enumerate() {
            for (primitive, indices) in of.primitives.iter().zip(indices) {
                assert!(primitive.indices.is_empty() || !indices.is_empty(), "{name} mesh {mesh}");
            }
        }
        assert!(chain.iter().all(|level| level.error.is_finite()), "{name}");
    }
}

#[test]
fn there_is_no_crack_between_two_primitives() {
    // One sheet cut in two: left and right of the middle.
    let whole = sheet(16);
    let side = |left: bool| {
        let middle = |corners: &&[u32]| {
            let x: f32 = corners.iter().map(|&index| whole.vertices.positions[index as usize].x / 3.0).sum();
            (x < 0.5) == left
        };
        let indices = whole.indices.chunks_exact(3).filter(middle).flatten().copied().collect();
        Primitive { indices, ..whole.clone() }
    };
    let mesh = Mesh { primitives: vec![side(true), side(false)], ..Mesh::default() };
    let mut model = model(&mut Random::new(2), Weights::Healthy).as_ref().clone();
    model.meshes = vec![mesh];
    model.instances.truncate(1);
    let chain = levels(&model, &LevelSettings { ratios: vec![0.3], ..LevelSettings::default() });
    let [left, right] = [0, 1].map(|primitive| &chain[1].indices[0][primitive]);
    assert!(chain[1].triangles < 400, "{}", chain[1].triangles);
    for indices in [left, right] {
        for row in 0..=16 {
            assert!(indices.contains(&(row * 17 + 8)), "{row}");
        }
    }
}

#[test]
fn invalid_meshes_are_reduced_in_a_bounded_time() {
    let seed = seed(32);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..300 {
        let count = random.below(30);
        let choices =
            [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE, Vec3::NAN, Vec3::INFINITY, Vec3::MAX, -Vec3::ZERO];
        let positions = (0..count).map(|_| match random.below(4) {
            0 => random.choice(&choices),
            _ => vector(&mut random, 1.0),
        });
        let vertices = Vertices { positions: positions.collect(), ..Vertices::default() };
        let indices = (0..random.below(200)).map(|_| match random.below(40) {
            0 => u32::MAX,
            _ => random.below(count + 1) as u32,
        });
        let indices: Vec<u32> = indices.collect();
        let primitive = Primitive { vertices, indices, ..Primitive::default() };
        let skin = random.choice(&[1.0, f32::NAN, -1.0, f32::INFINITY]);
        let progression = simplify(&primitive, &[], &free, &SimplifySettings { skin, triangles: 0 });
        let indices = after(&progression, &primitive, progression.steps());
        assert!(indices.len() <= primitive.indices.len(), "{round}");
        let model = ModelData {
            meshes: vec![Mesh { primitives: vec![primitive], ..Mesh::default() }],
            instances: vec![MeshInstance {
                mesh: 0,
                node: None,
                skin: None,
                bone: None,
                to_bone: Mat4::IDENTITY,
                morph_weights: vec![],
            }],
            ..ModelData::default()
        };
        let ratios = vec![0.5, f32::NAN, -1.0, 0.0];
        assert!(!levels(&model, &LevelSettings { ratios, ..LevelSettings::default() }).is_empty());
    }
}

#[test]
fn a_vertex_shared_by_many_triangles_is_not_slow() {
    let begin = Instant::now();
    // A wheel of 100,000 spokes, 100,000 triangles on one edge, and 100,000 triangles on top of each other.
    let many = 100_000_u32;
    let rim = |spoke: u32| {
        let angle = spoke as f32 * 6e-5;
        Vec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let positions: Vec<Vec3> = std::iter::once(Vec3::ZERO).chain((0..many).map(rim)).collect();
    let vertices = Vertices { positions, ..Vertices::default() };
    let wheel = (1..many).flat_map(|spoke| [0, spoke, spoke + 1]).collect();
    let pile = (2..many).flat_map(|spoke| [0, 1, spoke]).collect();
    let stack = (0..many).flat_map(|_| [0, 1, 2]).collect();
    for indices in [wheel, pile, stack] {
        let primitive = Primitive { vertices: vertices.clone(), indices, ..Primitive::default() };
        let progression = simplify(&primitive, &[], &free, &SimplifySettings::default());
        println!("{} steps after {:?}", progression.steps(), begin.elapsed());
    }
    assert!(begin.elapsed().as_secs() < 60, "{:?}", begin.elapsed());
}

#[test]
fn a_large_sheet_is_reduced_within_seconds() {
    let primitive = sheet(300);
    let begin = Instant::now();
    let progression =
        simplify(&primitive, &[], &free, &SimplifySettings { triangles: 20_000, ..Default::default() });
    println!(
        "{} triangles to {} in {:?}",
        primitive.indices.len() / 3,
        progression.left.last().unwrap(),
        begin.elapsed()
    );
    assert!(*progression.left.last().unwrap() <= 20_000);
    assert!(begin.elapsed().as_secs() < 60);
}

fn level(error: f32) -> Lod {
    Lod { indices: vec![], triangles: 0, error }
}

#[test]
fn the_level_follows_the_distance_and_does_not_flicker() {
    let chain = [0.0, 0.01, 0.05, 0.2].map(level);
    let sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let screen = |distance: f32| Screen { eye: Vec3::Z * distance, vertical_fov: 1.0, height: 1080.0 };
    let choose = |distance, current| choose_level(&chain, &screen(distance), &sphere, 1.0, 0.3, current);
    assert_eq!([0.5, 2.0, 12.0, 60.0, 300.0].map(|distance| choose(distance, None)), [0, 0, 1, 2, 3]);
    // Out and in again: every level is chosen once in each direction, and the visible error never exceeds the limit.
    let (mut current, mut changes) = (0, 0);
    for step in (0..2_000).chain((0..2_000).rev()) {
        // A distance that varies like that of a hand-held camera.
        let distance = 2.5 + step as f32 * 0.2 + if step % 2 == 0 { 0.6 } else { -0.6 };
        let next = choose(distance, Some(current));
        assert!(error_in_pixels(&screen(distance), &sphere, chain[next].error) <= 1.0);
        changes += usize::from(next != current);
        current = next;
    }
    assert_eq!((changes, current), (6, 0));
}

#[test]
fn sizes_on_the_screen_agree_with_the_projection() {
    let sphere = Sphere { center: Vec3::new(0.0, 0.0, -5.0), radius: 3.0 };
    let screen = Screen { eye: Vec3::ZERO, vertical_fov: std::f32::consts::FRAC_PI_2, height: 200.0 };
    // The tangent of the angle whose sine is 3/5 is 3/4; half the height is 100 pixels at 45°.
    assert!((radius_in_pixels(&screen, &sphere) - 75.0).abs() < 1e-4);
    assert!((error_in_pixels(&screen, &sphere, 0.5) - 25.0).abs() < 1e-4);
    let inside = Screen { eye: sphere.center, ..screen };
    assert_eq!(radius_in_pixels(&inside, &sphere), f32::INFINITY);
    assert_eq!(error_in_pixels(&inside, &sphere, 0.1), f32::INFINITY);
    assert_eq!(error_in_pixels(&inside, &sphere, 0.0), 0.0);
    let chain = [0.0, 0.1].map(level);
    for hostile in [f32::NAN, f32::INFINITY] {
        let screen = Screen { eye: Vec3::splat(hostile), ..screen };
        assert!(choose_level(&chain, &screen, &sphere, 1.0, 0.2, Some(9)) < 2);
        assert!(choose_level(&[], &screen, &sphere, hostile, hostile, None) == 0);
    }
    let far = Screen { eye: Vec3::Z * 1e6, ..screen };
    assert_eq!(choose_level(&chain, &far, &sphere, 1.0, 0.0, None), 1);
}

#[path = "../../anim/examples/levels.rs"]
mod example;

#[test]
fn the_example_runs() {
    example::main();
}
