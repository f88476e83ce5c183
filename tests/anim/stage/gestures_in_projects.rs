//! Gestures in scripts that name what the cast of their project shares.

use super::actors::{assets, fox, seconds};
use super::includes::context;
use super::listed;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureRefusal, GestureScene, SequenceOrder, add_clip, attach_thing, cut_to,
    delete_clip, delete_thing, duplicate_clip, duplicate_thing, face_splices, face_thing, follow_path,
    move_clip, path_point_splices, path_points_splices, place_splices, place_thing, rename_thing, set_fade,
    set_on_thing, set_repeat, set_speed, spliced_script, trim_end, trim_start,
};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptContext, StageRepeat, StageScript};
use dragonfly_anim::stage::splice::TextSplices;
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

/// Returns the texts of project and script after replacements that `find` makes for them.
fn texts(find: impl FnOnce(&GestureScene<'_>, &dyn Fn(&str) -> usize) -> TextSplices) -> [String; 2] {
    let script = of_project(SCRIPT);
    let plan =
        StagePlan::new(&script, &assets(&fox())).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let element = |id: &str| script.thing_element(id).expect(id);
    let splices = find(&GestureScene { script: &script, plan: &plan }, &element);
    let new = spliced_script(&script, &splices).unwrap_or_else(|refusal| panic!("{refusal}"));
    [new.project().expect("a project").tree().text().to_string(), new.tree().text().to_string()]
}

#[test]
fn a_thing_of_the_project_is_changed_in_the_text_of_the_project_and_nothing_else_is() {
    let put = |id: &'static str| {
        move |s: &GestureScene<'_>, _: &dyn Fn(&str) -> usize| {
            place_splices(s, id, seconds(0.0), DVec3::new(1.0, 2.0, 3.0), None).expect(id)
        }
    };
    let project = |old: &str, new: &str| [PROJECT.replacen(old, new, 1), SCRIPT.to_owned()];
    assert_eq!(texts(put("door")), project("at=\"3 0 0\"", "at=\"1 2 3\""));
    assert_eq!(texts(put("close")), project("id=\"close\"", "id=\"close\" at=\"1 2 3\""));
    let turned = texts(|s, _| face_splices(s, "door", seconds(0.0), 45.0).expect("a mark"));
    assert_eq!(turned, project("at=\"3 0 0\"", "at=\"3 0 0\" facing=\"45\""));
    let lens = texts(|s, of| set_on_thing(s.script, of("wide"), "lens", Some("85mm")).expect("a camera"));
    assert_eq!(lens, project("look=\"anna\"", "look=\"anna\" lens=\"85mm\""));
    let away = texts(|s, of| set_on_thing(s.script, of("wide"), "look", None).expect("a camera"));
    assert_eq!(away, project(" look=\"anna\"", ""));
    let point =
        texts(|s, _| path_point_splices(s.script, "aisle", 1, DVec3::new(5.0, 0.0, 6.0)).expect("a path"));
    assert_eq!(point, project("3 0 4", "5 0 6"));
    let moved = texts(|s, _| {
        path_points_splices(s.script, "aisle", &[DVec3::Y, DVec3::new(1.5, 0.0, 0.0)]).expect("a path")
    });
    assert_eq!(moved, project("0 0 0  3 0 4", "0 1 0  1.5 0 0"));
    let gone = texts(|s, of| delete_thing(s.script, of("close")).expect("a camera"));
    assert_eq!(gone, project("<camera id=\"close\"/>", ""));
    let twice = texts(|s, of| duplicate_thing(s.script, of("door")).expect("a mark"));
    let copy = "<mark id=\"door\" at=\"3 0 0\"/><mark id=\"door-2\" at=\"3 0 0\"/>";
    assert!(twice[0].contains(copy) && twice[1] == SCRIPT, "{}", twice[0]);
}

#[test]
fn a_new_name_is_written_in_the_project_and_in_the_script_and_one_step_changes_both() {
    let renamed = texts(|s, of| rename_thing(s.script, of("wide"), "front").expect("a camera"));
    let both = [PROJECT, SCRIPT].map(|text| text.replace("\"wide\"", "\"front\""));
    assert_eq!(renamed, both);
    // The role is in the script, and the project looks at it: that is not its own.
    let script = of_project(SCRIPT);
    for taken in ["close", "anna", "x", "prev", "a b"] {
        assert!(
            rename_thing(&script, script.thing_element("wide").expect("wide"), taken).is_err(),
            "{taken}"
        );
    }
    let both = texts(|s, of| {
        let parts = [
            set_on_thing(s.script, of("anna"), "facing", Some("90")).expect("a role"),
            set_on_thing(s.script, of("door"), "at", Some("0 0 1")).expect("a mark"),
        ];
        TextSplices::joined(parts).expect("two places")
    });
    assert!(both[0].contains("at=\"0 0 1\"") && both[1].contains("scale=\"0.01\" facing=\"90\""), "{both:?}");
}

#[test]
fn the_shared_cast_of_a_script_that_includes_a_file_is_changed_and_what_the_file_has_is_not() {
    let part = "<script version=\"1\"><cast><role id=\"ben\" model=\"a.glb\" scale=\"0.01\"/>\
        <path id=\"lane\" points=\"0 0 0  1 0 0\"/></cast><shot who=\"close\" begin=\"1\"/></script>";
    let main = SCRIPT.replace("</seq>", "</seq>\n<include src=\"part.xml\"/>");
    let project = StageProject::read(PROJECT).expect("a project");
    let context =
        ScriptContext { project: Some(project), ..context("scene.xml", &main, &[("part.xml", part)]) };
    let script =
        StageScript::read_in(main.as_str(), &context).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let element = |id: &str| script.thing_element(id).expect(id);
    let moved = set_on_thing(&script, element("door"), "at", Some("1 2 3")).expect("a mark");
    let new = spliced_script(&script, &moved).unwrap_or_else(|refusal| panic!("{refusal}"));
    let text = new.project().expect("a project").tree().text();
    assert_eq!(**text, *PROJECT.replace("at=\"3 0 0\"", "at=\"1 2 3\""));
    assert!(new.thing_called("ben").is_some() && *new.tree().text() == *script.tree().text());
    // The file names it, and is another text.
    let renamed = rename_thing(&script, element("close"), "near").expect("a name");
    assert!(spliced_script(&script, &renamed).is_err());
    let plan =
        StagePlan::new(&script, &assets(&fox())).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let scene = GestureScene { script: &script, plan: &plan };
    for id in ["ben", "lane"] {
        let element = element(id);
        assert!(set_on_thing(&script, element, "id", Some("x")).is_none(), "{id}");
        assert!(rename_thing(&script, element, "other").is_err(), "{id}");
        assert!(delete_thing(&script, element).is_none() && duplicate_thing(&script, element).is_none());
    }
    for refused in [
        place_splices(&scene, "ben", seconds(0.0), DVec3::X, None),
        face_splices(&scene, "ben", seconds(0.0), 45.0),
        path_point_splices(&script, "lane", 1, DVec3::X),
        path_points_splices(&script, "lane", &[DVec3::X, DVec3::Y]),
    ] {
        let refusal = refused.expect_err("it is in another file").to_string();
        assert!(refusal.ends_with(" is in part.xml: open it to change it"), "{refusal}");
    }
}
