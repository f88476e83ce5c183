//! Lint of takes: every planted defect is found, in the bone and at the frame where it was planted, and clean takes have none.

use super::support::{bone, take};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::joint::{AngleRange, Hinge, JointLimit};
use dragonfly_anim::lint::{LintFinding, LintRule, LintThresholds, lint_take};
use glam::{Quat, Vec3};
use std::f32::consts::TAU;

const RATE: f32 = 30.0;
const HIP_HEIGHT: f32 = 0.88;

fn leg() -> Skeleton {
    Skeleton {
        bones: vec![
            bone("Hips", None, Vec3::Y * HIP_HEIGHT),
            bone("Thigh.L", Some(0), Vec3::ZERO),
            bone("Shin.L", Some(1), Vec3::new(0.0, -0.42, 0.05)),
            bone("Foot.L", Some(2), Vec3::new(0.0, -0.42, -0.05)),
        ],
    }
}

/// Two seconds in which the hips sway and the shin swings; smooth, with a key on each frame. Where the foot is slow it is high.
fn clean() -> Take {
    let times: Vec<f32> = (0..61).map(|frame| frame as f32 / RATE).collect();
    let wave = |frame: usize| (frame as f32 / 60.0 * TAU).sin();
    let height = |frame: usize| HIP_HEIGHT + 0.06 - 0.06 * (frame as f32 / 30.0 * TAU).cos();
    let places = (0..61).map(|frame| Vec3::new(0.0, height(frame), 0.3 * wave(frame)));
    let turns = (0..61).map(|frame| Quat::from_rotation_x(0.3 * wave(frame)));
    take(vec![
        Track {
            translation: Channel::new(times.clone(), places.collect::<Vec<_>>(), Interpolation::Linear),
            ..Track::default()
        },
        Track::default(),
        Track {
            rotation: Channel::new(times, turns.collect::<Vec<_>>(), Interpolation::Linear),
            ..Track::default()
        },
        Track::default(),
    ])
}

fn places(take: &mut Take, change: impl Fn(usize, Vec3) -> Vec3) {
    let channel = &mut take.tracks[0].translation;
    channel.values = channel.values.iter().enumerate().map(|(key, &value)| change(key, value)).collect();
}

fn lint(take: &Take, thresholds: &LintThresholds) -> Vec<LintFinding> {
    lint_take(take, &leg(), RATE, thresholds).expect("a table")
}

/// Returns the findings of one rule; fails where there is none.
#[track_caller]
fn found(take: &Take, rule: LintRule) -> Vec<LintFinding> {
    let all = lint(take, &LintThresholds::default());
    let of_rule: Vec<LintFinding> = all.iter().copied().filter(|finding| finding.rule == rule).collect();
    assert!(!of_rule.is_empty(), "{rule:?} is not among {all:?}");
    of_rule
}

#[test]
fn a_smooth_take_has_no_defects() {
    assert_eq!(lint(&clean(), &LintThresholds::default()), []);
}

#[test]
fn a_trembling_bone_is_found_at_its_frame() {
    let mut take = clean();
    places(&mut take, |key, value| match key {
        20..26 => value + Vec3::X * if key % 2 == 0 { 0.002 } else { -0.002 },
        _ => value,
    });
    let finding = found(&take, LintRule::Jitter)[0];
    assert!((20..26).contains(&finding.frame) && finding.bone == 0, "{finding:?}");
    assert!((finding.amount - 8.0).abs() < 1.0, "{finding:?}");
}

#[test]
fn a_pose_that_is_wrong_for_one_frame_and_a_jump_are_pops() {
    let mut single = clean();
    places(&mut single, |key, value| if key == 30 { value + Vec3::X * 0.3 } else { value });
    let finding = found(&single, LintRule::Pop)[0];
    assert!((29..=30).contains(&finding.frame) && finding.amount > 150.0, "{finding:?}");
    let mut jump = clean();
    places(&mut jump, |key, value| if key >= 30 { value + Vec3::X * 0.3 } else { value });
    let finding = found(&jump, LintRule::Pop)[0];
    assert_eq!((finding.frame, finding.bone), (29, 0));
}

#[test]
fn a_flipped_rotation_is_found_with_its_angle() {
    let mut take = clean();
    let channel = &mut take.tracks[2].rotation;
    let turn =
        |(key, &value): (usize, &Quat)| if key == 40 { Quat::from_rotation_y(3.0) * value } else { value };
    channel.values = channel.values.iter().enumerate().map(turn).collect();
    let finding = found(&take, LintRule::Flip)[0];
    assert_eq!((finding.frame, finding.bone), (40, 2));
    assert!((finding.amount - 172.0).abs() < 1.0, "{finding:?}");
}

#[test]
fn a_stretched_bone_is_found_with_its_percentage() {
    let mut take = clean();
    let rest = Vec3::new(0.0, -0.42, -0.05);
    take.tracks[3].translation =
        Channel::new(vec![0.0, 1.0, 2.0], vec![rest, rest * 1.2, rest], Interpolation::Linear);
    let findings = found(&take, LintRule::Stretch);
    assert_eq!((findings.len(), findings[0].bone, findings[0].frame), (1, 3, 30));
    assert!((findings[0].amount - 20.0).abs() < 0.01, "{findings:?}");
}

#[test]
fn a_foot_below_the_floor_is_found_with_its_depth() {
    let mut take = clean();
    places(&mut take, |key, value| if (10..50).contains(&key) { value - Vec3::Y * 0.2 } else { value });
    let findings = found(&take, LintRule::Floor);
    assert!(findings.iter().all(|finding| finding.bone == 3), "{findings:?}");
    assert!((100.0..210.0).contains(&findings[0].amount), "{findings:?}");
}

#[test]
fn a_sliding_foot_is_found_with_its_speed() {
    let mut take = clean();
    places(&mut take, |key, _| Vec3::new(0.0, HIP_HEIGHT, 0.003 * key as f32));
    take.tracks[2] = Track { bone: 2, ..Track::default() };
    let finding = found(&take, LintRule::FootSlide)[0];
    assert_eq!(finding.bone, 3);
    assert!((finding.amount - 90.0).abs() < 1.0, "{finding:?}");
}

#[test]
fn keys_on_each_frame_that_the_others_predict_are_found() {
    let mut take = clean();
    places(&mut take, |key, _| {
        Vec3::new(0.0, HIP_HEIGHT, if key < 30 { 0.0 } else { 0.02 * (key - 30) as f32 })
    });
    let finding = found(&take, LintRule::SpareKeys)[0];
    assert_eq!((finding.bone, finding.rule.unit()), (0, "%"));
    assert!(finding.amount > 90.0, "{finding:?}");
}

#[test]
fn keys_outside_of_the_range_of_the_take_are_found() {
    let mut take = clean();
    take.length = 1.9;
    let findings = found(&take, LintRule::Outside);
    assert_eq!(findings.iter().map(|finding| finding.bone).collect::<Vec<_>>(), [0, 2]);
    assert!((findings[0].amount - 100.0).abs() < 0.1, "{findings:?}");
    take = clean();
    take.start = 0.5;
    assert_eq!(found(&take, LintRule::Outside)[0].frame, -15);
}

#[test]
fn the_gap_of_a_loop_is_measured_only_when_it_is_asked_for() {
    let mut take = clean();
    places(&mut take, |key, value| value + Vec3::X * 0.005 * key as f32);
    let asked = LintThresholds::default().with(LintRule::LoopGap, Some(10.0));
    let gaps = |take: &Take, thresholds: &LintThresholds| {
        let all = lint(take, thresholds);
        all.into_iter().filter(|finding| finding.rule == LintRule::LoopGap).collect::<Vec<_>>()
    };
    assert_eq!(gaps(&take, &LintThresholds::default()), []);
    assert_eq!(gaps(&clean(), &asked), []);
    let found = gaps(&take, &asked);
    assert_eq!(found.len(), 4);
    assert!((found[0].amount - 300.0).abs() < 0.1, "{found:?}");
}

#[test]
fn a_joint_that_is_turned_beyond_its_limit_is_found_with_the_angle() {
    // The shin turns about x by 0.3 rad to each side: 17.19 degrees.
    let knee = |max: f32| {
        let mut limits = LintThresholds::default();
        limits
            .joints
            .set(2, JointLimit::Hinge(Hinge { axis: Vec3::X, range: AngleRange::degrees(-20.0, max) }));
        lint(&clean(), &limits)
    };
    assert_eq!(knee(18.0), []);
    let found = knee(10.0);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        (found[0].rule, found[0].rule.unit(), found[0].bone, found[0].frame),
        (LintRule::JointLimit, "°", 2, 15)
    );
    assert!((found[0].amount - 7.189).abs() < 1e-2, "{found:?}");
    assert_eq!(knee(16.5), [], "less than a degree is not reported");
}

#[test]
fn a_rule_without_a_threshold_finds_nothing() {
    let mut take = clean();
    places(&mut take, |key, value| if key == 30 { value + Vec3::X * 0.3 } else { value });
    let mut off = LintThresholds::default();
    for rule in LintRule::ALL {
        off = off.with(rule, None);
    }
    assert_eq!(lint(&take, &off), []);
    let only = off.clone().with(LintRule::Pop, Some(10.0));
    assert!(lint(&take, &only).iter().all(|finding| finding.rule == LintRule::Pop));
}
