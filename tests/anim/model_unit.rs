//! The unit of length of a model: that of the file where it is plausible, and otherwise one guessed from the size of the figure.

use crate::contacts::{leg, step};
use crate::doors::data;
use crate::motion::load;
use crate::support::bone;
use dragonfly_anim::contact::{ContactThresholds, detect_contacts, feet_by_name};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::lint::{LintThresholds, lint_take};
use dragonfly_anim::model_unit::ModelUnit;
use glam::{Quat, Vec3};

#[test]
fn a_plausible_size_is_in_meters_and_any_other_in_the_first_unit_that_makes_it_plausible() {
    for (size, meters) in [
        (0.03, 1.0),
        (1.7 * 1.45, 1.0),
        (20.0, 1.0),
        (20.5, 0.01),
        (250.0, 0.01),
        (2_500.0, 0.001),
        (0.025, 100.0),
        (0.0, 1.0),
        (1e30, 1.0),
        (f32::INFINITY, 1.0),
        (f32::NAN, 1.0),
    ] {
        assert_eq!(ModelUnit::of_size(size).meters, meters, "{size}");
    }
    assert_eq!(ModelUnit::default(), ModelUnit::of(&Skeleton::default()));
}

#[test]
fn the_size_is_the_longest_way_along_the_bones_with_their_scale_however_the_figure_stands() {
    let figure = |turn: Quat, scale: f32| {
        let mut bones = vec![
            bone("Root", None, Vec3::new(0.0, 0.0, 900.0)),
            bone("Leg", Some(0), Vec3::NEG_Y * 3.0),
            bone("Spine", Some(0), Vec3::Y * 2.0),
            bone("Arm", Some(2), Vec3::X * 1.5),
            bone("Tail", Some(0), Vec3::Z),
        ];
        bones[2].rest.rotation = turn;
        bones[0].rest.scale = Vec3::splat(scale);
        ModelUnit::of(&Skeleton { bones }).size
    };
    // From the leg over the root and the spine to the arm; where the root is in the scene does not matter.
    assert!((figure(Quat::IDENTITY, 1.0) - 6.5).abs() < 1e-4);
    assert!((figure(Quat::from_rotation_z(1.3), 1.0) - 6.5).abs() < 1e-4);
    assert!((figure(Quat::IDENTITY, 0.01) - 0.065).abs() < 1e-4);
}

#[test]
fn models_of_games_and_captures_are_in_meters_and_the_fox_is_in_centimeters() {
    for file in [
        "collection/quaternius_Character4skins.glb",
        "collection/RobotExpressive.glb",
        "collection/greenman.glb",
        "collection/godot_enemy.glb",
        "bench/pab.glb",
    ] {
        let unit = ModelUnit::of(&load(&data().join(file)).animation.skeleton);
        assert!(unit.is_of_file() && unit.remark().is_none(), "{file}: {unit:?}");
    }
    if let Some(models) = dragonfly_kit::skip::models() {
        // In inches divided by 0.45, which the importer knows.
        let unit = ModelUnit::of(&load(&models.join("bvh/cmu_01_01.bvh")).animation.skeleton);
        assert!(unit.is_of_file() && (1.5..4.0).contains(&unit.size), "{unit:?}");
    }
    let unit = ModelUnit::of(&load(&data().join("gltf/Fox.glb")).animation.skeleton);
    assert!(unit.meters == 0.01 && (100.0..200.0).contains(&unit.size), "{unit:?}");
    let remark = unit.remark().expect("a remark");
    assert!(remark.contains("1 unit = 0.01 m") && remark.contains("it were 1."), "{remark}");
}

/// A leg and its steps in centimeters.
fn in_centimeters() -> (Skeleton, Take) {
    let (mut skeleton, mut take) = (leg(), step());
    skeleton.bones.iter_mut().for_each(|bone| bone.rest.translation *= 100.0);
    for track in &mut take.tracks {
        track.translation.values = track.translation.values.iter().map(|value| *value * 100.0).collect();
    }
    (skeleton, take)
}

#[test]
fn contacts_and_defects_in_centimeters_are_those_in_meters() {
    let (skeleton, take) = in_centimeters();
    let (meters, in_meters) = (leg(), step());
    let unit = ModelUnit::of(&skeleton).meters;
    assert_eq!((unit, ModelUnit::of(&meters).meters), (0.01, 1.0));
    let contacts = |skeleton: &Skeleton, take: &Take, meters_per_unit: f32| {
        let frames = TakeFrames::of(take, skeleton, 30.0).expect("frames");
        let thresholds = ContactThresholds { meters_per_unit, ..ContactThresholds::default() };
        detect_contacts(&frames, &feet_by_name(skeleton), &thresholds)
    };
    let wanted = contacts(&meters, &in_meters, 1.0);
    assert_eq!(wanted.len(), 2);
    assert_eq!(contacts(&skeleton, &take, unit), wanted);
    assert_eq!(contacts(&skeleton, &take, 1.0), [], "2 mm in a frame would be 20 cm");
    let defects = |skeleton: &Skeleton, take: &Take, meters: f32| {
        let mut limits = LintThresholds::default();
        limits.contacts.meters_per_unit = meters;
        let found = lint_take(take, skeleton, 30.0, &limits).expect("a table");
        found.iter().map(|finding| (finding.rule, finding.frame)).collect::<Vec<_>>()
    };
    let wanted = defects(&meters, &in_meters, 1.0);
    assert_eq!(defects(&skeleton, &take, unit), wanted);
    assert_ne!(defects(&skeleton, &take, 1.0), wanted);
}
