//! Chains of bones reach every reachable target, and keep their lengths and limits.

use crate::ik::{
    PARENTS, ParentScale, at_distance, direction, lengths, matrices, only_rotations, origin, row, started,
    turn, vector,
};
use crate::support::bone;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::ik::{Chain, ChainScratch, chain};
use dragonfly_anim::sample::rest_pose;
use glam::{Quat, Vec3};

#[test]
fn a_chain_reaches_every_reachable_target_and_keeps_its_lengths() {
    let mut random = started(27);
    let (mut scratch, mut worst) = (ChainScratch::default(), 0.0_f32);
    for round in 0..3_000 {
        let (links, parent) = (1 + random.below(9), random.choice(&PARENTS));
        let (skeleton, mut poses) = row(&mut random, links, parent);
        if random.below(4) == 0 {
            // Straight: every joint on the x axis of its parent.
            for pose in &mut poses[2..] {
                pose.translation = Vec3::X * pose.translation.length();
                pose.rotation = Quat::IDENTITY;
            }
        }
        let (before, old) = (poses.clone(), matrices(&skeleton, &poses));
        let parts = lengths(&poses);
        let most: f32 = parts.iter().sum();
        let least = (2.0 * parts.iter().copied().fold(0.0, f32::max) - most).max(0.0);
        let share = random.choice(&[0.0, 1e-3, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0]);
        let way = if random.below(4) == 0 {
            old[0]
                .inverse()
                .transform_vector3(origin(&old, links + 1) - origin(&old, 1))
                .normalize_or(Vec3::X)
        } else {
            direction(&mut random)
        };
        let target = at_distance(&old, &poses, way, least + (most - least) * share);
        let settings = Chain::new(1, links as u32 + 1);
        let reach = chain(&skeleton, &old, &settings, target, None, &mut scratch, &mut poses).unwrap();
        let size = most * poses[0].scale.abs().max_element();
        let off = origin(&matrices(&skeleton, &poses), links + 1).distance(target) / size;
        worst = worst.max(off);
        assert!(off < 1e-4, "{round} {parent:?} {links} links, share {share}: {off} {reach:?}");
        assert!((reach.distance / size - off).abs() < 1e-4, "{round} {reach:?}");
        only_rotations(&before, &poses);
    }
    println!("worst: {worst} of the length");
}

#[test]
fn a_chain_out_of_reach_points_straight_at_its_target() {
    let mut random = started(28);
    let mut scratch = ChainScratch::default();
    for round in 0..500 {
        let links = 1 + random.below(9);
        let (skeleton, mut poses) = row(&mut random, links, ParentScale::Uniform);
        let old = matrices(&skeleton, &poses);
        let (way, most) = (direction(&mut random), lengths(&poses).iter().sum::<f32>());
        let target = at_distance(&old, &poses, way, most * random.choice(&[1.0001, 2.0, 1e4]));
        let settings = Chain::new(1, links as u32 + 1);
        chain(&skeleton, &old, &settings, target, None, &mut scratch, &mut poses).unwrap();
        let new = matrices(&skeleton, &poses);
        let mut distance = 0.0;
        for (index, length) in lengths(&poses).into_iter().enumerate() {
            distance += length;
            let expected = at_distance(&old, &poses, way, distance);
            assert!(origin(&new, index + 2).distance(expected) < 1e-4 * most * poses[0].scale.x, "{round}");
        }
    }
}

#[test]
fn a_chain_that_cannot_fold_far_enough_points_at_its_target_from_the_nearest_position() {
    let mut random = started(36);
    let mut scratch = ChainScratch::default();
    for round in 0..500 {
        let links = 2 + random.below(4);
        let (skeleton, mut poses) = row(&mut random, links, ParentScale::Plain);
        let long = 2 + random.below(links);
        let part = poses[long].translation;
        poses[long].translation = part.normalize() * 6.0 * links as f32;
        let old = matrices(&skeleton, &poses);
        let parts = lengths(&poses);
        let most: f32 = parts.iter().sum();
        let least = 2.0 * parts.iter().copied().fold(0.0, f32::max) - most;
        assert!(least > 0.0);
        let (way, distance) = (direction(&mut random), least * random.choice(&[0.1, 0.5, 0.9, 0.999]));
        let target = at_distance(&old, &poses, way, distance);
        let settings = Chain::new(1, links as u32 + 1);
        chain(&skeleton, &old, &settings, target, None, &mut scratch, &mut poses).unwrap();
        let end = origin(&matrices(&skeleton, &poses), links + 1);
        let expected = at_distance(&old, &poses, way, least);
        assert!(end.distance(expected) < 1e-4 * most, "{round}: {} of {most}", end.distance(expected));
    }
}

#[test]
fn a_chain_keeps_its_joint_limits_and_comes_no_farther_from_its_target() {
    let mut random = started(29);
    let mut scratch = ChainScratch::default();
    for round in 0..500 {
        let links = 2 + random.below(6);
        let (skeleton, mut poses) = row(&mut random, links, ParentScale::Plain);
        poses.iter_mut().for_each(|pose| pose.rotation = Quat::IDENTITY);
        let old = matrices(&skeleton, &poses);
        let target = origin(&old, 1) + vector(&mut random) * links as f32;
        let within = |_: u32, wish: Quat| {
            let wish = if wish.w < 0.0 { -wish } else { wish };
            let (axis, angle) = wish.to_axis_angle();
            Quat::from_axis_angle(axis, angle.min(0.4))
        };
        let settings = Chain::new(1, links as u32 + 1);
        let mut limit = within;
        let limit: Option<dragonfly_anim::ik::Limit<'_>> = Some(&mut limit);
        let distance = origin(&old, links + 1).distance(target);
        let reach = chain(&skeleton, &old, &settings, target, limit, &mut scratch, &mut poses).unwrap();
        assert!(reach.distance <= distance * 1.000_01, "{round}: {reach:?} from {distance}");
        for pose in &poses[1..] {
            assert!(crate::support::angle_between(pose.rotation, Quat::IDENTITY) < 0.4001, "{round}");
        }
    }
}

#[test]
fn a_straight_chain_bends_within_its_limits_and_a_fixed_joint_makes_nothing_worse() {
    let bones = (0..5).map(|index: u32| bone("link", index.checked_sub(1), Vec3::X)).collect();
    let skeleton = Skeleton { bones };
    let rest: Vec<Transform> = skeleton.bones.iter().map(rest_pose).collect();
    let old = matrices(&skeleton, &rest);
    let mut scratch = ChainScratch::default();
    let mut solve = |target: Vec3, limit: dragonfly_anim::ik::Limit<'_>| {
        let mut poses = rest.clone();
        let row = Chain::new(0, 4);
        let reach = chain(&skeleton, &old, &row, target, Some(limit), &mut scratch, &mut poses).unwrap();
        assert!((origin(&matrices(&skeleton, &poses), 4).distance(target) - reach.distance).abs() < 1e-5);
        reach.distance
    };
    let mut cone = |bone: u32, wish: Quat| {
        let (axis, angle) = if wish.w < 0.0 { -wish } else { wish }.to_axis_angle();
        if bone == 0 { wish } else { Quat::from_axis_angle(axis, angle.min(1.2)) }
    };
    // On the line through the joints, so that no bending direction is preferred.
    for distance in [2.5, 3.0, 3.5, 3.9] {
        let left = solve(Vec3::X * distance, &mut cone);
        assert!(left < 0.1 * (4.0 - distance), "at {distance}: {left}");
    }
    let mut random = started(37);
    for _ in 0..200 {
        let (target, fixed) = (Vec3::X + vector(&mut random) * 4.0, turn(&mut random));
        let mut stubborn = |bone: u32, wish: Quat| if bone == 2 { fixed } else { wish };
        assert!(solve(target, &mut stubborn) <= origin(&old, 4).distance(target) * 1.000_01);
        let mut deaf = |_: u32, _: Quat| fixed;
        assert!(solve(target, &mut deaf) <= origin(&old, 4).distance(target) * 1.000_01);
    }
}

/// A straight row along x.
fn straight(links: u32) -> (Skeleton, Vec<Transform>) {
    let bones = (0..=links).map(|index| bone("link", index.checked_sub(1), Vec3::X)).collect();
    let skeleton = Skeleton { bones };
    let poses = skeleton.bones.iter().map(rest_pose).collect();
    (skeleton, poses)
}

#[test]
fn a_straight_chain_with_a_target_on_its_line_bends_at_once_and_in_one_plane() {
    let mut scratch = ChainScratch::default();
    for links in [2_u32, 3, 4, 6, 9] {
        for share in [0.2, 0.4, 0.6, 0.8] {
            for limited in [false, true] {
                let (skeleton, mut poses) = straight(links);
                let old = matrices(&skeleton, &poses);
                let target = Vec3::X * (1.0 + links as f32 * share);
                let mut cone = |bone: u32, wish: Quat| {
                    let (axis, angle) = if wish.w < 0.0 { -wish } else { wish }.to_axis_angle();
                    if bone == 0 { wish } else { Quat::from_axis_angle(axis, angle.min(2.9)) }
                };
                let limit: Option<dragonfly_anim::ik::Limit<'_>> = limited.then_some(&mut cone);
                let settings = Chain::new(0, links);
                let reach =
                    chain(&skeleton, &old, &settings, target, limit, &mut scratch, &mut poses).unwrap();
                let place = format!("{links} links, {share} of the way, limits {limited}: {reach:?}");
                assert!(reach.distance < 1e-3 * links as f32, "{place}");
                // A sweep that finds the joints on the line leaves them there, and so do all later ones.
                assert!(share < 0.4 || reach.iterations < 16, "{place}");
                let new = matrices(&skeleton, &poses);
                let off = |bone: u32| origin(&new, bone as usize).reject_from(Vec3::X);
                let side = (1..links).map(off).max_by(|a, b| a.length().total_cmp(&b.length())).unwrap();
                for bone in 1..links {
                    let across = off(bone).reject_from(side).length();
                    assert!(
                        across < 1e-3 * links as f32,
                        "{place}: joint {bone} is {across} away from the plane"
                    );
                }
            }
        }
    }
}

#[test]
fn a_chain_that_its_limits_force_away_keeps_its_best_pose() {
    // One bone must rotate away from its target: every sweep ends farther from the target than the pose was.
    let (skeleton, rest) = straight(4);
    let old = matrices(&skeleton, &rest);
    let mut scratch = ChainScratch::default();
    let mut random = started(38);
    let mut kept = 0;
    for round in 0..300 {
        let away = turn(&mut random);
        let target = origin(&old, 4) + vector(&mut random) * random.choice(&[0.02, 0.3, 1.0]);
        let before = origin(&old, 4).distance(target);
        let mut deaf = |_: u32, _: Quat| away;
        let limit: Option<dragonfly_anim::ik::Limit<'_>> = Some(&mut deaf);
        let mut poses = rest.clone();
        let reach =
            chain(&skeleton, &old, &Chain::new(0, 4), target, limit, &mut scratch, &mut poses).unwrap();
        let after = origin(&matrices(&skeleton, &poses), 4).distance(target);
        assert!(after <= before + 1e-5 && (reach.distance - after).abs() < 1e-5, "{round}: {before} {after}");
        kept += usize::from(poses == rest);
    }
    assert!(kept > 250, "{kept}: most rotations lead away");
}

#[test]
fn a_chain_with_limits_reaches_most_targets_that_are_reachable_within_them() {
    let mut random = started(34);
    let mut scratch = ChainScratch::default();
    let mut found = 0;
    for _ in 0..1_000 {
        let links = 2 + random.below(5);
        let (skeleton, mut poses) = row(&mut random, links, ParentScale::Plain);
        poses.iter_mut().for_each(|pose| pose.rotation = Quat::IDENTITY);
        let old = matrices(&skeleton, &poses);
        let mut bent = poses.clone();
        bent[1..]
            .iter_mut()
            .for_each(|pose| pose.rotation = Quat::from_scaled_axis(vector(&mut random) * 0.4));
        let target = origin(&matrices(&skeleton, &bent), links + 1);
        let mut limit = |_: u32, wish: Quat| {
            let wish = if wish.w < 0.0 { -wish } else { wish };
            let (axis, angle) = wish.to_axis_angle();
            Quat::from_axis_angle(axis, angle.min(0.7))
        };
        let settings = Chain::new(1, links as u32 + 1);
        let limit: Option<dragonfly_anim::ik::Limit<'_>> = Some(&mut limit);
        let reach = chain(&skeleton, &old, &settings, target, limit, &mut scratch, &mut poses).unwrap();
        found += usize::from(reach.distance < 1e-3 * lengths(&poses).iter().sum::<f32>());
    }
    println!("{found} of 1000");
    assert!(found >= 990, "{found}");
}
