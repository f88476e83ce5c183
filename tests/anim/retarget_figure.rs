//! Takes of one figure on another: bindings by parts of the body, chains of different length, contacts.

use crate::doors::data;
use crate::motion::load;
use crate::retarget::{matrices, places};
use crate::support::{bone, take};
use dragonfly_anim::contact::contact_slide;
use dragonfly_anim::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::motion::Axis;
use dragonfly_anim::retarget::{
    BindingGuess, BodyPart, BoneRole, FigureError, FigureOptions, SkeletonBinding, SkeletonRoles,
    retarget_figure,
};
use glam::{Quat, Vec3};

/// Times, positions and rotations of a joint.
type JointMotion = (Vec<f32>, Vec<Vec3>, Vec<Quat>);

/// Reads the skeleton and the motion of a BVH file, every `step`-th frame.
fn bvh(text: &str, step: usize) -> (Skeleton, Take) {
    let mut words = text.split_whitespace();
    let (mut bones, mut channels) = (Vec::new(), Vec::new());
    let mut open: Vec<Option<u32>> = Vec::new();
    let mut name: Option<String> = None;
    while let Some(word) = words.next() {
        match word {
            "ROOT" | "JOINT" => name = words.next().map(str::to_owned),
            "End" => name = None,
            "{" => {
                let parent = open.iter().rev().flatten().next().copied();
                open.push(name.as_ref().map(|_| bones.len() as u32));
                if let Some(name) = name.take() {
                    bones.push(bone(&name, parent, Vec3::ZERO));
                    channels.push(Vec::new());
                }
            }
            "}" => {
                open.pop();
            }
            "OFFSET" => {
                let numbers: Vec<f32> = (0..3).map(|_| words.next().unwrap().parse().unwrap()).collect();
                if let Some(Some(bone)) = open.last() {
                    bones[*bone as usize].rest.translation = Vec3::from_slice(&numbers);
                }
            }
            "CHANNELS" => {
                let count: usize = words.next().unwrap().parse().unwrap();
                channels[bones.len() - 1] =
                    (0..count).map(|_| words.next().unwrap().to_owned()).collect::<Vec<_>>();
            }
            "Frames:" => break,
            _ => {}
        }
    }
    let frames: usize = words.next().unwrap().parse().unwrap();
    assert_eq!([words.next(), words.next()], [Some("Frame"), Some("Time:")]);
    let seconds: f32 = words.next().unwrap().parse().unwrap();
    let mut tracks: Vec<JointMotion> = vec![Default::default(); bones.len()];
    for frame in 0..frames {
        for (bone, names) in channels.iter().enumerate() {
            let (mut moved, mut turned) = (Vec3::ZERO, Quat::IDENTITY);
            for name in names {
                let number: f32 = words.next().unwrap().parse().unwrap();
                let axis = Vec3::AXES[(name.as_bytes()[0].to_ascii_lowercase() - b'x') as usize];
                if name.ends_with("position") {
                    moved += axis * number;
                } else {
                    turned *= Quat::from_axis_angle(axis, number.to_radians());
                }
            }
            if frame % step == 0 {
                let track = &mut tracks[bone];
                track.0.push((frame / step) as f32 * (seconds * step as f32));
                track.1.push(moved);
                track.2.push(turned);
            }
        }
    }
    let track = |(bone, (times, moved, turned)): (usize, JointMotion)| Track {
        bone: bone as u32,
        translation: match channels[bone].len() {
            6 => Channel::new(times.clone(), moved, Interpolation::Linear),
            _ => Channel::default(),
        },
        rotation: Channel::new(times, turned, Interpolation::Linear),
        ..Track::default()
    };
    let tracks = tracks.into_iter().enumerate().map(track).collect();
    (Skeleton { bones }, take(tracks))
}

/// Returns motion capture: CMU subject 1, trial 1, at 30 frames per second.
pub(crate) fn captured() -> Option<(Skeleton, Take)> {
    let text = std::fs::read_to_string(dragonfly_kit::skip::models()?.join("bvh/cmu_01_01.bvh")).unwrap();
    let (mut skeleton, take) = bvh(&text, 4);
    // The rest pose is moved up, so that the feet are near the ground.
    skeleton.bones[0].rest.translation = Vec3::new(0.0, 17.0, 0.0);
    Some((skeleton, take))
}

fn name(skeleton: &Skeleton, bone: BoneIndex) -> &str {
    &skeleton.bones[bone as usize].name
}

#[test]
fn figures_of_different_programs_are_bound_by_the_parts_of_the_body() {
    let quaternius = load(&data().join("collection/quaternius_Character4skins.glb")).animation.skeleton;
    let pab = load(&data().join("bench/pab.glb")).animation.skeleton;
    let robot = load(&data().join("collection/RobotExpressive.glb")).animation.skeleton;
    for (skeleton, convention) in [(&quaternius, "Quaternius"), (&pab, "Mixamo"), (&robot, "Quaternius")] {
        assert_eq!(SkeletonRoles::guess(skeleton).convention, Some(convention));
    }
    let guess = BindingGuess::of(&pab, &quaternius);
    let source = |target: &str| {
        let bone = quaternius.find(target).unwrap();
        guess.binding.source_of[bone as usize].map(|from| name(&pab, from).to_owned())
    };
    for (target, from) in [
        // It carries the legs as well as the bone called hips.
        ("Body", "Hips"),
        ("UpperArm.L", "LeftArm"),
        ("LowerArm.R", "RightForeArm"),
        ("Hand.L", "Lefthand"),
        ("UpperLeg.R", "RightUpLeg"),
        ("LowerLeg.L", "LeftLeg"),
        ("Foot.L", "LeftFoot"),
        ("Head", "Head"),
        ("Abdomen", "Spine"),
        ("Chest", "Spine3"),
    ] {
        assert_eq!(source(target).as_deref(), Some(from), "{target}");
    }
    assert_eq!((source("Weapon"), source("Hips")), (None, None));
}

#[test]
fn names_of_all_conventions_are_recognized() {
    let conventions: [(&str, [&str; 8]); 6] = [
        (
            "Mixamo",
            [
                "mixamorig:Hips",
                "mixamorig:Spine1",
                "mixamorig:LeftUpLeg",
                "mixamorig:LeftLeg",
                "mixamorig:LeftFoot",
                "mixamorig:LeftArm",
                "mixamorig:LeftForeArm",
                "mixamorig:LeftHandIndex1",
            ],
        ),
        (
            "Unreal mannequin",
            ["pelvis", "spine_01", "thigh_l", "calf_l", "foot_l", "upperarm_l", "lowerarm_l", "index_01_l"],
        ),
        (
            "VRM humanoid",
            [
                "J_Bip_C_Hips",
                "J_Bip_C_Spine",
                "J_Bip_L_UpperLeg",
                "J_Bip_L_LowerLeg",
                "J_Bip_L_Foot",
                "J_Bip_L_UpperArm",
                "J_Bip_L_LowerArm",
                "J_Bip_L_Index1",
            ],
        ),
        (
            "Rigify",
            [
                "DEF-spine",
                "DEF-spine.001",
                "DEF-thigh.L",
                "DEF-shin.L",
                "DEF-foot.L",
                "DEF-upper_arm.L",
                "DEF-forearm.L",
                "DEF-f_index.01.L",
            ],
        ),
        (
            "CMU",
            ["Hips", "LowerBack", "LeftUpLeg", "LeftLeg", "LeftFoot", "LeftArm", "LeftForeArm", "LThumb"],
        ),
        (
            "KayKit",
            ["hips", "chest", "upperleg.l", "lowerleg.l", "foot.l", "upperarm.l", "lowerarm.l", "wrist.l"],
        ),
    ];
    let parts = [
        BodyPart::Hips,
        BodyPart::Spine,
        BodyPart::UpperLeg,
        BodyPart::LowerLeg,
        BodyPart::Foot,
        BodyPart::UpperArm,
        BodyPart::LowerArm,
    ];
    for (convention, names) in conventions {
        let bones = names
            .iter()
            .enumerate()
            .map(|(at, name)| bone(name, at.checked_sub(1).map(|at| at as u32), Vec3::Y));
        let roles = SkeletonRoles::guess(&Skeleton { bones: bones.collect() });
        assert_eq!(roles.convention, Some(convention));
        for (bone, part) in parts.into_iter().enumerate() {
            assert_eq!(roles.of[bone].map(|role| role.part), Some(part), "{convention}: {}", names[bone]);
            let side = u8::from(![BodyPart::Hips, BodyPart::Spine].contains(&part));
            assert_eq!(roles.of[bone].map(|role| role.side), Some(side), "{convention}: {}", names[bone]);
        }
        assert!(roles.of[7].is_some(), "{convention}: {}", names[7]);
    }
}

#[test]
fn a_figure_on_its_own_skeleton_moves_as_before_within_a_tenth_of_a_degree() {
    for path in [
        "collection/quaternius_Character4skins.glb",
        "bench/pab.glb",
        "collection/RobotExpressive.glb",
        "gltf/Fox.glb",
    ] {
        let model = load(&data().join(path));
        let skeleton = &model.animation.skeleton;
        let binding = BindingGuess::of(skeleton, skeleton).binding;
        for take in &model.animation.takes {
            let result =
                retarget_figure(take, skeleton, skeleton, &binding, &FigureOptions::default()).unwrap();
            let mut worst = 0.0_f32;
            for step in 0..=50 {
                let time = take.start + take.length * step as f32 / 50.0;
                let (a, b) = (matrices(skeleton, take, time), matrices(skeleton, &result.take, time));
                for (a, b) in a.iter().zip(&b) {
                    let (a, b) = (a.to_scale_rotation_translation().1, b.to_scale_rotation_translation().1);
                    worst = worst.max(2.0 * (a - b).length().min((a + b).length()).to_degrees());
                }
            }
            println!("{path} {}: {worst}°", take.name);
            assert!(worst < 0.1, "{path} {}: {worst}°", take.name);
        }
    }
}

#[test]
fn a_captured_walk_on_rigs_of_other_proportions_slides_less_than_5_mm_in_contacts() {
    let Some((source, take)) = captured() else { return };
    let rigs =
        ["collection/quaternius_Character4skins.glb", "collection/RobotExpressive.glb", "bench/pab.glb"];
    let mut rigs = rigs.map(|path| data().join(path)).to_vec();
    rigs.extend(dragonfly_kit::skip::models().map(|models| models.join("gltf/kaykit_Rogue.glb")));
    for path in &rigs {
        let target = load(path).animation.skeleton;
        let guess = BindingGuess::of(&source, &target);
        let result =
            retarget_figure(&take, &source, &target, &guess.binding, &FigureOptions::default()).unwrap();
        let title = path.file_name().unwrap().to_string_lossy().into_owned();
        println!(
            "{title}: {} of {} bones bound, {} and {}, ratio {:.4}, {} contacts, largest drift {:.2} mm before and {:.3} mm after",
            guess.binding.bound(),
            target.len(),
            guess.source.convention.unwrap(),
            guess.target.convention.unwrap(),
            result.ratio,
            result.contacts.len(),
            result.slide_before,
            result.slide_after
        );
        assert!(result.contacts.len() >= 6, "{title}");
        assert!(result.slide_before > 5.0, "{title}: nothing to lock");
        assert!(result.slide_after < 5.0, "{title}: {}", result.slide_after);
        // The same, measured on the take of the target itself, with the figure's height taken for 1.7 m.
        let frames = TakeFrames::of(&result.take, &target, 30.0).unwrap();
        let rest = places(&target, &Take::default(), 0.0);
        let heights = rest.iter().map(|place| place.y);
        let unit = 1.7 / heights.clone().fold(0.0, f32::max);
        let drifts =
            result.contacts.iter().map(|contact| contact_slide(&frames, contact, Axis::Y, unit).drift);
        let worst = drifts.fold(0.0, f32::max);
        println!("  measured again: {worst:.3} mm");
        assert!(worst < 5.0, "{title}: {worst}");
        let free = FigureOptions { contacts: false, ..FigureOptions::default() };
        let free = retarget_figure(&take, &source, &target, &guess.binding, &free).unwrap();
        assert!(free.contacts.is_empty());
    }
}

/// A figure with legs, and a spine of `count` bones that is 0.6 long.
fn figure(count: usize) -> Skeleton {
    let mut bones = vec![bone("hips", None, Vec3::Y)];
    for (side, x) in [("l", 0.1), ("r", -0.1)] {
        let at = bones.len() as u32;
        bones.push(bone(&format!("thigh_{side}"), Some(0), Vec3::new(x, 0.0, 0.0)));
        bones.push(bone(&format!("calf_{side}"), Some(at), Vec3::new(0.0, -0.45, 0.01)));
        bones.push(bone(&format!("foot_{side}"), Some(at + 1), Vec3::new(0.0, -0.45, -0.01)));
    }
    bones[0].name = "pelvis".to_owned();
    let mut parent = 0;
    for index in 0..count {
        bones.push(bone(&format!("spine_0{}", index + 1), Some(parent), Vec3::Y * (0.6 / count as f32)));
        parent = bones.len() as u32 - 1;
    }
    bones.push(bone("head", Some(parent), Vec3::Y * 0.2));
    Skeleton { bones }
}

#[test]
fn the_bend_of_a_short_spine_is_distributed_over_a_long_one_and_the_chest_keeps_its_direction() {
    for (from, to) in [(2, 4), (4, 2), (1, 3), (3, 1), (2, 3)] {
        let (source, target) = (figure(from), figure(to));
        let tracks = (0..source.len() as u32).map(|bone| {
            let bends = source.bones[bone as usize].name.starts_with("spine");
            let values = [Quat::IDENTITY, Quat::from_rotation_x(1.2 / from as f32)];
            let rotation = if bends {
                Channel::new([0.0, 1.0], values, Interpolation::Linear)
            } else {
                Channel::default()
            };
            Track { bone, rotation, ..Track::default() }
        });
        let bending = take(tracks.collect());
        let guess = BindingGuess::of(&source, &target);
        let result =
            retarget_figure(&bending, &source, &target, &guess.binding, &FigureOptions::default()).unwrap();
        let direction = |skeleton: &Skeleton, take: &Take, bone: &str| {
            matrices(skeleton, take, 1.0)[skeleton.find(bone).unwrap() as usize]
                .to_scale_rotation_translation()
                .1
        };
        let head = direction(&target, &result.take, "head");
        assert!(head.angle_between(direction(&source, &bending, "head")) < 1e-3, "{from} to {to}: {head}");
        // Each bone of the spine bends in the same sense, none by all.
        let bends: Vec<f32> = (1..=to)
            .map(|index| {
                let bone = target.find(&format!("spine_0{index}")).unwrap() as usize;
                let track = &result.take.tracks[bone].rotation;
                track.values.last().map_or(0.0, |value| 2.0 * value.x.atan2(value.w))
            })
            .collect();
        println!("{from} to {to}: {bends:?}");
        assert!((bends.iter().sum::<f32>() - 1.2).abs() < 1e-3, "{from} to {to}: {bends:?}");
        let most = bends.iter().fold(0.0_f32, |most, bend| most.max(*bend));
        assert!(to == 1 || most < 1.0, "{from} to {to}: {bends:?}");
        assert!(bends.iter().all(|bend| *bend >= -1e-5), "{from} to {to}: {bends:?}");
    }
}

#[test]
fn nothing_bound_is_an_error_and_a_correction_of_the_map_is_followed() {
    let (source, target) = (figure(2), figure(2));
    let none = SkeletonBinding::from_map(&source, &target, &[]).unwrap();
    let bending = take(vec![Track::default()]);
    let error = retarget_figure(&bending, &source, &target, &none, &FigureOptions::default()).unwrap_err();
    assert_eq!(error, FigureError::Unbound);
    let left = SkeletonRoles::guess(&target).bones(BoneRole { part: BodyPart::UpperLeg, side: 1 });
    assert_eq!(left, [target.find("thigh_l").unwrap()]);
}

#[test]
fn the_motion_of_a_text_file_is_read_as_its_numbers() {
    let text = "HIERARCHY ROOT Hips { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation JOINT Leg { OFFSET 0 -1 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 -1 0 } } } MOTION Frames: 2 Frame Time: 0.5 0 1 0 0 0 0 0 0 0 0 1 2 0 90 0 0 0 90";
    let (skeleton, take) = bvh(text, 1);
    assert_eq!(skeleton.len(), 2);
    let places = places(&skeleton, &take, 0.5);
    assert!(places[0].abs_diff_eq(Vec3::new(0.0, 1.0, 2.0), 1e-6), "{places:?}");
    assert!(places[1].abs_diff_eq(Vec3::new(0.0, 0.0, 2.0), 1e-6), "{places:?}");
}

#[test]
fn a_capture_whose_rest_pose_hangs_below_the_ground_does_not_lift_the_target() {
    // As in files of captures: the hips rest at the origin, and the motion has their height, 0.9 above the feet.
    let (mut source, target) = (figure(2), figure(2));
    source.bones[0].rest.translation = Vec3::ZERO;
    let hips = Channel::new([0.0, 1.0], [0.9 * Vec3::Y, Vec3::new(0.0, 0.8, 2.0)], Interpolation::Linear);
    let walk = take(vec![Track { translation: hips, ..Track::default() }]);
    let guess = BindingGuess::of(&source, &target);
    let moved =
        retarget_figure(&walk, &source, &target, &guess.binding, &FigureOptions::default()).unwrap().take;
    for (time, wanted) in [(0.0, Vec3::Y), (1.0, Vec3::new(0.0, 0.9, 2.0))] {
        let at = places(&target, &moved, time)[0];
        assert!(at.abs_diff_eq(wanted, 1e-3), "{time}: {at}");
    }
    // A take that stays below the ground keeps its distance from the rest pose.
    let still = Channel::new([0.0, 1.0], [Vec3::ZERO, Vec3::Z], Interpolation::Linear);
    let still = take(vec![Track { translation: still, ..Track::default() }]);
    let moved =
        retarget_figure(&still, &source, &target, &guess.binding, &FigureOptions::default()).unwrap().take;
    assert!(places(&target, &moved, 1.0)[0].abs_diff_eq(Vec3::new(0.0, 1.0, 1.0), 1e-3));
}
