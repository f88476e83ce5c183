//! The unit of length of a model: as the file says where that is plausible, and otherwise as the size of the figure says.

use crate::doors::data;
use crate::motion::load;
use crate::support::bone;
use dragonfly_anim::contact::{ContactThresholds, detect_contacts, feet_by_name};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::frames::{TakeFrames, frame_rate};
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

#[test]
fn the_feet_of_the_fox_touch_the_ground_in_its_unit_and_its_defects_are_those_of_an_animal() {
    let model = load(&data().join("gltf/Fox.glb"));
    let skeleton = &model.animation.skeleton;
    let take = &model.animation.takes[0];
    let frames = TakeFrames::of(take, skeleton, frame_rate(take)).expect("frames");
    let feet = feet_by_name(skeleton);
    let covered = |meters_per_unit: f32| {
        let thresholds = ContactThresholds { meters_per_unit, ..ContactThresholds::default() };
        let found = detect_contacts(&frames, &feet, &thresholds);
        found.iter().map(|contact| contact.to - contact.from).sum::<f32>() / feet.len() as f32
    };
    let unit = ModelUnit::of(skeleton).meters;
    assert!(covered(unit) > 0.8 * take.length && covered(1.0) < 0.5 * take.length, "{}", covered(1.0));
    let defects = |meters: f32| {
        let mut limits = LintThresholds::default();
        limits.contacts.meters_per_unit = meters;
        lint_take(take, skeleton, 24.0, &limits).expect("a table").len()
    };
    assert!(defects(unit) < defects(1.0), "{} {}", defects(unit), defects(1.0));
}
