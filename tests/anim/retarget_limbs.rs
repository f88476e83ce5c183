//! Fingers are bound by side and number, and twist bones get a share of the roll of their limb, in rigs of four conventions.

use crate::retarget::matrices;
use crate::support::{bone, take};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::retarget::{BindingGuess, FigureOptions, SkeletonRoles, retarget_figure};
use dragonfly_anim::sample::sample_track;
use glam::{Quat, Vec3};

/// Names of a convention: of the trunk, of the limbs of a side, and of a finger's bone.
struct Names {
    convention: &'static str,
    trunk: [&'static str; 4],
    /// Shoulder, upper arm, forearm, hand, thigh, shin, foot; `@` is the side.
    limbs: [&'static str; 7],
    sides: [&'static str; 2],
    finger: fn(&str, usize, usize) -> String,
    /// Number of bones of a finger, with the tip.
    count: usize,
}

const FINGERS: [[&str; 4]; 5] = [
    ["Thumb", "thumb", "Thumb", "thumb"],
    ["Index", "index", "Index", "f_index"],
    ["Middle", "middle", "Middle", "f_middle"],
    ["Ring", "ring", "Ring", "f_ring"],
    ["Pinky", "pinky", "Little", "f_pinky"],
];

const RIGS: [Names; 4] = [
    Names {
        convention: "Mixamo",
        trunk: ["mixamorig:Hips", "mixamorig:Spine", "mixamorig:Neck", "mixamorig:Head"],
        limbs: ["@Shoulder", "@Arm", "@ForeArm", "@Hand", "@UpLeg", "@Leg", "@Foot"],
        sides: ["mixamorig:Left", "mixamorig:Right"],
        finger: |side, finger, number| format!("{side}Hand{}{number}", FINGERS[finger][0]),
        count: 4,
    },
    Names {
        convention: "Unreal mannequin",
        trunk: ["pelvis", "spine_01", "neck_01", "head"],
        limbs: ["clavicle_@", "upperarm_@", "lowerarm_@", "hand_@", "thigh_@", "calf_@", "foot_@"],
        sides: ["l", "r"],
        finger: |side, finger, number| format!("{}_0{number}_{side}", FINGERS[finger][1]),
        count: 3,
    },
    Names {
        convention: "VRM humanoid",
        trunk: ["hips", "spine", "neck", "head"],
        limbs: ["@Shoulder", "@UpperArm", "@LowerArm", "@Hand", "@UpperLeg", "@LowerLeg", "@Foot"],
        sides: ["left", "right"],
        finger: |side, finger, number| {
            let parts = if finger == 0 {
                ["Metacarpal", "Proximal", "Distal"]
            } else {
                ["Proximal", "Intermediate", "Distal"]
            };
            format!("{side}{}{}", FINGERS[finger][2], parts[number - 1])
        },
        count: 3,
    },
    Names {
        convention: "Rigify",
        trunk: ["DEF-spine", "DEF-spine.001", "DEF-spine.004", "DEF-spine.006"],
        limbs: [
            "DEF-shoulder.@",
            "DEF-upper_arm.@",
            "DEF-forearm.@",
            "DEF-hand.@",
            "DEF-thigh.@",
            "DEF-shin.@",
            "DEF-foot.@",
        ],
        sides: ["L", "R"],
        finger: |side, finger, number| format!("DEF-{}.0{number}.{side}", FINGERS[finger][3]),
        count: 3,
    },
];

/// Returns a figure in T-pose.
fn rig(names: &Names) -> Skeleton {
    let mut bones = Vec::new();
    let mut add = |name: &str, parent: Option<u32>, offset: Vec3| {
        bones.push(bone(name, parent, offset));
        bones.len() as u32 - 1
    };
    let hips = add(names.trunk[0], None, Vec3::Y);
    let spine = add(names.trunk[1], Some(hips), Vec3::Y * 0.2);
    let neck = add(names.trunk[2], Some(spine), Vec3::Y * 0.3);
    add(names.trunk[3], Some(neck), Vec3::Y * 0.1);
    for (side, sign) in names.sides.into_iter().zip([1.0, -1.0]) {
        let x = Vec3::X * sign;
        let limb = |at: usize| names.limbs[at].replace('@', side);
        let shoulder = add(&limb(0), Some(spine), Vec3::Y * 0.25 + 0.05 * x);
        let upper = add(&limb(1), Some(shoulder), 0.1 * x);
        let lower = add(&limb(2), Some(upper), 0.3 * x);
        let hand = add(&limb(3), Some(lower), 0.25 * x);
        for finger in 0..5 {
            let mut above = hand;
            for number in 1..=names.count {
                let offset =
                    if number == 1 { 0.08 * x + Vec3::Z * (0.04 - 0.02 * finger as f32) } else { 0.03 * x };
                above = add(&(names.finger)(side, finger, number), Some(above), offset);
            }
        }
        let thigh = add(&limb(4), Some(hips), 0.1 * x);
        let shin = add(&limb(5), Some(thigh), Vec3::Y * -0.45);
        add(&limb(6), Some(shin), Vec3::Y * -0.45);
    }
    Skeleton { bones }
}

/// Returns a take in which named bones have rotations at whole seconds.
fn turning(skeleton: &Skeleton, turns: &[(&str, &[Quat])]) -> Take {
    let tracks = skeleton.bones.iter().enumerate().map(|(index, bone)| {
        let mut track = Track { bone: index as u32, ..Track::default() };
        if let Some((_, turns)) = turns.iter().find(|(name, _)| *name == bone.name) {
            let times: Vec<f32> = (0..turns.len()).map(|second| second as f32).collect();
            track.rotation = Channel::new(times, turns.to_vec(), Interpolation::Linear);
        }
        track
    });
    take(tracks.collect())
}

fn retargeted(take: &Take, source: &Skeleton, target: &Skeleton) -> Take {
    let binding = BindingGuess::of(source, target).binding;
    retarget_figure(take, source, target, &binding, &FigureOptions::default()).expect("a take").take
}

#[test]
fn fingers_are_bound_by_side_and_number_in_all_conventions() {
    for from in &RIGS {
        let source = rig(from);
        assert_eq!(SkeletonRoles::guess(&source).convention, Some(from.convention));
        for to in &RIGS {
            let target = rig(to);
            let guess = BindingGuess::of(&source, &target);
            for side in 0..2 {
                for finger in 0..5 {
                    for number in 1..=to.count {
                        let title = (to.finger)(to.sides[side], finger, number);
                        let bone = target.find(&title).expect("a bone") as usize;
                        let moved_by = guess.binding.source_of[bone]
                            .map(|from| source.bones[from as usize].name.as_str());
                        let wanted =
                            (number <= from.count).then(|| (from.finger)(from.sides[side], finger, number));
                        assert_eq!(moved_by, wanted.as_deref(), "{title} by {}", from.convention);
                    }
                }
            }
        }
    }
}

#[test]
fn a_curled_finger_curls_on_the_other_rig_in_the_same_joint() {
    for from in &RIGS {
        for to in &RIGS {
            let (source, target) = (rig(from), rig(to));
            let curl = Quat::from_rotation_z(-0.7);
            let name = (from.finger)(from.sides[0], 1, 2);
            let curling = turning(&source, &[(&name, &[Quat::IDENTITY, curl])]);
            let result = retargeted(&curling, &source, &target);
            let poses = matrices(&target, &result, 1.0);
            for (number, angle) in [(1, 0.0), (2, 0.7), (3, 0.7)] {
                let bone = target.find(&(to.finger)(to.sides[0], 1, number)).expect("a bone");
                let turned = poses[bone as usize].to_scale_rotation_translation().1;
                let apart = turned.angle_between(Quat::from_rotation_z(-angle));
                assert!(apart < 1e-3, "{} to {}, {number}: {apart}", from.convention, to.convention);
            }
        }
    }
}

/// Adds twist bones to a rig of Unreal: at the shoulder, and at 60 % of the forearm.
fn with_twists() -> Skeleton {
    let mut skeleton = rig(&RIGS[1]);
    for (above, name, x) in
        [("upperarm_l", "upperarm_twist_01_l", 0.0), ("lowerarm_l", "lowerarm_twist_01_l", 0.15)]
    {
        let parent = skeleton.find(above).expect("a bone");
        let mut twist = bone(name, Some(parent), Vec3::X * x);
        twist.rest.rotation = Quat::from_rotation_y(0.3);
        skeleton.bones.push(twist);
    }
    skeleton
}

/// Returns the angle about X by which a bone is turned from its rest pose, relative to its parent, in degrees.
fn roll(skeleton: &Skeleton, take: &Take, bone: &str, time: f32) -> f32 {
    let index = skeleton.find(bone).expect("a bone") as usize;
    let rest = skeleton.bones[index].rest.rotation;
    let channel = &take.tracks[index].rotation;
    let turned = dragonfly_anim::sample::sample_channel(channel, rest, time) * rest.inverse();
    let angle = (2.0 * turned.x.atan2(turned.w)).to_degrees();
    assert!(turned.y.abs() < 1e-5 && turned.z.abs() < 1e-5, "{bone}: {turned}");
    angle
}

#[test]
fn twist_bones_get_their_share_of_the_roll_of_both_parts_of_the_arm() {
    let (source, target) = (rig(&RIGS[0]), with_twists());
    let turns = |degrees: &[f32]| -> Vec<Quat> {
        degrees.iter().map(|angle| Quat::from_rotation_x(angle.to_radians())).collect()
    };
    // The hand also bends, which is no roll.
    let bend = Quat::from_rotation_y(0.4);
    let hand: Vec<Quat> = turns(&[0.0, 50.0, 80.0]).into_iter().map(|roll| bend * roll).collect();
    let arm = turns(&[0.0, 30.0, 60.0]);
    let rolling = turning(&source, &[("mixamorig:LeftHand", &hand), ("mixamorig:LeftArm", &arm)]);
    let result = retargeted(&rolling, &source, &target);
    for (time, arm, hand) in [(0.0, 0.0, 0.0), (1.0, 30.0, 50.0), (2.0, 60.0, 80.0)] {
        let [upper, lower] =
            ["upperarm_twist_01_l", "lowerarm_twist_01_l"].map(|twist| roll(&target, &result, twist, time));
        // The skin at the shoulder rests; at 60 % of the forearm it turns by 60 % of the hand's roll.
        assert!((upper + arm).abs() < 0.1, "{time}: {upper}");
        assert!((lower - 0.6 * hand).abs() < 0.1, "{time}: {lower}");
    }
    // The right side has no twist bones, and the arms themselves move as without them.
    let plain = retargeted(&rolling, &source, &rig(&RIGS[1]));
    for ((with, without), bone) in result.tracks.iter().zip(&plain.tracks).zip(&rig(&RIGS[1]).bones) {
        if !["arm", "hand"].iter().any(|part| bone.name.contains(part)) {
            continue;
        }
        for time in [0.0, 0.3, 1.0, 1.7, 2.0] {
            let [with, without] = [with, without].map(|track| sample_track(track, bone, time));
            assert!(with.rotation.dot(without.rotation).abs() > 1.0 - 1e-6, "{} at {time}", bone.name);
        }
    }
}

#[test]
fn a_roll_by_more_than_half_a_turn_is_shared_without_a_jump() {
    let (source, target) = (rig(&RIGS[0]), with_twists());
    let hand: Vec<Quat> =
        [0.0_f32, 100.0, 200.0, 300.0].map(|angle| Quat::from_rotation_x(angle.to_radians())).to_vec();
    let rolling = turning(&source, &[("mixamorig:LeftHand", &hand)]);
    let result = retargeted(&rolling, &source, &target);
    for (time, wanted) in [(1.0, 60.0), (2.0, 120.0), (3.0, 180.0)] {
        let lower = roll(&target, &result, "lowerarm_twist_01_l", time);
        let apart = (lower - wanted).rem_euclid(360.0);
        assert!(!(0.1..359.9).contains(&apart), "{time}: {lower}");
    }
}

#[test]
fn twist_bones_that_the_source_moves_keep_their_motion() {
    let (source, target) = (with_twists(), with_twists());
    let turn = [Quat::from_rotation_y(0.3), Quat::from_rotation_x(0.2) * Quat::from_rotation_y(0.3)];
    let rolling =
        turning(&source, &[("lowerarm_twist_01_l", &turn), ("hand_l", &[Quat::from_rotation_x(1.0)])]);
    let mut other = target.clone();
    // Another size, so that the take is not only copied.
    other.bones.iter_mut().for_each(|bone| bone.rest.translation *= 2.0);
    let result = retargeted(&rolling, &source, &other);
    let lower = roll(&other, &result, "lowerarm_twist_01_l", 1.0);
    assert!((lower - 0.2_f32.to_degrees()).abs() < 0.1, "{lower}");
}
