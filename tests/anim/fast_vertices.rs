//! Vertices of the fast path agree with the open path: any number of joints and influences, morph targets, and numbers
//! that are not finite.

use crate::ik::{started, vector};
use dragonfly_anim::data::{Influence, MorphTarget, Primitive, Vertices};
use dragonfly_anim::fast::matrix::{Matrix34, matrix34};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{SkinnedVertices, skin_morphed_vertices, skin_vertices, skin_vertices_by_matrix};
use dragonfly_anim::skin::{Movement, skin_normals, skin_positions};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec3};

/// Allowed difference, relative to the largest number of the same vector, or to 1 if that is smaller.
const RELATIVE: f32 = 1e-5;

/// Poses that differ so little that their sum is not nearly flat.
fn poses(random: &mut Random, joints: usize) -> Vec<Mat4> {
    let pose = |_| {
        let rotation = Quat::from_axis_angle(vector(random).normalize_or(Vec3::X), random.between(0.0, 0.7));
        let scale = Vec3::ONE + vector(random) * 0.3;
        Mat4::from_scale_rotation_translation(scale, rotation, vector(random))
    };
    (0..joints).map(pose).collect()
}

/// Returns `count` vertices with up to `most` influences each, of joints below `joints`.
fn primitive(random: &mut Random, count: usize, joints: usize, most: usize) -> Primitive {
    let mut influences = Vec::new();
    for _ in 0..count {
        let used = 1 + random.below(most);
        let weights: Vec<f32> = (0..used).map(|_| random.between(0.05, 1.0)).collect();
        let sum: f32 = weights.iter().sum();
        influences.extend((0..most).map(|at| match weights.get(at) {
            Some(weight) => Influence { joint: random.below(joints) as u16, weight: weight / sum },
            None => Influence::default(),
        }));
    }
    let vertices = Vertices {
        positions: (0..count).map(|_| vector(random)).collect(),
        normals: (0..count).map(|_| vector(random).normalize_or(Vec3::X)).collect(),
        influences,
        influences_per_vertex: most,
        ..Vertices::default()
    };
    Primitive { vertices, ..Primitive::default() }
}

/// Returns `targets` morph targets; some have no normals.
fn targets(random: &mut Random, targets: usize, count: usize) -> Vec<MorphTarget> {
    let some = |random: &mut Random| (0..count).map(|_| vector(random) * 0.1).collect::<Vec<Vec3>>();
    let target = |at: usize| MorphTarget {
        positions: some(random),
        normals: if at % 3 == 2 { Vec::new() } else { some(random) },
        ..MorphTarget::default()
    };
    (0..targets).map(target).collect()
}

/// Moves `primitive` on both paths and compares the results; morphed, if there are weights.
#[track_caller]
fn compare(primitive: &Primitive, finals: &[Mat4], weights: &[f32], place: &str) {
    let count = primitive.vertices.len();
    let (mut positions, mut normals) = (vec![Vec3::NAN; count], vec![Vec3::NAN; count]);
    skin_positions(primitive, Movement::Skin(finals), weights, &mut positions);
    skin_normals(primitive, Movement::Skin(finals), weights, &mut normals);
    let size = positions.iter().map(|point| point.abs().max_element()).fold(1.0, f32::max);
    let vertices = SkinnedVertices::new(primitive);
    let rows: Vec<Matrix34> = finals.iter().copied().map(matrix34).collect();
    for level in SimdLevel::all() {
        let (mut points, mut directions) = (vec![[f32::NAN; 3]; count], vec![[f32::NAN; 3]; count]);
        let (asked, written) = count_written(level, &vertices, weights, &rows, &mut points, &mut directions);
        assert_eq!((asked, written), (0, count), "{place}");
        for (at, (got, expected)) in points.iter().zip(&positions).enumerate() {
            let off = Vec3::from_array(*got).distance(*expected);
            let place = format!("{place} {} position {at}: {got:?} {expected}", level.name());
            assert!(off <= RELATIVE * size, "{place}");
        }
        for (at, (got, expected)) in directions.iter().zip(&normals).enumerate() {
            let off = Vec3::from_array(*got).distance(*expected);
            assert!(off <= 2.0 * RELATIVE, "{place} {} normal {at}: {got:?} {expected}", level.name());
        }
    }
}

/// Returns the number of allocations, and of written vertices.
fn count_written(
    level: SimdLevel,
    vertices: &SkinnedVertices,
    weights: &[f32],
    finals: &[Matrix34],
    points: &mut [[f32; 3]],
    directions: &mut [[f32; 3]],
) -> (u64, usize) {
    let (asked, written) = count(|| match weights {
        [] => skin_vertices(level, vertices, finals, points, directions),
        weights => skin_morphed_vertices(level, vertices, weights, finals, points, directions),
    });
    (asked.allocations, written)
}

#[test]
fn any_number_of_vertices_influences_and_joints_moves_like_on_the_open_path() {
    let mut random = started(81);
    for count in [0, 1, 7, 8, 9, 31, 127, 128, 129, 400] {
        for (joints, most) in [(1, 1), (5, 2), (60, 4), (256, 4), (257, 4), (300, 8), (3_000, 8), (40, 8)] {
            let primitive = primitive(&mut random, count, joints, most);
            let finals = poses(&mut random, joints);
            compare(
                &primitive,
                &finals,
                &[],
                &format!("{count} vertices, {joints} joints, {most} influences"),
            );
        }
    }
}

#[test]
fn joints_that_the_skin_lacks_count_as_the_identity() {
    let mut random = started(82);
    for count in [5, 200] {
        for (joints, have) in [(60, 20), (60, 0), (256, 255), (300, 256), (300, 10)] {
            let mut primitive = primitive(&mut random, count, joints, 4);
            compare(&primitive, &poses(&mut random, have), &[], &format!("{have} of {joints}"));
            primitive.vertices.influences[2].joint = u16::MAX;
            compare(&primitive, &poses(&mut random, have), &[], &format!("{have} of {}", u16::MAX));
        }
    }
}

#[test]
fn numbers_that_are_not_finite_have_the_same_result_as_on_the_open_path() {
    let mut random = started(83);
    for round in 0..60 {
        let count = [20, 150][round % 2];
        let mut primitive = primitive(&mut random, count, 40, 4);
        let mut finals = poses(&mut random, 40);
        for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            match random.below(3) {
                0 => finals[random.below(40)].as_mut()[random.below(4) * 4 + random.below(3)] = wrong,
                1 => primitive.vertices.positions[random.below(count)][random.below(3)] = wrong,
                _ => primitive.vertices.normals[random.below(count)][random.below(3)] = wrong,
            }
        }
        let weight = random.below(count) * 4;
        primitive.vertices.influences[weight].weight = random.choice(&[f32::NAN, f32::INFINITY, 0.2]);
        compare(&primitive, &finals, &[], &format!("{round}"));
    }
}

#[test]
fn normals_of_flat_and_collapsed_surfaces_agree_with_the_open_path() {
    let mut random = started(84);
    let flat = [Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, Vec3::splat(1e-20)];
    let finals: Vec<Mat4> = flat.map(Mat4::from_scale).to_vec();
    for count in [9, 140] {
        // One joint per vertex, because a sum of flat surfaces is only rounding errors.
        let primitive = primitive(&mut random, count, 4, 1);
        compare(&primitive, &finals, &[], &format!("{count}"));
    }
    let mut loose = primitive(&mut random, 20, 4, 4);
    loose.vertices.influences.iter_mut().for_each(|influence| influence.weight = 0.0);
    compare(&loose, &poses(&mut random, 4), &[], "no weight at all");
}

#[test]
fn normals_of_mirrored_bones_agree_with_the_open_path() {
    let mut random = started(91);
    for (count, most) in [(9, 1), (140, 1), (140, 2), (140, 4)] {
        let primitive = primitive(&mut random, count, 6, most);
        // All mirrored: a sum of both kinds would be nearly flat.
        let mut finals = poses(&mut random, 6);
        finals.iter_mut().for_each(|matrix| *matrix *= Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
        compare(&primitive, &finals, &[], &format!("{count} {most}"));
    }
}

#[test]
fn morph_targets_are_added_like_on_the_open_path() {
    let mut random = started(85);
    for count in [1, 8, 13, 128, 301] {
        for number in [1, 2, 5, 12] {
            let mut primitive = primitive(&mut random, count, 30, 4);
            primitive.morph_targets = targets(&mut random, number, count);
            let finals = poses(&mut random, 30);
            // The number of targets, fewer, and more.
            for weights in [number, number / 2, number + 3] {
                let weights: Vec<f32> =
                    (0..weights).map(|_| random.choice(&[0.0, 0.3, 1.0, -0.7, 2.5])).collect();
                compare(&primitive, &finals, &weights, &format!("{count} {number} {weights:?}"));
            }
        }
    }
}

#[test]
fn without_weights_morph_targets_change_no_bit() {
    let mut random = started(86);
    let mut primitive = primitive(&mut random, 150, 30, 4);
    let finals: Vec<Matrix34> = poses(&mut random, 30).into_iter().map(matrix34).collect();
    let plain = SkinnedVertices::new(&primitive);
    primitive.morph_targets = targets(&mut random, 3, 150);
    let vertices = SkinnedVertices::new(&primitive);
    for level in SimdLevel::all() {
        let moved = |vertices: &SkinnedVertices, weights: &[f32]| {
            let (mut points, mut directions) = (vec![[0.0; 3]; 150], vec![[0.0; 3]; 150]);
            skin_morphed_vertices(level, vertices, weights, &finals, &mut points, &mut directions);
            (points, directions)
        };
        let expected = moved(&plain, &[0.5]);
        for weights in [&[][..], &[0.0, -0.0], &[0.0; 9]] {
            assert_eq!(moved(&vertices, weights), expected);
        }
        assert_ne!(moved(&vertices, &[0.5]), expected);
    }
}

#[test]
fn a_morph_without_a_valid_result_leaves_a_vertex_unchanged() {
    let mut random = started(87);
    for count in [10, 150] {
        let mut primitive = primitive(&mut random, count, 30, 4);
        let mut target = targets(&mut random, 1, count).remove(0);
        target.positions[3].y = f32::NAN;
        target.positions[4].x = f32::INFINITY;
        target.normals[5].z = f32::NAN;
        // This normal becomes zero.
        target.normals[6] = -primitive.vertices.normals[6];
        primitive.morph_targets = vec![target];
        let finals = poses(&mut random, 30);
        for weight in [1.0, 0.5, f32::NAN, f32::INFINITY] {
            compare(&primitive, &finals, &[weight], &format!("{count} {weight}"));
        }
    }
}

#[test]
fn the_shorter_output_limits_the_number_of_written_vertices() {
    let mut random = started(88);
    let primitive = primitive(&mut random, 200, 10, 4);
    let vertices = SkinnedVertices::new(&primitive);
    let finals: Vec<Matrix34> = poses(&mut random, 10).into_iter().map(matrix34).collect();
    let (mut points, mut directions) = (vec![[0.0; 3]; 200], vec![[0.0; 3]; 200]);
    let level = SimdLevel::best();
    assert_eq!(skin_vertices(level, &vertices, &finals, &mut points, &mut directions), 200);
    for room in [0, 1, 7, 8, 9, 130, 199] {
        let (mut some, mut others) = (vec![[0.0; 3]; room], vec![[0.0; 3]; 200]);
        assert_eq!(skin_vertices(level, &vertices, &finals, &mut some, &mut others), room);
        assert_eq!((&some[..], &others[..room]), (&points[..room], &directions[..room]));
        assert!(others[room..].iter().all(|normal| *normal == [0.0; 3]), "{room}");
    }
}

/// Moves `primitive` by the matrix itself and compares positions with the open path, normals with the formula.
#[track_caller]
fn compare_by_matrix(primitive: &Primitive, finals: &[Mat4], place: &str) {
    let number = primitive.vertices.len();
    let mut positions = vec![Vec3::NAN; number];
    skin_positions(primitive, Movement::Skin(finals), &[], &mut positions);
    let normal = |at: usize| {
        let stored = primitive.vertices.normals[at];
        let add = |sum: Vec3, influence: &Influence| {
            let matrix = finals.get(usize::from(influence.joint)).copied().unwrap_or(Mat4::IDENTITY);
            sum + matrix.transform_vector3(stored) * influence.weight
        };
        let used = primitive.vertices.influences_of(at).iter().filter(|influence| influence.weight != 0.0);
        let moved = used.fold(Vec3::ZERO, add);
        [moved, stored].into_iter().find(|normal| normal.is_finite()).unwrap_or(Vec3::ZERO)
    };
    let size = positions.iter().map(|point| point.abs().max_element()).fold(1.0, f32::max);
    let vertices = SkinnedVertices::new(primitive);
    let rows: Vec<Matrix34> = finals.iter().copied().map(matrix34).collect();
    for level in SimdLevel::all() {
        let (mut points, mut directions) = (vec![[f32::NAN; 3]; number], vec![[f32::NAN; 3]; number]);
        let (asked, written) =
            count(|| skin_vertices_by_matrix(level, &vertices, &rows, &mut points, &mut directions));
        assert_eq!((asked.allocations, written), (0, number), "{place}");
        for at in 0..number {
            let place = format!("{place} {} vertex {at}", level.name());
            let off = Vec3::from_array(points[at]).distance(positions[at]);
            assert!(off <= RELATIVE * size, "{place}: {:?} {}", points[at], positions[at]);
            let (got, expected) = (Vec3::from_array(directions[at]), normal(at));
            assert!(
                got.distance(expected) <= 2.0 * RELATIVE * expected.length().max(1.0),
                "{place}: {got} {expected}"
            );
        }
    }
}

#[test]
fn normals_moved_by_the_matrix_keep_its_scale() {
    let mut random = started(89);
    for count in [0, 1, 7, 8, 9, 31, 127, 128, 129, 400] {
        for (joints, most) in [(1, 1), (5, 2), (60, 4), (256, 4), (257, 2), (300, 8)] {
            let primitive = primitive(&mut random, count, joints, most);
            // Fewer poses than joints: the others count as the identity.
            let have = joints - joints / 3;
            let place = format!("{count} vertices, {joints} joints, {most} influences");
            compare_by_matrix(&primitive, &poses(&mut random, have), &place);
        }
    }
    let mut loose = primitive(&mut random, 20, 4, 4);
    loose.vertices.influences.iter_mut().for_each(|influence| influence.weight = 0.0);
    compare_by_matrix(&loose, &poses(&mut random, 4), "no weight at all");
}

#[test]
fn a_normal_that_the_matrix_makes_infinite_is_left_as_stored() {
    let mut random = started(90);
    for round in 0..60 {
        let count = [20, 150][round % 2];
        let most = [1, 2, 4][round % 3];
        let mut primitive = primitive(&mut random, count, 40, most);
        let mut finals = poses(&mut random, 40);
        let wrong = random.choice(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
        match random.below(3) {
            0 => finals[random.below(40)].as_mut()[random.below(4) * 4 + random.below(3)] = wrong,
            1 => primitive.vertices.positions[random.below(count)][random.below(3)] = wrong,
            _ => primitive.vertices.normals[random.below(count)][random.below(3)] = wrong,
        }
        compare_by_matrix(&primitive, &finals, &format!("{round}"));
    }
}
