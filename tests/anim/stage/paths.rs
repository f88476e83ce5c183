//! Paths in an editor: how much they bend, where feet land on them, and their points, which can be moved.

use super::actors::{bone, fox, planned, seconds};
use super::{listed, scene};
use dragonfly_anim::stage::gesture::{move_path_point, written_points};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::{StageAssets, StagePath};
use glam::DVec3;
use std::sync::Arc;

#[test]
fn the_radius_of_a_circle_is_its_radius_and_a_line_has_none() {
    let circle: Vec<DVec3> = (0..=24)
        .map(|step| {
            let (sin, cos) = (f64::from(step) / 24.0 * std::f64::consts::TAU).sin_cos();
            DVec3::new(2.0 * cos, 0.5, 2.0 * sin)
        })
        .collect();
    let path = StagePath::new(&circle, true);
    for (distance, span) in [(3.0, 0.2), (6.0, 0.5), (9.0, 1.0)] {
        let radius = path.radius(distance, span);
        assert!((radius - 2.0).abs() < 0.05, "{radius} after {distance} m");
    }
    assert_eq!(path.radius(0.1, 0.2), f64::INFINITY, "there is nothing before the start");
    let straight = StagePath::new(&[DVec3::ZERO, DVec3::X, DVec3::X * 4.0], false);
    assert_eq!(straight.radius(1.0, 0.5), f64::INFINITY);
}

#[test]
fn a_corner_is_a_bend_in_proportion_to_what_is_measured() {
    let corner = StagePath::new(&[DVec3::ZERO, DVec3::X * 2.0, DVec3::new(2.0, 0.0, 2.0)], false);
    // The circle through (1.5, 0), (2, 0) and (2, 0.5) has its middle between the outer two.
    assert!((corner.radius(2.0, 0.5) - 0.5 * 0.5_f64.sqrt()).abs() < 1e-9, "{}", corner.radius(2.0, 0.5));
    assert_eq!(corner.radius(1.0, 0.5), f64::INFINITY);
    let back = StagePath::new(&[DVec3::ZERO, DVec3::X * 2.0, DVec3::X], false);
    assert_eq!(back.radius(2.0, 0.5), 0.0);
}

#[test]
fn footprints_are_where_the_feet_stand() {
    let model = fox();
    let mut assets = StageAssets::default();
    assets.add_model("a.glb", Arc::clone(&model));
    let text = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/>\
         <path id=\"bend\" points=\"0 0 0  1 0 0  2 0 1\" curve=\"smooth\"/></cast>\
         <seq><wait dur=\"0.5\"/><move who=\"anna\" path=\"bend\" take=\"Walk\"/></seq></script>";
    let plan = planned(text, &assets);
    let action = plan.schedule().times().len() - 1;
    let walk = &model.takes()[model.take_called("Walk").unwrap()];
    let stride = walk.stride_speed().unwrap() * walk.length().seconds() * 0.01;
    assert!((plan.stride_on_path(0, action).unwrap() - stride).abs() < 1e-9);
    let prints = plan.footprints(0, action);
    let cycles = plan.things()[1].path.as_ref().unwrap().length() / stride;
    let contacts = walk.contacts().len() as f64;
    assert!(
        (prints.len() as f64 - contacts * cycles).abs() < contacts + 1.0,
        "{} in {cycles} cycles",
        prints.len()
    );
    assert!(prints.is_sorted_by_key(|print| print.time) && prints[0].time.seconds() >= 0.5);
    let mut compared = 0;
    for print in prints.iter().filter(|print| print.time.seconds() < plan.length().seconds() - 0.2) {
        let mut state = plan.new_scene();
        // A little after it has landed.
        plan.scene_at(seconds(print.time.seconds() + 0.02), &mut state);
        let foot = bone(&plan, &state, "anna", model.feet()[print.foot].bone).as_dvec3();
        let aside = (foot - print.position).with_y(0.0).length();
        assert!(aside < 0.005, "foot {} at {:?} is {aside} m from its print", print.foot, print.time);
        assert_eq!(print.position.y, 0.0);
        compared += 1;
    }
    assert!(compared > 2, "{compared}");
    assert_eq!((plan.footprints(0, 1), plan.stride_on_path(9, action)), (Vec::new(), None));
}

#[test]
fn a_point_of_a_path_is_moved_and_all_others_stay_as_they_are_written() {
    let text = scene("<wait dur=\"1\"/>")
        .replace("points=\"0 0 0  3 0 4\"", "points=' 0 0 0.50\n\t3. 0  4\n +5 0 6 '");
    let script = StageScript::read(text.as_str()).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let points = [DVec3::new(0.0, 0.0, 0.5), DVec3::new(3.0, 0.0, 4.0), DVec3::new(5.0, 0.0, 6.0)];
    assert_eq!(written_points(&script, "aisle").unwrap(), points);
    let moved = |index, place| move_path_point(&script, "aisle", index, place);
    let expected = text.replace("3. 0  4", "-1.5 0.25 2.1235");
    assert_eq!(moved(1, DVec3::new(-1.5, 0.25, 2.123_456)).unwrap(), expected);
    assert_eq!(moved(2, DVec3::ONE).unwrap(), text.replace("+5 0 6", "1 1 1"));
    for (index, place) in [(3, DVec3::ONE), (usize::MAX, DVec3::ONE), (0, DVec3::NAN), (0, DVec3::X * 1e7)] {
        assert!(moved(index, place).is_err(), "{index} {place}");
    }
    assert!(move_path_point(&script, "anna", 0, DVec3::ONE).is_err(), "a role is no path");
    assert_eq!(written_points(&script, "door"), None);
}
