//! Takes that travel: their movements add up over repetitions, parts and actions.

use super::actors::{assets, at, planned, seconds, thing};
use super::read;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform,
};
use dragonfly_anim::stage::gesture::{GestureScene, face_thing, place_splices, place_thing, spliced_text};
use dragonfly_anim::stage::{StageModel, StagePath, StagePlan};
use glam::{DVec3, Quat, Vec3};
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

/// Returns a model of hips 1 m above the ground: `Step` goes 0.5 m along z in 1 s, slow and then fast, and 0.1 m up; `Quarter` turns by 90
/// degrees to the left in 1 s and goes 1 m along z.
pub(super) fn stepper() -> Arc<StageModel> {
    let rest = Transform { translation: Vec3::Y, ..Transform::IDENTITY };
    let hips = Bone { rest, ..Bone::root("hips") };
    let places = [Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 1.1, 0.125), Vec3::new(0.0, 1.0, 0.5)];
    let step = Channel::new([0.0, 0.5, 1.0], places, Interpolation::Linear);
    let quarter = Channel::new([0.0, 1.0], [Vec3::Y, Vec3::new(0.0, 1.0, 1.0)], Interpolation::Linear);
    let turn =
        Channel::new([0.0, 1.0], [Quat::IDENTITY, Quat::from_rotation_y(FRAC_PI_2)], Interpolation::Linear);
    let take = |name: &str, track: Track| {
        Arc::new(Take { name: name.to_owned(), length: 1.0, tracks: vec![track], ..Take::default() })
    };
    let takes = vec![
        take("Step", Track { translation: step, ..Track::default() }),
        take("Quarter", Track { translation: quarter, rotation: turn, ..Track::default() }),
    ];
    let skeleton = Arc::new(Skeleton { bones: vec![hips] });
    Arc::new(StageModel::new(Arc::new(ModelData {
        animation: AnimationData { skeleton, takes },
        ..ModelData::default()
    })))
}

fn stepping(actions: &str) -> StagePlan {
    let text = format!(
        "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"2\" at=\"1 0 0\" facing=\"90\"/>\
         <path id=\"p\" points=\"0 0 0  0 0 4\"/></cast>{actions}</script>"
    );
    planned(&text, &assets(&stepper()))
}

/// Checks where anna is, and that her hips are above that place.
fn check(plan: &StagePlan, time: f64, expected: [f64; 3]) {
    let placement = plan.placement(0, seconds(time)).unwrap();
    assert!(
        placement.position.distance(expected.into()) < 1e-5,
        "{time}: {} instead of {expected:?}",
        placement.position
    );
    let scene = at(plan, time);
    let hips = scene.things[0].pose.as_ref().unwrap().pose.get(0).unwrap().translation;
    assert!(Vec3::new(hips.x, 0.0, hips.z).length() < 1e-5, "the hips are {hips}, in place");
    assert!(
        (thing(plan, &scene, "anna").transform.translation.as_dvec3() - placement.position).length() < 1e-5
    );
}

#[test]
fn repetitions_add_up_and_the_role_stays_where_they_left_it() {
    let plan = stepping("<play who=\"anna\" take=\"Step\" repeat=\"2.5\"/>");
    check(&plan, 0.5, [1.25, 0.0, 0.0]);
    check(&plan, 1.0, [2.0, 0.0, 0.0]);
    check(&plan, 2.25, [3.125, 0.0, 0.0]);
    check(&plan, 2.5, [3.25, 0.0, 0.0]);
    check(&plan, 99.0, [3.25, 0.0, 0.0]);
}

#[test]
fn parts_speeds_and_backward_play_move_by_their_part() {
    let plan = stepping(
        "<seq><play who=\"anna\" take=\"Step\" from=\"0.5\" repeat=\"2\" speed=\"2\"/><play who=\"anna\" take=\"Step\" speed=\"-1\"/></seq>",
    );
    check(&plan, 0.25, [1.75, 0.0, 0.0]);
    check(&plan, 0.5, [2.5, 0.0, 0.0]);
    check(&plan, 1.0, [1.75, 0.0, 0.0]);
    check(&plan, 1.5, [1.5, 0.0, 0.0]);
}

#[test]
fn the_next_action_starts_where_one_is_cut() {
    let plan = stepping(
        "<wait id=\"w\" dur=\"1.5\"/><seq><play who=\"anna\" take=\"Step\" repeat=\"fill\"/>\
         <play who=\"anna\" take=\"Step\" begin=\"w.end\"/></seq>",
    );
    check(&plan, 1.5, [2.25, 0.0, 0.0]);
    check(&plan, 2.5, [3.25, 0.0, 0.0]);
}

#[test]
fn turns_of_takes_turn_what_follows() {
    let plan = stepping("<play who=\"anna\" take=\"Quarter\" repeat=\"4\"/>");
    let facing = |time: f64| plan.placement(0, seconds(time)).unwrap().facing.to_degrees();
    assert!((facing(1.0) - 180.0).abs() < 1e-3 && (facing(2.0) - 270.0).abs() < 1e-3, "{}", facing(1.0));
    // Along +x, then -z, -x, +z: back at the start.
    check(&plan, 1.0, [3.0, 0.0, 0.0]);
    check(&plan, 2.0, [3.0, 0.0, -2.0]);
    check(&plan, 4.0, [1.0, 0.0, 0.0]);
}

#[test]
fn on_a_path_the_take_is_played_by_distance_at_the_speed_of_its_steps() {
    // A step is 1 m at twice the size: 4 s for the path.
    let plan = stepping("<move who=\"anna\" path=\"p\" take=\"Step\"/>");
    assert!((plan.length().seconds() - 4.0).abs() < 1e-6, "{}", plan.length().seconds());
    check(&plan, 0.5, [0.0, 0.0, 0.25]);
    check(&plan, 3.5, [0.0, 0.0, 3.25]);
    check(&plan, 4.0, [0.0, 0.0, 4.0]);
    let height = |plan: &StagePlan, time: f64| {
        at(plan, time).things[0].pose.as_ref().unwrap().pose.get(0).unwrap().translation.y
    };
    assert!((height(&plan, 2.5) - 1.1).abs() < 1e-5 && (height(&plan, 3.0) - 1.0).abs() < 1e-5);
    // At twice the speed the same steps are at the same places.
    let plan = stepping("<move who=\"anna\" path=\"p\" take=\"Step\" speed=\"2\"/>");
    check(&plan, 0.25, [0.0, 0.0, 0.25]);
    assert!((height(&plan, 1.25) - 1.1).abs() < 1e-5);
}

#[test]
fn paths_are_measured_by_length() {
    let corner = [DVec3::ZERO, DVec3::X * 3.0, DVec3::new(3.0, 0.0, 4.0)];
    let path = StagePath::new(&corner, false);
    assert_eq!(path.length(), 7.0);
    assert_eq!((path.at(5.0).position, path.at(5.0).direction), (DVec3::new(3.0, 0.0, 2.0), DVec3::Z));
    assert_eq!((path.at(-1.0).position, path.at(9.0).position), (corner[0], corner[2]));
    // A smooth path passes through its points, and its length is that of many short lines.
    let smooth = StagePath::new(&corner, true);
    let steps = 20_000;
    let points: Vec<DVec3> = (0..=steps)
        .map(|step| smooth.at(smooth.length() * f64::from(step) / f64::from(steps)).position)
        .collect();
    let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    assert!((length - smooth.length()).abs() < 1e-3, "{length} {}", smooth.length());
    let longest = points.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f64::max);
    assert!(longest < 1.01 * smooth.length() / f64::from(steps), "even steps are of even length");
    assert!(points.iter().any(|point| point.distance(corner[1]) < 1e-3));
    // Directions are those of the steps.
    for step in (100..steps as usize - 100).step_by(97) {
        let direction = (points[step + 1] - points[step - 1]).normalize();
        let at = smooth.at(smooth.length() * step as f64 / f64::from(steps)).direction;
        assert!(direction.dot(at) > 0.9999, "{step}");
    }
    assert_eq!(StagePath::new(&[], true).at(1.0).direction, DVec3::ZERO);
    assert_eq!(StagePath::new(&[DVec3::X, DVec3::X], false).length(), 0.0);
}

#[test]
fn a_thing_that_walked_since_it_was_placed_is_dragged_to_where_the_pointer_is() {
    for actions in [
        "<place who=\"anna\" at=\"1 0 1\" begin=\"0.5\"/>\n<play who=\"anna\" take=\"Step\" repeat=\"3\" begin=\"0.5\"/>",
        "<place who=\"anna\" at=\"door\" begin=\"0.5\"/>\n<play who=\"anna\" take=\"Step\" repeat=\"3\" begin=\"1\"/>",
        "<play who=\"anna\" take=\"Step\" repeat=\"3\"/>",
    ] {
        let text = format!(
            "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"2\" at=\"1 0 0\" facing=\"90\"/>\
             <mark id=\"door\" at=\"5 0 3\"/></cast>\n{actions}</script>"
        );
        let (script, plan) = (read(&text), planned(&text, &assets(&stepper())));
        let (time, wanted) = (seconds(2.75), DVec3::new(-3.0, 0.0, 2.5));
        let scene = GestureScene { script: &script, plan: &plan };
        let new = place_thing(&scene, "anna", time, wanted).expect("a text");
        let found = planned(&new, &assets(&stepper())).placement(0, time).expect("a place").position;
        assert!(found.distance(wanted) < 1.5e-3, "{found} instead of {wanted}: {new}");
    }
}

#[test]
fn a_thing_at_a_mark_is_put_elsewhere_and_turned_at_once_and_is_turned_where_it_is() {
    let text = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\"/><mark id=\"door\" at=\"5 0 3\" facing=\"90\"/>\
                </cast><place who=\"anna\" at=\"door\" begin=\"0.5\"/></script>";
    let (script, plan) = (read(text), planned(text, &assets(&stepper())));
    let (scene, time) = (GestureScene { script: &script, plan: &plan }, seconds(1.0));
    let place = |new: &str| planned(new, &assets(&stepper())).placement(0, time).expect("a place");
    let wanted = DVec3::new(1.0, 0.0, 2.0);
    let splices = place_splices(&scene, "anna", time, wanted, Some(30.0)).expect("replacements");
    let put = place(&spliced_text(&script, splices).expect("a text"));
    assert!(put.position.distance(wanted) < 1e-9 && (put.facing.to_degrees() - 30.0).abs() < 1e-9, "{put:?}");
    let turned = place(&face_thing(&scene, "anna", time, 0.0).expect("a text"));
    assert!(turned.position.distance(DVec3::new(5.0, 0.0, 3.0)) < 1e-9 && turned.facing == 0.0, "{turned:?}");
}
