//! Limbs, chains and look-at reach every reachable target, and change nothing but rotations.

use crate::support::bone;
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::ik::{
    Chain, ChainScratch, EndOrientation, IkError, Pole, TwoBone, chain, soft_distance, two_bone,
};
use dragonfly_anim::sample::rest_pose;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{DVec3, Mat3, Mat4, Quat, Vec3};

/// Scale of the parent of a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ParentScale {
    Plain,
    Uniform,
    Mirrored,
    Uneven,
}

pub(crate) const PARENTS: [ParentScale; 4] =
    [ParentScale::Plain, ParentScale::Uniform, ParentScale::Mirrored, ParentScale::Uneven];

pub(crate) fn started(usual: u64) -> Random {
    let seed = seed(usual);
    println!("DRAGONFLY_SEED={seed}");
    Random::new(seed)
}

pub(crate) fn vector(random: &mut Random) -> Vec3 {
    Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)))
}

pub(crate) fn direction(random: &mut Random) -> Vec3 {
    vector(random).normalize_or(Vec3::Y)
}

pub(crate) fn turn(random: &mut Random) -> Quat {
    Quat::from_array([(); 4].map(|()| random.between(-1.0, 1.0))).normalize()
}

/// Bone 0 is the parent, then a row of `links + 1` bones; all rotated at random.
pub(crate) fn row(random: &mut Random, links: usize, parent: ParentScale) -> (Skeleton, Vec<Transform>) {
    let mut bones = vec![bone("parent", None, vector(random))];
    for index in 0..=links {
        let length = if index == 0 { 1.0 } else { random.between(0.2, 2.0) };
        let offset = direction(random) * length;
        bones.push(bone(&format!("link {index}"), Some(index as u32), offset));
    }
    let skeleton = Skeleton { bones };
    let mut poses: Vec<Transform> = skeleton.bones.iter().map(rest_pose).collect();
    poses.iter_mut().for_each(|pose| pose.rotation = turn(random));
    poses[0].scale = match parent {
        ParentScale::Plain => Vec3::ONE,
        ParentScale::Uniform => Vec3::splat(random.between(0.01, 20.0)),
        ParentScale::Mirrored => Vec3::new(-1.0, 1.0, 1.0),
        ParentScale::Uneven => Vec3::new(random.between(0.5, 2.0), -random.between(0.5, 2.0), 1.0),
    };
    (skeleton, poses)
}

pub(crate) fn matrices(skeleton: &Skeleton, poses: &[Transform]) -> Vec<Mat4> {
    let mut out = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, poses, &mut out);
    out
}

pub(crate) fn origin(matrices: &[Mat4], bone: usize) -> Vec3 {
    matrices[bone].w_axis.truncate()
}

/// Returns the lengths of the row in the space of its parent.
pub(crate) fn lengths(poses: &[Transform]) -> Vec<f32> {
    poses[2..].iter().map(|pose| pose.translation.length()).collect()
}

/// Returns a point of to-root space at `distance` from the row's first joint, measured in the space of its parent.
pub(crate) fn at_distance(matrices: &[Mat4], poses: &[Transform], way: Vec3, distance: f32) -> Vec3 {
    matrices[0].transform_point3(poses[1].translation + way * distance)
}

/// Checks that only rotations have changed.
pub(crate) fn only_rotations(before: &[Transform], after: &[Transform]) {
    for (before, after) in before.iter().zip(after) {
        assert_eq!((before.translation, before.scale), (after.translation, after.scale));
        assert!(after.is_finite() && (after.rotation.length() - 1.0).abs() < 1e-5, "{after:?}");
    }
}

#[test]
fn a_limb_reaches_every_reachable_target_under_any_parent() {
    let mut random = started(21);
    for round in 0..4_000 {
        let parent = random.choice(&PARENTS);
        let (skeleton, mut poses) = row(&mut random, 2, parent);
        let (before, old) = (poses.clone(), matrices(&skeleton, &poses));
        let parts = lengths(&poses);
        let (least, most) = ((parts[0] - parts[1]).abs(), parts[0] + parts[1]);
        let share = random.choice(&[0.0, 1e-4, 0.999, 0.999_99, 1.0, 0.5, 0.3, 0.7]);
        let target = at_distance(&old, &poses, direction(&mut random), least + (most - least) * share);
        let mut limb = TwoBone::new(1, 2, 3);
        limb.pole = match random.below(3) {
            0 => Pole::AsPosed,
            1 => Pole::Direction(vector(&mut random)),
            _ => Pole::Point(vector(&mut random) * 5.0),
        };
        let reach = two_bone(&skeleton, &old, &limb, target, &mut poses).unwrap();
        let end = origin(&matrices(&skeleton, &poses), 3);
        let size = most * poses[0].scale.abs().max_element();
        assert!(end.distance(target) < 1e-4 * size, "{round} {parent:?} {share} {end} {target} {size}");
        assert!((reach.distance - end.distance(target)).abs() < 1e-4 * size, "{round} {reach:?}");
        only_rotations(&before, &poses);
    }
}

/// Returns the positions of middle and end by the law of cosines in f64, from nothing but lengths, target and pole.
fn closed_form(root: DVec3, target: DVec3, pole: DVec3, a: f64, b: f64) -> [DVec3; 2] {
    let along = (target - root).normalize();
    let distance = (target - root).length().clamp((a - b).abs(), a + b);
    let side = ((pole - root) - along * (pole - root).dot(along)).normalize();
    // Height of the triangle over its side root–end.
    let foot = (a * a - b * b + distance * distance) / (2.0 * distance);
    let height = (a * a - foot * foot).max(0.0).sqrt();
    [root + along * foot + side * height, root + along * distance]
}

#[test]
fn a_limb_with_a_pole_agrees_with_the_law_of_cosines_in_f64() {
    let mut random = started(22);
    for round in 0..4_000 {
        let parent = random.choice(&[ParentScale::Plain, ParentScale::Uniform, ParentScale::Mirrored]);
        let (skeleton, mut poses) = row(&mut random, 2, parent);
        let old = matrices(&skeleton, &poses);
        let root = origin(&old, 1);
        let size = poses[0].scale.abs().x;
        let parts = lengths(&poses).into_iter().map(|length| length * size).collect::<Vec<_>>();
        let (least, most) = ((parts[0] - parts[1]).abs(), parts[0] + parts[1]);
        // Also out of reach; the pole is far from the line to the target.
        let distance = least * 0.5 + (most * 1.5 - least * 0.5) * random.unit() + 1e-3 * most;
        let way = direction(&mut random);
        let across = way.cross(direction(&mut random)).normalize_or(way.any_orthonormal_vector());
        let (target, pole) = (root + way * distance, root + across * most + way * random.between(-1.0, 1.0));
        let limb = TwoBone { pole: Pole::Point(pole), ..TwoBone::new(1, 2, 3) };
        two_bone(&skeleton, &old, &limb, target, &mut poses).unwrap();
        let new = matrices(&skeleton, &poses);
        let [a, b] = [parts[0], parts[1]].map(f64::from);
        let [middle, end] = closed_form(root.as_dvec3(), target.as_dvec3(), pole.as_dvec3(), a, b);
        let off = |bone, place: DVec3| (origin(&new, bone).as_dvec3() - place).length() / f64::from(most);
        assert!(off(3, end) < 2e-5, "{round} {parent:?}: end off by {}", off(3, end));
        // Near full extension and full folding the height is the root of a small difference, which has half the digits.
        assert!(off(2, middle) < 2e-3, "{round} {parent:?}: middle off by {}", off(2, middle));
        let slack =
            ((f64::from(distance) - f64::from(least)).min(f64::from(most - distance))) / f64::from(most);
        assert!(slack < 0.02 || off(2, middle) < 5e-5, "{round}: {} with slack {slack}", off(2, middle));
    }
}

#[test]
fn a_limb_out_of_reach_points_straight_at_its_target() {
    let mut random = started(23);
    for round in 0..1_000 {
        let (skeleton, mut poses) = row(&mut random, 2, ParentScale::Uniform);
        let old = matrices(&skeleton, &poses);
        let way = direction(&mut random);
        let most: f32 = lengths(&poses).iter().sum();
        let target = at_distance(&old, &poses, way, most * random.choice(&[1.0001, 2.0, 1e4]));
        two_bone(&skeleton, &old, &TwoBone::new(1, 2, 3), target, &mut poses).unwrap();
        let new = matrices(&skeleton, &poses);
        let expected = at_distance(&old, &poses, way, most);
        let size = most * poses[0].scale.x;
        assert!(origin(&new, 3).distance(expected) < 1e-4 * size, "{round}");
        let upper = (origin(&new, 2) - origin(&new, 1)).normalize();
        let lower = (origin(&new, 3) - origin(&new, 2)).normalize();
        assert!(upper.distance(lower) < 2e-3, "{round} {upper} {lower}");
    }
}

#[test]
fn weight_zero_changes_no_bit_and_half_a_weight_goes_half_the_way() {
    let mut random = started(24);
    let mut scratch = ChainScratch::default();
    for _ in 0..200 {
        let (skeleton, poses) = row(&mut random, 4, ParentScale::Plain);
        let old = matrices(&skeleton, &poses);
        let target = vector(&mut random) * 3.0;
        for weight in [0.0, -0.0, -1.0, f32::NAN] {
            let orientation = EndOrientation::SetToRoot(Quat::from_rotation_x(1.0));
            let limb = TwoBone { weight, end_orientation: orientation, ..TwoBone::new(1, 2, 4) };
            let mut after = poses.clone();
            two_bone(&skeleton, &old, &limb, target, &mut after).unwrap();
            assert_eq!(after, poses);
            let row = Chain { weight, ..Chain::new(1, 5) };
            chain(&skeleton, &old, &row, target, None, &mut scratch, &mut after).unwrap();
            assert_eq!(after, poses);
        }
        let solved = |weight: f32| {
            let mut after = poses.clone();
            let limb = TwoBone { weight, ..TwoBone::new(1, 2, 4) };
            two_bone(&skeleton, &old, &limb, target, &mut after).unwrap();
            after[1].rotation
        };
        let (half, full) = (solved(0.5), solved(1.0));
        let angle = crate::support::angle_between;
        let way = angle(poses[1].rotation, full);
        assert!((angle(poses[1].rotation, half) - 0.5 * way).abs() < 1e-4, "{way}");
    }
}

#[test]
fn the_bend_goes_to_the_side_of_the_pole_and_without_one_stays_in_its_plane() {
    let bones = vec![
        bone("hip", None, Vec3::Y * 2.0),
        bone("knee", Some(0), -Vec3::Y),
        bone("foot", Some(1), -Vec3::Y),
    ];
    let skeleton = Skeleton { bones };
    let rest: Vec<Transform> = skeleton.bones.iter().map(rest_pose).collect();
    let old = matrices(&skeleton, &rest);
    for pole in [Vec3::Z, Vec3::X, Vec3::NEG_Z, Vec3::new(0.3, 9.0, -0.2)] {
        let mut poses = rest.clone();
        let limb = TwoBone { pole: Pole::Direction(pole), ..TwoBone::new(0, 1, 2) };
        two_bone(&skeleton, &old, &limb, Vec3::new(0.0, 0.8, 0.0), &mut poses).unwrap();
        let knee = origin(&matrices(&skeleton, &poses), 1);
        let side = Vec3::new(pole.x, 0.0, pole.z).normalize();
        let expected = Vec3::new(0.0, 1.4, 0.0) + side * 0.8;
        assert!(knee.distance(expected) < 1e-5, "{pole}: {knee}");
        // A straight leg bends to that side immediately and does not twist.
        assert!(poses[0].rotation.y.abs() < 1e-6, "{pole}: {}", poses[0].rotation);
    }
    // Slightly bent forward, the knee stays in the plane x = 0 however it is lifted.
    let mut poses = rest.clone();
    poses[0].rotation = Quat::from_rotation_x(-0.1);
    poses[1].rotation = Quat::from_rotation_x(0.2);
    let old = matrices(&skeleton, &poses);
    two_bone(&skeleton, &old, &TwoBone::new(0, 1, 2), Vec3::new(0.0, 1.2, 0.4), &mut poses).unwrap();
    let knee = origin(&matrices(&skeleton, &poses), 1);
    assert!(knee.x.abs() < 1e-6 && knee.z > 0.5, "{knee}");
}

#[test]
fn soft_reach_has_no_step_and_never_quite_straightens() {
    let (length, softness) = (2.0_f32, 0.2_f32);
    let mut last = 0.0;
    for step in 0..=4_000 {
        let distance = step as f32 * 0.001;
        let soft = soft_distance(distance, length, softness);
        assert!(soft <= distance && soft <= length && soft >= last, "{distance}: {soft}");
        // The slope is 1 up to `hard` and decreases from there: no step is larger than that of the distance itself.
        assert!(soft - last <= 0.001_01, "{distance}: {soft} after {last}");
        last = soft;
    }
    assert_eq!(soft_distance(1.5, 2.0, 0.2), 1.5);
    let expected = 1.6 + 0.4 * (1.0 - (-1.0_f64).exp());
    assert!((f64::from(soft_distance(2.0, 2.0, 0.2)) - expected).abs() < 1e-6);
    assert_eq!(soft_distance(3.0, 2.0, 0.0), 2.0);
    let mut random = started(25);
    let (skeleton, mut poses) = row(&mut random, 2, ParentScale::Plain);
    let old = matrices(&skeleton, &poses);
    let most: f32 = lengths(&poses).iter().sum();
    let target = at_distance(&old, &poses, Vec3::X, most);
    let limb = TwoBone { softness: 0.1, ..TwoBone::new(1, 2, 3) };
    let reach = two_bone(&skeleton, &old, &limb, target, &mut poses).unwrap();
    let expected = most - soft_distance(most, most, 0.1);
    assert!((reach.distance - expected).abs() < 1e-5 * most && expected > 0.03 * most, "{reach:?}");
}

#[test]
fn the_end_gets_the_requested_rotation() {
    let mut random = started(26);
    for _ in 0..500 {
        let (skeleton, poses) = row(&mut random, 2, ParentScale::Uniform);
        let old = matrices(&skeleton, &poses);
        let target = origin(&old, 1) + vector(&mut random) * poses[0].scale.x;
        let axes = |matrix: Mat4| {
            let linear = Mat3::from_mat4(matrix);
            linear * (1.0 / linear.x_axis.length())
        };
        let wanted = turn(&mut random);
        let solved = |end_orientation| {
            let mut after = poses.clone();
            let limb = TwoBone { end_orientation, ..TwoBone::new(1, 2, 3) };
            two_bone(&skeleton, &old, &limb, target, &mut after).unwrap();
            axes(matrices(&skeleton, &after)[3])
        };
        let before = axes(old[3]);
        assert!(solved(EndOrientation::KeepToRoot).abs_diff_eq(before, 1e-4));
        let turned = Mat3::from_quat(wanted) * before;
        assert!(solved(EndOrientation::TurnToRoot(wanted)).abs_diff_eq(turned, 1e-4));
        assert!(solved(EndOrientation::SetToRoot(wanted)).abs_diff_eq(Mat3::from_quat(wanted), 1e-4));
    }
    // Under a mirroring parent, `KeepToRoot` still keeps the axes of the end; with `SetToRoot`, the rotation is the one
    // that decomposing the end's matrix gives.
    for _ in 0..200 {
        let (skeleton, poses) = row(&mut random, 2, ParentScale::Mirrored);
        let old = matrices(&skeleton, &poses);
        let target = origin(&old, 1) + vector(&mut random);
        let wanted = turn(&mut random);
        for orientation in [EndOrientation::KeepToRoot, EndOrientation::SetToRoot(wanted)] {
            let mut after = poses.clone();
            let limb = TwoBone { end_orientation: orientation, ..TwoBone::new(1, 2, 3) };
            two_bone(&skeleton, &old, &limb, target, &mut after).unwrap();
            let end = matrices(&skeleton, &after)[3];
            if orientation == EndOrientation::KeepToRoot {
                assert!(Mat3::from_mat4(end).abs_diff_eq(Mat3::from_mat4(old[3]), 1e-4));
            } else {
                let read = Transform::from_matrix(end).rotation;
                assert!(crate::support::angle_between(read, wanted) < 1e-3, "{read} {wanted}");
            }
        }
    }
}

#[test]
fn a_real_animal_reaches_and_looks_in_every_take() {
    use dragonfly_anim::ik::{Gaze, LookAt, look_at};
    use dragonfly_anim::sample::sample_take;
    let model = crate::motion::load(&crate::doors::data().join("gltf/Fox.glb"));
    let skeleton = &model.animation.skeleton;
    let named = |part: &str| skeleton.bones.iter().position(|bone| bone.name.contains(part)).unwrap();
    let [upper, fore, hand] = ["RightUpperArm", "RightForeArm", "RightHand"].map(named);
    let [tail, tip, neck, head] = ["Tail01", "Tail03", "Neck", "Head"].map(named);
    let (mut scratch, mut random) = (ChainScratch::default(), started(35));
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    for take in &model.animation.takes {
        for step in 0..50 {
            sample_take(Some(take), skeleton, take.start + take.length * step as f32 / 49.0, &mut poses);
            let old = matrices(skeleton, &poses);
            let size = |bones: &[usize]| -> f32 {
                bones.windows(2).map(|pair| origin(&old, pair[0]).distance(origin(&old, pair[1]))).sum()
            };
            let arm = size(&[upper, fore, hand]);
            let way = origin(&old, hand) - origin(&old, upper) + vector(&mut random) * arm * 0.2;
            let paw = origin(&old, upper) + way.clamp_length(0.5 * arm, 0.95 * arm);
            let limb = TwoBone::new(upper as u32, fore as u32, hand as u32);
            two_bone(skeleton, &old, &limb, paw, &mut poses).unwrap();
            let wag = origin(&old, tip) + vector(&mut random) * 0.3 * size(&[tail, tip]);
            let wag =
                origin(&old, tail) + (wag - origin(&old, tail)).clamp_length_max(0.9 * size(&[tail, tip]));
            let settings = Chain::new(tail as u32, tip as u32);
            chain(skeleton, &old, &settings, wag, None, &mut scratch, &mut poses).unwrap();
            let prey = origin(&old, head) + direction(&mut random) * 200.0;
            let gazes =
                [Gaze { share: 0.5, ..Gaze::new(neck as u32, Vec3::X) }, Gaze::new(head as u32, Vec3::X)];
            look_at(skeleton, &old, &LookAt::new(&gazes), prey, &mut poses).unwrap();
            let new = matrices(skeleton, &poses);
            assert!(origin(&new, hand).distance(paw) < 1e-4 * arm, "{}", take.name);
            assert!(origin(&new, tip).distance(wag) < 1e-4 * size(&[tail, tip]), "{}", take.name);
            let ahead = new[head].x_axis.truncate().normalize();
            assert!(ahead.distance((prey - origin(&new, head)).normalize()) < 1e-4, "{}", take.name);
        }
    }
}

#[test]
fn degenerate_limbs_have_defined_results() {
    let mut random = started(30);
    let (skeleton, rest) = row(&mut random, 2, ParentScale::Plain);
    let old = matrices(&skeleton, &rest);
    let mut scratch = ChainScratch::default();
    let mut solve = |poses: &[Transform], target: Vec3| {
        let old = matrices(&skeleton, poses);
        let (mut limb, mut row) = (poses.to_vec(), poses.to_vec());
        let first = two_bone(&skeleton, &old, &TwoBone::new(1, 2, 3), target, &mut limb).unwrap();
        let second = chain(&skeleton, &old, &Chain::new(1, 3), target, None, &mut scratch, &mut row).unwrap();
        only_rotations(poses, &limb);
        only_rotations(poses, &row);
        [first.distance, second.distance]
    };
    // The target at the root: as near as the lengths allow.
    let parts = lengths(&rest);
    for left in solve(&rest, origin(&old, 1)) {
        assert!((left - (parts[0] - parts[1]).abs()).abs() < 1e-4, "{left}");
    }
    // In the opposite direction, and on the other side of the root.
    let way = (origin(&old, 3) - origin(&old, 1)).normalize();
    let middle = parts[0].max(parts[1]);
    for scale in [-0.99, -1.0, 1.0] {
        let target = origin(&old, 1) + way * middle * scale;
        assert!(solve(&rest, target).into_iter().all(|left| left < 1e-4));
    }
    // Bones of length zero: the remaining ones still point at the target.
    for (upper, lower) in [(0.0, 1.0), (1.0, 0.0), (0.0, 0.0)] {
        let mut poses = rest.clone();
        poses[2].translation = Vec3::X * upper;
        poses[3].translation = Vec3::Y * lower;
        let target = origin(&old, 1) + Vec3::new(0.0, 0.0, 3.0);
        for left in solve(&poses, target) {
            assert!((left - (3.0 - upper - lower)).abs() < 1e-4, "{upper} {lower}: {left}");
        }
    }
    // A limb whose root bone has a non-uniform scale.
    let mut poses = rest.clone();
    poses[1].scale = Vec3::new(1.2, 0.9, -1.0);
    let target = origin(&old, 1) + Vec3::new(0.2, 0.5, 0.3) * (parts[0] + parts[1]);
    assert!(solve(&poses, target).into_iter().all(|left| left < 2e-2), "{:?}", solve(&poses, target));
}

#[test]
fn invalid_limbs_are_an_error_and_change_nothing() {
    let mut random = started(31);
    let (skeleton, rest) = row(&mut random, 3, ParentScale::Plain);
    let old = matrices(&skeleton, &rest);
    let mut scratch = ChainScratch::default();
    let mut fails = |root: u32, end: u32, target: Vec3, poses: &[Transform], matrices: &[Mat4]| {
        let mut after = poses.to_vec();
        let limb = TwoBone::new(root, 2, end);
        let first = two_bone(&skeleton, matrices, &limb, target, &mut after).unwrap_err();
        let row = Chain::new(root, end);
        let second = chain(&skeleton, matrices, &row, target, None, &mut scratch, &mut after).unwrap_err();
        assert_eq!(format!("{after:?}"), format!("{poses:?}"));
        (first, second)
    };
    assert_eq!(fails(1, 9, Vec3::X, &rest, &old).0, IkError::NoSuchBone { bone: 9 });
    assert_eq!(fails(1, u32::MAX, Vec3::X, &rest, &old).1, IkError::NoSuchBone { bone: u32::MAX });
    assert_eq!(fails(4, 1, Vec3::X, &rest, &old).1, IkError::NotBelow { above: 4, below: 1 });
    let nan = IkError::NotFinite { bone: 1 };
    assert_eq!(fails(1, 4, Vec3::NAN, &rest, &old), (nan, nan));
    assert_eq!(fails(1, 4, Vec3::INFINITY, &rest, &old), (nan, nan));
    assert_eq!(fails(1, 4, Vec3::X, &rest[..4], &old).1, IkError::NoSuchBone { bone: 4 });
    assert_eq!(fails(1, 4, Vec3::X, &rest, &[]).1, IkError::NoSuchBone { bone: 0 });
    let flat = [Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0))];
    assert_eq!(fails(1, 4, Vec3::X, &rest, &flat).1, IkError::Flat { bone: 1 });
}

#[test]
fn no_input_makes_a_pose_nan() {
    let mut random = started(32);
    let hostile =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, 1e-45, 1e38, -1e38, f32::MAX, 1e19, 1e-30, 1.0];
    let mut scratch = ChainScratch::default();
    for round in 0..20_000 {
        let parent = random.choice(&PARENTS);
        let (skeleton, mut poses) = row(&mut random, 4, parent);
        let mut old = matrices(&skeleton, &poses);
        let mut target = vector(&mut random);
        for _ in 0..1 + random.below(3) {
            let (number, index) = (random.choice(&hostile), random.below(6));
            match random.below(5) {
                0 => poses[index].translation[round % 3] = number,
                1 => poses[index].scale[round % 3] = number,
                2 => poses[index].rotation.x = number,
                3 => target[round % 3] = number,
                _ => old[0] = Mat4::from_scale(Vec3::new(number, 1.0, 1.0)),
            }
        }
        let finite = |poses: &[Transform]| poses.iter().map(Transform::is_finite).collect::<Vec<_>>();
        let before = finite(&poses);
        let limb = TwoBone {
            pole: Pole::Direction(vector(&mut random) * random.choice(&hostile)),
            softness: random.choice(&hostile),
            weight: random.choice(&hostile),
            end_orientation: random.choice(&[
                EndOrientation::KeepToRoot,
                EndOrientation::FollowParent,
                EndOrientation::SetToRoot(Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)),
            ]),
            ..TwoBone::new(1, 2, 4)
        };
        let _ = two_bone(&skeleton, &old, &limb, target, &mut poses);
        assert_eq!(finite(&poses), before, "{round}");
        let settings = Chain { tolerance: random.choice(&hostile), ..Chain::new(1, 5) };
        let _ = chain(&skeleton, &old, &settings, target, None, &mut scratch, &mut poses);
        assert_eq!(finite(&poses), before, "{round}");
    }
}

#[test]
fn solving_again_allocates_nothing() {
    let mut random = started(33);
    let (skeleton, mut poses) = row(&mut random, 6, ParentScale::Plain);
    let old = matrices(&skeleton, &poses);
    let mut scratch = ChainScratch::with_capacity(7);
    let (allocated, ()) = count(|| {
        for step in 0..50 {
            let target = Vec3::new(step as f32 * 0.1, 1.0, 0.5);
            two_bone(&skeleton, &old, &TwoBone::new(1, 3, 6), target, &mut poses).unwrap();
            chain(&skeleton, &old, &Chain::new(1, 7), target, None, &mut scratch, &mut poses).unwrap();
        }
    });
    assert_eq!(allocated.allocations, 0);
}
