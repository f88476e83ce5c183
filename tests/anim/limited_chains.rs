//! Chains with joint limits reach every target that is reachable within the limits.

use crate::ik::{ParentScale, lengths, matrices, origin, row, started, turn, vector};
use crate::support::bone;
use dragonfly_anim::data::{Skeleton, Transform};
use dragonfly_anim::ik::{Chain, ChainScratch, Limit, chain};
use dragonfly_anim::joint::{AngleRange, Ball, Euler, EulerOrder, Hinge, JointLimit, JointLimits, SLACK};
use dragonfly_anim::sample::rest_pose;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::Random;
use glam::{Quat, Vec3};

/// A row of bones at rest, each with a limit.
struct Limited {
    skeleton: Skeleton,
    limits: JointLimits,
    poses: Vec<Transform>,
}

impl Limited {
    /// Returns `row` with each bone's pose as its rest pose, and the limits that `choose` returns.
    fn new(row: (Skeleton, Vec<Transform>), mut choose: impl FnMut(u32) -> Option<JointLimit>) -> Self {
        let (mut skeleton, poses) = row;
        let mut limits = JointLimits::new();
        for (index, (bone, pose)) in skeleton.bones.iter_mut().zip(&poses).enumerate() {
            bone.rest = *pose;
            limits.set(index as u32, choose(index as u32));
        }
        Self { skeleton, limits, poses }
    }

    fn links(&self) -> usize {
        self.skeleton.len() - 2
    }

    /// Returns a point that a pose within the limits reaches: every joint rotated at random, then clamped to its limit.
    fn reachable(&self, random: &mut Random, most: f32) -> Vec3 {
        let mut poses = self.poses.clone();
        for pose in &mut poses[1..] {
            pose.rotation = (pose.rotation * Quat::from_scaled_axis(vector(random) * most)).normalize();
        }
        self.limits.apply(&self.skeleton, &mut poses, &mut []);
        origin(&matrices(&self.skeleton, &poses), self.links() + 1)
    }

    /// Solves the chain and returns the distance of its end from `target`, relative to its length; checks that no joint
    /// exceeds its limit.
    fn off(&self, target: Vec3, scratch: &mut ChainScratch) -> f32 {
        let (old, mut poses) = (matrices(&self.skeleton, &self.poses), self.poses.clone());
        let settings = Chain::new(1, self.links() as u32 + 1);
        let mut within = |bone: u32, wish: Quat| {
            let rest = self.skeleton.bones[bone as usize].rest.rotation;
            self.limits.get(bone).map_or(wish, |limit| limit.clamp(wish, rest).rotation)
        };
        let limit: Option<Limit<'_>> = Some(&mut within);
        let reach = chain(&self.skeleton, &old, &settings, target, limit, scratch, &mut poses).unwrap();
        let end = origin(&matrices(&self.skeleton, &poses), self.links() + 1);
        let size: f32 = lengths(&self.poses).iter().sum();
        assert!((reach.distance - end.distance(target)).abs() < 1e-4 * size, "{reach:?}");
        // Values rounded to f32 may exceed a limit by the rounding error.
        let mut by = vec![0.0; poses.len()];
        let report = self.limits.apply(&self.skeleton, &mut poses, &mut by);
        assert!(report.by < 2.0 * SLACK, "{report:?}");
        end.distance(target) / size
    }
}

fn any_limit(random: &mut Random) -> JointLimit {
    let range = |random: &mut Random| {
        let width = random.between(0.3, 2.5);
        let low = -width * random.unit();
        AngleRange::new(low, low + width)
    };
    let axis = |random: &mut Random| turn(random) * Vec3::X;
    match random.below(3) {
        0 => JointLimit::Hinge(Hinge { axis: axis(random), range: range(random) }),
        1 => JointLimit::Ball(Ball {
            axis: axis(random),
            side: axis(random),
            swing_side: random.between(0.2, 1.5),
            swing_up: random.between(0.2, 1.5),
            twist: range(random),
        }),
        _ => JointLimit::Euler(Euler {
            order: random.choice(&EulerOrder::ALL),
            ranges: [(); 3].map(|()| range(random)),
        }),
    }
}

/// A shoulder, an elbow, a wrist and a hand, straight down.
fn arm(random: &mut Random) -> Limited {
    let down = |length: f32| Vec3::NEG_Y * length;
    let bones = vec![
        bone("chest", None, Vec3::ZERO),
        bone("upper arm", Some(0), Vec3::X * 0.2),
        bone("lower arm", Some(1), down(random.between(0.25, 0.35))),
        bone("hand", Some(2), down(random.between(0.2, 0.3))),
        bone("tip", Some(3), down(random.between(0.1, 0.2))),
    ];
    let skeleton = Skeleton { bones };
    let poses = skeleton.bones.iter().map(rest_pose).collect();
    Limited::new((skeleton, poses), |bone| match bone {
        1 => Some(JointLimit::Ball(Ball {
            axis: Vec3::NEG_Y,
            side: Vec3::X,
            swing_side: 1.6,
            swing_up: 1.2,
            twist: AngleRange::within(1.2),
        })),
        2 => Some(JointLimit::Hinge(Hinge { axis: Vec3::NEG_X, range: AngleRange::degrees(0.0, 150.0) })),
        3 => Some(JointLimit::Ball(Ball::round(Vec3::NEG_Y, 0.8, AngleRange::NONE))),
        _ => None,
    })
}

/// A finger or a tail: hinges that all bend in the same direction.
fn finger(random: &mut Random) -> Limited {
    let links = 2 + random.below(5);
    let mut bones = vec![bone("hand", None, Vec3::ZERO)];
    for index in 0..=links {
        bones.push(bone("link", Some(index as u32), Vec3::X * random.between(0.2, 1.0)));
    }
    let skeleton = Skeleton { bones };
    let poses = skeleton.bones.iter().map(rest_pose).collect();
    let range = AngleRange::degrees(0.0, random.between(40.0, 120.0));
    Limited::new((skeleton, poses), |_| Some(JointLimit::Hinge(Hinge { axis: Vec3::Z, range })))
}

fn found(name: &str, seed: u64, make: impl Fn(&mut Random) -> (Limited, Vec3)) -> (usize, usize) {
    let mut random = started(seed);
    let mut scratch = ChainScratch::default();
    let (mut found, mut exact) = (0, 0);
    let begun = std::time::Instant::now();
    for _ in 0..1_000 {
        let (limited, target) = make(&mut random);
        let off = limited.off(target, &mut scratch);
        found += usize::from(off < 0.01);
        exact += usize::from(off < 1e-3);
    }
    println!("{name}: {found} of 1000 within 1 %, {exact} within 0.1 %; {:?} each", begun.elapsed() / 1000);
    (found, exact)
}

#[test]
fn a_chain_with_limits_reaches_targets_that_are_reachable_within_them() {
    let cones = |random: &mut Random| {
        let links = 2 + random.below(5);
        let (skeleton, mut poses) = row(random, links, ParentScale::Plain);
        poses.iter_mut().for_each(|pose| pose.rotation = Quat::IDENTITY);
        let cone = JointLimit::Ball(Ball::round(Vec3::X, 0.7, AngleRange::within(0.7)));
        let limited = Limited::new((skeleton, poses), |_| Some(cone));
        let target = limited.reachable(random, 0.4);
        (limited, target)
    };
    let mixed = |most: f32| {
        move |random: &mut Random| {
            let links = 2 + random.below(6);
            let row = row(random, links, ParentScale::Plain);
            let limited = Limited::new(row, |_| Some(any_limit(random)));
            let target = limited.reachable(random, most);
            (limited, target)
        }
    };
    let arms = |random: &mut Random| {
        let arm = arm(random);
        let target = arm.reachable(random, 2.0);
        (arm, target)
    };
    let fingers = |random: &mut Random| {
        let finger = finger(random);
        let target = finger.reachable(random, 2.0);
        (finger, target)
    };
    let all = [
        found("cones", 41, cones),
        found("all kinds", 42, mixed(1.0)),
        found("all kinds, far", 43, mixed(3.0)),
        found("arms", 44, arms),
        found("fingers", 45, fingers),
    ];
    assert!(all.iter().all(|&(found, _)| found >= 990), "{all:?}");
}

#[test]
fn a_chain_with_limits_allocates_nothing_and_evaluates_them_a_bounded_number_of_times() {
    let mut random = started(46);
    let (limited, mut scratch) = (arm(&mut random), ChainScratch::with_capacity(5));
    let old = matrices(&limited.skeleton, &limited.poses);
    let mut most = 0;
    for _ in 0..100 {
        let (mut poses, mut asked) = (limited.poses.clone(), 0);
        let target = vector(&mut random) * 1.2;
        let mut within = |bone: u32, wish: Quat| {
            asked += 1;
            let rest = limited.skeleton.bones[bone as usize].rest.rotation;
            limited.limits.get(bone).map_or(wish, |limit| limit.clamp(wish, rest).rotation)
        };
        let settings = Chain::new(1, 4);
        let (allocated, _) = count(|| {
            let limit: Option<Limit<'_>> = Some(&mut within);
            chain(&limited.skeleton, &old, &settings, target, limit, &mut scratch, &mut poses).unwrap()
        });
        assert_eq!(allocated.allocations, 0);
        most = most.max(asked);
    }
    println!("evaluated at most {most} times");
    // The documented bound: for each rotating bone, the sweeps and 2,028 more.
    assert!(most > 100 && most <= 3 * (32 + 2_028), "{most}");
}
