//! Look-at and foot placement.

use crate::ik::{PARENTS, direction, matrices, origin, row, started, vector};
use crate::support::{angle_between, bone};
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::ik::{Feet, Gaze, Ground, IkError, Leg, LookAt, Pole, look_at, place_feet};
use dragonfly_anim::sample::rest_pose;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec3};

/// Returns the angle in radians between a bone's forward axis and the direction to the target, in to-root space.
fn off(to_root: Mat4, gaze: &Gaze, target: Vec3) -> f32 {
    let eye = to_root.transform_point3(gaze.eye);
    let forward = to_root.transform_vector3(gaze.forward).normalize();
    let wanted = (target - eye).normalize();
    2.0 * (forward - wanted).length().atan2((forward + wanted).length())
}

#[test]
fn the_last_bone_looks_straight_at_its_target_whatever_its_parents_do() {
    let mut random = started(61);
    for round in 0..3_000 {
        let parent = random.choice(&PARENTS);
        let (skeleton, mut poses) = row(&mut random, 4, parent);
        let old = matrices(&skeleton, &poses);
        let target = origin(&old, 5)
            + direction(&mut random) * random.between(1.0, 50.0) * poses[0].scale.abs().max_element() * 4.0;
        let gazes = [1, 3, 5].map(|bone| Gaze {
            share: if bone == 5 { 1.0 } else { random.unit() * 0.5 },
            up: direction(&mut random),
            eye: if bone == 5 { vector(&mut random) * 0.3 } else { Vec3::ZERO },
            ..Gaze::new(bone, direction(&mut random))
        });
        let up = (random.below(2) == 0).then(|| direction(&mut random));
        let before = poses.clone();
        let reach =
            look_at(&skeleton, &old, &LookAt { up, ..LookAt::new(&gazes) }, target, &mut poses).unwrap();
        let new = matrices(&skeleton, &poses);
        assert!(
            off(new[5], &gazes[2], target) < 1e-4,
            "{round} {parent:?}: {}",
            off(new[5], &gazes[2], target)
        );
        let far = origin(&new, 5).distance(target);
        assert!(reach.distance < 2e-4 * far, "{round}: {reach:?} of {far}");
        for (before, after) in before.iter().zip(&poses) {
            assert_eq!((before.translation, before.scale), (after.translation, after.scale));
        }
        assert_eq!((poses[2].rotation, poses[4].rotation), (before[2].rotation, before[4].rotation));
    }
}

#[test]
fn the_up_axis_stays_as_upright_as_the_gaze_allows() {
    let mut random = started(62);
    for _ in 0..500 {
        let (skeleton, mut poses) = row(&mut random, 1, crate::ik::ParentScale::Uniform);
        let old = matrices(&skeleton, &poses);
        let target = origin(&old, 2) + direction(&mut random) * poses[0].scale.x;
        let gaze = [Gaze { up: Vec3::Y, ..Gaze::new(2, Vec3::Z) }];
        let look = LookAt { up: Some(Vec3::Y), ..LookAt::new(&gaze) };
        look_at(&skeleton, &old, &look, target, &mut poses).unwrap();
        let new = matrices(&skeleton, &poses)[2];
        let (forward, up) = (new.z_axis.truncate().normalize(), new.y_axis.truncate().normalize());
        let expected = (Vec3::Y - forward * forward.y).normalize();
        assert!(up.distance(expected) < 1e-3, "{up} {expected}");
    }
}

/// A neck at the origin that looks along z.
fn neck() -> (Skeleton, Vec<Transform>, Vec<Mat4>) {
    let skeleton = Skeleton { bones: vec![bone("neck", None, Vec3::ZERO)] };
    let poses: Vec<Transform> = skeleton.bones.iter().map(rest_pose).collect();
    let old = matrices(&skeleton, &poses);
    (skeleton, poses, old)
}

fn turned(look: &LookAt<'_>, angle: f32) -> f32 {
    let (skeleton, mut poses, old) = neck();
    let target = Vec3::new(angle.sin(), 0.0, angle.cos()) * 3.0;
    look_at(&skeleton, &old, look, target, &mut poses).unwrap();
    assert!(poses[0].rotation.x.abs() < 1e-6 && poses[0].rotation.z.abs() < 1e-6);
    angle_between(poses[0].rotation, Quat::IDENTITY)
}

#[test]
fn no_bone_rotates_farther_than_its_limit_and_a_soft_one_slows_down() {
    let gaze = [Gaze { limit: 0.8, ..Gaze::new(0, Vec3::Z) }];
    let (hard, soft) = (LookAt::new(&gaze), LookAt { softness: 0.5, ..LookAt::new(&gaze) });
    let mut last = 0.0;
    for step in 0..=310 {
        let angle = step as f32 * 0.01;
        assert!((turned(&hard, angle) - angle.min(0.8)).abs() < 1e-5, "{angle}");
        let now = turned(&soft, angle);
        assert!(
            now <= 0.8 && now <= angle + 1e-5 && now >= last - 1e-5 && now - last < 0.010_1,
            "{angle} {now}"
        );
        last = now;
    }
    assert!(last > 0.79);
    // Half a share rotates half the angle.
    let half = [Gaze { share: 0.5, ..Gaze::new(0, Vec3::Z) }];
    assert!((turned(&LookAt::new(&half), 1.0) - 0.5).abs() < 1e-5);
    assert!((turned(&LookAt { weight: 0.5, ..LookAt::new(&half) }, 1.0) - 0.25).abs() < 1e-5);
}

#[test]
fn a_target_that_leaves_the_field_of_view_is_released_smoothly() {
    let gaze = [Gaze::new(0, Vec3::Z)];
    let look = LookAt { field: [1.0, 2.0], ..LookAt::new(&gaze) };
    let mut last = turned(&look, 0.0);
    for step in 1..=620 {
        let angle = step as f32 * 0.005;
        let now = turned(&look, angle);
        if angle <= 1.0 {
            assert!((now - angle).abs() < 1e-5);
        }
        assert!((now - last).abs() < 0.015, "{angle}: {now} after {last}");
        assert!(angle < 2.0 || now == 0.0, "{angle}: {now}");
        last = now;
    }
}

#[test]
fn a_gaze_without_weight_or_target_changes_no_bit_and_errors_change_nothing() {
    let mut random = started(63);
    let (skeleton, poses) = row(&mut random, 4, crate::ik::ParentScale::Uneven);
    let old = matrices(&skeleton, &poses);
    let gazes = [Gaze::new(1, Vec3::X), Gaze::new(4, Vec3::Z)];
    let look = |look: &LookAt<'_>, target: Vec3| {
        let mut after = poses.clone();
        let result = look_at(&skeleton, &old, look, target, &mut after);
        (result.map(|_| ()), after == poses)
    };
    for weight in [0.0, -1.0, f32::NAN] {
        assert_eq!(look(&LookAt { weight, ..LookAt::new(&gazes) }, Vec3::ONE * 9.0), (Ok(()), true));
    }
    assert_eq!(look(&LookAt::new(&[]), Vec3::ONE), (Ok(()), true));
    let first = gazes[..1].to_vec();
    assert_eq!(look(&LookAt::new(&first), origin(&old, 1)).0, Ok(()));
    let nan = Err(IkError::NotFinite { bone: 1 });
    assert_eq!(look(&LookAt::new(&gazes), Vec3::NAN), (nan, true));
    let backwards = [gazes[1], gazes[0]];
    assert_eq!(
        look(&LookAt::new(&backwards), Vec3::ONE),
        (Err(IkError::NotBelow { above: 4, below: 1 }), true)
    );
    let missing = [gazes[0], Gaze::new(77, Vec3::X)];
    assert_eq!(look(&LookAt::new(&missing), Vec3::ONE), (Err(IkError::NoSuchBone { bone: 77 }), true));
}

/// Hips at 1.9 with two slightly bent legs of 2 × 1; soles 0.1 below the ankles, which are at the height 0.1.
fn walker() -> (Skeleton, Vec<Transform>, Vec<Leg>) {
    let mut bones = vec![bone("root", None, Vec3::ZERO), bone("hips", Some(0), Vec3::new(0.0, 2.0, 0.0))];
    let mut legs = Vec::new();
    for side in [-0.2, 0.2] {
        let at = bones.len() as u32;
        bones.push(bone("thigh", Some(1), Vec3::new(side, 0.0, 0.0)));
        bones.push(bone("shin", Some(at), Vec3::new(0.0, -1.0, 0.0)));
        bones.push(bone("foot", Some(at + 1), Vec3::new(0.0, -1.0, 0.0)));
        legs.push(Leg {
            thigh: at,
            shin: at + 1,
            foot: at + 2,
            ankle_height: 0.1,
            pole: Pole::Direction(Vec3::Z),
        });
    }
    let skeleton = Skeleton { bones };
    let mut poses: Vec<Transform> = skeleton.bones.iter().map(rest_pose).collect();
    // cos(bend) = 0.95: the ankles are 1.9 below the hips.
    let bend = 0.95_f32.acos();
    for leg in &legs {
        poses[leg.thigh as usize].rotation = Quat::from_rotation_x(-bend);
        poses[leg.shin as usize].rotation = Quat::from_rotation_x(2.0 * bend);
        poses[leg.foot as usize].rotation = Quat::from_rotation_x(-bend);
    }
    (skeleton, poses, legs)
}

fn feet(legs: &[Leg]) -> Feet<'_> {
    Feet { hips: 1, legs, up: Vec3::Y, floor: 0.0, lower: 1.0, tilt: 1.0, softness: 0.0, weight: 1.0 }
}

#[test]
fn feet_are_on_their_ground_and_the_hips_are_lowered_for_the_lower_one() {
    let mut random = started(64);
    for round in 0..1_000 {
        let (skeleton, mut poses, legs) = walker();
        let old = matrices(&skeleton, &poses);
        let grounds = [(); 2].map(|()| {
            let normal = (Vec3::Y * 3.0 + vector(&mut random)).normalize();
            Some(Ground { point: vector(&mut random) * 0.2, normal: normal * 3.0 })
        });
        let lowered = place_feet(&skeleton, &old, &feet(&legs), &grounds, &mut poses).unwrap();
        let new = matrices(&skeleton, &poses);
        assert!((origin(&old, 1).y - origin(&new, 1).y - lowered).abs() < 1e-5 && lowered >= 0.0);
        let mut deepest = 0.0_f32;
        for (leg, ground) in legs.iter().zip(grounds) {
            let foot = leg.foot as usize;
            let (ground, ankle) = (ground.unwrap(), origin(&new, foot));
            let normal = ground.normal.normalize();
            // Directly above its place, at its height from the plane, with the sole along the plane.
            assert!((ankle - origin(&old, foot)).reject_from(Vec3::Y).length() < 1e-4, "{round}");
            assert!(((ankle - ground.point).dot(normal) - 0.1).abs() < 1e-4, "{round}");
            assert!(new[foot].y_axis.truncate().normalize().distance(normal) < 1e-3, "{round}");
            deepest = deepest.max(origin(&old, foot).y - ankle.y);
        }
        assert!((lowered - deepest).abs() < 1e-4, "{round}: {lowered} {deepest}");
    }
}

#[test]
fn a_lifted_foot_stays_lifted_and_flat_ground_changes_nothing_visible() {
    let (skeleton, mut poses, legs) = walker();
    poses[legs[0].thigh as usize].rotation *= Quat::from_rotation_x(-0.5);
    let old = matrices(&skeleton, &poses);
    let flat = Some(Ground { point: Vec3::ZERO, normal: Vec3::Y });
    let placed = |grounds: &[Option<Ground>], change: &dyn Fn(&mut Feet<'_>)| {
        let (mut after, mut settings) = (poses.clone(), feet(&legs));
        change(&mut settings);
        let lowered = place_feet(&skeleton, &old, &settings, grounds, &mut after).unwrap();
        (lowered, after.clone(), matrices(&skeleton, &after))
    };
    for grounds in [&[flat, flat][..], &[], &[None, flat]] {
        let (lowered, _, new) = placed(grounds, &|_| ());
        assert!(lowered < 1e-5);
        for (old, new) in old.iter().zip(&new) {
            assert!(old.abs_diff_eq(*new, 2e-3), "{old} {new}");
        }
    }
    // Both on a step of 0.3: the lifted foot is lifted by the same amount above it.
    let step = Some(Ground { point: Vec3::new(0.0, 0.3, 0.0), normal: Vec3::Y });
    let (_, _, new) = placed(&[step, step], &|_| ());
    for leg in &legs {
        let foot = leg.foot as usize;
        assert!((origin(&new, foot).y - origin(&old, foot).y - 0.3).abs() < 1e-4);
    }
    // A deep hole: the hips go down only by their limit. Weight zero: not a bit changes.
    let hole = Some(Ground { point: Vec3::new(0.0, -5.0, 0.0), normal: Vec3::Y });
    assert_eq!(placed(&[hole, flat], &|feet| feet.lower = 0.4).0, 0.4);
    assert_eq!(placed(&[hole, flat], &|feet| feet.weight = 0.0).1, poses);
    // A wall and a ceiling are not ground.
    for normal in [Vec3::X, Vec3::NEG_Y, Vec3::ZERO, Vec3::NAN] {
        let (lowered, after, _) = placed(&[Some(Ground { point: Vec3::Y, normal })], &|_| ());
        assert!(lowered < 1e-5 && after.iter().all(Transform::is_finite));
    }
}

#[test]
fn invalid_legs_are_an_error_and_gazes_and_feet_allocate_nothing() {
    let (skeleton, mut poses, mut legs) = walker();
    let old = matrices(&skeleton, &poses);
    let before = poses.clone();
    let grounds = [Some(Ground { point: Vec3::NEG_Y * 0.1, normal: Vec3::new(0.1, 1.0, 0.0) }); 2];
    let gazes = [Gaze::new(1, Vec3::Z), Gaze::new(4, Vec3::Z)];
    let (allocated, ()) = count(|| {
        place_feet(&skeleton, &old, &feet(&legs), &grounds, &mut poses).unwrap();
        look_at(&skeleton, &old, &LookAt::new(&gazes), Vec3::ONE * 4.0, &mut poses).unwrap();
    });
    assert_eq!(allocated.allocations, 0);
    poses.clone_from(&before);
    legs[1].foot = legs[0].foot;
    let error = place_feet(&skeleton, &old, &feet(&legs), &grounds, &mut poses).unwrap_err();
    assert_eq!(error, IkError::NotBelow { above: legs[1].shin, below: legs[0].foot });
    assert_eq!(poses, before);
    let mut random = Random::new(5);
    let hostile = [f32::NAN, f32::INFINITY, 0.0, 1e38, -1.0, 1e-40];
    for _ in 0..5_000 {
        let (skeleton, mut poses, legs) = walker();
        let number = |random: &mut Random| random.choice(&hostile);
        let index = random.below(8);
        match random.below(4) {
            0 => poses[index].translation.y = number(&mut random),
            1 => poses[index].scale.x = number(&mut random),
            2 => poses[index].rotation.z = number(&mut random),
            _ => (),
        }
        let old = matrices(&skeleton, &poses);
        let finite = |poses: &[Transform]| poses.iter().map(Transform::is_finite).collect::<Vec<_>>();
        let before = finite(&poses);
        let ground = Some(Ground {
            point: vector(&mut random) * number(&mut random),
            normal: Vec3::Y * number(&mut random),
        });
        let settings = Feet {
            floor: number(&mut random),
            tilt: number(&mut random),
            lower: number(&mut random),
            ..feet(&legs)
        };
        let _ = place_feet(&skeleton, &old, &settings, &[ground; 2], &mut poses);
        let gazes = [
            Gaze {
                limit: number(&mut random),
                share: number(&mut random),
                ..Gaze::new(1, Vec3::Z * number(&mut random))
            },
            Gaze { eye: Vec3::X * number(&mut random), ..Gaze::new(4, Vec3::Z) },
        ];
        let look = LookAt {
            field: [number(&mut random), number(&mut random)],
            up: Some(Vec3::Y * number(&mut random)),
            ..LookAt::new(&gazes)
        };
        let _ = look_at(&skeleton, &old, &look, vector(&mut random) * number(&mut random), &mut poses);
        assert_eq!(finite(&poses), before);
    }
}
