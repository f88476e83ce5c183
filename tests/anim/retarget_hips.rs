//! Figures whose hips do not carry their legs stay in one piece: the bone that carries both is moved as hips.

use crate::doors::data;
use crate::motion::load;
use crate::retarget::places;
use crate::retarget_figure::captured;
use crate::support::bone;
use dragonfly_anim::contact::contact_slide;
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::motion::Axis;
use dragonfly_anim::retarget::{
    BindingGuess, BodyPart, BoneRole, FigureOptions, SkeletonRoles, retarget_figure,
};
use glam::Vec3;

const HIPS: BoneRole = BoneRole { part: BodyPart::Hips, side: 0 };

#[test]
fn a_captured_walk_does_not_tear_legs_from_the_trunk() {
    let Some((source, take)) = captured() else { return };
    let target = load(&data().join("collection/quaternius_Character4skins.glb")).animation.skeleton;
    let guess = BindingGuess::of(&source, &target);
    let result =
        retarget_figure(&take, &source, &target, &guess.binding, &FigureOptions::default()).expect("a take");
    let find = |name: &str| target.find(name).expect("a bone") as usize;
    let pairs = ["UpperLeg.L", "UpperLeg.R"].map(|leg| (find(leg), find("Abdomen")));
    let rest = places(&target, &Take::default(), 0.0);
    let (mut worst, mut moved) = (0.0_f32, 0.0_f32);
    for step in 0..=100 {
        let time = result.take.start + result.take.length * step as f32 / 100.0;
        let now = places(&target, &result.take, time);
        for (leg, spine) in pairs {
            let length = rest[leg].distance(rest[spine]);
            worst = worst.max((now[leg].distance(now[spine]) / length - 1.0).abs());
        }
        moved = moved.max(now[find("Body")].distance(rest[find("Body")]));
    }
    println!(
        "legs to spine: off by {:.3} % of the distance at rest; the body moves {moved:.2}",
        100.0 * worst
    );
    assert!(worst < 0.03, "{worst}");
    assert!(moved > 0.5, "the body walks: {moved}");
    let frames = TakeFrames::of(&result.take, &target, 30.0).expect("frames");
    let slides = result.contacts.iter().map(|contact| contact_slide(&frames, contact, Axis::Y, 1.0).drift);
    let slide = slides.fold(0.0, f32::max);
    println!("{} contacts slide at most {slide:.3} mm", result.contacts.len());
    assert!(result.contacts.len() >= 6 && slide < 5.0, "{slide}");
}

/// A body with legs and a spine. The hips are `place` away from the body, and `legs` hang at this bone.
fn figure(place: Vec3, legs: u32) -> Skeleton {
    let mut bones = vec![
        bone("Root", None, Vec3::ZERO),
        bone("Body", Some(0), Vec3::Y),
        bone("Hips", Some(1), place),
        bone("Abdomen", Some(2), Vec3::Y * 0.1),
        bone("Chest", Some(3), Vec3::Y * 0.3),
        bone("Head", Some(4), Vec3::Y * 0.3),
    ];
    for (side, x) in [("L", 0.1), ("R", -0.1)] {
        let upper = bones.len() as u32;
        bones.push(bone(&format!("UpperLeg.{side}"), Some(legs), Vec3::X * x));
        bones.push(bone(&format!("LowerLeg.{side}"), Some(upper), Vec3::NEG_Y * 0.45));
        bones.push(bone(&format!("Foot.{side}"), Some(upper + 1), Vec3::NEG_Y * 0.45));
        bones.push(bone(&format!("UpperArm.{side}"), Some(4), Vec3::X * x));
        bones.push(bone(&format!("LowerArm.{side}"), Some(upper + 3), Vec3::X * x));
    }
    Skeleton { bones }
}

#[test]
fn the_hips_are_the_closest_bone_above_legs_and_spine_that_is_where_hips_are() {
    let hips = |skeleton: &Skeleton| {
        let roles = SkeletonRoles::guess(skeleton);
        assert!(roles.convention.is_some());
        roles.bones(HIPS)
    };
    assert_eq!(hips(&figure(Vec3::Y * 0.05, 2)), [2], "the legs are children of the hips");
    assert_eq!(hips(&figure(Vec3::Y * 0.05, 1)), [1], "legs and hips are children of the body");
    // A bone on the ground between the feet is no hips, even where it carries everything.
    assert_eq!(hips(&figure(Vec3::Y * 0.05, 0)), [2]);
    assert_eq!(hips(&figure(Vec3::Y * 0.6, 1)), [2], "the body is too far away");
    let legless = Skeleton { bones: figure(Vec3::ZERO, 1).bones[..6].to_vec() };
    assert!(SkeletonRoles::guess(&legless).bones(HIPS).is_empty(), "too few parts for a figure");
}
