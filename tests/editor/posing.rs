//! Chains of bones that follow the pointer, pinned bones that stay, and bones that aim at a target.

use crate::gizmo_rig::Rig;
use crate::panels::Bench;
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::data::{BoneIndex, Transform};
use dragonfly_anim::joint::{Hinge, JointLimits};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, SetPose};
use dragonfly_document::posing::{Goal, IkMode, PoseDragState, look_at, poses_of_drag};
use dragonfly_kit::counting;
use dragonfly_kit::document::fixture;
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Hips with a leg of three bones and a chest with an arm of four: hips 0, thigh 1, shin 2, foot 3, toe 4, chest 5,
/// clavicle 6, arm 7, forearm 8, hand 9.
const PARENTS: [Option<BoneIndex>; 10] =
    [None, Some(0), Some(1), Some(2), Some(3), Some(0), Some(5), Some(6), Some(7), Some(8)];

fn any(random: &mut Random) -> Vec3 {
    Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0))
}

fn figure(random: &mut Random) -> Rig {
    let lengths = [0.0, 0.1, 0.45, 0.42, 0.15, 0.5, 0.1, 0.15, 0.3, 0.28];
    let poses = lengths
        .iter()
        .map(|&length| Transform {
            translation: Vec3::new(0.02, length, 0.01),
            rotation: Quat::from_scaled_axis(any(random) * 0.8),
            scale: Vec3::ONE,
        })
        .collect();
    Rig::of(&PARENTS, poses)
}

fn hold(rig: &Rig, pins: &[BoneIndex], length: u32) -> PoseDragState {
    let mode = IkMode { on: true, length, pole: None };
    PoseDragState::new(Arc::new(rig.skeleton.clone()), &rig.poses, pins, mode, None)
}

/// Returns the poses of the rig with the resulting poses applied.
fn with(rig: &Rig, found: &[BonePose]) -> Vec<Transform> {
    let mut poses = rig.poses.clone();
    for pose in found {
        let BoneRef::Index(bone) = pose.bone else { panic!("by number") };
        let now = &mut poses[bone as usize];
        now.translation = pose.translation.map_or(now.translation, Vec3::from);
        now.rotation = pose.rotation.map_or(now.rotation, Quat::from_array);
        now.scale = pose.scale.map_or(now.scale, Vec3::from);
    }
    poses
}

fn place(rig: &Rig, poses: &[Transform], bone: usize) -> Vec3 {
    rig.to_root_of(poses)[bone].w_axis.truncate()
}

fn facing(rig: &Rig, poses: &[Transform], bone: usize) -> Quat {
    rig.to_root_of(poses)[bone].to_scale_rotation_translation().1
}

fn moved(bone: BoneIndex, to: Vec3) -> BonePose {
    BonePose { bone: BoneRef::Index(bone), translation: Some(to.to_array()), rotation: None, scale: None }
}

#[test]
fn a_pinned_foot_keeps_its_position_and_rotation_while_the_hips_move() {
    let first = seed(71);
    for number in first..first + 300 {
        let mut random = Random::new(number);
        let rig = figure(&mut random);
        let mut hold = hold(&rig, &[3], 2);
        let leg = rig.poses[2].translation.length() + rig.poses[3].translation.length();
        let foot = place(&rig, &rig.poses, 3);
        for _ in 0..5 {
            let to = rig.poses[0].translation + any(&mut random) * 0.3;
            let turn = Quat::from_scaled_axis(any(&mut random) * 0.3) * rig.poses[0].rotation;
            let wanted = BonePose { rotation: Some(turn.to_array()), ..moved(0, to) };
            let mut followed = rig.poses.clone();
            (followed[0].translation, followed[0].rotation) = (to, turn);
            let from_hip = foot.distance(place(&rig, &followed, 1));
            let lower = (rig.poses[2].translation.length() - rig.poses[3].translation.length()).abs();
            let found = poses_of_drag(&mut hold, &[wanted], &[]);
            let poses = with(&rig, &found);
            assert_eq!(poses[0].translation, to, "the hips are where the hand wants them");
            let miss = place(&rig, &poses, 3).distance(foot);
            if from_hip < leg * 0.999 && from_hip > lower * 1.01 + 1e-3 {
                assert!(miss <= leg * 1e-4, "seed {number}: missed by {miss} of {leg}");
            } else {
                let nearest = (from_hip - leg).max(lower - from_hip).max(0.0);
                assert!((miss - nearest).abs() < leg * 2e-3, "seed {number}: {miss}, not {nearest}");
            }
            let turned = facing(&rig, &poses, 3).dot(facing(&rig, &rig.poses, 3)).abs();
            assert!(turned > 1.0 - 1e-5, "seed {number}: the foot turned: {turned}");
            for (bone, (now, begun)) in poses.iter().zip(&rig.poses).enumerate().skip(1) {
                assert_eq!(now.translation, begun.translation, "bone {bone} keeps its length");
                assert_eq!(now.scale, begun.scale);
            }
            let names: Vec<&BoneRef> = found.iter().map(|pose| &pose.bone).collect();
            assert_eq!(
                names,
                [0, 1, 2, 3].map(BoneRef::Index).iter().collect::<Vec<_>>(),
                "always the same bones"
            );
        }
    }
}

#[test]
fn moving_an_end_bone_moves_a_chain_of_any_length() {
    let first = seed(72);
    for number in first..first + 200 {
        let mut random = Random::new(number);
        let rig = figure(&mut random);
        for length in [1, 2, 3, 4, 9] {
            let mut hold = hold(&rig, &[], length);
            // A position that the chain can certainly reach: the position of the hand in another pose.
            let mut other = rig.poses.clone();
            let row = [8, 7, 6, 5, 0];
            for &bone in row.iter().take(length as usize) {
                other[bone].rotation = Quat::from_scaled_axis(any(&mut random)) * other[bone].rotation;
            }
            let goal = place(&rig, &other, 9);
            let found = poses_of_drag(&mut hold, &[], &[Goal { bone: 9, place: goal }]);
            assert_eq!(found.len(), row.len().min(length as usize) + 1);
            let poses = with(&rig, &found);
            let miss = place(&rig, &poses, 9).distance(goal);
            assert!(miss < 2e-4, "seed {number}, {length} bones: {miss}");
            let turned = facing(&rig, &poses, 9).dot(facing(&rig, &rig.poses, 9)).abs();
            assert!(turned > 1.0 - 1e-5, "the hand keeps its direction");
        }
    }
}

#[test]
fn a_target_out_of_reach_straightens_the_chain() {
    let rig = figure(&mut Random::new(3));
    for length in [2, 3] {
        let mut hold = hold(&rig, &[], length);
        let root = if length == 2 { 7 } else { 6 };
        let from = place(&rig, &rig.poses, root);
        let goal = from + Vec3::new(50.0, 20.0, -10.0);
        let poses = with(&rig, &poses_of_drag(&mut hold, &[], &[Goal { bone: 9, place: goal }]));
        let reach: f32 = (root + 1..=9).map(|bone| rig.poses[bone].translation.length()).sum();
        let nearest = from + (goal - from).normalize() * reach;
        let miss = place(&rig, &poses, 9).distance(nearest);
        assert!(miss < 1e-3, "{length} bones: {miss}");
    }
}

#[test]
fn elbows_bend_towards_the_pole() {
    let first = seed(73);
    for number in first..first + 100 {
        let mut random = Random::new(number);
        let rig = figure(&mut random);
        for length in [2, 3] {
            let pole = 4;
            let mode = IkMode { on: true, length, pole: Some(pole) };
            let mut hold = PoseDragState::new(Arc::new(rig.skeleton.clone()), &rig.poses, &[], mode, None);
            let root = if length == 2 { 7 } else { 6 };
            let from = place(&rig, &rig.poses, root);
            let goal = from + any(&mut random).normalize() * 0.3;
            let poses = with(&rig, &poses_of_drag(&mut hold, &[], &[Goal { bone: 9, place: goal }]));
            let (begin, end) = (place(&rig, &poses, root), place(&rig, &poses, 9));
            let axis = (end - begin).normalize();
            let aside = |point: Vec3| (point - begin) - axis * (point - begin).dot(axis);
            let towards = aside(place(&rig, &rig.poses, pole as usize));
            let bend = (root + 1..9).map(|bone| aside(place(&rig, &poses, bone)));
            let bend = bend.max_by(|a, b| a.length().total_cmp(&b.length())).unwrap();
            if bend.length() > 0.02 && towards.length() > 0.05 {
                let angle = bend.angle_between(towards);
                assert!(angle < 0.02, "seed {number}, {length} bones: {angle} rad off");
            }
            assert!(end.distance(goal) < 1e-3, "seed {number}: the pole does not keep it from the goal");
        }
    }
}

#[test]
fn joint_limits_are_kept() {
    let rig = figure(&mut Random::new(5));
    let mut limits = JointLimits::new();
    let hinge = Hinge { axis: Vec3::X, range: dragonfly_anim::joint::AngleRange { min: -0.2, max: 0.2 } };
    limits.set(8, dragonfly_anim::joint::JointLimit::Hinge(hinge));
    let mode = IkMode { on: true, length: 2, pole: None };
    let mut hold = PoseDragState::new(Arc::new(rig.skeleton.clone()), &rig.poses, &[], mode, Some(limits));
    let from = place(&rig, &rig.poses, 7);
    for way in [Vec3::X, Vec3::Y, -Vec3::X, Vec3::Z] {
        let goal = from + way * 0.25;
        let poses = with(&rig, &poses_of_drag(&mut hold, &[], &[Goal { bone: 9, place: goal }]));
        let rest = rig.skeleton.bones[8].rest.rotation;
        let turned = rest.angle_between(poses[8].rotation);
        assert!(turned <= 0.2 + 1e-3, "{turned}");
    }
}

#[test]
fn solving_a_chain_gives_finite_poses_for_any_input() {
    let first = seed(74);
    for number in first..first + 300 {
        let mut random = Random::new(number);
        let mut rig = figure(&mut random);
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38, -1e38, 0.0, 1e-38];
        for _ in 0..random.below(4) {
            let bone = random.below(10);
            match random.below(3) {
                0 => rig.poses[bone].translation.y = random.choice(&odd),
                1 => rig.poses[bone].rotation = Quat::from_array([random.choice(&odd); 4]),
                _ => rig.poses[bone].scale = Vec3::splat(random.choice(&odd)),
            }
        }
        let number_of = |random: &mut Random| match random.below(3) {
            0 => random.choice(&odd),
            _ => random.between(-2.0, 2.0),
        };
        let pins: Vec<BoneIndex> = (0..random.below(4)).map(|_| random.below(12) as BoneIndex).collect();
        let mode =
            IkMode { on: true, length: random.below(6) as u32, pole: Some(random.below(12) as BoneIndex) };
        let mut hold = PoseDragState::new(Arc::new(rig.skeleton.clone()), &rig.poses, &pins, mode, None);
        let bone = random.below(12) as BoneIndex;
        let to = Vec3::new(number_of(&mut random), number_of(&mut random), number_of(&mut random));
        let turn = Quat::from_array([0; 4].map(|_| number_of(&mut random)));
        let given = BonePose { rotation: Some(turn.to_array()), ..moved(bone, to) };
        let goal = Goal { bone: random.below(12) as BoneIndex, place: to };
        let finite = |found: Vec<BonePose>| {
            for pose in found {
                let numbers = pose.translation.into_iter().flatten();
                let numbers = numbers.chain(pose.rotation.into_iter().flatten());
                let numbers = numbers.chain(pose.scale.into_iter().flatten());
                assert!(numbers.clone().all(f32::is_finite), "seed {number}: {pose:?}");
            }
        };
        finite(poses_of_drag(&mut hold, &[given], &[goal]));
        finite(look_at(&rig.skeleton, &rig.poses, &[bone, 3, 9], to));
    }
}

#[test]
fn bones_aim_at_their_target() {
    let first = seed(75);
    for number in first..first + 100 {
        let mut random = Random::new(number);
        let rig = figure(&mut random);
        let target = any(&mut random) * 5.0;
        let poses = with(&rig, &look_at(&rig.skeleton, &rig.poses, &[8], target));
        let (elbow, hand) = (place(&rig, &poses, 8), place(&rig, &poses, 9));
        let angle = (hand - elbow).angle_between(target - elbow);
        assert!(angle < 2e-3, "seed {number}: {angle} rad off");
    }
}

#[test]
fn solving_a_chain_allocates_nothing_that_grows_with_the_model() {
    let bytes = |more: usize| {
        let rig = figure(&mut Random::new(9));
        let mut parents = PARENTS.to_vec();
        let mut poses = rig.poses.clone();
        parents.extend((0..more).map(|_| Some(5)));
        poses.extend((0..more).map(|_| Transform::IDENTITY));
        let large = Rig::of(&parents, poses);
        let mut hold = hold(&large, &[3], 2);
        let mut work = |by: f32| poses_of_drag(&mut hold, &[moved(0, Vec3::new(0.0, by, 0.0))], &[]);
        work(0.0);
        counting::count(|| work(0.1)).0.bytes
    };
    assert_eq!(bytes(0), bytes(5000));
}

#[test]
fn commands_pin_bones_change_the_ik_settings_and_aim_bones() {
    let mut bench = Bench::new(Some(fixture::full()));
    let state = &mut bench.state;
    state.execute(Request::SelectBones(vec![3, 4], Choice::Replace));
    state.execute(Request::Command(Id::Pin));
    assert!(state.read().is_pinned(3) && state.read().is_pinned(4));
    state.execute(Request::SelectBones(vec![4], Choice::Replace));
    state.execute(Request::Command(Id::Pin));
    assert!(state.read().is_pinned(3) && !state.read().is_pinned(4));
    state.execute(Request::Command(Id::FreePins));
    assert!(state.read().pins.is_empty());
    state.execute(Request::Command(Id::ToggleIk));
    state.execute(Request::Command(Id::LongerIk));
    assert_eq!((state.read().ik.on, state.read().ik.length), (true, 3));
    for _ in 0..9 {
        state.execute(Request::Command(Id::ShorterIk));
    }
    assert_eq!(state.read().ik.length, 1);
    state.execute(Request::Command(Id::IkPole));
    assert_eq!(state.read().ik.pole, Some(4));
    assert!(state.read().bones_follow());
    // A single selected bone has no other bone to aim at.
    assert_eq!(state.execute(Request::Command(Id::LookAt)), None);
    assert!(state.read().status.last().unwrap().text.contains("last the bone to look at"));
    state.execute(Request::SelectBones(vec![6, 4], Choice::Replace));
    let effect = state.execute(Request::Command(Id::LookAt));
    let Some(Effect::Change(Change::Edit(Edit::SetPose(SetPose { poses, .. }), None))) = effect else {
        panic!("{effect:?}")
    };
    assert!(poses.len() == 1 && poses[0].rotation.is_some() && poses[0].translation.is_none());
}
