//! A stroke in the view is the line of action of a chain: its bones have the directions of the parts of the stroke.

use crate::ik::{PARENTS, ParentScale, direction, matrices, only_rotations, origin, row, started};
use crate::support::bone;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::ik::{ActionLine, IkError, line_of_action};
use dragonfly_anim::sample::rest_pose;
use glam::{Quat, Vec3};

/// Three bones of these offsets after a root at the origin.
fn chain_of(offsets: &[Vec3]) -> (Skeleton, Vec<Transform>) {
    let mut bones = vec![bone("root", None, Vec3::ZERO)];
    bones.extend(
        offsets
            .iter()
            .enumerate()
            .map(|(index, offset)| bone(&format!("{index}"), Some(index as u32), *offset)),
    );
    let skeleton = Skeleton { bones };
    let poses = skeleton.bones.iter().map(rest_pose).collect();
    (skeleton, poses)
}

/// Returns the joints after a stroke that is seen from +z.
fn drawn(offsets: &[Vec3], stroke: &[Vec3]) -> Vec<Vec3> {
    let (skeleton, mut poses) = chain_of(offsets);
    let to_root = matrices(&skeleton, &poses);
    let line = ActionLine { root: 0, end: offsets.len() as u32, stroke, back: Vec3::Z };
    line_of_action(&skeleton, &to_root, &line, None, &mut poses).unwrap();
    let after = matrices(&skeleton, &poses);
    (0..skeleton.len()).map(|bone| origin(&after, bone)).collect()
}

fn assert_near(found: &[Vec3], expected: &[[f32; 3]]) {
    let expected: Vec<Vec3> = expected.iter().map(|point| Vec3::from_array(*point)).collect();
    let near = found.iter().zip(&expected).all(|(found, expected)| found.distance(*expected) < 1e-5);
    assert!(near && found.len() == expected.len(), "{found:?} instead of {expected:?}");
}

#[test]
fn bones_lie_along_the_parts_of_a_stroke() {
    // Two thirds of the stroke go to the right, the last one up.
    let stroke = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 0.0)];
    let up = [Vec3::Y; 3];
    let expected = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]];
    assert_near(&drawn(&up, &stroke), &expected);
    // Size, place and depth of the stroke do not count.
    let elsewhere = stroke.map(|point| point * 7.0 + Vec3::new(20.0, -3.0, 5.0));
    assert_near(&drawn(&up, &elsewhere), &expected);
    // Bones of other lengths have other parts: 2 of 4, 1 of 4, 1 of 4.
    let stroke = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), Vec3::new(2.0, 2.0, 0.0)];
    let expected = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 2.0, 0.0]];
    assert_near(&drawn(&[Vec3::Y * 2.0, Vec3::Y, Vec3::Y], &stroke), &expected);
}

#[test]
fn two_bones_on_a_quarter_of_a_circle_have_its_chords() {
    let stroke: Vec<Vec3> = (0..=900)
        .map(|step| {
            let (sin, cos) = (step as f32 / 900.0 * std::f32::consts::FRAC_PI_2).sin_cos();
            Vec3::new(sin, 1.0 - cos, 0.0)
        })
        .collect();
    // From 0° to 45° the chord has 22.5°, from 45° to 90° it has 67.5°.
    let (sin, cos) = (22.5_f32).to_radians().sin_cos();
    assert_near(
        &drawn(&[Vec3::X, Vec3::X], &stroke),
        &[[0.0; 3], [cos, sin, 0.0], [cos + sin, sin + cos, 0.0]],
    );
}

#[test]
fn the_end_of_the_stroke_near_the_first_joint_is_its_start() {
    let stroke = [Vec3::new(2.0, 1.0, 0.0), Vec3::new(2.0, 0.0, 0.0), Vec3::ZERO];
    let found = drawn(&[Vec3::X; 3], &stroke);
    assert_near(&found, &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]);
}

#[test]
fn bones_keep_their_depth() {
    // 0.6 in the view, 0.8 towards the viewer; the second one away from the viewer.
    let offsets = [Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.6, 0.0, -0.8)];
    let stroke = [Vec3::ZERO, Vec3::new(0.0, 5.0, 0.0)];
    assert_near(&drawn(&offsets, &stroke), &[[0.0; 3], [0.0, 0.6, 0.8], [0.0, 1.2, 0.0]]);
    // A bone that points at the viewer has no part of the stroke.
    let offsets = [Vec3::X, Vec3::Z, Vec3::X];
    assert_near(&drawn(&offsets, &stroke), &[[0.0; 3], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 2.0, 1.0]]);
}

#[test]
fn a_limited_bone_stays_within_its_limit_and_the_next_one_has_the_direction_of_the_stroke() {
    let (skeleton, mut poses) = chain_of(&[Vec3::X; 3]);
    let to_root = matrices(&skeleton, &poses);
    let stroke = [Vec3::ZERO, Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 2.0, 0.0)];
    let line = ActionLine { root: 0, end: 3, stroke: &stroke, back: Vec3::Z };
    let mut stiff = |bone: u32, rotation: Quat| if bone == 1 { Quat::IDENTITY } else { rotation };
    line_of_action(&skeleton, &to_root, &line, Some(&mut stiff), &mut poses).unwrap();
    let after = matrices(&skeleton, &poses);
    let joints: Vec<Vec3> = (0..4).map(|bone| origin(&after, bone)).collect();
    assert_near(&joints, &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]);
}

#[test]
fn under_any_parent_bones_keep_length_and_depth_and_look_like_the_stroke() {
    let mut random = started(91);
    for round in 0..2_000 {
        let (links, parent) = (1 + random.below(7), random.choice(&PARENTS[..3]));
        let (skeleton, mut poses) = row(&mut random, links, parent);
        let (before, old) = (poses.clone(), matrices(&skeleton, &poses));
        let back = direction(&mut random);
        // A straight stroke: all bones have its direction in the view, whichever end is the start.
        let along = (direction(&mut random).cross(back)).normalize_or(back.any_orthonormal_vector());
        let stroke = [Vec3::ZERO, along * 3.0];
        let line = ActionLine { root: 1, end: links as u32 + 1, stroke: &stroke, back };
        line_of_action(&skeleton, &old, &line, None, &mut poses).unwrap();
        only_rotations(&before, &poses);
        let new = matrices(&skeleton, &poses);
        let size = if parent == ParentScale::Uniform { poses[0].scale.x } else { 1.0 };
        let mut sign = 0.0;
        for bone in 1..=links {
            let [was, is] = [&old, &new].map(|of| (origin(of, bone + 1) - origin(of, bone)) / size);
            assert!((was.length() - is.length()).abs() < 1e-4, "{round}: {was} {is}");
            assert!((was.dot(back) - is.dot(back)).abs() < 1e-4, "{round}: {was} {is}");
            let flat = is - back * is.dot(back);
            let side = flat.dot(along).signum();
            sign = if sign == 0.0 { side } else { sign };
            assert!(
                (flat - along * sign * flat.length()).length() < 1e-3,
                "{round}: {flat} is not along {along}"
            );
        }
    }
}

#[test]
fn what_has_no_solution_is_an_error_and_leaves_the_poses() {
    let (skeleton, mut poses) = chain_of(&[Vec3::X; 3]);
    let (before, to_root) = (poses.clone(), matrices(&skeleton, &poses));
    let stroke = [Vec3::ZERO, Vec3::Y];
    let line = ActionLine { root: 0, end: 3, stroke: &stroke, back: Vec3::Z };
    let wrong = IkError::NotFinite { bone: 0 };
    let below = IkError::NotBelow { above: 0, below: 0 };
    let cases: [(ActionLine<'_>, IkError); 7] = [
        (ActionLine { stroke: &[], ..line }, IkError::NoLine),
        (ActionLine { stroke: &[Vec3::Y; 3], ..line }, IkError::NoLine),
        (ActionLine { stroke: &[Vec3::ZERO, Vec3::NAN], ..line }, wrong),
        (ActionLine { back: Vec3::ZERO, ..line }, IkError::NoLine),
        (ActionLine { back: Vec3::X, ..line }, IkError::NoLine),
        (ActionLine { end: 0, ..line }, below),
        (ActionLine { end: 9, ..line }, IkError::NoSuchBone { bone: 9 }),
    ];
    for (line, error) in cases {
        assert_eq!(line_of_action(&skeleton, &to_root, &line, None, &mut poses), Err(error), "{line:?}");
        assert_eq!(poses, before);
    }
}
