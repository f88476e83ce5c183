//! Gestures in a timeline: which lines of the text they change, and what the scene is like after them.

use super::actors::{assets, at, bits, fox, fox_script, planned};
use super::includes::{cut_out, including};
use super::random_scripts;
use super::read;
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureRefusal, GestureScene, MovedPart, SequenceOrder, add_clip, attach_thing,
    cut_to, delete_clip, duplicate_clip, face_thing, move_clip, moved_along, place_thing, set_fade,
    set_repeat, set_speed, stretch_to, trim_end, trim_start,
};
use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::script::StageRepeat;
use dragonfly_anim::stage::splice::TextSplice;
use dragonfly_anim::stage::time::{Decimal, StageTime};
use dragonfly_anim::stage::{StageAssets, StagePlan};
use dragonfly_kit::random::{Random, seed};
use glam::DVec3;

fn seconds(seconds: f64) -> StageTime {
    StageTime::from_seconds(seconds)
}

/// Does a gesture in a scene of foxes. Returns the text before it and after it.
pub(super) fn gesture(
    actions: &str,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) -> (String, Result<String, GestureRefusal>) {
    let text = fox_script(actions);
    let script = read(&text);
    let plan = planned(&text, &assets(&fox()));
    let new = act(&GestureScene { script: &script, plan: &plan });
    (text, new)
}

/// Returns the lines after the first that differ, as the gesture left them.
pub(super) fn changed(
    actions: &str,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) -> Vec<String> {
    let (old, new) = gesture(actions, act);
    let new = new.unwrap_or_else(|refusal| panic!("{refusal}"));
    planned(&new, &assets(&fox()));
    let old: Vec<&str> = old.lines().collect();
    new.lines().filter(|line| !old.contains(line)).map(|line| line.trim().to_owned()).collect()
}

pub(super) fn called(scene: &GestureScene<'_>, id: &str) -> usize {
    scene.script.action_called(id).unwrap()
}

pub(super) fn moved(scene: &GestureScene<'_>, id: &str, to: f64) -> Result<String, GestureRefusal> {
    move_clip(scene, called(scene, id), seconds(to), SequenceOrder::Keep, Followers::Follow)
}

pub(super) const PAR: &str = "<par id=\"all\" begin=\"1\">\n  <!-- looks -->\n  <play id=\"a\" who=\"anna\" take=\"Survey\"/>\n  <play id=\"b\" who=\"ben\" take=\"Walk\" begin=\"a.end-12f\"/>\n</par>";

const SEQ: &str = "<seq>\n  <play id=\"a\" who=\"anna\" take=\"Walk\" repeat=\"2\"/>\n  <play id=\"b\" who=\"anna\" take=\"Survey\" fade-in=\"6f\"/>\n  <play id=\"c\" who=\"anna\" take=\"Run\" begin=\"0.5\"/>\n</seq>";

#[test]
fn a_clip_moved_in_a_par_gets_a_begin_after_that_of_the_par() {
    assert_eq!(
        changed(PAR, |scene| moved(scene, "a", 3.25)),
        [r#"<play id="a" who="anna" take="Survey" begin="2.25"/>"#]
    );
    // Nothing is written for the time at which it begins anyway.
    let (old, new) = gesture(PAR, |scene| moved(scene, "a", 1.0));
    assert_eq!(new.unwrap(), old);
    // A twenty-fourth of a second is a frame.
    let line = changed(PAR, |scene| moved(scene, "a", 1.0 + 1.0 / 24.0));
    assert_eq!(line, [r#"<play id="a" who="anna" take="Survey" begin="1f"/>"#]);
}

#[test]
fn a_clip_is_stretched_to_an_end_by_its_speed_unless_something_else_decides_about_that() {
    let stretched =
        |actions: &str, to: f64| changed(actions, |scene| stretch_to(scene, called(scene, "a"), seconds(to)));
    // The way is 5 m long: its speed is in meters per second, whatever its take walks.
    let walk = r#"<move id="a" who="anna" path="aisle" take="Walk" begin="1"/>"#;
    assert_eq!(
        stretched(walk, 11.0),
        [r#"<move id="a" who="anna" path="aisle" take="Walk" begin="1" speed="0.5"/>"#]
    );
    let fast = r#"<move id="a" who="anna" path="aisle" speed="5"/>"#;
    assert_eq!(stretched(fast, 2.0), [r#"<move id="a" who="anna" path="aisle" speed="2.5"/>"#]);
    // From 1 0 2 to 4 0 0, less the gap.
    let to = r#"<move id="a" who="anna" to="4 0 2" speed="3"/>"#;
    assert_eq!(stretched(to, 2.0), [r#"<move id="a" who="anna" to="4 0 2" speed="1.5"/>"#]);
    let run = r#"<play id="a" who="anna" take="Run" speed="-2" repeat="3"/>"#;
    let (_, plan) = (read(&fox_script(run)), planned(&fox_script(run), &assets(&fox())));
    let length = plan.schedule().times()[1].end.seconds();
    assert_eq!(
        stretched(run, 2.0 * length),
        [r#"<play id="a" who="anna" take="Run" speed="-1" repeat="3"/>"#]
    );
    for (actions, reason) in [
        (walk.replace("begin", "dur=\"3\" begin"), "Its `dur` decides"),
        (walk.replace("begin=\"1\"", "end=\"3\""), "Its `end` decides"),
        (run.replace("repeat=\"3\"", "repeat=\"fill\""), "as long as there is time"),
        ("<look id=\"a\" who=\"anna\" at=\"ben\" bones=\"b_Head_05\"/>".to_owned(), "<look> has no speed"),
    ] {
        let (_, refused) = gesture(&actions, |scene| stretch_to(scene, called(scene, "a"), seconds(9.0)));
        let refused = refused.expect_err("a refusal").0;
        assert!(refused.contains(reason), "{actions}: {refused}");
    }
}

#[test]
fn what_follows_a_dragged_clip_and_what_refers_to_it_moves_along() {
    let all = "<seq>\n  <play id=\"a\" who=\"anna\" take=\"Walk\"/>\n  <play id=\"b\" who=\"anna\" take=\"Survey\"/>\n  <play id=\"c\" who=\"anna\" take=\"Run\"/>\n</seq>\n<play id=\"d\" who=\"ben\" take=\"Walk\" begin=\"b.begin+1\"/>\n<play id=\"e\" who=\"ben\" take=\"Walk\" begin=\"b.end\"/>\n<title id=\"f\" text=\"x\" begin=\"3\" end=\"d.end\"/>";
    let text = fox_script(all);
    let script = read(&text);
    let plan = planned(&text, &assets(&fox()));
    let scene = GestureScene { script: &script, plan: &plan };
    let along = |part: MovedPart, followers: Followers| {
        let moved = moved_along(&scene, &[called(&scene, "b")], part, followers);
        let mut found = String::new();
        for id in ["a", "b", "c", "d", "e", "f"] {
            let action = called(&scene, id);
            found += if moved.begin(action) { id } else { "" };
            found += &if moved.end(action) { id.to_uppercase() } else { String::new() };
        }
        found
    };
    assert_eq!(along(MovedPart::Whole, Followers::Follow), "bBcCdDeEF");
    assert_eq!(along(MovedPart::Whole, Followers::Stay), "bBdDeEF");
    assert_eq!(along(MovedPart::End, Followers::Follow), "BcCeE");
    assert_eq!(along(MovedPart::End, Followers::Stay), "BeE");
    assert_eq!(along(MovedPart::Begin, Followers::Follow), "bdDF");
    assert_eq!(along(MovedPart::Neither, Followers::Follow), "bB");
}

#[test]
fn a_clip_that_begins_with_another_keeps_that_reference_and_its_unit() {
    let begin = |scene: &GestureScene<'_>| scene.plan.schedule().times()[called(scene, "b")].begin;
    let line = changed(PAR, |scene| {
        let to = begin(scene) + seconds(0.25);
        move_clip(scene, called(scene, "b"), to, SequenceOrder::Change, Followers::Follow)
    });
    assert_eq!(line, [r#"<play id="b" who="ben" take="Walk" begin="a.end-6f"/>"#]);
    let line = changed(PAR, |scene| {
        let to = begin(scene) + seconds(0.5);
        move_clip(scene, called(scene, "b"), to, SequenceOrder::Change, Followers::Follow)
    });
    assert_eq!(line, [r#"<play id="b" who="ben" take="Walk" begin="a.end"/>"#]);
}

#[test]
fn what_follows_in_a_seq_moves_along_or_stays() {
    let begin = |scene: &GestureScene<'_>| scene.plan.schedule().times()[called(scene, "b")].begin;
    let by = |scene: &GestureScene<'_>, followers| {
        move_clip(scene, called(scene, "b"), begin(scene) + seconds(0.25), SequenceOrder::Keep, followers)
    };
    let follow = changed(SEQ, |scene| by(scene, Followers::Follow));
    assert_eq!(follow, [r#"<play id="b" who="anna" take="Survey" fade-in="6f" begin="0.25"/>"#]);
    let stay = changed(SEQ, |scene| by(scene, Followers::Stay));
    assert_eq!(stay.len(), 2);
    assert_eq!(stay[1], r#"<play id="c" who="anna" take="Run" begin="0.25"/>"#);
}

#[test]
fn a_clip_whose_middle_passes_that_of_its_neighbor_changes_places_with_it() {
    let text = |to: f64, id: &str| {
        let (_, new) = gesture(SEQ, |scene| {
            let to = scene.plan.schedule().times()[called(scene, id)].begin + seconds(to);
            move_clip(scene, called(scene, id), to, SequenceOrder::Change, Followers::Follow)
        });
        let new = new.unwrap();
        let place = |id: &str| new.find(&format!("id=\"{id}\"")).unwrap();
        let mut order = ["a", "b", "c"];
        order.sort_by_key(|id| place(id));
        (order.concat(), new)
    };
    assert_eq!(text(0.3, "a").0, "abc");
    assert_eq!(text(2.6, "a").0, "bac");
    assert_eq!(text(-3.5, "b").0, "bac");
    let (order, new) = text(-6.0, "c");
    assert_eq!(order, "cab");
    assert!(
        new.contains(r#"<play id="c" who="anna" take="Run"/>"#),
        "the distance to the one before is gone: {new}"
    );
}

/// Returns the bits of the scene at some times in `part`.
fn poses(text: &str, part: [f64; 2]) -> Vec<Vec<u32>> {
    let plan = planned(text, &assets(&fox()));
    (0..=10).map(|step| bits(&at(&plan, part[0] + (part[1] - part[0]) * f64::from(step) / 10.0))).collect()
}

#[test]
fn a_trimmed_start_leaves_the_poses_of_the_rest_as_they_are() {
    for clip in [
        r#"<play id="x" who="anna" take="Survey"/>"#,
        r#"<play id="x" who="anna" take="Survey" speed="2" from="0.5"/>"#,
        r#"<play id="x" who="anna" take="Survey" speed="-0.5" to="2"/>"#,
        r#"<play id="x" who="anna" take="Survey" dur="1.5"/>"#,
    ] {
        let (old, new) =
            gesture(&format!("<seq>\n{clip}\n<play who=\"anna\" take=\"Run\"/>\n</seq>"), |scene| {
                trim_start(scene, called(scene, "x"), seconds(0.75))
            });
        let new = new.unwrap();
        assert_ne!(old, new);
        assert_eq!(poses(&old, [0.76, 3.0]), poses(&new, [0.76, 3.0]), "{new}");
    }
}

#[test]
fn a_start_cannot_be_trimmed_beyond_the_take_or_its_end() {
    let refusal = |clip: &str, to: f64| {
        gesture(clip, |scene| trim_start(scene, called(scene, "x"), seconds(to))).1.unwrap_err().to_string()
    };
    let clip = r#"<play id="x" who="anna" take="Survey" begin="1"/>"#;
    assert_eq!(refusal(clip, 0.5), "The take has nothing more there");
    assert_eq!(refusal(clip, 9.0), "It would have no length");
}

#[test]
fn a_trimmed_end_cuts_the_take_and_repeats_it_beyond_its_end() {
    let clip = r#"<play id="x" who="anna" take="Survey"/>"#;
    let end = |clip: &str, to: f64| {
        changed(clip, |scene| trim_end(scene, called(scene, "x"), seconds(to), Followers::Follow))
    };
    assert_eq!(end(clip, 1.5), [r#"<play id="x" who="anna" take="Survey" to="1.5"/>"#]);
    let backwards = r#"<play id="x" who="anna" take="Survey" speed="-1" to="3"/>"#;
    assert_eq!(
        end(backwards, 1.0),
        [r#"<play id="x" who="anna" take="Survey" speed="-1" to="3" from="2"/>"#]
    );
    let long = end(clip, 6.8333333);
    assert_eq!(long, [r#"<play id="x" who="anna" take="Survey" repeat="2"/>"#]);
    let (old, _) = gesture(clip, |scene| Ok(scene.script.tree().text().to_string()));
    let back = changed(&clip.replace("/>", " to=\"1\"/>"), |scene| {
        let length = scene.plan.things()[0].model.as_ref().unwrap().takes()[0].length();
        trim_end(scene, called(scene, "x"), length, Followers::Follow)
    });
    assert_eq!(back, [clip], "the whole take needs no end: {old}");
}

#[test]
fn ends_that_the_script_gives_stay_what_they_are() {
    let scene = "<seq>\n<play id=\"a\" who=\"ben\" take=\"Survey\"/>\n</seq>\n<play id=\"x\" who=\"anna\" take=\"Survey\" repeat=\"fill\" end=\"a.end\"/>\n<look id=\"y\" who=\"anna\" at=\"ben\" bones=\"b_Head_05\" dur=\"24f\"/>\n<shot id=\"s\" who=\"wide\"/>";
    let trim = |id: &'static str, to: f64| {
        move |scene: &GestureScene<'_>| trim_end(scene, called(scene, id), seconds(to), Followers::Follow)
    };
    assert_eq!(
        changed(scene, trim("x", 82.0 / 24.0 - 0.5 + 1e-4)),
        [r#"<play id="x" who="anna" take="Survey" repeat="fill" end="a.end-0.5"/>"#]
    );
    assert_eq!(
        changed(scene, trim("y", 0.5)),
        [r#"<look id="y" who="anna" at="ben" bones="b_Head_05" dur="12f"/>"#]
    );
    let refusal = gesture(scene, trim("s", 1.0)).1.unwrap_err();
    assert_eq!(refusal.to_string(), "A shot ends where the next one begins");
}

#[test]
fn fades_speeds_and_repetitions_are_attributes_that_are_absent_where_they_are_the_default() {
    let of = |act: &dyn Fn(&GestureScene<'_>, usize) -> Result<String, GestureRefusal>| {
        changed(SEQ, |scene| act(scene, called(scene, "b"))).pop().unwrap_or_default()
    };
    assert_eq!(
        of(&|s, b| set_fade(s, b, FadeEnd::In, StageTime::ZERO)),
        r#"<play id="b" who="anna" take="Survey"/>"#
    );
    assert_eq!(
        of(&|s, b| set_fade(s, b, FadeEnd::In, seconds(0.5))),
        r#"<play id="b" who="anna" take="Survey" fade-in="12f"/>"#
    );
    assert_eq!(
        of(&|s, b| set_fade(s, b, FadeEnd::Out, seconds(0.5))),
        r#"<play id="b" who="anna" take="Survey" fade-in="6f" fade-out="0.5"/>"#
    );
    assert_eq!(
        of(&|s, b| set_speed(s, b, -1.5)),
        r#"<play id="b" who="anna" take="Survey" fade-in="6f" speed="-1.5"/>"#
    );
    assert_eq!(of(&|s, b| set_speed(s, b, 1.0)), "");
    let last = changed(SEQ, |scene| set_repeat(scene, called(scene, "c"), StageRepeat::Fill));
    assert_eq!(last, [r#"<play id="c" who="anna" take="Run" begin="0.5" repeat="fill"/>"#]);
    let refused = |act: &dyn Fn(&GestureScene<'_>, usize) -> Result<String, GestureRefusal>| {
        gesture(SEQ, |scene| act(scene, called(scene, "b"))).1.unwrap_err().to_string()
    };
    assert_eq!(
        refused(&|s, b| set_speed(s, b, 0.0)),
        "The speed has to be a number other than 0; below 0 plays backwards"
    );
    assert_eq!(refused(&|s, b| set_speed(s, b, f64::NAN)), "The speed is too large");
    assert!(refused(&|s, b| set_repeat(s, b, StageRepeat::Fill)).starts_with("this time depends on itself"));
    assert_eq!(refused(&|s, _| set_speed(s, 1, 1.0)), "<seq> has no speed");
}

#[test]
fn a_clip_that_others_refer_to_is_not_deleted_and_one_that_is_deleted_leaves_no_gap_unless_asked() {
    let refusal =
        gesture(PAR, |scene| delete_clip(scene, called(scene, "a"), Followers::Follow)).1.unwrap_err();
    assert_eq!(refusal.to_string(), "<play id=\"b\"> (line 5) depends on it: change that first");
    let (old, new) = gesture(SEQ, |scene| delete_clip(scene, called(scene, "b"), Followers::Follow));
    assert_eq!(
        new.unwrap(),
        old.replace("  <play id=\"b\" who=\"anna\" take=\"Survey\" fade-in=\"6f\"/>\n", "")
    );
    let (old, new) = gesture(SEQ, |scene| delete_clip(scene, called(scene, "b"), Followers::Stay));
    let begin = |text: &str| {
        let plan = planned(text, &assets(&fox()));
        plan.schedule().times()[read(text).action_called("c").unwrap()].begin
    };
    let moved = (begin(&old) - begin(&new.unwrap())).seconds();
    assert!((0.0..0.001).contains(&moved), "it stays, up to a millisecond: {moved}");
}

#[test]
fn a_duplicate_begins_where_the_original_ends() {
    for actions in [PAR, SEQ] {
        for id in ["a", "b"] {
            let (old, new) = gesture(actions, |scene| duplicate_clip(scene, called(scene, id)));
            let (new, copy) = (new.unwrap(), format!("{id}-2"));
            let times = |text: &str, id: &str| {
                planned(text, &assets(&fox())).schedule().times()[read(text).action_called(id).unwrap()]
            };
            let apart = (times(&old, id).end - times(&new, &copy).begin).seconds();
            assert!((0.0..0.001).contains(&apart), "{apart}: {new}");
        }
    }
}

#[test]
fn a_cut_inserts_a_shot_after_the_one_that_is_seen() {
    let shots = "<par>\n  <shot who=\"wide\" begin=\"0\"/>\n  <play who=\"anna\" take=\"Survey\"/>\n</par>";
    let cut =
        |camera: &'static str, at: f64| move |scene: &GestureScene<'_>| cut_to(scene, camera, seconds(at));
    assert_eq!(changed(shots, cut("close", 1.5)), [r#"<shot who="close" begin="1.5"/>"#]);
    assert_eq!(
        changed(shots, cut("close", 0.0)),
        [r#"<shot who="close" begin="0"/>"#],
        "another camera for the shot of that time"
    );
    let refusal = |camera, at| gesture(shots, cut(camera, at)).1.unwrap_err().to_string();
    assert_eq!(refusal("wide", 1.0), "\"wide\" is seen at that time already");
    assert_eq!(refusal("anna", 1.0), "\"anna\" is no camera of the cast");
    // Without any action, and in a script whose shots are in a sequence.
    let (_, new) = gesture("", cut("close", 2.0));
    assert!(new.unwrap().contains("</cast><shot who=\"close\" begin=\"2\"/>\n"));
    let nested = "<seq begin=\"1\">\n  <shot who=\"wide\"/>\n</seq>";
    let (_, new) = gesture(nested, cut("close", 3.0));
    let new = new.unwrap();
    let plan = planned(&new, &assets(&fox()));
    let seen = |time| at(&plan, time).camera.map(|camera| plan.things()[camera.thing].id.to_string());
    assert_eq!([seen(2.9), seen(3.0)].map(Option::unwrap), ["wide", "close"], "{new}");
}

#[test]
fn a_new_clip_continues_the_sequence_of_its_role_or_begins_in_a_par() {
    let add =
        |who: &'static str, at: f64| move |scene: &GestureScene<'_>| add_clip(scene, who, "Run", seconds(at));
    let (_, new) = gesture(SEQ, add("anna", 9.0));
    let new = new.unwrap();
    let plan = planned(&new, &assets(&fox()));
    let script = read(&new);
    assert_eq!(script.actions()[1].children.len(), 4, "{new}");
    let begin = plan.schedule().times()[5].begin.seconds();
    assert!((8.999..=9.0).contains(&begin), "{begin}");
    assert_eq!(changed(SEQ, add("ben", 0.25)), [r#"<play who="ben" take="Run" begin="0.25"/>"#]);
    assert_eq!(
        gesture(SEQ, add("wide", 0.0)).1.unwrap_err().to_string(),
        "\"wide\" is a camera; only roles and props play takes"
    );
}

#[test]
fn what_is_attached_begins_to_be_held_at_that_time() {
    let line = changed(SEQ, |scene| attach_thing(scene, "sword", "anna.b_Head_05", seconds(1.5)));
    assert_eq!(line, [r#"<attach who="sword" to="anna.b_Head_05" begin="1.5"/>"#]);
    let refusal =
        gesture(SEQ, |scene| attach_thing(scene, "anna", "anna.b_Head_05", StageTime::ZERO)).1.unwrap_err();
    assert_eq!(refusal.to_string(), "A thing cannot hold itself");
}

#[test]
fn a_thing_is_dragged_by_its_place_in_the_cast_or_by_the_last_place() {
    let scenes = [
        "<move who=\"anna\" path=\"aisle\" take=\"Walk\" begin=\"5\"/>",
        "<place who=\"anna\" at=\"1 0 1\" facing=\"0\" begin=\"0.5\"/>",
    ];
    for actions in scenes {
        let (old, new) =
            gesture(actions, |scene| place_thing(scene, "anna", seconds(1.0), DVec3::new(2.5, 0.0, -0.1234)));
        let new = new.unwrap();
        assert_eq!(old.lines().zip(new.lines()).filter(|(old, new)| old != new).count(), 1);
        let place = planned(&new, &assets(&fox())).placement(0, seconds(1.0)).unwrap();
        assert!((place.position - DVec3::new(2.5, 0.0, -0.123)).length() < 1e-9, "{new}");
        let (_, new) = gesture(actions, |scene| face_thing(scene, "anna", seconds(1.0), 270.0));
        let place = planned(&new.unwrap(), &assets(&fox())).placement(0, seconds(1.0)).unwrap();
        assert!((place.facing.to_degrees() + 90.0).abs() < 1e-9, "{}", place.facing.to_degrees());
    }
}

/// Does a random gesture.
fn random_gesture(
    random: &mut Random,
    scene: &GestureScene<'_>,
    action: usize,
) -> (&'static str, Result<String, GestureRefusal>) {
    let time = seconds(random.below(200) as f64 / 24.0);
    let followers = random.choice(&[Followers::Follow, Followers::Stay]);
    let order = random.choice(&[SequenceOrder::Keep, SequenceOrder::Change]);
    match random.below(12) {
        0..=2 => ("move", move_clip(scene, action, time, order, followers)),
        3 => ("start", trim_start(scene, action, time)),
        4 => ("end", trim_end(scene, action, time, followers)),
        5 => ("fade", set_fade(scene, action, random.choice(&[FadeEnd::In, FadeEnd::Out]), time)),
        6 => ("speed", set_speed(scene, action, random.below(9) as f64 / 2.0 - 2.0)),
        7 => ("repeat", set_repeat(scene, action, StageRepeat::Times(Decimal::parse("2.5").unwrap()))),
        8 => ("delete", delete_clip(scene, action, followers)),
        9 => ("duplicate", duplicate_clip(scene, action)),
        10 => ("cut", cut_to(scene, random.choice(&["wide", "close"]), time)),
        _ => ("add", add_clip(scene, random.choice(&["anna", "ben"]), "Survey", time)),
    }
}

#[test]
fn random_gestures_leave_valid_scripts_and_their_inverses_lead_back_to_the_first_text() {
    let first = seed(1);
    println!("seed {first}");
    let model = fox();
    let assets: StageAssets = assets(&model);
    let (mut done, mut refused, mut scripts) = (std::collections::BTreeMap::<&str, usize>::new(), 0, 0);
    let (mut included, mut foreign) = (0, 0);
    let mut at = first;
    while scripts < 250 {
        at += 1;
        let mut random = Random::new(at);
        // Half of them include a part of themselves.
        let script = random_scripts::script(at);
        let cut = at.is_multiple_of(2).then(|| cut_out(&script, &mut random)).flatten();
        let (text, part) = cut.map_or((script, None), |(_, include, part)| (include, Some(part)));
        let with_survey = |text: String| {
            let takes = ["PickUp", "Slash", "Idle", "Fall"];
            takes.iter().fold(text, |text, take| text.replace(&format!("\"{take}\""), "\"Survey\""))
        };
        let (mut text, part) = (with_survey(text), part.map(with_survey));
        let files: Vec<(&str, &str)> = part.as_deref().map(|part| ("part.xml", part)).into_iter().collect();
        let original = text.clone();
        let mut inverses: Vec<TextSplice> = Vec::new();
        for _ in 0..12 {
            let Ok(script) = including(&text, &files) else { break };
            let Ok(plan) = StagePlan::new(&script, &assets) else { break };
            let scene = GestureScene { script: &script, plan: &plan };
            let lanes = SceneLanes::new(&script, &plan);
            assert!(
                lanes.list.iter().all(|lane| lane.bars.iter().all(|bar| bar.row < lane.rows)),
                "seed {at}"
            );
            let action = 1 + random.below(script.actions().len() - 1);
            let is_foreign = action < script.actions().len() && script.element(action).is_included();
            match random_gesture(&mut random, &scene, action) {
                (name, Ok(new)) => {
                    assert!(
                        !is_foreign || matches!(name, "cut" | "add"),
                        "seed {at} {name}: {}",
                        script.element(action).row.name
                    );
                    included += usize::from(part.is_some());
                    let script = including(&new, &files)
                        .unwrap_or_else(|errors| panic!("seed {at} {name}: {}\n{new}", errors[0]));
                    if let Err(errors) = StagePlan::new(&script, &assets) {
                        panic!("seed {at} {name}: {}\n{text}\n{new}", errors[0]);
                    }
                    inverses.extend(TextSplice::between(&new, &text));
                    *done.entry(name).or_default() += 1;
                    text = new;
                }
                (name, Err(GestureRefusal(reason))) => {
                    assert!(!reason.is_empty() && !reason.ends_with('.'), "{reason}");
                    if is_foreign && !matches!(name, "cut" | "add") {
                        assert!(
                            reason.ends_with(" is in part.xml: open it to change it"),
                            "seed {at} {name}: {reason}"
                        );
                        foreign += 1;
                    }
                    refused += 1;
                }
            }
        }
        scripts += usize::from(!inverses.is_empty());
        for inverse in inverses.iter().rev() {
            text.replace_range(inverse.range.clone(), &inverse.text);
        }
        assert_eq!(text, original, "seed {at}");
    }
    println!(
        "{done:?}, {refused} refused; {included} in scripts that include, {foreign} refused in a file of theirs"
    );
    assert!(included > 100 && foreign > 50, "{included} {foreign}");
    assert!(done.len() == 10 && done.values().all(|&count| count > 15), "{done:?}");
}
