//! Clips of one lane: mixes where they overlap, several at once, copies, other lanes.

use super::actors::{assets, at, bits, fox, fox_script, planned};
use super::gestures::{called, changed, gesture, moved};
use super::read;
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureScene, SequenceOrder, add_clip, copied_clips, delete_clip, delete_clips,
    duplicate_clip, duplicate_clips, move_clips, move_to_lane, paste_clips, set_fade, set_repeat, set_speed,
    trim_end, trim_start,
};
use dragonfly_anim::stage::lanes::{SceneLanes, Takeover};
use dragonfly_anim::stage::script::StageRepeat;
use dragonfly_anim::stage::time::{Decimal, StageTime};

fn seconds(seconds: f64) -> StageTime {
    StageTime::from_seconds(seconds)
}

const TWO: &str = "<par>\n  <play id=\"a\" who=\"anna\" take=\"Survey\" to=\"2\"/>\n  <play id=\"b\" who=\"anna\" take=\"Survey\" begin=\"3\"/>\n</par>";

/// Returns the script after a gesture in a script.
fn after(
    text: &str,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, dragonfly_anim::stage::gesture::GestureRefusal>,
) -> String {
    let (script, plan) = (read(text), planned(text, &assets(&fox())));
    let new =
        act(&GestureScene { script: &script, plan: &plan }).unwrap_or_else(|refusal| panic!("{refusal}"));
    planned(&new, &assets(&fox()));
    new
}

fn line_of(text: &str, id: &str) -> String {
    text.lines().find(|line| line.contains(&format!("id=\"{id}\""))).unwrap_or_default().trim().to_owned()
}

#[test]
fn a_clip_that_is_moved_over_the_one_before_mixes_with_it_for_as_long_as_they_overlap() {
    assert_eq!(
        changed(TWO, |scene| moved(scene, "b", 1.5)),
        [r#"<play id="b" who="anna" take="Survey" begin="1.5" fade-in="0.5"/>"#]
    );
    // The fade follows the overlap, and is gone with it.
    let text = after(&fox_script(TWO), |scene| moved(scene, "b", 1.5));
    let nearer = after(&text, |scene| moved(scene, "b", 1.25));
    assert_eq!(
        line_of(&nearer, "b"),
        r#"<play id="b" who="anna" take="Survey" begin="1.25" fade-in="0.75"/>"#
    );
    let apart = after(&nearer, |scene| moved(scene, "b", 3.0));
    assert_eq!(apart, fox_script(TWO));
}

#[test]
fn a_fade_of_another_length_stays_while_the_overlap_changes() {
    let text = after(&fox_script(TWO), |scene| moved(scene, "b", 1.5));
    let own = after(&text, |scene| set_fade(scene, called(scene, "b"), FadeEnd::In, seconds(0.2)));
    let moved_on = after(&own, |scene| moved(scene, "b", 1.25));
    assert_eq!(
        line_of(&moved_on, "b"),
        r#"<play id="b" who="anna" take="Survey" begin="1.25" fade-in="0.2"/>"#
    );
    // Without an overlap a fade is a mix with what the one before holds: it is no length of an overlap.
    let apart = TWO.replace("begin=\"3\"", "begin=\"3\" fade-in=\"0.4\"");
    assert_eq!(
        changed(&apart, |scene| moved(scene, "b", 1.5)),
        [r#"<play id="b" who="anna" take="Survey" begin="1.5" fade-in="0.4"/>"#]
    );
    // A cut that the text has stays a cut.
    let cut = TWO.replace("begin=\"3\"", "begin=\"1\"");
    assert_eq!(
        changed(&cut, |scene| moved(scene, "b", 1.5)),
        [r#"<play id="b" who="anna" take="Survey" begin="1.5"/>"#]
    );
}

#[test]
fn trimmed_ends_and_starts_mix_too_and_other_lanes_and_layers_do_not() {
    assert_eq!(
        changed(TWO, |scene| trim_end(scene, called(scene, "a"), seconds(3.25), Followers::Follow)),
        [
            r#"<play id="a" who="anna" take="Survey" to="3.25"/>"#,
            r#"<play id="b" who="anna" take="Survey" begin="3" fade-in="0.25"/>"#
        ]
    );
    let later = TWO.replace("begin=\"3\"", "begin=\"3\" from=\"1.5\"");
    assert_eq!(
        changed(&later, |scene| trim_start(scene, called(scene, "b"), seconds(1.75))),
        [r#"<play id="b" who="anna" take="Survey" begin="1.75" from="0.25" fade-in="0.25"/>"#]
    );
    for (old, new) in
        [("id=\"b\" who=\"anna\"", "id=\"b\" who=\"ben\""), ("begin=\"3\"", "begin=\"3\" layer=\"top\"")]
    {
        let other = TWO.replace(old, new);
        let line = changed(&other, |scene| moved(scene, "b", 1.5)).concat();
        assert!(line.contains("begin=\"1.5\"") && !line.contains("fade-in"), "{line}");
    }
}

#[test]
fn a_fade_follows_an_overlap_whatever_changes_it() {
    let text = after(&fox_script(TWO), |scene| moved(scene, "b", 1.5));
    let b = |new: &str| line_of(new, "b");
    let slower = after(&text, |scene| set_speed(scene, called(scene, "a"), 0.8));
    assert_eq!(b(&slower), r#"<play id="b" who="anna" take="Survey" begin="1.5" fade-in="1"/>"#);
    let twice = StageRepeat::Times(Decimal::parse("2").unwrap());
    let longer = after(&text, |scene| set_repeat(scene, called(scene, "a"), twice));
    assert_eq!(b(&longer), r#"<play id="b" who="anna" take="Survey" begin="1.5" fade-in="2.5"/>"#);
    let alone = r#"<play id="b" who="anna" take="Survey" begin="1.5"/>"#;
    assert_eq!(b(&after(&text, |scene| delete_clip(scene, called(scene, "a"), Followers::Follow))), alone);
    let more = text.replace("</par>", "<wait id=\"w\" dur=\"1\"/></par>");
    let two = |scene: &GestureScene<'_>| [called(scene, "a"), called(scene, "w")];
    assert_eq!(b(&after(&more, |scene| delete_clips(scene, &two(scene), Followers::Follow))), alone);
    // A copy begins when the original ends, and overlaps nothing.
    let copied = after(&text, |scene| duplicate_clip(scene, called(scene, "b")));
    assert_eq!(b(&copied), b(&text));
    assert_eq!(line_of(&copied, "b-2"), r#"<play id="b-2" who="anna" take="Survey" begin="4.916"/>"#);
}

#[test]
fn fades_follow_overlaps_in_the_lanes_of_other_things_and_of_ways() {
    let actions = "<play id=\"p\" who=\"ben\" take=\"Survey\" to=\"2\"/>\n<play id=\"q\" who=\"ben\" take=\"Survey\" begin=\"k.end\"/>\n\
                   <play id=\"k\" who=\"anna\" take=\"Survey\" to=\"1\" begin=\"2\"/>";
    let text = after(&fox_script(actions), |scene| moved(scene, "k", 0.5));
    assert_eq!(line_of(&text, "q"), r#"<play id="q" who="ben" take="Survey" begin="k.end" fade-in="0.5"/>"#);
    // The way is 5 m long.
    let actions = "<move id=\"m\" who=\"ben\" path=\"aisle\" take=\"Walk\" speed=\"2.5\"/>\n\
                   <play id=\"q\" who=\"ben\" take=\"Survey\" begin=\"1.5\" fade-in=\"0.5\"/>";
    let slower = after(&fox_script(actions), |scene| set_speed(scene, called(scene, "m"), 2.0));
    assert_eq!(line_of(&slower, "q"), r#"<play id="q" who="ben" take="Survey" begin="1.5" fade-in="1"/>"#);
}

#[test]
fn lanes_say_where_clips_mix_and_where_they_cut() {
    let takeover = |actions: &str| {
        let text = fox_script(actions);
        let (script, plan) = (read(&text), planned(&text, &assets(&fox())));
        let lanes = SceneLanes::new(&script, &plan);
        lanes.bar_of(script.action_called("b").unwrap()).unwrap().1.takeover
    };
    assert_eq!(takeover(TWO), Takeover::After);
    let cut = TWO.replace("begin=\"3\"", "begin=\"1.5\"");
    assert_eq!(takeover(&cut), Takeover::Cut);
    let mixed = TWO.replace("begin=\"3\"", "begin=\"1.5\" fade-in=\"0.25\"");
    assert_eq!(takeover(&mixed), Takeover::Mix(seconds(1.75)));
    // The one before ends during the fade.
    let long = TWO.replace("begin=\"3\"", "begin=\"1.5\" fade-in=\"1\"");
    assert_eq!(takeover(&long), Takeover::Mix(seconds(2.0)));
    // The pose is a mix exactly there: it is that of b alone where the lanes end the mix, and not before.
    let alone = fox_script(
        &TWO.replace("begin=\"3\"", "begin=\"1.5\"").replace("to=\"2\"", "to=\"2\" speed=\"0.9\""),
    );
    let with = alone.replace("begin=\"1.5\"", "begin=\"1.5\" fade-in=\"0.25\"");
    let pose = |text: &str, time: f64| bits(&at(&planned(text, &assets(&fox())), time));
    assert_ne!(pose(&alone, 1.7), pose(&with, 1.7));
    assert_eq!(pose(&alone, 1.75), pose(&with, 1.75));
}

/// The second clip begins after the first one, and is shorter.
const SHORT: &str = "<par>\n  <play id=\"a\" who=\"anna\" take=\"Survey\"/>\n  <play id=\"b\" who=\"anna\" take=\"Run\" to=\"1\" begin=\"4\"/>\n  <play id=\"c\" who=\"anna\" take=\"Walk\" begin=\"6\"/>\n</par>";

#[test]
fn a_clip_that_is_moved_inside_of_another_one_fades_in_and_out_and_no_longer_once_it_is_outside() {
    let line = |begin: &str, fades: &str| {
        format!(r#"<play id="b" who="anna" take="Run" to="1" begin="{begin}"{fades}/>"#)
    };
    let inside = after(&fox_script(SHORT), |scene| moved(scene, "b", 1.0));
    assert_eq!(line_of(&inside, "b"), line("1", r#" fade-in="0.25" fade-out="0.25""#));
    let further = after(&inside, |scene| moved(scene, "b", 2.0));
    assert_eq!(line_of(&further, "b"), line("2", r#" fade-in="0.25" fade-out="0.25""#));
    // Survey ends at 3.417 s: beyond it, the fade is the overlap, and the pose is held.
    let partly = after(&further, |scene| moved(scene, "b", 3.0));
    assert_eq!(line_of(&partly, "b"), line("3", r#" fade-in="0.416""#));
    let outside = after(&partly, |scene| moved(scene, "b", 4.0));
    assert_eq!(outside, fox_script(SHORT));
    // A short one fades for half of itself, and a fade that was given stays.
    let shorter =
        after(&inside, |scene| trim_end(scene, called(scene, "b"), seconds(1.2), Followers::Follow));
    assert!(line_of(&shorter, "b").contains(r#"fade-in="0.1" fade-out="0.1""#), "{shorter}");
    let own = after(&inside, |scene| set_fade(scene, called(scene, "b"), FadeEnd::Out, seconds(0.4)));
    let moved_on = after(&own, |scene| moved(scene, "b", 1.5));
    assert_eq!(line_of(&moved_on, "b"), line("1.5", r#" fade-in="0.25" fade-out="0.4""#));
    // One that ends with the other one gives nothing back.
    let last = SHORT.replace("to=\"1\" begin=\"4\"", "end=\"a.end\" begin=\"4\"");
    let last = after(&fox_script(&last), |scene| moved(scene, "b", 2.0));
    assert!(line_of(&last, "b").contains("fade-in=\"0.25\"") && !last.contains("fade-out"), "{last}");
}

#[test]
fn a_clip_dropped_inside_of_another_one_leaves_the_mix_at_its_end_as_it_is() {
    let text = after(&fox_script(SHORT), |scene| moved(scene, "c", 3.0));
    assert_eq!(line_of(&text, "c"), r#"<play id="c" who="anna" take="Walk" begin="3" fade-in="0.416"/>"#);
    let inside = after(&text, |scene| moved(scene, "b", 1.0));
    assert_eq!(line_of(&inside, "c"), line_of(&text, "c"));
    let added = after(&text, |scene| add_clip(scene, "anna", "Run", seconds(0.5)));
    assert!(added.contains(r#"take="Run" begin="0.5" fade-in="0.25" fade-out="0.25"/>"#), "{added}");
}

#[test]
fn after_a_clip_inside_of_another_one_the_pose_is_that_of_the_other_one_and_lanes_show_where_it_is_given_back()
 {
    let inside = after(&fox_script(SHORT), |scene| moved(scene, "b", 1.0));
    let alone = fox_script(SHORT);
    let pose = |text: &str, time: f64| bits(&at(&planned(text, &assets(&fox())), time));
    for time in [0.5, 0.99, 2.0, 2.5, 3.3] {
        assert_eq!(pose(&inside, time), pose(&alone, time), "{time}");
    }
    // In the middle it is that of the clip alone, as a cut shows it, and it is mixed in the fades.
    let cut = inside.replace(" fade-in=\"0.25\" fade-out=\"0.25\"", "");
    assert_eq!(pose(&inside, 1.5), pose(&cut, 1.5));
    for time in [1.1, 1.9] {
        assert!(
            pose(&inside, time) != pose(&cut, time) && pose(&inside, time) != pose(&alone, time),
            "{time}"
        );
    }
    let bar = |text: &str| {
        let (script, plan) = (read(text), planned(text, &assets(&fox())));
        let lanes = SceneLanes::new(&script, &plan);
        let (_, bar) = lanes.bar_of(script.action_called("b").unwrap()).unwrap();
        (bar.takeover, bar.hand_back)
    };
    assert_eq!(bar(&inside), (Takeover::Mix(seconds(1.25)), Some(seconds(1.75))));
    assert_eq!(bar(&cut), (Takeover::Cut, None), "it holds its last pose");
    let released = cut.replace("to=\"1\" begin=\"1\"", "to=\"1\" begin=\"1\" fill=\"release\"");
    assert_eq!(bar(&released), (Takeover::Cut, Some(seconds(2.0))));
    assert_eq!(bar(&alone), (Takeover::After, None));
    // The take of the other one is the one that plays again.
    let plan = planned(&inside, &assets(&fox()));
    let playing = |time: f64| plan.take_at(0, seconds(time)).map(|(action, _)| action);
    let script = read(&inside);
    let [a, b] = ["a", "b"].map(|id| script.action_called(id));
    assert_eq!([playing(0.5), playing(1.5), playing(2.5)], [a, b, a]);
}

const SEVERAL: &str = "<seq>\n  <play id=\"a\" who=\"anna\" take=\"Survey\" to=\"1\"/>\n  <play id=\"b\" who=\"anna\" take=\"Survey\" to=\"1\"/>\n  <play id=\"c\" who=\"anna\" take=\"Survey\" to=\"1\"/>\n  <play id=\"d\" who=\"anna\" take=\"Survey\" to=\"1\"/>\n</seq>\n<play id=\"e\" who=\"ben\" take=\"Walk\" begin=\"b.begin+0.25\"/>\n<title id=\"f\" text=\"The\" begin=\"1\" dur=\"1\"/>";

fn begins(text: &str) -> Vec<f64> {
    let (script, plan) = (read(text), planned(text, &assets(&fox())));
    let begin = |id: &&str| plan.schedule().times()[script.action_called(id).unwrap()].begin.seconds();
    ["a", "b", "c", "d", "e", "f"].iter().map(begin).collect()
}

#[test]
fn several_clips_move_by_the_same_time_whatever_depends_on_what() {
    let text = fox_script(SEVERAL);
    let by = |ids: &[&str], by: f64, followers| {
        let new = after(&text, |scene| {
            let actions: Vec<usize> = ids.iter().map(|id| called(scene, id)).collect();
            move_clips(scene, &actions, seconds(by), SequenceOrder::Keep, followers)
        });
        begins(&new)
    };
    assert_eq!(begins(&text), [0.0, 1.0, 2.0, 3.0, 1.25, 1.0]);
    // A selected action that depends on another one moves once.
    assert_eq!(by(&["b", "e", "f"], 0.5, Followers::Follow), [0.0, 1.5, 2.5, 3.5, 1.75, 1.5]);
    assert_eq!(by(&["b", "e", "f"], 0.5, Followers::Stay), [0.0, 1.5, 2.0, 3.0, 1.75, 1.5]);
    assert_eq!(by(&["b", "c"], 0.5, Followers::Stay), [0.0, 1.5, 2.5, 3.0, 1.75, 1.0]);
    assert_eq!(by(&["b", "d"], 0.5, Followers::Stay), [0.0, 1.5, 2.0, 3.5, 1.75, 1.0]);
    assert_eq!(by(&["b", "d"], 0.5, Followers::Follow), [0.0, 1.5, 2.5, 3.5, 1.75, 1.0]);
    // The first one stops at zero, the others keep their distance.
    assert_eq!(by(&["e", "f"], -5.0, Followers::Follow), [0.0, 1.0, 2.0, 3.0, 0.25, 0.0]);
}

#[test]
fn several_clips_are_deleted_together_also_those_that_refer_to_each_other() {
    let delete = |ids: &[&str], followers| {
        gesture(SEVERAL, |scene| {
            let actions: Vec<usize> = ids.iter().map(|id| called(scene, id)).collect();
            delete_clips(scene, &actions, followers)
        })
        .1
    };
    let text = delete(&["b", "e"], Followers::Follow).unwrap();
    assert!(!text.contains("id=\"b\"") && !text.contains("id=\"e\""));
    assert_eq!(fox_script(SEVERAL).lines().count() - text.lines().count(), 2);
    let refusal = delete(&["b", "c"], Followers::Follow).unwrap_err().to_string();
    assert!(refusal.starts_with("<play id=\"e\">"), "{refusal}");
    let text = delete(&["b", "c", "e"], Followers::Stay).unwrap();
    assert_eq!(line_of(&text, "d"), r#"<play id="d" who="anna" take="Survey" to="1" begin="2"/>"#);
    let two = delete(&["a", "c"], Followers::Stay).unwrap();
    let (script, plan) = (read(&two), planned(&two, &assets(&fox())));
    let begin = |id: &str| plan.schedule().times()[script.action_called(id).unwrap()].begin.seconds();
    assert_eq!([begin("b"), begin("d")], [1.0, 3.0]);
}

#[test]
fn copied_clips_are_inserted_at_the_playhead_also_for_another_role() {
    let text = fox_script(SEVERAL);
    let copy = |ids: &[&str]| {
        after_text(&text, |scene| {
            let actions: Vec<usize> = ids.iter().map(|id| called(scene, id)).collect();
            copied_clips(scene, &actions)
        })
    };
    let copied = copy(&["b", "d"]);
    assert_eq!(
        copied,
        "<script version=\"1\" fps=\"24\">\n  <play who=\"anna\" take=\"Survey\" to=\"1\" begin=\"0\"/>\n  <play who=\"anna\" take=\"Survey\" to=\"1\" begin=\"2\"/>\n</script>\n"
    );
    let lines = |new: &str| -> Vec<String> {
        new.lines()
            .filter(|line| !text.lines().any(|old| old == *line))
            .map(|line| line.trim().to_owned())
            .collect()
    };
    let pasted = after(&text, |scene| paste_clips(scene, &copied, seconds(6.0), None));
    assert_eq!(
        lines(&pasted),
        [
            r#"<play who="anna" take="Survey" to="1" begin="6"/>"#,
            r#"<play who="anna" take="Survey" to="1" begin="8"/>"#
        ]
    );
    let onto = after(&text, |scene| paste_clips(scene, &copied, seconds(6.0), Some("ben")));
    assert_eq!(
        lines(&onto),
        [
            r#"<play who="ben" take="Survey" to="1" begin="6"/>"#,
            r#"<play who="ben" take="Survey" to="1" begin="8"/>"#
        ]
    );
    // A time that depends on another action is written out, and clips of several things stay with theirs.
    let both = copy(&["a", "e"]);
    let pasted = after(&text, |scene| paste_clips(scene, &both, seconds(5.0), Some("ben")));
    assert_eq!(
        lines(&pasted),
        [
            r#"<play who="anna" take="Survey" to="1" begin="5"/>"#,
            r#"<play who="ben" take="Walk" begin="6.25"/>"#
        ]
    );
    let duplicated = after(&text, |scene| duplicate_clips(scene, &[called(scene, "a"), called(scene, "b")]));
    assert_eq!(
        lines(&duplicated),
        [
            r#"<play who="anna" take="Survey" to="1" begin="2"/>"#,
            r#"<play who="anna" take="Survey" to="1" begin="3"/>"#
        ]
    );
}

fn after_text(
    text: &str,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, dragonfly_anim::stage::gesture::GestureRefusal>,
) -> String {
    let (script, plan) = (read(text), planned(text, &assets(&fox())));
    act(&GestureScene { script: &script, plan: &plan }).unwrap_or_else(|refusal| panic!("{refusal}"))
}

#[test]
fn names_that_the_model_of_another_role_lacks_are_listed() {
    let copied = "<script version=\"1\" fps=\"24\">\n  <play who=\"anna\" take=\"Fly\" bones=\"Wing, b_Head_05\" begin=\"0\"/>\n</script>\n";
    let refusal =
        gesture(SEVERAL, |scene| paste_clips(scene, copied, seconds(1.0), Some("ben"))).1.unwrap_err();
    assert_eq!(refusal.to_string(), "The model of ben lacks the take \"Fly\" and the bone \"Wing\"");
    let refusal =
        gesture(SEVERAL, |scene| paste_clips(scene, copied, seconds(1.0), Some("sun"))).1.unwrap_err();
    assert!(refusal.to_string().contains("\"sun\""), "{refusal}");
    let refusal =
        gesture(SEVERAL, |scene| paste_clips(scene, "<script version=\"1\"></script>", seconds(1.0), None));
    assert_eq!(refusal.1.unwrap_err().to_string(), "The clipboard contains no actions");
}

#[test]
fn a_clip_goes_to_the_lane_of_another_role_with_its_id_and_what_followed_it_moves_up_or_stays() {
    let text = fox_script(SEVERAL);
    let onto = |followers| {
        after(&text, |scene| move_to_lane(scene, called(scene, "b"), seconds(4.5), "ben", followers))
    };
    let new = onto(Followers::Follow);
    assert_eq!(line_of(&new, "b"), r#"<play id="b" who="ben" take="Survey" to="1" begin="4.5"/>"#);
    assert_eq!(begins(&new), [0.0, 4.5, 1.0, 2.0, 4.75, 1.0]);
    assert_eq!(begins(&onto(Followers::Stay)), [0.0, 4.5, 2.0, 3.0, 4.75, 1.0]);
    // It mixes with what is there.
    let over = after(&text, |scene| {
        move_to_lane(scene, called(scene, "f"), seconds(4.5), "ben", Followers::Follow)
            .or_else(|_| move_to_lane(scene, called(scene, "d"), seconds(1.5), "ben", Followers::Follow))
    });
    let line = line_of(&over, "d");
    assert!(line.contains("fade-in=\"0.458\""), "Walk lasts from 1.25 to 1.958: {line}");
}
