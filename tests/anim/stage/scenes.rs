//! The contents of a scene at a time, by example.

use super::actors::{assets, at, bone, fox, fox_script, foxes, planned, seconds, thing};
use super::listed;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{StageAssets, StagePlan};
use glam::{DVec3, Vec3};

fn near(found: Vec3, expected: [f32; 3]) {
    assert!(found.distance(expected.into()) < 1e-4, "{found} instead of {expected:?}");
}

/// Returns the direction in which a thing looks, degrees.
fn facing(plan: &StagePlan, id: &str, time: f64) -> f64 {
    let placement = plan.placement(plan.thing_called(id).unwrap(), seconds(time)).unwrap();
    (placement.facing.to_degrees() + 720.5) % 360.0 - 0.5
}

fn position(plan: &StagePlan, id: &str, time: f64) -> Vec3 {
    thing(plan, &at(plan, time), id).transform.translation
}

#[test]
fn things_stand_where_the_cast_says() {
    let plan = foxes("");
    near(position(&plan, "anna", 0.0), [1.0, 0.0, 2.0]);
    let scene = at(&plan, 0.0);
    // Facing 90 looks along +x.
    near(thing(&plan, &scene, "anna").transform.rotation * Vec3::Z, [1.0, 0.0, 0.0]);
    near(thing(&plan, &scene, "anna").transform.scale, [0.01; 3]);
    assert_eq!(plan.length(), StageTime::ZERO);
}

#[test]
fn a_path_is_followed_at_the_given_speed_and_the_role_stays_at_its_end() {
    let plan = foxes("<move id=\"m\" who=\"anna\" path=\"aisle\" speed=\"2\"/>");
    assert_eq!(plan.length().seconds(), 2.5);
    near(position(&plan, "anna", 0.0), [0.0, 0.0, 0.0]);
    near(position(&plan, "anna", 1.25), [1.5, 0.0, 2.0]);
    near(position(&plan, "anna", 2.5), [3.0, 0.0, 4.0]);
    near(position(&plan, "anna", 100.0), [3.0, 0.0, 4.0]);
    assert!((facing(&plan, "anna", 1.0) - 36.869_897).abs() < 1e-5, "{}", facing(&plan, "anna", 1.0));
}

#[test]
fn without_a_speed_the_stride_of_the_take_decides() {
    let model = fox();
    let walk = &model.takes()[model.take_called("Walk").unwrap()];
    let speed = walk.stride_speed().unwrap() * 0.01;
    // The speed varies with the steps, so all is within a part of one.
    let close = |plan: &StagePlan, time: f64, expected: [f32; 3]| {
        let found = position(plan, "anna", time);
        assert!(found.distance(expected.into()) < 0.06, "{time}: {found}");
    };
    let plan = foxes("<move who=\"anna\" path=\"aisle\" take=\"Walk\"/>");
    assert!((plan.length().seconds() - 5.0 / speed).abs() < 0.06, "{} {speed}", plan.length().seconds());
    close(&plan, 2.5 / speed, [1.5, 0.0, 2.0]);
    near(position(&plan, "anna", 9.0), [3.0, 0.0, 4.0]);
    // With a duration, the take is faster.
    let plan = foxes("<move who=\"anna\" path=\"aisle\" take=\"Walk\" dur=\"2\"/>");
    close(&plan, 1.0, [1.5, 0.0, 2.0]);
    near(position(&plan, "anna", 2.0), [3.0, 0.0, 4.0]);
    // A speed and a duration: the way is cut.
    let plan = foxes("<move who=\"anna\" path=\"aisle\" take=\"Walk\" dur=\"2\" speed=\"1\"/>");
    close(&plan, 3.0, [1.2, 0.0, 1.6]);
}

#[test]
fn easing_laps_and_endless_paths() {
    let plan = foxes("<move who=\"wide\" path=\"aisle\" dur=\"4\" ease=\"in-out\" turn=\"keep\"/>");
    near(position(&plan, "wide", 1.0), [0.375, 0.0, 0.5]);
    near(position(&plan, "wide", 2.0), [1.5, 0.0, 2.0]);
    let plan = foxes("<move who=\"wide\" path=\"aisle\" speed=\"5\" repeat=\"1.5\"/>");
    near(position(&plan, "wide", 1.25), [0.75, 0.0, 1.0]);
    near(position(&plan, "wide", 9.0), [1.5, 0.0, 2.0]);
    let plan =
        foxes("<par dur=\"3.2\"><move who=\"wide\" path=\"aisle\" speed=\"5\" repeat=\"fill\"/></par>");
    near(position(&plan, "wide", 2.5), [1.5, 0.0, 2.0]);
    near(position(&plan, "wide", 9.0), [0.6, 0.0, 0.8]);
}

#[test]
fn a_way_to_a_mark_starts_where_the_role_stands_then() {
    let plan = foxes(
        "<seq><move who=\"anna\" path=\"aisle\" speed=\"5\"/><move id=\"m\" who=\"anna\" to=\"door\" speed=\"1\" gap=\"0.5\"/>\
         <turn who=\"anna\" to=\"door\" dur=\"1\"/><place who=\"anna\" at=\"door\"/></seq>",
    );
    let way = DVec3::new(2.0, 0.0, -1.0).length() - 0.5;
    let expected = 2.0 + way;
    assert!((plan.length().seconds() - expected).abs() < 1e-6, "{}", plan.length().seconds());
    let end = Vec3::new(5.0, 0.0, 3.0) - Vec3::new(2.0, 0.0, -1.0).normalize() * 0.5;
    near(position(&plan, "anna", expected - 1.0), end.to_array());
    // The place has the direction of the mark.
    near(position(&plan, "anna", expected), [5.0, 0.0, 3.0]);
    assert!((facing(&plan, "anna", expected) - 180.0).abs() < 1e-9);
}

#[test]
fn ways_to_places_that_wait_for_each_other_are_resolved() {
    // Ben goes where Anna is after her walk, which ends when Ben has turned.
    let plan = foxes(
        "<par><seq><wait dur=\"1\"/><move id=\"a\" who=\"anna\" to=\"1 0 5\" speed=\"1\"/></seq>\
         <move id=\"b\" who=\"ben\" to=\"anna\" speed=\"2\" begin=\"a.end\"/><move who=\"anna\" to=\"ben\" speed=\"1\" begin=\"b.end+1\"/></par>",
    );
    let far = DVec3::new(3.0, 0.0, 5.0).length();
    assert!((plan.length().seconds() - (1.0 + 3.0 + far / 2.0 + 1.0)).abs() < 1e-6);
    near(position(&plan, "ben", 20.0), [1.0, 0.0, 5.0]);
}

#[test]
fn a_turn_takes_the_short_way_and_a_released_one_lets_go() {
    let plan = foxes("<turn who=\"anna\" to=\"-90\" dur=\"2\"/>");
    assert!((facing(&plan, "anna", 1.0) - 180.0).abs() < 1e-6 || facing(&plan, "anna", 1.0).abs() < 1e-6);
    assert!((facing(&plan, "anna", 5.0) - 270.0).abs() < 1e-6);
    let plan = foxes("<turn who=\"anna\" to=\"ben\" dur=\"2\" fill=\"release\"/>");
    let to_ben = 3.0_f64.atan2(-2.0).to_degrees();
    assert!((facing(&plan, "anna", 1.999_999) - to_ben).abs() < 1e-3, "{}", facing(&plan, "anna", 1.999_999));
    assert!((facing(&plan, "anna", 2.0) - 90.0).abs() < 1e-6);
}

#[test]
fn of_two_actions_on_one_channel_the_later_begin_wins_then_the_later_in_the_text() {
    let plan = foxes(
        "<place who=\"anna\" at=\"9 0 0\" begin=\"1\"/><place who=\"anna\" at=\"8 0 0\"/><place who=\"anna\" at=\"7 0 0\" begin=\"1\"/>",
    );
    near(position(&plan, "anna", 0.5), [8.0, 0.0, 0.0]);
    near(position(&plan, "anna", 1.5), [7.0, 0.0, 0.0]);
}

#[test]
fn a_take_fades_in_over_the_one_before_and_holds_its_end() {
    let only = |actions: &str, time: f64| {
        let plan = foxes(actions);
        let scene = at(&plan, time);
        thing(&plan, &scene, "anna").pose.as_ref().unwrap().pose.clone()
    };
    let walk = "<play who=\"anna\" take=\"Walk\" repeat=\"fill\"/><wait dur=\"9\"/>";
    let both = format!("{walk}<play who=\"anna\" take=\"Survey\" begin=\"1\" fade-in=\"0.5\"/>");
    let survey = "<play who=\"anna\" take=\"Survey\" begin=\"1\"/>";
    assert_eq!(only(&both, 0.9), only(walk, 0.9));
    assert_eq!(only(&both, 1.5), only(survey, 1.5));
    // In the middle of the fade every bone is in the middle.
    let (a, b, middle) = (only(walk, 1.25), only(survey, 1.25), only(&both, 1.25));
    for index in 0..a.bones() {
        let [a, b, middle] = [&a, &b, &middle].map(|pose| pose.get(index).unwrap());
        let expected = 0.5 * (a.translation + b.translation);
        assert!(middle.translation.distance(expected) < 1e-3, "{index}");
        let sign = if a.rotation.dot(b.rotation) < 0.0 { -1.0 } else { 1.0 };
        let expected = (a.rotation * 0.5 + b.rotation * (0.5 * sign)).normalize();
        assert!(middle.rotation.dot(expected).abs() > 1.0 - 1e-5, "{index}");
    }
    assert_eq!(only(survey, 100.0), only(survey, 1.0 + fox().takes()[0].length().seconds()));
    assert_eq!(only("<play who=\"anna\" take=\"Survey\" fill=\"release\"/>", 100.0), only("", 0.0));
}

#[test]
fn part_speed_and_repeats_of_a_take() {
    let pose = |actions: &str, time: f64| {
        let plan = foxes(actions);
        thing(&plan, &at(&plan, time), "anna").pose.as_ref().unwrap().pose.clone()
    };
    let plain = |time: f64| pose("<play who=\"anna\" take=\"Survey\"/>", time);
    assert_eq!(pose("<play who=\"anna\" take=\"Survey\" from=\"0.5\" speed=\"2\"/>", 0.25), plain(1.0));
    assert_eq!(pose("<play who=\"anna\" take=\"Survey\" to=\"1\" speed=\"-0.5\"/>", 0.5), plain(0.75));
    assert_eq!(
        pose("<play who=\"anna\" take=\"Survey\" from=\"0.25\" to=\"0.75\" repeat=\"3\"/>", 1.125),
        plain(0.375)
    );
    assert_eq!(
        pose("<play who=\"anna\" take=\"Survey\" from=\"0.25\" to=\"0.75\" repeat=\"3\"/>", 9.0),
        plain(0.75)
    );
    assert_eq!(
        pose("<play who=\"anna\" take=\"Survey\" from=\"0.25\" to=\"0.75\" repeat=\"2.5\"/>", 9.0),
        plain(0.5)
    );
}

#[test]
fn a_layer_moves_only_its_bones() {
    let model = fox();
    let skeleton = model.skeleton();
    let neck = skeleton.bones.iter().position(|bone| bone.name.contains("Neck")).unwrap();
    let name = &skeleton.bones[neck].name;
    let base = "<play who=\"anna\" take=\"Walk\" repeat=\"fill\"/><wait dur=\"9\"/>";
    let plan =
        foxes(&format!("{base}<play who=\"anna\" take=\"Survey\" bones=\"{name}\" begin=\"1\" dur=\"2\"/>"));
    let [plain, survey] = [foxes(base), foxes("<play who=\"anna\" take=\"Survey\" begin=\"1\"/>")];
    let get = |plan: &StagePlan, time: f64| {
        thing(plan, &at(plan, time), "anna").pose.as_ref().unwrap().pose.clone()
    };
    let (found, walk, over) = (get(&plan, 2.0), get(&plain, 2.0), get(&survey, 2.0));
    let below = |bone: usize| {
        std::iter::successors(Some(bone), |&bone| skeleton.bones[bone].parent.map(|parent| parent as usize))
            .any(|bone| bone == neck)
    };
    let mut masked = 0;
    for bone in 0..found.bones() {
        let expected = if below(bone) { over.get(bone) } else { walk.get(bone) };
        let (found, expected) = (found.get(bone).unwrap(), expected.unwrap());
        assert!(found.rotation.dot(expected.rotation).abs() > 1.0 - 1e-5, "{bone}");
        masked += usize::from(below(bone));
    }
    assert!(masked >= 2 && masked < found.bones());
    // Layers are released at their end.
    assert_eq!(get(&plan, 3.0), get(&plain, 3.0));
}

#[test]
fn what_is_attached_follows_the_bone_is_handed_over_and_falls() {
    let model = fox();
    let head = model.skeleton().bones.iter().position(|bone| bone.name.contains("Head")).unwrap();
    let name = model.skeleton().bones[head].name.clone();
    let plan = foxes(&format!(
        "<play who=\"anna\" take=\"Survey\" repeat=\"fill\"/><play who=\"ben\" take=\"Run\" repeat=\"fill\"/><wait dur=\"9\"/>\
         <attach who=\"sword\" to=\"anna.{name}\" begin=\"1\" offset=\"0 0.5 0\"/><attach who=\"sword\" to=\"ben.{name}\" begin=\"2\" fade-in=\"0.5\"/>\
         <detach who=\"sword\" begin=\"4\" drop=\"ground\"/><place who=\"sword\" at=\"7 7 7\" begin=\"8\"/>"
    ));
    near(position(&plan, "sword", 0.5), [0.0, 2.0, 0.0]);
    let scene = at(&plan, 1.5);
    let (hand, sword) = (bone(&plan, &scene, "anna", head as u32), thing(&plan, &scene, "sword").transform);
    assert!((sword.translation.distance(hand) - 0.5).abs() < 1e-5);
    assert_eq!(sword.scale, Vec3::ONE);
    let scene = at(&plan, 3.0);
    assert!(
        thing(&plan, &scene, "sword").transform.translation.distance(bone(&plan, &scene, "ben", head as u32))
            < 1e-5
    );
    // Half way between both hands.
    let scene = at(&plan, 2.25);
    let sword = thing(&plan, &scene, "sword").transform.translation;
    assert!(sword.distance(bone(&plan, &scene, "ben", head as u32)) > 0.5);
    // It is detached where it was, and falls.
    let (held, detach_places) = (position(&plan, "sword", 4.0 - 1e-9), position(&plan, "sword", 4.0));
    assert!(held.distance(detach_places) < 1e-3, "{held} {detach_places}");
    let falling = position(&plan, "sword", 4.1);
    assert!((detach_places.y - falling.y - 0.5 * 9.81 * 0.01).abs() < 1e-4);
    near(position(&plan, "sword", 7.0), [detach_places.x, 0.0, detach_places.z]);
    near(position(&plan, "sword", 8.5), [7.0, 7.0, 7.0]);
}

#[test]
fn a_role_looks_at_its_target() {
    let model = fox();
    let name = model.skeleton().bones.iter().find(|bone| bone.name.contains("Head")).unwrap().name.clone();
    let head = model.skeleton().find(&name).unwrap();
    let plan = foxes(&format!(
        "<look who=\"anna\" at=\"ben\" bones=\"{name}\" begin=\"1\" dur=\"2\" fade-in=\"0.5\"/>"
    ));
    let ahead = |time: f64| {
        let scene = at(&plan, time);
        let state = thing(&plan, &scene, "anna");
        let to_root =
            dragonfly_anim::fast::matrix::mat4(state.pose.as_ref().unwrap().to_root.get(head as usize));
        let rest = thing(&plan, &at(&plan, 0.0), "anna")
            .pose
            .as_ref()
            .unwrap()
            .to_root
            .get(head as usize)
            .to_owned();
        let axis = dragonfly_anim::fast::matrix::mat4(&rest).inverse().transform_vector3(Vec3::Z);
        let forward = state.transform.rotation * to_root.transform_vector3(axis).normalize();
        let target = thing(&plan, &scene, "ben").transform.translation - bone(&plan, &scene, "anna", head);
        forward.angle_between(target.normalize()).to_degrees()
    };
    assert!(ahead(0.5) > 20.0);
    assert!(ahead(2.0) < 0.1, "{}", ahead(2.0));
    assert!(ahead(1.25) > 1.0 && ahead(1.25) < ahead(0.5));
    assert!((ahead(3.0) - ahead(0.5)).abs() < 1e-3);
}

#[test]
fn cameras_cut_blend_look_and_focus() {
    let plan = foxes(
        "<shot who=\"close\" begin=\"1\"/><shot who=\"wide\" begin=\"2\" blend=\"1\"/><wait dur=\"4\"/>\
         <change who=\"wide\" property=\"lens\" to=\"70\" begin=\"3\" dur=\"1\"/>",
    );
    let camera = |time: f64| at(&plan, time).camera.unwrap();
    // Before any shot the first camera is seen.
    assert_eq!(plan.things()[camera(0.0).thing].id.as_ref(), "wide");
    let close = camera(1.5);
    near(close.position, [-1.0, 1.0, 2.0]);
    assert_eq!((close.lens, close.aperture), (85.0, 2.8));
    let to_anna = Vec3::new(2.0, -1.0, 0.0);
    near(close.rotation * Vec3::NEG_Z, to_anna.normalize().to_array());
    assert!((close.focus.unwrap() - to_anna.length()).abs() < 1e-5);
    assert!((close.rotation * Vec3::X).y.abs() < 1e-6);
    let blend = camera(2.5);
    near(blend.position, [-0.5, 1.0, 5.5]);
    assert_eq!(blend.lens, 60.0);
    assert_eq!(camera(3.0).lens, 35.0);
    assert_eq!((camera(3.5).lens, camera(9.0).lens), (52.5, 70.0));
}

#[test]
fn lights_effects_titles_and_sounds() {
    let text = fox_script(
        "<wait dur=\"10\"/><set who=\"sun\" property=\"color\" to=\"#ff0000\" begin=\"1\"/><change who=\"sun\" property=\"strength\" to=\"1\" begin=\"2\" dur=\"2\"/>\
         <run who=\"rain\" begin=\"1\" end=\"3\" fade-in=\"1\"/><run who=\"rain\" begin=\"5\" dur=\"1\"/>\
         <title text=\"The End\" begin=\"2\" dur=\"2\" fade-in=\"1\" fade-out=\"1\" at=\"0.5 0.9\"/>\
         <sound src=\"thunder.ogg\" begin=\"1\" gain=\"0.5\"/><sound src=\"loop.ogg\" begin=\"1\" repeat=\"fill\"/><sound src=\"new.ogg\" begin=\"4\"/>",
    );
    let mut assets = assets(&fox());
    assets.add_sound("thunder.ogg", seconds(2.0));
    assets.add_sound("loop.ogg", seconds(0.75));
    let plan = planned(&text, &assets);
    let sun = |time: f64| thing(&plan, &at(&plan, time), "sun").light.unwrap();
    assert_eq!((sun(0.0).color, sun(1.0).color, sun(0.0).strength), (Vec3::ONE, Vec3::X, 3.0));
    assert_eq!((sun(3.0).strength, sun(9.0).strength), (2.0, 1.0));
    let rain = |time: f64| thing(&plan, &at(&plan, time), "rain").effect.unwrap();
    assert_eq!(
        (rain(0.9).weight, rain(1.5).weight, rain(2.5).weight, rain(3.0).weight),
        (0.0, 0.5, 1.0, 0.0)
    );
    assert_eq!((rain(2.5).seconds, rain(5.5).seconds, rain(5.5).rate), (1.5, 0.5, 50.0));
    // Each run has its own random numbers.
    assert_ne!(rain(2.5).seed, rain(5.5).seed);
    let titles = |time: f64| at(&plan, time).titles;
    assert!(titles(1.9).is_empty() && titles(4.0).is_empty());
    assert_eq!((titles(2.5)[0].weight, titles(3.0)[0].weight, titles(3.5)[0].weight), (0.5, 1.0, 0.5));
    assert_eq!((&*plan.titles()[0].text, plan.titles()[0].at), ("The End", [0.5, 0.9]));
    let heard = |time: f64| {
        let scene = at(&plan, time);
        scene
            .sounds
            .iter()
            .map(|sound| (plan.sounds()[sound.sound].source.to_string(), sound.seconds, sound.gain))
            .collect::<Vec<_>>()
    };
    assert_eq!(heard(2.0), [("thunder.ogg".to_owned(), 1.0, 0.5), ("loop.ogg".to_owned(), 0.25, 1.0)]);
    assert_eq!(heard(5.5), [("loop.ogg".to_owned(), 0.0, 1.0), ("new.ogg".to_owned(), 1.5, 1.0)]);
}

#[test]
fn what_a_model_does_not_have_is_an_error_with_its_place_and_the_names_it_has() {
    let errors = |actions: &str| {
        let script = StageScript::read(fox_script(actions)).unwrap();
        listed(&StagePlan::new(&script, &assets(&fox())).unwrap_err())
    };
    for (actions, expected) in [
        (
            "<play who=\"anna\" take=\"Wlak\"/>",
            "2:24: \"anna\" has no take \"Wlak\"; did you mean \"Walk\"? (takes: Survey, Walk, Run)",
        ),
        ("<play who=\"sword\" take=\"Walk\"/>", "2:25: \"sword\" has no take \"Walk\"; there are no takes"),
        ("<look who=\"anna\" at=\"ben.Haed\"/>", "2:22: \"ben\" has no bone \"Haed\"; "),
        ("<look who=\"anna\" at=\"sun.Head\"/>", "2:22: a light has no bones"),
        ("<look who=\"anna\" at=\"ben\"/>", "2:2: \"anna\" has no bone called head; `bones` is needed; "),
        (
            "<move who=\"wide\" path=\"aisle\"/>",
            "2:2: nothing says how long this way takes; give it a `speed`",
        ),
        ("<move who=\"anna\" path=\"aisle\" take=\"Survey\"/>", "2:2: the take \"Survey\" has no stride"),
        ("<move who=\"wide\" path=\"aisle\" take=\"Walk\" dur=\"1\"/>", "2:37: a camera has no takes"),
        (
            "<attach who=\"anna\" to=\"ben\"/><attach who=\"ben\" to=\"anna\" begin=\"5\"/>",
            "2:2: these things hold each other: anna, ben",
        ),
    ] {
        let found = errors(actions);
        assert!(
            found.lines().any(|line| line["scene.xml:".len()..].starts_with(expected)),
            "{actions}\n{expected}\n{found}"
        );
    }
    let script = StageScript::read(fox_script("")).unwrap();
    let found = listed(&StagePlan::new(&script, &StageAssets::default()).unwrap_err());
    assert!(found.contains("there is no model \"a.glb\"; there are no models"), "{found}");
}

#[test]
fn a_way_whose_length_depends_on_itself_is_an_error() {
    // It begins earlier the longer it is, and so starts elsewhere.
    let script = fox_script(
        "<move who=\"anna\" path=\"aisle\" speed=\"0.5\"/><move id=\"m\" who=\"anna\" to=\"0 0 50\" speed=\"3\" begin=\"w.begin\"/>\
         <wait id=\"w\" begin=\"x.end-17\"/><wait id=\"x\" begin=\"m.end\"/>",
    );
    let script = StageScript::read(script).unwrap();
    let errors = listed(&StagePlan::new(&script, &assets(&fox())).unwrap_err());
    assert!(errors.contains("depends on itself"), "{errors}");
}
