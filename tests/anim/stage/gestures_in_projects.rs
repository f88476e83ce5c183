//! Gestures in scripts that name what the cast of their project shares.

use super::actors::{assets, fox, seconds};
use super::listed;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureRefusal, GestureScene, SequenceOrder, add_clip, attach_thing, cut_to,
    delete_clip, duplicate_clip, face_thing, follow_path, move_clip, place_thing, set_fade, set_repeat,
    set_speed, trim_end, trim_start,
};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{StageRepeat, StageScript};
use dragonfly_anim::stage::time::Decimal;
use glam::DVec3;

const PROJECT: &str = "<project version=\"1\" fps=\"30\"><cast><camera id=\"wide\" look=\"anna\"/>\
    <camera id=\"close\"/><path id=\"aisle\" points=\"0 0 0  3 0 4\"/><mark id=\"door\" at=\"3 0 0\"/></cast></project>";

const SCRIPT: &str = "<script version=\"1\"><cast>\n<role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/>\n</cast>\n\
    <shot who=\"wide\"/>\n<seq>\n<play id=\"x\" who=\"anna\" take=\"Survey\" begin=\"6f\"/>\n\
    <play id=\"y\" who=\"anna\" take=\"Run\"/>\n</seq>\n</script>\n";

fn of_project(text: &str) -> StageScript {
    let project = StageProject::read(PROJECT).expect("a project");
    StageScript::read_of(text, Some(&project)).unwrap_or_else(|errors| panic!("{}\n{text}", listed(&errors)))
}

fn done(
    act: impl FnOnce(&GestureScene<'_>, usize) -> Result<String, GestureRefusal>,
) -> Result<String, GestureRefusal> {
    let script = of_project(SCRIPT);
    let plan =
        StagePlan::new(&script, &assets(&fox())).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    act(&GestureScene { script: &script, plan: &plan }, script.action_called("x").expect("x"))
}

#[test]
fn every_gesture_works_in_a_script_that_names_a_shared_thing() {
    let new = [
        done(|s, x| move_clip(s, x, seconds(0.5), SequenceOrder::Keep, Followers::Follow)),
        done(|s, x| move_clip(s, x, seconds(9.0), SequenceOrder::Change, Followers::Follow)),
        done(|s, x| trim_start(s, x, seconds(0.5))),
        done(|s, x| trim_end(s, x, seconds(1.5), Followers::Stay)),
        done(|s, x| set_fade(s, x, FadeEnd::In, seconds(0.5))),
        done(|s, x| set_speed(s, x, 2.0)),
        done(|s, x| set_repeat(s, x, StageRepeat::Times(Decimal::parse("2").expect("a number")))),
        done(|s, x| delete_clip(s, x, Followers::Stay)),
        done(duplicate_clip),
        done(|s, _| cut_to(s, "close", seconds(1.0))),
        done(|s, _| add_clip(s, "anna", "Walk", seconds(9.0))),
        done(|s, _| follow_path(s, "anna", "aisle", Some("Walk"), seconds(9.0))),
        done(|s, _| attach_thing(s, "anna", "door", seconds(1.0))),
        done(|s, _| place_thing(s, "anna", seconds(0.0), DVec3::X)),
        done(|s, _| face_thing(s, "anna", seconds(0.0), 45.0)),
    ];
    for (at, new) in new.into_iter().enumerate() {
        let new = new.unwrap_or_else(|refusal| panic!("gesture {at}: {refusal}"));
        assert_ne!(new, SCRIPT, "gesture {at}");
        assert!(of_project(&new).actions().len() > 3 && new.ends_with("</script>\n"), "gesture {at}: {new}");
    }
}

#[test]
fn a_time_is_written_at_the_frame_rate_of_the_project() {
    let new = done(|s, x| move_clip(s, x, seconds(0.5), SequenceOrder::Keep, Followers::Follow));
    assert!(new.expect("a text").contains("begin=\"15f\""), "half a second is 15 of 30 frames");
}

#[test]
fn a_thing_of_the_project_is_not_placed_by_a_script() {
    for refused in [
        done(|s, _| place_thing(s, "wide", seconds(0.0), DVec3::X)),
        done(|s, _| face_thing(s, "door", seconds(0.0), 45.0)),
    ] {
        let refusal = refused.expect_err("the text of the script has no such element").to_string();
        assert!(refusal.ends_with("belongs to the project: change it there"), "{refusal}");
    }
}
