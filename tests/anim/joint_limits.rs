//! Joint limits clamp rotations to their range.

use crate::blending::{a_rotation, bits, hostile};
use crate::support::{angle_between, bone};
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::joint::{
    AngleRange, Ball, Clamped, Euler, EulerOrder, Hinge, JointLimit, JointLimits, LimitReport, SLACK,
};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{DQuat, DVec3, Quat, Vec3};
use proptest::prelude::*;
use std::f32::consts::PI;

/// Ranges of all kinds: narrow, wide, beyond half a turn, reversed.
fn a_range() -> impl Strategy<Value = AngleRange> {
    (-4.0_f32..4.0, 0.0_f32..5.0, 0_u8..12).prop_map(|(min, width, kind)| match kind {
        0 => AngleRange::FREE,
        1 => AngleRange::NONE,
        2 => AngleRange::new(1.0, -1.0),
        _ => AngleRange::new(min, min + width),
    })
}

fn an_axis() -> impl Strategy<Value = Vec3> {
    a_rotation().prop_map(|turn| turn * Vec3::X * 2.0)
}

fn a_limit() -> impl Strategy<Value = JointLimit> {
    let half = || prop_oneof![Just(0.0_f32), Just(PI), 0.0_f32..3.2];
    let hinge = (an_axis(), a_range()).prop_map(|(axis, range)| JointLimit::Hinge(Hinge { axis, range }));
    let ball = (an_axis(), an_axis(), half(), half(), a_range()).prop_map(
        |(axis, side, swing_side, swing_up, twist)| {
            JointLimit::Ball(Ball { axis, side, swing_side, swing_up, twist })
        },
    );
    let euler = (0_usize..6, prop::array::uniform3(a_range()))
        .prop_map(|(order, ranges)| JointLimit::Euler(Euler { order: EulerOrder::ALL[order], ranges }));
    prop_oneof![hinge, ball, euler]
}

/// Rotations, including the difficult ones: half turns, right angles, nearly zero.
fn a_turn() -> impl Strategy<Value = Quat> {
    let about = |angle: f32| {
        (0_usize..3, -1e-6_f32..1e-6).prop_map(move |(axis, more)| {
            Quat::from_axis_angle([Vec3::X, Vec3::Y, Vec3::Z][axis], angle + more)
        })
    };
    prop_oneof![4 => a_rotation(), 1 => about(PI), 1 => about(PI / 2.0), 1 => about(0.0)]
}

fn quat_bits(rotation: Quat) -> [u32; 4] {
    rotation.to_array().map(f32::to_bits)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn clamping_twice_is_clamping_once(limit in a_limit(), turn in a_turn(), rest in a_turn()) {
        let once = limit.clamp(turn, rest);
        prop_assert!((once.rotation.length() - 1.0).abs() < 1e-6);
        let twice = limit.clamp(once.rotation, rest);
        prop_assert_eq!(quat_bits(twice.rotation), quat_bits(once.rotation), "{:?} then {:?}", once, twice);
        prop_assert_eq!(twice.by, 0.0);
    }

    #[test]
    fn the_reported_angle_is_that_between_given_and_clamped(limit in a_limit(), turn in a_turn(), rest in a_turn()) {
        let clamped = limit.clamp(turn, rest);
        prop_assert!((clamped.by - angle_between(turn, clamped.rotation)).abs() < 4e-6, "{clamped:?}");
        prop_assert!((0.0..=PI + 1e-6).contains(&clamped.by));
        if clamped.by == 0.0 {
            prop_assert_eq!(quat_bits(clamped.rotation), quat_bits(turn));
        }
    }

    #[test]
    fn a_hinge_inside_its_range_stays_bit_for_bit(
        axis in an_axis(), min in -3.0_f32..0.0, width in 0.01_f32..3.0, part in 0.0_f32..1.0, rest in a_rotation(),
    ) {
        let hinge = JointLimit::Hinge(Hinge { axis, range: AngleRange::new(min, min + width) });
        let turn = Quat::from_axis_angle(axis.normalize(), min + width * part);
        // In f64, like an exporter, rounded once.
        let rotation = (rest.as_dquat() * turn.as_dquat()).as_quat();
        let clamped = hinge.clamp(rotation, rest);
        prop_assert_eq!(clamped, Clamped { rotation, by: 0.0 });
        prop_assert_eq!(quat_bits(clamped.rotation), quat_bits(rotation));
    }

    #[test]
    fn a_hinge_outside_its_range_stops_at_the_nearer_end(
        axis in an_axis(), beyond in 0.01_f32..1.0, rest in a_rotation(), lower: bool,
    ) {
        let range = AngleRange::new(-0.5, 1.5);
        let hinge = JointLimit::Hinge(Hinge { axis, range });
        let (end, angle) = if lower { (range.min, range.min - beyond) } else { (range.max, range.max + beyond) };
        let about = |angle| rest * Quat::from_axis_angle(axis.normalize(), angle);
        let clamped = hinge.clamp(about(angle), rest);
        prop_assert!(angle_between(clamped.rotation, about(end)) < 2e-6);
        prop_assert!((clamped.by - beyond).abs() < 3e-6);
    }

    #[test]
    fn a_rotation_clamped_by_a_ball_joint_is_within_its_cone_and_its_twist_range(
        turn in a_rotation(), halves in (0.05_f32..2.5, 0.05_f32..2.5), twist in (-1.0_f32..0.0, 0.0_f32..1.0),
    ) {
        let (axis, side) = (Vec3::Y, Vec3::X);
        let range = AngleRange::new(twist.0, twist.1);
        let ball = Ball { axis, side, swing_side: halves.0, swing_up: halves.1, twist: range };
        let clamped = JointLimit::Ball(ball).clamp(turn, Quat::IDENTITY).rotation.as_dquat();
        // The direction of the bone determines how far it swings, and about what.
        let points = clamped * DVec3::Y;
        let across = DVec3::Y.cross(points);
        let swing = across.length().atan2(points.y) * across.normalize_or_zero();
        let (x, up) = (swing.dot(DVec3::X), swing.dot(DVec3::NEG_Z));
        let inside = (x / f64::from(halves.0)).powi(2) + (up / f64::from(halves.1)).powi(2);
        prop_assert!(inside < 1.0 + 1e-4, "{inside}");
        // Undo the shortest rotation to that direction: the rest is the twist.
        let left = DQuat::from_rotation_arc(DVec3::Y, points).conjugate() * clamped;
        let twisted = 2.0 * left.y.atan2(left.w);
        let twisted = if twisted > std::f64::consts::PI { twisted - std::f64::consts::TAU } else { twisted };
        let twisted = if twisted < -std::f64::consts::PI { twisted + std::f64::consts::TAU } else { twisted };
        prop_assert!((f64::from(range.min) - 1e-4..=f64::from(range.max) + 1e-4).contains(&twisted), "{twisted}");
    }

    #[test]
    fn a_round_cone_keeps_the_direction_of_the_swing(direction in 0.0_f32..6.2, swing in 0.1_f32..3.0) {
        let about = Quat::from_rotation_y(direction) * Vec3::X;
        let turn = |angle: f32| Quat::from_axis_angle(about, angle);
        let cone = JointLimit::Ball(Ball::round(Vec3::Y, 0.6, AngleRange::NONE));
        let clamped = cone.clamp(turn(swing), Quat::IDENTITY);
        // A rotation that is nearer to the border than the slack stays.
        prop_assert!(angle_between(clamped.rotation, turn(swing.min(0.6))) < SLACK + 2e-6);
    }

    #[test]
    fn angles_inside_their_ranges_stay_bit_for_bit(
        order in 0_usize..6, angles in prop::array::uniform3(-1.5_f32..1.5),
    ) {
        let order = EulerOrder::ALL[order];
        let ranges = angles.map(|angle| AngleRange::new(angle - 0.02, angle + 0.02));
        let turn = order.axes().into_iter().fold(Quat::IDENTITY, |turn, axis| {
            turn * Quat::from_axis_angle([Vec3::X, Vec3::Y, Vec3::Z][axis], angles[axis])
        });
        let euler = JointLimit::Euler(Euler { order, ranges });
        prop_assert_eq!(quat_bits(euler.clamp(turn, Quat::IDENTITY).rotation), quat_bits(turn));
    }

    #[test]
    fn a_mirrored_limit_clamps_a_mirrored_rotation_to_the_mirrored_result(
        limit in a_limit(), turn in a_rotation(), rest in a_rotation(), normal in 0_usize..3,
    ) {
        let mirror = |rotation: Quat| match normal {
            0 => Quat::from_xyzw(rotation.x, -rotation.y, -rotation.z, rotation.w),
            1 => Quat::from_xyzw(-rotation.x, rotation.y, -rotation.z, rotation.w),
            _ => Quat::from_xyzw(-rotation.x, -rotation.y, rotation.z, rotation.w),
        };
        // A ball joint without a side axis may use any, which need not be the mirrored one.
        let one = limit.clamp(turn, rest);
        let other = limit.mirrored(normal).clamp(mirror(turn), mirror(rest));
        // On the border between two ends both are correct.
        prop_assume!((one.by - PI).abs() > 1e-3);
        prop_assert!((one.by - other.by).abs() < 1e-4, "{one:?} {other:?}");
        prop_assert!(angle_between(mirror(one.rotation), other.rotation) < 1e-3, "{one:?} {other:?}");
    }
}

#[test]
fn an_elbow_bends_one_way_only() {
    let rest = Quat::from_rotation_z(0.3);
    let elbow = JointLimit::Hinge(Hinge { axis: Vec3::X, range: AngleRange::degrees(0.0, 150.0) });
    let bent = |degrees: f32| rest * Quat::from_rotation_x(degrees.to_radians());
    assert_eq!(elbow.clamp(bent(90.0), rest), Clamped { rotation: bent(90.0), by: 0.0 });
    let over = elbow.clamp(bent(-30.0), rest);
    assert!(angle_between(over.rotation, rest) < 1e-6 && (over.by.to_degrees() - 30.0).abs() < 1e-3);
    // A rotation of the hinge's own axis is removed.
    let sideways = elbow.clamp(bent(90.0) * Quat::from_rotation_y(0.5), rest);
    let twist = 2.0
        * ((45.0_f32.to_radians().sin() * 0.25_f32.cos()) / (45.0_f32.to_radians().cos() * 0.25_f32.cos()))
            .atan();
    assert!(angle_between(sideways.rotation, rest * Quat::from_rotation_x(twist)) < 1e-6);
}

#[test]
fn a_flat_cone_swings_in_one_plane_and_does_not_jump() {
    let saddle = |side: f32| {
        let ball =
            Ball { axis: Vec3::Y, side: Vec3::X, swing_side: 1.0, swing_up: 0.0, twist: AngleRange::NONE };
        let turn = Quat::from_scaled_axis(Vec3::new(0.5, 0.0, side));
        JointLimit::Ball(ball).clamp(turn, Quat::IDENTITY).rotation
    };
    for side in [-0.3, -1e-4, 0.0, 1e-4, 0.3] {
        assert!(
            angle_between(saddle(side), Quat::from_rotation_x(0.5)) < 1e-6 + 2.0 * side.abs() * SLACK,
            "{side}"
        );
    }
}

#[test]
fn a_limit_without_an_axis_limits_nothing() {
    let turn = Quat::from_rotation_x(3.0);
    for axis in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        let limits = [
            JointLimit::Hinge(Hinge { axis, range: AngleRange::NONE }),
            JointLimit::Ball(Ball::round(axis, 0.0, AngleRange::NONE)),
        ];
        for limit in limits {
            assert_eq!(limit.clamp(turn, Quat::IDENTITY), Clamped { rotation: turn, by: 0.0 }, "{axis}");
        }
    }
    // Without a side axis any is used; it only matters for cones that are not round.
    let ball = Ball { side: Vec3::Y, ..Ball::round(Vec3::Y, 0.5, AngleRange::NONE) };
    let clamped = JointLimit::Ball(ball).clamp(turn, Quat::IDENTITY);
    assert!(angle_between(clamped.rotation, Quat::from_rotation_x(0.5)) < 1e-6);
}

#[test]
fn a_half_turn_has_a_defined_limit() {
    // Straight back: the twist is undefined, so it is zero.
    let back = Quat::from_xyzw(1.0, 0.0, 0.0, 0.0);
    let ball = JointLimit::Ball(Ball::round(Vec3::Y, PI, AngleRange::NONE));
    let clamped = ball.clamp(back, Quat::IDENTITY);
    assert!((clamped.by.to_degrees() - 5.0).abs() < 1e-3, "175° at most: {clamped:?}");
    // Across the axis of a hinge: no angle about it.
    let hinge = JointLimit::Hinge(Hinge { axis: Vec3::Y, range: AngleRange::within(1.0) });
    assert_eq!(hinge.clamp(back, Quat::IDENTITY).rotation, Quat::IDENTITY);
    assert!((hinge.clamp(back, Quat::IDENTITY).by - PI).abs() < 1e-6);
}

#[test]
fn a_mirrored_scale_does_not_affect_limits() {
    let skeleton = Skeleton { bones: vec![bone("elbow", None, Vec3::Y)] };
    let mut limits = JointLimits::new();
    limits.set(0, JointLimit::Hinge(Hinge { axis: Vec3::X, range: AngleRange::new(0.0, 1.0) }));
    let pose = |scale| Transform { rotation: Quat::from_rotation_x(1.5), scale, translation: Vec3::NEG_Z };
    for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::ZERO] {
        let mut poses = [pose(scale)];
        limits.apply(&skeleton, &mut poses, &mut []);
        assert!(angle_between(poses[0].rotation, Quat::from_rotation_x(1.0)) < 1e-6, "{scale}");
        assert_eq!((poses[0].scale, poses[0].translation), (scale, Vec3::NEG_Z));
    }
}

#[test]
fn limits_of_a_skeleton_change_only_bones_outside_of_them_and_report_those() {
    let bones = (0..4).map(|_| bone("", None, Vec3::Y)).collect();
    let skeleton = Skeleton { bones };
    let mut limits = JointLimits::new();
    let hinge = |max: f32| JointLimit::Hinge(Hinge { axis: Vec3::X, range: AngleRange::new(0.0, max) });
    for (bone, max) in [(3, 0.5), (0, 2.0), (1, 0.9), (9, 0.1)] {
        assert_eq!(limits.set(bone, hinge(max)), None);
    }
    assert_eq!(limits.iter().map(|(bone, _)| bone).collect::<Vec<_>>(), [0, 1, 3, 9]);
    let before = Transform { rotation: Quat::from_rotation_x(1.0), ..Transform::IDENTITY };
    let (mut poses, mut by) = ([before; 4], [9.0; 4]);
    let report = limits.apply(&skeleton, &mut poses, &mut by);
    assert_eq!((report.clamped, report.worst), (2, Some(3)));
    assert!((report.by - 0.5).abs() < 1e-6 && (by[1] - 0.1).abs() < 1e-6 && by[3] == report.by);
    assert_eq!((by[0], by[2]), (0.0, 0.0));
    assert_eq!([bits(poses[0]), bits(poses[2])], [bits(before); 2]);
    // The second time nothing changes.
    assert_eq!(limits.apply(&skeleton, &mut poses, &mut by[..1]), LimitReport::default());
    assert_eq!(limits.set(3, None), Some(hinge(0.5)));
    assert_eq!((limits.len(), limits.get(3), limits.get(1)), (3, None, Some(&hinge(0.9))));
    let (count, _) = count(|| limits.apply(&skeleton, &mut poses, &mut by));
    assert_eq!(count.allocations, 0);
}

#[test]
fn invalid_limits_and_rotations_give_valid_rotations() {
    let seed = seed(24);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..20_000 {
        let (a, b, c) = (hostile(&mut random), hostile(&mut random), hostile(&mut random));
        let range = AngleRange::new(a.scale.x, a.scale.y);
        let ranges = [range, AngleRange::new(b.scale.x, b.scale.y), AngleRange::new(b.scale.z, a.scale.z)];
        let limits = [
            JointLimit::Hinge(Hinge { axis: a.translation, range }),
            JointLimit::Ball(Ball {
                axis: a.translation,
                side: b.translation,
                swing_side: c.scale.x,
                swing_up: c.scale.y,
                twist: range,
            }),
            JointLimit::Euler(Euler { order: random.choice(&EulerOrder::ALL), ranges }),
        ];
        for limit in limits {
            for limit in [limit, limit.mirrored(round % 4)] {
                let once = limit.clamp(b.rotation, c.rotation);
                assert!(
                    once.rotation.is_finite() && (once.rotation.length() - 1.0).abs() < 2e-4,
                    "{round}: {once:?}"
                );
                assert!(once.by.is_finite(), "{round}: {once:?}");
                assert_eq!(
                    limit.clamp(once.rotation, c.rotation).rotation,
                    once.rotation,
                    "{round}: {limit:?}"
                );
            }
        }
    }
}
