//! Things put elsewhere by gestures: held in another way, keyed at a time, tilted, paths as a whole.

use super::actors::{assets, at, bits, fox, fox_script, planned, seconds, thing};
use super::gestures::{changed, gesture};
use super::read;
use dragonfly_anim::stage::gesture::{
    GestureScene, HeldGrip, attach_splices, detach_splices, facing_and_tilt, grip_splices, key_place_splices,
    path_points_splices, spliced_text, turn_about_axes,
};
use dragonfly_anim::stage::{RigidPlace, ThingHold};
use dragonfly_kit::random::{Random, seed};
use glam::{DQuat, DVec3, EulerRot, Vec3};
use std::f64::consts::FRAC_PI_2;

const HELD: &str = "<play id=\"a\" who=\"anna\" take=\"Survey\"/>\n<attach id=\"held\" who=\"sword\" to=\"anna.b_Head_05\" begin=\"1\" turn=\"10 20 30\"/>";

fn random_rotation(random: &mut Random) -> DQuat {
    let mut angle = || (f64::from(random.unit()) - 0.5) * 6.0;
    DQuat::from_euler(EulerRot::XYZ, angle(), angle(), angle())
}

/// Returns the angle between two rotations, radians.
fn between(one: DQuat, other: DQuat) -> f64 {
    2.0 * one.dot(other).abs().min(1.0).acos()
}

#[test]
fn a_held_thing_is_put_anywhere_by_offset_and_turn_and_moves_along_from_there() {
    let text = fox_script(HELD);
    let (script, plan) = (read(&text), planned(&text, &assets(&fox())));
    let scene = GestureScene { script: &script, plan: &plan };
    let now = at(&plan, 2.0);
    let sword = plan.thing_called("sword").unwrap();
    let Some(ThingHold::Attached { action, holder, grip, is_arriving }) = plan.hold_of(sword, &now) else {
        panic!("it is held");
    };
    assert!(!is_arriving && plan.hold_of(sword, &at(&plan, 0.5)).is_none());
    let shown = holder.then(&grip);
    let found = &thing(&plan, &now, "sword").transform;
    assert!(shown.position.as_vec3().distance(found.translation) < 1e-5, "{shown:?} {found:?}");
    let mut random = Random::new(seed(5));
    for _ in 0..20 {
        let wanted = RigidPlace {
            position: DVec3::from_array(std::array::from_fn(|_| f64::from(random.unit()) * 4.0 - 2.0)),
            rotation: random_rotation(&mut random),
        };
        let splices = grip_splices(&scene, action, &HeldGrip::keeping(&holder, &wanted)).unwrap();
        let plan = planned(&spliced_text(&script, splices).unwrap(), &assets(&fox()));
        let put = thing(&plan, &at(&plan, 2.0), "sword").transform;
        assert!(put.translation.as_dvec3().distance(wanted.position) < 3e-4, "{put:?} {wanted:?}");
        assert!(between(put.rotation.as_dquat(), wanted.rotation) < 2e-3, "{put:?} {wanted:?}");
        // The head has moved since.
        let later = thing(&plan, &at(&plan, 3.0), "sword").transform;
        assert!(later.translation.distance(put.translation) > 1e-3);
    }
    // The same grip changes nothing, not even its spelling.
    let same = grip_splices(&scene, action, &HeldGrip::keeping(&holder, &shown)).unwrap();
    assert_eq!(spliced_text(&script, same).unwrap(), text);
}

#[test]
fn what_is_attached_with_a_grip_and_what_is_detached_stay_where_they_are() {
    let (old, new) = gesture("<play id=\"a\" who=\"anna\" take=\"Survey\"/>", |scene| {
        let now = at(scene.plan, 1.0);
        let holder = scene.plan.place_of_name("anna.b_Head_05", &now).unwrap();
        let place = thing(scene.plan, &now, "sword").transform;
        let place =
            RigidPlace { position: place.translation.as_dvec3(), rotation: place.rotation.as_dquat() };
        let grip = HeldGrip::keeping(&holder, &place);
        let splices = attach_splices(scene, "sword", "anna.b_Head_05", seconds(1.0), Some(&grip))?;
        spliced_text(scene.script, splices)
    });
    let new = new.unwrap();
    let (before, after) = (planned(&old, &assets(&fox())), planned(&new, &assets(&fox())));
    let place = |plan: &dragonfly_anim::stage::StagePlan, time| {
        thing(plan, &at(plan, time), "sword").transform.translation
    };
    assert!(place(&after, 1.0).distance(place(&before, 1.0)) < 3e-4, "{new}");
    assert!(place(&after, 2.0).distance(place(&before, 2.0)) > 1e-3, "it moves along");
    let script = read(&new);
    let scene = GestureScene { script: &script, plan: &after };
    let detached = spliced_text(&script, detach_splices(&scene, "sword", seconds(2.0)).unwrap()).unwrap();
    let detached = planned(&detached, &assets(&fox()));
    assert_eq!(place(&detached, 2.0), place(&after, 2.0));
    assert_eq!(place(&detached, 3.0), place(&after, 2.0));
}

#[test]
fn a_thing_that_is_keyed_elsewhere_is_where_it_was_before_and_there_from_then_on() {
    let actions = "<play id=\"a\" who=\"anna\" take=\"Survey\"/>";
    let wanted = DVec3::new(2.0, 0.5, -1.0);
    let (old, new) = gesture(actions, |scene| {
        spliced_text(scene.script, key_place_splices(scene, "ben", seconds(1.5), Some(wanted), Some(45.0))?)
    });
    let new = new.unwrap();
    let (before, after) = (planned(&old, &assets(&fox())), planned(&new, &assets(&fox())));
    assert_eq!(bits(&at(&after, 1.4)), bits(&at(&before, 1.4)), "before it, nothing changes");
    let ben = thing(&after, &at(&after, 1.5), "ben").transform;
    assert!(ben.translation.as_dvec3().distance(wanted) < 1e-6);
    assert!((ben.rotation * Vec3::Z).distance(Vec3::new(0.5_f32.sqrt(), 0.0, 0.5_f32.sqrt())) < 1e-5);
    // At the same time, the same action has the new place.
    let script = read(&new);
    let scene = GestureScene { script: &script, plan: &after };
    let splices = key_place_splices(&scene, "ben", seconds(1.5), Some(DVec3::X), None).unwrap();
    let again = spliced_text(&script, splices).unwrap();
    assert_eq!((again.matches("<place").count(), new.matches("<place").count()), (1, 1), "{again}");
    let line = changed(actions, |scene| {
        spliced_text(scene.script, key_place_splices(scene, "sun", seconds(0.5), Some(DVec3::Y), None)?)
    });
    assert_eq!(line, [r#"<place who="sun" at="0 1 0" begin="0.5"/>"#]);
}

#[test]
fn a_thing_on_its_way_and_one_without_a_place_are_not_keyed() {
    let walk = "<move id=\"walk\" who=\"ben\" path=\"aisle\" dur=\"2\" feet=\"free\"/>";
    let keyed = |who: &'static str, time: f64| {
        gesture(walk, |scene| {
            spliced_text(scene.script, key_place_splices(scene, who, seconds(time), Some(DVec3::X), None)?)
        })
        .1
    };
    let refusal = keyed("ben", 1.0).unwrap_err().to_string();
    assert_eq!(refusal, "ben follows the path aisle at this time: move the path, or go to its end");
    assert!(keyed("ben", 2.0).is_ok(), "the way is over");
    assert!(keyed("door", 1.0).unwrap_err().to_string().contains("is a mark"));
    assert!(keyed("none", 1.0).unwrap_err().to_string().contains("No thing of the cast"));
}

#[test]
fn a_prop_is_pitched_and_rolled_in_its_own_space_and_turned_after_that() {
    let text = fox_script("<wait dur=\"1\"/>")
        .replace("at=\"0 2 0\"/>", "at=\"0 2 0\" facing=\"90\" tilt=\"30 0\"/>");
    let plan = planned(&text, &assets(&fox()));
    let up = thing(&plan, &at(&plan, 0.5), "sword").transform.rotation * Vec3::Y;
    // Pitched by 30 degrees, what points up points to its front, and its front is +x.
    assert!(up.distance(Vec3::new(0.5, 0.75_f32.sqrt(), 0.0)) < 1e-5, "{up}");
    let mut random = Random::new(seed(6));
    for _ in 0..200 {
        let rotation = random_rotation(&mut random);
        let (facing, [pitch, roll]) = facing_and_tilt(rotation);
        let [facing, pitch, roll] = [facing, pitch, roll].map(f64::to_radians);
        let again = DQuat::from_euler(EulerRot::YXZ, facing, pitch, roll);
        assert!(between(again, rotation) < 1e-3, "{rotation}");
        let DVec3 { x, y, z } = turn_about_axes(rotation) * std::f64::consts::PI / 180.0;
        let again = DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
        assert!(between(again, rotation) < 1e-3, "{rotation}");
    }
    for rotation in [DQuat::from_rotation_y(FRAC_PI_2), DQuat::from_rotation_x(-FRAC_PI_2)] {
        let (facing, [pitch, roll]) = facing_and_tilt(rotation);
        let angles = [facing, pitch, roll].map(f64::to_radians);
        assert!(between(DQuat::from_euler(EulerRot::YXZ, angles[0], angles[1], angles[2]), rotation) < 1e-3);
        let DVec3 { x, y, z } = turn_about_axes(rotation) * std::f64::consts::PI / 180.0;
        let again = DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
        assert!(between(again, rotation) < 1e-3, "{rotation}");
    }
}

#[test]
fn all_points_of_a_path_are_put_elsewhere_at_once() {
    let text = fox_script("<wait dur=\"1\"/>");
    let script = read(&text);
    let splices = path_points_splices(&script, "aisle", &[DVec3::X, DVec3::new(1.0, 0.25, -2.5)]).unwrap();
    let new = spliced_text(&script, splices).unwrap();
    assert_eq!(new, text.replace("0 0 0  3 0 4", "1 0 0  1 0.25 -2.5"));
    let refused = path_points_splices(&script, "ben", &[DVec3::X]).unwrap_err();
    assert!(refused.to_string().contains("no points of its own"), "{refused}");
    assert!(path_points_splices(&script, "aisle", &[DVec3::X * f64::NAN, DVec3::X]).is_err());
}
