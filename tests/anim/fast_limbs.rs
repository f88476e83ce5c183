//! Limbs of the fast path bend like those of the open path.

use crate::ik::{ParentScale, at_distance, direction, lengths, matrices, origin, row, started, turn, vector};
use crate::support::angle_between;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{FastTwoBone, Pose, Rig, RootPoses, matrix, to_root, two_bone};
use dragonfly_anim::ik;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec3};

/// Allowed angle between the rotations of both paths, radians.
const ANGLE: f32 = 2e-4;

/// The parents with a uniform scale.
const PARENTS: [ParentScale; 3] = [ParentScale::Plain, ParentScale::Uniform, ParentScale::Mirrored];

/// Returns `poses` after the fast path solved `limb`; `None` if it did not.
fn fast(
    skeleton: &Skeleton,
    poses: &[Transform],
    limb: &FastTwoBone,
    target: Vec3,
) -> Option<Vec<Transform>> {
    let rig = Rig::new(skeleton);
    let (mut pose, mut roots) = (Pose::from_transforms(poses), RootPoses::new(&rig));
    to_root(SimdLevel::best(), &rig, pose.blocks(), &mut roots);
    let (asked, is_solved) = count(|| two_bone(limb, target, &roots, &mut pose));
    assert_eq!(asked.allocations, 0);
    let mut after = poses.to_vec();
    pose.write_to(&mut after);
    is_solved.then_some(after)
}

/// Returns `poses` after the open path solved the same limb.
fn open(skeleton: &Skeleton, poses: &[Transform], limb: &FastTwoBone, target: Vec3) -> Vec<Transform> {
    let pole = if limb.pole == Vec3::ZERO { ik::Pole::AsPosed } else { ik::Pole::Direction(limb.pole) };
    let same = ik::TwoBone {
        pole,
        softness: limb.softness,
        weight: limb.weight,
        ..ik::TwoBone::new(limb.root, limb.middle, limb.end)
    };
    let mut after = poses.to_vec();
    ik::two_bone(skeleton, &matrices(skeleton, poses), &same, target, &mut after).unwrap();
    after
}

/// Returns the limb 1–2–3 of a row, with a pole in two of three cases.
fn limb(random: &mut Random) -> FastTwoBone {
    let pole = if random.below(3) == 0 { Vec3::ZERO } else { vector(random) };
    FastTwoBone { pole, ..FastTwoBone::new(1, 2, 3) }
}

/// Solves many limbs made by `limb` on both paths and compares root and middle.
fn compare(usual: u64, limb: impl Fn(&mut Random) -> FastTwoBone) {
    let mut random = started(usual);
    let (mut compared, mut worst) = (0, 0.0_f32);
    for round in 0..3_000 {
        let parent = random.choice(&PARENTS);
        let (skeleton, poses) = row(&mut random, 2, parent);
        let limb = limb(&mut random);
        let old = matrices(&skeleton, &poses);
        let parts = lengths(&poses);
        let (least, most) = ((parts[0] - parts[1]).abs(), parts[0] + parts[1]);
        // Also out of reach and too near. Full extension and full folding are left out, since they have only half the
        // digits.
        let share = random.choice(&[-0.4, 0.02, 0.1, 0.35, 0.6, 0.8, 0.93, 0.98, 1.3, 40.0]);
        let distance = least + (most - least) * share;
        if distance < 0.05 * most {
            continue;
        }
        let target = at_distance(&old, &poses, direction(&mut random), distance);
        let expected = open(&skeleton, &poses, &limb, target);
        let got = fast(&skeleton, &poses, &limb, target).unwrap_or_else(|| panic!("{round} {parent:?}"));
        // Straight and folded limbs have no bending plane; their middles and ends still have defined positions.
        let straight = share < 0.0 || ik::soft_distance(distance, most, limb.softness) > 0.999 * most;
        for bone in [1, 2].into_iter().filter(|_| !straight) {
            let off = angle_between(got[bone].rotation, expected[bone].rotation);
            assert!(off < ANGLE, "{round} {parent:?} {share} {limb:?}: bone {bone} off by {off}");
            (compared, worst) = (compared + 1, worst.max(off));
        }
        let size = most * poses[0].scale.abs().x;
        let (got, expected) = (matrices(&skeleton, &got), matrices(&skeleton, &expected));
        for bone in [2, 3] {
            let off = origin(&got, bone).distance(origin(&expected, bone)) / size;
            let allowed = if straight { 2e-3 } else { 1e-4 };
            assert!(off < allowed, "{round} {parent:?} {share} {limb:?}: bone {bone} off by {off}");
        }
        assert_eq!(got.len(), 4);
    }
    println!("{compared} turns, worst {worst:e} radians");
    assert!(compared > 2_000);
}

#[test]
fn a_limb_bends_like_on_the_open_path() {
    compare(61, limb);
}

#[test]
fn a_soft_limb_bends_like_on_the_open_path() {
    compare(62, |random| FastTwoBone {
        softness: random.choice(&[0.01, 0.1, 0.4, 1.0, 3.0]),
        ..limb(random)
    });
}

#[test]
fn a_limb_with_a_weight_rotates_like_on_the_open_path() {
    compare(63, |random| FastTwoBone {
        softness: random.choice(&[0.0, 0.2]),
        weight: random.between(0.01, 0.99),
        ..limb(random)
    });
}

#[test]
fn weight_zero_changes_no_bit() {
    let mut random = started(64);
    for weight in [0.0, -0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
        let (skeleton, poses) = row(&mut random, 2, ParentScale::Plain);
        let limb = FastTwoBone { weight, ..limb(&mut random) };
        assert_eq!(fast(&skeleton, &poses, &limb, vector(&mut random)), Some(poses));
    }
    let (skeleton, poses) = row(&mut random, 2, ParentScale::Plain);
    let (limb, target) = (limb(&mut random), vector(&mut random));
    let over = FastTwoBone { weight: 7.0, ..limb };
    assert_eq!(fast(&skeleton, &poses, &over, target), fast(&skeleton, &poses, &limb, target));
}

/// Returns a straight row of two segments along `way`, of lengths `a` and `b`; a negative length folds back.
fn line(random: &mut Random, way: Vec3, a: f32, b: f32) -> (Skeleton, Vec<Transform>) {
    let (mut skeleton, mut poses) = row(random, 2, ParentScale::Plain);
    for (bone, length) in [(2, a), (3, b)] {
        skeleton.bones[bone].rest.translation = way * length;
        poses[bone].translation = way * length;
        poses[bone].rotation = Quat::IDENTITY;
    }
    poses.iter_mut().take(2).for_each(|pose| pose.rotation = turn(random));
    (skeleton, poses)
}

#[test]
fn a_straight_limb_bends_towards_its_pole_or_anywhere_and_reaches_its_target() {
    let mut random = started(65);
    for round in 0..1_000 {
        let way = direction(&mut random);
        let (a, b) = (random.between(0.3, 2.0), random.between(0.3, 2.0) * random.choice(&[-1.0, 1.0]));
        let (skeleton, poses) = line(&mut random, way, a, b);
        let limb = limb(&mut random);
        let old = matrices(&skeleton, &poses);
        let (least, most) = ((a - b.abs()).abs(), a + b.abs());
        let distance = least + (most - least) * random.between(0.05, 0.95);
        // Along the limb itself, against it, and anywhere.
        let along = (origin(&old, 2) - origin(&old, 1)).normalize();
        let towards = [along, -along, direction(&mut random)][random.below(3)];
        let target = origin(&old, 1) + towards * distance;
        let got = fast(&skeleton, &poses, &limb, target).expect("a limb");
        let new = matrices(&skeleton, &got);
        let (middle, end) = (origin(&new, 2) - origin(&new, 1), origin(&new, 3));
        assert!(end.distance(target) < 1e-4 * most, "{round}: {end} {target}");
        let line = (target - origin(&new, 1)).normalize();
        let across = |vector: Vec3| vector - line * vector.dot(line);
        let (side, pole) = (across(middle), across(limb.pole));
        if pole.length() > 0.05 * limb.pole.length() && side.length() > 0.02 * most {
            assert!(side.normalize().dot(pole.normalize()) > 0.999, "{round}: {side} {pole}");
        }
    }
}

#[test]
fn targets_directly_behind_the_limb_are_reached() {
    let mut random = started(66);
    for round in 0..2_000 {
        let (skeleton, poses) = row(&mut random, 2, ParentScale::Plain);
        let old = matrices(&skeleton, &poses);
        let [root, middle, end] = [1, 2, 3].map(|bone| origin(&old, bone));
        if (end - root).length() < 0.2 || (middle - root).cross(end - root).length() < 0.05 {
            continue;
        }
        let off = vector(&mut random) * random.choice(&[0.0, 1e-7, 1e-5, 1e-3, 1e-1]);
        let target = root - (end - root) + off * (end - root).length();
        let limb = limb(&mut random);
        let got = fast(&skeleton, &poses, &limb, target).expect("a limb");
        let (a, b) = ((middle - root).length(), (end - middle).length());
        let (most, distance) = (a + b, target.distance(root));
        let left = origin(&matrices(&skeleton, &got), 3).distance(target);
        let allowed = 1e-4 * most + (distance - most).max(0.0) + ((a - b).abs() - distance).max(0.0);
        assert!(left < allowed, "{round}: {left} {allowed}");
    }
}

#[test]
fn limbs_of_any_size_bend_the_same_way() {
    let mut random = started(67);
    for _ in 0..300 {
        let (mut skeleton, mut poses) = row(&mut random, 2, ParentScale::Plain);
        let (limb, target) = (limb(&mut random), vector(&mut random));
        poses[0].translation = Vec3::ZERO;
        let usual = fast(&skeleton, &poses, &limb, target).unwrap();
        for size in [1e-7_f32, 1e-3, 1e3, 1e7] {
            let mut sized = poses.clone();
            for (bone, pose) in skeleton.bones.iter_mut().zip(&mut sized) {
                pose.translation *= size;
                bone.rest.translation = pose.translation;
            }
            let got = fast(&skeleton, &sized, &limb, target * size).unwrap_or_else(|| panic!("{size}"));
            for bone in [1, 2] {
                let off = angle_between(got[bone].rotation, usual[bone].rotation);
                assert!(off < 1e-2, "{size}: {off}");
            }
        }
    }
}

#[test]
fn an_unsolvable_limb_changes_nothing() {
    let mut random = started(68);
    let (skeleton, poses) = row(&mut random, 2, ParentScale::Plain);
    let rig = Rig::new(&skeleton);
    let mut roots = RootPoses::new(&rig);
    to_root(SimdLevel::best(), &rig, Pose::from_transforms(&poses).blocks(), &mut roots);
    let root = matrix::transform_point(roots.get(1), Vec3::ZERO);
    let limb = FastTwoBone::new(1, 2, 3);
    let mut cases = vec![
        (FastTwoBone { root: 9, ..limb }, Vec3::ONE),
        (FastTwoBone { middle: u32::MAX, ..limb }, Vec3::ONE),
        (FastTwoBone { end: 4, ..limb }, Vec3::ONE),
        (FastTwoBone { end: 2, ..limb }, Vec3::ONE),
        (limb, root),
    ];
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        cases.extend((0..3).map(|axis| {
            let mut target = Vec3::ONE;
            target[axis] = wrong;
            (limb, target)
        }));
    }
    for (limb, target) in cases {
        let mut pose = Pose::from_transforms(&poses);
        assert!(!two_bone(&limb, target, &roots, &mut pose), "{limb:?} {target}");
        assert_eq!(pose, Pose::from_transforms(&poses), "{limb:?} {target}");
    }
    let mut short = Pose::new(1);
    assert!(two_bone(&limb, Vec3::ONE, &roots, &mut short), "padding lanes exist");
    assert!(!two_bone(&limb, Vec3::ONE, &roots, &mut Pose::new(0)));
}

#[test]
fn no_input_makes_an_invalid_rotation() {
    let mut random = started(69);
    let odd = [0.0, -0.0, 1e-30, 1e-45, 1.0, -3.0, 1e19, 1e30, f32::MAX, f32::INFINITY, f32::NAN];
    let any = |random: &mut Random| Vec3::from_array([(); 3].map(|()| random.choice(&odd)));
    for round in 0..5_000 {
        let (skeleton, poses) = row(&mut random, 2, random_parent(round));
        let rig = Rig::new(&skeleton);
        let mut pose = Pose::from_transforms(&poses);
        let mut roots = RootPoses::new(&rig);
        to_root(SimdLevel::best(), &rig, pose.blocks(), &mut roots);
        let limb = FastTwoBone {
            pole: any(&mut random),
            softness: random.choice(&odd),
            weight: random.choice(&odd),
            ..FastTwoBone::new(1, 2, 3)
        };
        let target = if round % 2 == 0 { vector(&mut random) } else { any(&mut random) };
        two_bone(&limb, target, &roots, &mut pose);
        for bone in 0..4 {
            let rotation = pose.get(bone).unwrap().rotation;
            let is_unit = (rotation.length() - 1.0).abs() < 1e-5;
            assert!(is_unit, "{round} {limb:?} {target}: {rotation}");
        }
    }
}

fn random_parent(round: usize) -> ParentScale {
    PARENTS[round % 3]
}

#[test]
fn the_returned_distance_is_that_from_the_end_to_the_target() {
    let (skeleton, poses) = row(&mut started(70), 2, ParentScale::Plain);
    let rig = Rig::new(&skeleton);
    let mut roots = RootPoses::new(&rig);
    to_root(SimdLevel::best(), &rig, Pose::from_transforms(&poses).blocks(), &mut roots);
    let old: Vec<Mat4> = matrices(&skeleton, &poses);
    let left = dragonfly_anim::fast::distance_left(&FastTwoBone::new(1, 2, 3), Vec3::ONE, &roots);
    assert!((left - origin(&old, 3).distance(Vec3::ONE)).abs() < 1e-5);
}
