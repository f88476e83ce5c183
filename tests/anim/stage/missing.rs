//! Models that are missing: the rest of the scene plays.

use super::actors::{assets, fox, seconds};
use super::read;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::{StageAssets, StagePlan};

/// A fox that is there and a knight who is not: he plays, walks, looks, holds and is looked at.
const HALF: &str = r#"<script version="1"><cast>
<role id="fox" model="a.glb" scale="0.01"/><role id="knight" model="knight.glb" at="2 0 0"/>
<prop id="sword" model="sword.glb"/><camera id="close" at="0 1 5" look="knight.Head" focus="knight.Head"/>
</cast>
<seq>
<play id="bow" who="knight" take="Bow"><at name="low" time="0.4"/></play>
<play id="part" who="knight" take="Bow" from="0.5" to="2" speed="2"/>
<move id="walk" who="knight" to="2 0 7" take="Walk"/>
<look who="knight" at="fox" begin="bow.low"/>
<play who="knight" take="Wave" layer="arm" bones="Arm" begin="bow.begin"/>
</seq>
<attach who="sword" to="knight.Hand" begin="bow.low"/>
<play id="runs" who="fox" take="Run"/>
</script>"#;

/// Seconds that a take of a missing model lasts.
const UNKNOWN_TAKE: f64 = 1.0;

/// Meters per second of a walk of a missing model.
const UNKNOWN_SPEED: f64 = 1.4;

fn half() -> (StageScript, StagePlan) {
    let mut assets = assets(&fox());
    assets.allow_missing_models();
    let script = read(HALF);
    let plan = StagePlan::new(&script, &assets).expect("it plays without the knight");
    (script, plan)
}

#[test]
fn without_permission_a_missing_model_is_an_error_with_its_place() {
    let errors = StagePlan::new(&read(HALF), &assets(&fox())).expect_err("no knight");
    assert_eq!(errors[0].message, "there is no model \"knight.glb\"");
    assert_eq!((errors[0].place.line, errors.len()), (2, 2));
}

#[test]
fn takes_of_a_missing_model_last_a_guess_and_its_ways_take_a_walk() {
    let (script, plan) = half();
    let times = |id: &str| plan.schedule().times()[script.action_called(id).expect(id)];
    assert_eq!(times("bow").end, seconds(UNKNOWN_TAKE));
    // A part of a known length, at twice the speed.
    assert_eq!(times("part").end - times("part").begin, seconds(0.75));
    let walk = (times("walk").end - times("walk").begin).seconds();
    assert!((walk - 7.0 / UNKNOWN_SPEED).abs() < 1e-6, "{walk}");
}

#[test]
fn a_thing_without_its_model_stands_and_walks_and_holds_where_it_is_and_the_others_play() {
    let (script, plan) = half();
    let [fox, knight, sword] = ["fox", "knight", "sword"].map(|id| plan.thing_called(id).expect(id));
    assert!(plan.things()[knight].is_missing && !plan.things()[fox].is_missing);
    let mut scene = plan.new_scene();
    let end = plan.schedule().times()[script.action_called("walk").expect("a walk")].end;
    plan.scene_at(end, &mut scene);
    let place = |thing: usize| scene.things[thing].transform.translation;
    assert!((place(knight) - glam::Vec3::new(2.0, 0.0, 7.0)).length() < 1e-4, "{:?}", place(knight));
    assert!((place(sword) - place(knight)).length() < 1e-4, "it is held by the place of the knight");
    assert!(scene.things[knight].pose.is_none() && scene.things[fox].pose.is_some());
    // The camera looks at the place of the knight.
    let camera = scene.camera.expect("a camera");
    let ahead = camera.rotation * -glam::Vec3::Z;
    assert!(ahead.dot((place(knight) - camera.position).normalize()) > 0.9999, "{ahead:?}");
}

#[test]
fn all_other_errors_are_still_found() {
    let mut assets = StageAssets::default();
    assets.allow_missing_models();
    let text = HALF.replace("take=\"Walk\"", "");
    let errors = StagePlan::new(&read(&text), &assets).expect_err("no speed");
    let messages: Vec<&str> = errors.iter().map(|error| &*error.message).collect();
    assert_eq!(messages, ["nothing says how long this way takes"]);
}
