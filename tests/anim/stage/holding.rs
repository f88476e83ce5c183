//! Things that hold and are held: the place where one is detached, and limits.

use super::actors::{assets, at, fox, foxes, planned, seconds, thing};
use super::{listed, read};
use dragonfly_anim::stage::{StageAssets, StagePlan};
use dragonfly_kit::process::thread_time;
use std::time::Duration;

/// Returns the errors of a plan without models.
fn refused(text: &str) -> String {
    StagePlan::new(&read(text), &StageAssets::default())
        .map_or_else(|errors| listed(&errors), |_| String::new())
}

/// Returns a script with `count` marks and these actions.
fn with_marks(count: usize, actions: &str) -> String {
    let cast: String =
        (0..count).map(|mark| format!("<light id=\"p{mark}\" kind=\"sun\" at=\"{mark} 0 0\"/>\n")).collect();
    format!("<script version=\"1\"><cast>\n{cast}</cast>\n<par>\n{actions}</par></script>")
}

#[test]
fn what_is_detached_lies_exactly_where_it_was_held_also_by_a_head_that_follows_another_head() {
    let head = fox().skeleton().bones.iter().find(|bone| bone.name.contains("Head")).unwrap().name.clone();
    let holding = format!(
        "<play who=\"anna\" take=\"Run\" repeat=\"fill\"/><move who=\"ben\" path=\"bend\" take=\"Walk\"/>\
         <look who=\"ben\" at=\"anna.{head}\" bones=\"{head}\"/><look who=\"anna\" at=\"ben.{head}\" bones=\"{head}\"/>\
         <attach who=\"sword\" to=\"anna.{head}\" offset=\"0 10 3\"/>"
    );
    for tenths in 1..20 {
        let time = f64::from(tenths) * 0.1;
        let held = foxes(&holding);
        let detached = foxes(&format!("{holding}<detach who=\"sword\" begin=\"{time}\"/>"));
        let place = |plan: &StagePlan| thing(plan, &at(plan, time), "sword").transform;
        assert_eq!(place(&held).translation.to_array(), place(&detached).translation.to_array(), "{time}");
        assert_eq!(place(&held).rotation.to_array(), place(&detached).rotation.to_array(), "{time}");
    }
}

#[test]
fn a_plan_takes_a_time_in_proportion_to_what_is_detached() {
    const MANY: usize = 20_000;
    let mut actions = String::new();
    for thing in 1..MANY {
        let end = thing + 1;
        actions += &format!(
            "<attach who=\"p{thing}\" to=\"p0\" offset=\"0 1 0\" begin=\"{thing}\"/><detach who=\"p{thing}\" begin=\"{end}\"/>\n"
        );
    }
    let text = with_marks(MANY, &actions);
    let begin = thread_time();
    let plan = planned(&text, &StageAssets::default());
    let spent = thread_time() - begin;
    assert!(spent < Duration::from_secs(30), "{spent:?}");
    let mut scene = plan.new_scene();
    plan.scene_at(seconds(5.0), &mut scene);
    let heights = scene.things[..8].iter().map(|thing| thing.transform.translation.y);
    assert_eq!(heights.collect::<Vec<_>>(), [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
}

#[test]
fn chains_of_too_many_holders_and_loops_are_errors() {
    let chain = |count: usize| {
        let actions = (1..count).map(|thing| format!("<attach who=\"p{}\" to=\"p{thing}\"/>\n", thing - 1));
        with_marks(count, &actions.collect::<String>())
    };
    assert_eq!(refused(&chain(65)), "");
    assert!(refused(&chain(66)).contains("more than 64 things hold \"p0\", one through another"));
    assert!(refused(&chain(50_000)).contains("more than 64 things hold"));
    let round = with_marks(
        3,
        "<attach who=\"p0\" to=\"p1\"/><attach who=\"p1\" to=\"p2\"/><attach who=\"p2\" to=\"p0\"/>",
    );
    assert!(refused(&round).contains("these things hold each other: p0, p1, p2"), "{}", refused(&round));
    let own = with_marks(2, "<attach who=\"p1\" to=\"p1\"/>");
    assert!(refused(&own).contains("hold each other: p1"), "{}", refused(&own));
}

#[test]
fn what_needs_too_much_to_find_where_it_is_detached_is_an_error() {
    // Each of many things is held by the last one of a chain, which is long.
    let mut actions: String =
        (1..60).map(|thing| format!("<attach who=\"p{}\" to=\"p{thing}\"/>\n", thing - 1)).collect();
    for thing in 60..5_000 {
        actions += &format!("<attach who=\"p{thing}\" to=\"p0\"/><detach who=\"p{thing}\" begin=\"1\"/>\n");
    }
    let refused = refused(&with_marks(5_000, &actions));
    assert!(refused.contains("too many things hold or see what is detached here and before"), "{refused}");
}

#[test]
fn a_prop_is_held_by_a_foot_that_is_kept_on_the_ground() {
    let model = fox();
    let foot = model.feet()[0].bone as usize;
    let name = &model.skeleton().bones[foot].name;
    let script = super::actors::fox_script(&format!(
        "<move who=\"anna\" path=\"bend\" take=\"Walk\"/><attach who=\"sword\" to=\"anna.{name}\"/>"
    ));
    let plan = planned(&script, &assets(&model));
    for frame in 0..40 {
        let scene = at(&plan, f64::from(frame) * 0.05);
        let (sword, foot) = (
            thing(&plan, &scene, "sword").transform.translation,
            super::actors::bone(&plan, &scene, "anna", foot as u32),
        );
        assert!(sword.distance(foot) < 1e-4, "{frame}: {sword} {foot}");
    }
}

#[test]
fn a_thing_that_is_detached_several_times_at_once_lies_where_it_was_held() {
    let place = |detaches: usize| {
        let plan = foxes(&format!(
            "<play who=\"anna\" take=\"Run\" repeat=\"fill\" dur=\"9\"/><move who=\"anna\" to=\"9 0 2\" speed=\"1\"/>\
             <attach who=\"sword\" to=\"anna.b_Head_05\"/>{}",
            "<detach who=\"sword\" begin=\"2\"/>".repeat(detaches)
        ));
        thing(&plan, &at(&plan, 3.0), "sword").transform.translation
    };
    for detaches in [4, 5, 6, 20] {
        assert_eq!(place(detaches), place(1), "{detaches} times");
    }
}

#[test]
fn looks_of_those_who_hold_count_as_work_and_the_error_is_at_the_detachment() {
    let looks: String =
        (0..6_000).map(|at| format!("<look who=\"c\" at=\"p1\" begin=\"{at}ms\" dur=\"1ms\"/>\n")).collect();
    let held = |at: usize| {
        let (held, free) = (9_000 + 2 * at, 9_001 + 2 * at);
        format!("<attach who=\"p0\" to=\"c\" begin=\"{held}ms\"/>\n<detach who=\"p0\" begin=\"{free}ms\"/>\n")
    };
    let held: String = (0..6_000).map(held).collect();
    let text = with_marks(2, &format!("{looks}{held}")).replace("<cast>", "<cast><camera id=\"c\"/>");
    let Err(errors) = StagePlan::new(&read(&text), &StageAssets::default()) else { panic!("too much") };
    assert!(errors[0].message.contains("too many things hold or see what is detached here and before"));
    let line = text.lines().nth(errors[0].place.line as usize - 1).unwrap_or_default();
    assert!(
        line.starts_with("<detach") && !errors[0].help.contains("attach one of them"),
        "{line}: {}",
        errors[0]
    );
}
