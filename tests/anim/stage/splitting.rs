//! Clips that are split: both halves play what the whole played, and nothing else changes.

use super::actors::{assets, at, fox, fox_script, planned, seconds};
use super::gestures::called;
use super::random_scripts;
use super::travels::stepper;
use super::{listed, read};
use dragonfly_anim::stage::gesture::{
    Followers, GestureRefusal, GestureScene, split_clips, trim_end, trim_start,
};
use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::{StageAssets, StagePlan, StageScene};
use dragonfly_kit::random::{Random, seed};

/// Splits actions of a script at a time. Returns the new text.
fn split_in(text: &str, assets: &StageAssets, ids: &[&str], time: f64) -> Result<String, GestureRefusal> {
    let (script, plan) = (read(text), planned(text, assets));
    let scene = GestureScene { script: &script, plan: &plan };
    let actions: Vec<usize> = ids.iter().map(|id| called(&scene, id)).collect();
    let split = split_clips(&scene, &actions, seconds(time))?;
    let new = read(&split.text);
    for half in split.halves {
        let begin = planned(&split.text, assets).schedule().times()[half].begin;
        assert!((begin.seconds() - time).abs() < 2e-3, "half {half} begins at {begin:?}: {}", split.text);
        assert!(new.actions().len() > script.actions().len());
    }
    Ok(split.text)
}

/// Splits actions of a scene of foxes.
fn split(actions: &str, ids: &[&str], time: f64) -> Result<String, GestureRefusal> {
    split_in(&fox_script(actions), &assets(&fox()), ids, time)
}

/// Returns the lines that differ from those of a scene of foxes.
fn new_lines(actions: &str, new: &str) -> Vec<String> {
    let old = fox_script(actions);
    let old: Vec<&str> = old.lines().collect();
    new.lines().filter(|line| !old.contains(line)).map(|line| line.trim().to_owned()).collect()
}

/// Returns the places and the poses of all things: meters, and the matrices of their bones with the positions at their size.
fn numbers(scene: &StageScene) -> Vec<f32> {
    let mut all = Vec::new();
    for state in &scene.things {
        let size = state.transform.scale.x;
        all.extend(state.transform.translation.to_array());
        all.extend((state.transform.rotation * glam::Vec3::Z).to_array());
        if let Some(pose) = &state.pose {
            // The last number of each row is a position.
            let scaled = |(at, number): (usize, &f32)| if at % 4 == 3 { number * size } else { *number };
            pose.to_root.matrices().for_each(|matrix| all.extend(matrix.iter().enumerate().map(scaled)));
            all.extend(&pose.shapes);
        }
    }
    all.push(scene.titles.iter().map(|title| title.weight).sum());
    all
}

/// Asserts that two plans are the same at many times of a part of the scene.
fn assert_same([old, new]: [&StagePlan; 2], part: [f64; 2], what: &str) {
    for step in 0..=40 {
        let time = part[0] + (part[1] - part[0]) * f64::from(step) / 40.0;
        let [before, after] = [old, new].map(|plan| numbers(&at(plan, time)));
        assert_eq!(before.len(), after.len(), "{what}");
        let far = before.iter().zip(&after).map(|(one, other)| (one - other).abs()).fold(0.0, f32::max);
        assert!(far < 1e-4, "{far} at {time} s: {what}");
    }
}

#[test]
fn both_halves_of_a_clip_show_the_poses_of_the_whole_whatever_part_of_the_take_it_plays_and_how_often() {
    let assets = assets(&fox());
    for clip in [
        r#"<play id="x" who="anna" take="Survey"/>"#,
        r#"<play id="x" who="anna" take="Survey" from="0.25" to="3" begin="0.5"/>"#,
        r#"<play id="x" who="anna" take="Survey" speed="1.3"/>"#,
        r#"<play id="x" who="anna" take="Survey" speed="-0.7" from="0.4"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="3.5"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="4" speed="-0.9" to="0.6"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="4" start="0.3"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="fill"/>"#,
        r#"<play id="x" who="anna" take="Walk" repeat="fill" end="all.end-0.25"/>"#,
        r#"<play id="x" who="anna" take="Run" dur="3.5"/>"#,
        r#"<play id="x" who="anna" take="Run" speed="-1" dur="3.5"/>"#,
        r#"<play id="x" who="anna" take="Survey" end="3"/>"#,
        r#"<play id="x" who="anna" take="Survey" fade-in="0.5" fade-out="0.25"/>"#,
        r#"<play id="x" who="anna" take="Survey" fill="release"/>"#,
        r#"<play id="x" who="anna" take="Survey" weight="0.5"/>"#,
        r#"<play id="x" who="anna" take="Survey" layer="top" bones="b_Neck_04" weight="0.7" fade-in="0.25" fade-out="0.25"/>"#,
        r#"<play id="x" who="anna" take="Survey" bones="b_Neck_04" fill="hold" weight="0.5"/>"#,
        r#"<look id="x" who="anna" at="ben" bones="b_Neck_04,b_Head_05" dur="3" fade-in="0.25" fade-out="0.5"/>"#,
        r#"<look id="x" who="anna" at="ben" bones="b_Head_05" weight="0.5" end="3" fill="hold"/>"#,
        r#"<look id="x" who="anna" at="ben" bones="b_Head_05"/>"#,
        r#"<title id="x" text="The" dur="3" fade-in="0.5" fade-out="0.5"/>"#,
    ] {
        for (open, close) in [("<par id=\"all\">", "</par>"), ("<par id=\"all\">\n<seq>", "</seq></par>")] {
            // Something else of the thing is on before and under it, and something follows.
            let text = fox_script(&format!(
                "<play who=\"anna\" take=\"Run\" repeat=\"6\"/>\n{open}\n{clip}\n{close}\n<wait dur=\"4\"/>\n\
                 <play who=\"anna\" take=\"Walk\" begin=\"4.5\" fade-in=\"0.5\"/>"
            ))
            .replace("<par id=\"all\">", "<par id=\"all\" dur=\"4\">");
            let old = planned(&text, &assets);
            for time in [0.75, 1.0, 1.375, 2.0] {
                let new = split_in(&text, &assets, &["x"], time)
                    .unwrap_or_else(|refusal| panic!("{refusal}: {clip}"));
                let plan = planned(&new, &assets);
                assert_same([&old, &plan], [0.0, 6.0], &format!("{clip} split at {time}: {new}"));
                assert_eq!(plan.length(), old.length());
                // And one of the halves again.
                let again = split_in(&new, &assets, &["x"], 0.625);
                let again = again.unwrap_or_else(|refusal| panic!("{refusal}: {new}"));
                assert_same([&old, &planned(&again, &assets)], [0.0, 6.0], &again);
            }
        }
    }
}

#[test]
fn a_role_that_travels_stands_where_it_stood_and_what_follows_starts_there() {
    let assets = assets(&stepper());
    for clip in [
        r#"<play id="x" who="anna" take="Step" repeat="3.5"/>"#,
        r#"<play id="x" who="anna" take="Step" repeat="3" speed="0.8"/>"#,
        r#"<play id="x" who="anna" take="Step" repeat="4" speed="-1.1" from="0.2"/>"#,
        r#"<play id="x" who="anna" take="Quarter" repeat="3"/>"#,
        r#"<play id="x" who="anna" take="Quarter" repeat="5" start="0.4" to="0.9"/>"#,
        r#"<play id="x" who="anna" take="Quarter" repeat="fill" dur="3"/>"#,
        r#"<play id="x" who="anna" take="Quarter" dur="3"/>"#,
        r#"<play id="x" who="anna" take="Step" speed="0.3"/>"#,
    ] {
        let text = format!(
            "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"2\" at=\"1 0 0\" facing=\"90\"/></cast>\n\
             <seq>\n{clip}\n<play who=\"anna\" take=\"Step\" repeat=\"2\"/>\n</seq>\n</script>"
        );
        let old = planned(&text, &assets);
        for time in [0.5, 1.0, 1.3, 2.0, 2.25] {
            let new =
                split_in(&text, &assets, &["x"], time).unwrap_or_else(|refusal| panic!("{refusal}: {clip}"));
            let plan = planned(&new, &assets);
            assert_same([&old, &plan], [0.0, 7.0], &format!("{clip} split at {time}: {new}"));
            let ends = [&old, &plan].map(|plan| plan.placement(0, seconds(99.0)).expect("a place"));
            assert!(ends[0].position.distance(ends[1].position) < 1e-4, "{ends:?}");
        }
    }
}

#[test]
fn a_split_writes_one_line_more_and_keeps_ids_comments_and_spelling() {
    let lines = |actions: &str, time: f64| {
        let new = split(actions, &["x"], time).unwrap_or_else(|refusal| panic!("{refusal}"));
        new_lines(actions, &new)
    };
    let seq = "<seq>\n  <!-- looks -->\n  <play id=\"x\" who='anna'  take=\"Survey\" fade-in=\"6f\"/> <!-- around -->\n  <play who=\"anna\" take=\"Run\"/>\n</seq>";
    assert_eq!(
        lines(seq, 1.5),
        [
            r#"<play id="x" who='anna'  take="Survey" fade-in="6f" to="1.5"/> <!-- around -->"#,
            r#"<play who='anna'  take="Survey" from="1.5"/>"#
        ]
    );
    let par = "<par begin=\"1\">\n  <play id=\"x\" who=\"anna\" take=\"Survey\" begin=\"12f\" fade-out=\"0.25\"/>\n</par>";
    assert_eq!(
        lines(par, 2.0),
        [
            r#"<play id="x" who="anna" take="Survey" begin="12f" to="0.5" fill="release"/>"#,
            r#"<play who="anna" take="Survey" begin="24f" fade-out="0.25" from="0.5"/>"#
        ]
    );
    // Walk takes 0.708 s.
    let loops = "<play id=\"x\" who=\"anna\" take=\"Walk\" repeat=\"3\" to=\"0.5\"/>";
    assert_eq!(
        lines(loops, 0.75),
        [
            r#"<play id="x" who="anna" take="Walk" repeat="3" to="0.5" dur="0.75"/>"#,
            r#"<play who="anna" take="Walk" repeat="2" to="0.5" start="0.25" begin="0.75"/>"#
        ]
    );
    assert_eq!(lines(loops, 1.0)[1], r#"<play who="anna" take="Walk" to="0.5" begin="1"/>"#);
    let title =
        "<wait id=\"w\" dur=\"1\"/>\n<title id=\"x\" text=\"The &amp; End\" dur=\"48f\" begin=\"w.end\"/>";
    assert_eq!(
        lines(title, 2.5),
        [
            r#"<title id="x" text="The &amp; End" dur="36f" begin="w.end"/>"#,
            r#"<title text="The &amp; End" dur="12f" begin="w.end+1.5"/>"#
        ]
    );
}

#[test]
fn what_refers_to_the_end_or_to_a_moment_of_the_second_half_refers_to_that() {
    let actions = "<seq>\n<play id=\"x\" who=\"anna\" take=\"Survey\">\n  <at name=\"early\" time=\"0.5\"/>\n  <at name=\"late\" time=\"2\"/>\n</play>\n\
                   <wait id=\"n\" begin=\"prev.end+0.5\" dur=\"1\"/>\n</seq>\n<title id=\"a\" text=\"a\" begin=\"x.early\" end=\"x.late-6f\"/>\n\
                   <title id=\"b\" text=\"b\" begin=\"x.end+6f\" dur=\"1\"/>\n<title id=\"c\" text=\"c\" begin=\"x.begin+1\" dur=\"1\"/>";
    let new = split(actions, &["x"], 1.0).unwrap_or_else(|refusal| panic!("{refusal}"));
    let half = r#"<play id="x-2" who="anna" take="Survey" from="1"><at name="late" time="2"/></play>"#;
    assert!(new.contains(half), "{new}");
    assert!(
        new.contains(r#"begin="x.early" end="x-2.late-6f""#) && new.contains(r#"begin="x-2.end+6f""#),
        "{new}"
    );
    assert!(new.contains(r#"begin="x.begin+1""#) && !new.contains("name=\"late\" time=\"2\"/>\n"), "{new}");
    let times = |text: &str| -> Vec<[f64; 2]> {
        let (script, plan) = (read(text), planned(text, &assets(&fox())));
        let of = |id: &str| plan.schedule().times()[script.action_called(id).unwrap()];
        ["n", "a", "b", "c"].map(|id| [of(id).begin.seconds(), of(id).end.seconds()]).to_vec()
    };
    let (old, now) = (times(&fox_script(actions)), times(&new));
    for (old, now) in old.iter().flatten().zip(now.iter().flatten()) {
        assert!((old - now).abs() < 1e-6, "{old} {now}");
    }
    // The bars show each moment once.
    let (script, plan) = (read(&new), planned(&new, &assets(&fox())));
    let lanes = SceneLanes::new(&script, &plan);
    let marks = |id: &str| {
        let (_, bar) = lanes.bar_of(script.action_called(id).unwrap()).unwrap();
        bar.marks.iter().map(|mark| (mark.name.to_string(), mark.time.seconds())).collect::<Vec<_>>()
    };
    assert_eq!(marks("x"), [("early".to_owned(), 0.5)]);
    assert_eq!(marks("x-2"), [("late".to_owned(), 2.0)]);
}

#[test]
fn what_has_no_halves_is_refused_with_the_reason() {
    let refusal = |actions: &str, time: f64| split(actions, &["x"], time).expect_err(actions).0;
    for (actions, reason) in [
        ("<shot id=\"x\" who=\"wide\"/>\n<wait dur=\"3\"/>", "A shot is split by a cut to another camera"),
        ("<place id=\"x\" who=\"anna\" at=\"0 0 0\"/>\n<wait dur=\"3\"/>", "<place> takes no time"),
        ("<move id=\"x\" who=\"anna\" path=\"aisle\" dur=\"3\"/>", "<move> cannot be split"),
        ("<turn id=\"x\" who=\"anna\" to=\"ben\" dur=\"3\"/>", "<turn> cannot be split"),
        ("<sound id=\"x\" src=\"a.ogg\"/>\n<wait dur=\"3\"/>", "A sound cannot be split"),
        ("<run id=\"x\" who=\"rain\" dur=\"3\"/>", "An effect cannot be split"),
        ("<seq id=\"x\">\n<wait dur=\"3\"/>\n</seq>", "Only actions are split"),
        ("<play id=\"x\" who=\"anna\" take=\"Survey\" begin=\"2\"/>", "The playhead is not inside"),
        ("<play id=\"x\" who=\"anna\" take=\"Survey\" fade-in=\"2\"/>", "It fades there"),
        ("<play id=\"x\" who=\"anna\" take=\"Survey\" fade-out=\"3\"/>", "It fades there"),
        // Its second half would begin after the other clip, and be seen instead.
        (
            "<play id=\"x\" who=\"anna\" take=\"Survey\"/>\n<play who=\"anna\" take=\"Run\" begin=\"0.5\"/>",
            "<play> (line 3) begins after it",
        ),
        (
            "<par>\n<play id=\"x\" who=\"anna\" take=\"Survey\"/>\n<wait begin=\"prev.begin\" dur=\"1\"/>\n</par>",
            "relative to the action before it",
        ),
        // The sequence in it would end later, and what follows that would begin later.
        (
            "<par>\n<wait dur=\"3\"/>\n<seq>\n<seq>\n<play id=\"x\" who=\"anna\" take=\"Walk\" repeat=\"fill\"/>\n</seq>\n<wait id=\"n\" dur=\"0.5\"/>\n</seq>\n</par>",
            "would begin or end at another time",
        ),
    ] {
        let found = refusal(actions, 1.0);
        assert!(found.contains(reason), "{found} instead of {reason}: {actions}");
    }
    // One that is over and gave the pose back changes nothing.
    let inside = "<play id=\"x\" who=\"anna\" take=\"Survey\"/>\n<play who=\"anna\" take=\"Run\" to=\"0.5\" begin=\"0.5\" fade-in=\"0.1\" fade-out=\"0.1\"/>";
    let (old, assets) = (fox_script(inside), assets(&fox()));
    let new = split(inside, &["x"], 2.0).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_same([&planned(&old, &assets), &planned(&new, &assets)], [0.0, 4.0], &new);
}

#[test]
fn several_actions_are_split_at_once_and_those_that_cannot_be_are_counted() {
    let actions = "<par>\n<play id=\"x\" who=\"anna\" take=\"Survey\"/>\n<play id=\"y\" who=\"ben\" take=\"Survey\"/>\n<look id=\"z\" who=\"anna\" at=\"ben\" bones=\"b_Head_05\" dur=\"3\"/>\n\
                   <move id=\"m\" who=\"sword\" path=\"aisle\" dur=\"3\"/>\n<title id=\"t\" text=\"later\" begin=\"5\" dur=\"1\"/>\n</par>";
    let text = fox_script(actions);
    let (script, plan) = (read(&text), planned(&text, &assets(&fox())));
    let all: Vec<usize> = (2..script.actions().len()).rev().collect();
    let scene = GestureScene { script: &script, plan: &plan };
    let split = split_clips(&scene, &all, seconds(1.25)).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_eq!(
        split.left.expect("the way").0,
        "1 action is not split: <move> cannot be split: both halves would go all the way"
    );
    let new = planned(&split.text, &assets(&fox()));
    assert_same([&plan, &new], [0.0, 6.0], &split.text);
    let halves = read(&split.text);
    let names: Vec<&str> = split.halves.iter().map(|&half| halves.element(half).row.name).collect();
    assert_eq!(names, ["play", "play", "look"]);
    for half in split.halves {
        assert_eq!(new.schedule().times()[half].begin, seconds(1.25));
    }
}

#[test]
fn a_play_that_begins_in_the_middle_of_a_repetition_is_shorter_by_that_and_its_bar_shows_it() {
    let text = fox_script(
        "<play id=\"x\" who=\"anna\" take=\"Survey\" to=\"2\" repeat=\"3\" start=\"1.5\" begin=\"1\"><at name=\"m\" time=\"1\"/></play>\n\
         <title id=\"t\" text=\"t\" begin=\"x.m\" dur=\"1\"/>",
    );
    let (script, plan) = (read(&text), planned(&text, &assets(&fox())));
    let lanes = SceneLanes::new(&script, &plan);
    let (_, bar) = lanes.bar_of(script.action_called("x").unwrap()).unwrap();
    assert_eq!((bar.begin, bar.end), (seconds(1.0), seconds(5.5)), "three times two seconds less 1.5");
    assert_eq!(bar.repetitions(9).collect::<Vec<_>>(), [1.5, 3.5].map(seconds));
    assert_eq!(bar.occurrences(seconds(1.0), 9).collect::<Vec<_>>(), [2.5, 4.5].map(seconds));
    assert_eq!(bar.occurrences(seconds(1.75), 9).collect::<Vec<_>>(), [1.25, 3.25, 5.25].map(seconds));
    let parts: Vec<_> = bar.occurrences_of_part([seconds(1.25), seconds(1.75)], 9).collect();
    assert_eq!(parts, [[1.0, 1.25], [2.75, 3.25], [4.75, 5.25]].map(|part| part.map(seconds)));
    let title = plan.schedule().times()[script.action_called("t").unwrap()];
    assert_eq!(title.begin, seconds(2.5), "the moment is in the second repetition");
    // Trimmed, it begins at the same moment of the take, and ends where the pointer is.
    let scene = GestureScene { script: &script, plan: &plan };
    for new in [
        trim_end(&scene, called(&scene, "x"), seconds(4.5), Followers::Follow),
        trim_start(&scene, called(&scene, "x"), seconds(2.0)),
    ] {
        let new = new.unwrap_or_else(|refusal| panic!("{refusal}"));
        assert!(new.contains("start=\"1.5\"") && new.contains("repeat=\"2.5\""), "{new}");
    }
}

#[test]
fn random_actions_of_random_scripts_are_split_without_a_difference() {
    let first = seed(1);
    println!("seed {first}");
    let assets = assets(&fox());
    let (mut at_seed, mut done, mut refused) = (first, 0, 0);
    while done < 40 {
        at_seed += 1;
        let mut random = Random::new(at_seed);
        let mut text = random_scripts::script(at_seed);
        for take in ["PickUp", "Slash", "Idle", "Fall"] {
            text = text.replace(&format!("\"{take}\""), "\"Survey\"");
        }
        let Ok(script) = StageScript::read(text.as_str()) else { continue };
        let Ok(plan) = StagePlan::new(&script, &assets) else { continue };
        let scene = GestureScene { script: &script, plan: &plan };
        for _ in 0..6 {
            let action = 1 + random.below(script.actions().len() - 1);
            let times = plan.schedule().times()[action];
            let length = (times.stop - times.begin).seconds();
            let time = times.begin.seconds() + length * random.below(100) as f64 / 100.0;
            match split_clips(&scene, &[action], seconds(time)) {
                Ok(split) => {
                    let script = StageScript::read(split.text.as_str());
                    let script = script.unwrap_or_else(|errors| {
                        panic!("seed {at_seed}: {}\n{}", listed(&errors), split.text)
                    });
                    let new = StagePlan::new(&script, &assets);
                    let new = new.unwrap_or_else(|errors| {
                        panic!("seed {at_seed}: {}\n{}", listed(&errors), split.text)
                    });
                    let end = plan.length().seconds() + 1.0;
                    assert_same(
                        [&plan, &new],
                        [0.0, end],
                        &format!("seed {at_seed}, action {action} at {time}:\n{text}\n{}", split.text),
                    );
                    done += 1;
                }
                Err(GestureRefusal(reason)) => {
                    assert!(!reason.is_empty() && !reason.ends_with('.'), "{reason}");
                    refused += 1;
                }
            }
        }
    }
    println!("{done} split, {refused} refused");
}
