//! Random sequences of all gestures: the text stays a script, only what a gesture names changes, and the inverses lead back.

use super::actors::{assets, fox};
use super::includes::{context, cut_out};
use super::random_scripts;
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureRefusal, GestureScene, SequenceOrder, add_clip, add_new_action, attach_thing,
    copied_clips, cut_to, delete_clip, delete_clips, duplicate_clip, duplicate_clips, face_thing,
    follow_path, move_clip, move_clips, move_path_point, move_to_lane, paste_clips, place_thing, set_fade,
    set_repeat, set_speed, trim_end, trim_start, wait_after,
};
use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::script::{ScriptContext, ScriptElement, StageRepeat, StageScript};
use dragonfly_anim::stage::splice::TextSplice;
use dragonfly_anim::stage::table::{ElementGroup, NEW_ACTIONS};
use dragonfly_anim::stage::time::{Decimal, StageTime};
use dragonfly_anim::stage::{StageAssets, StagePlan};
use dragonfly_kit::random::{Random, seed};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Number of different gestures.
const GESTURES: usize = 23;

/// A gesture, with the elements that it may change.
struct Named {
    name: &'static str,
    /// The actions that it names; it may also change what follows them, and the fades of other clips of the same things.
    actions: Vec<usize>,
    /// Things whose clips may get other fades, or that it changes itself.
    things: Vec<&'static str>,
    /// Whether it adds elements.
    adds: bool,
}

const THINGS: [&str; 2] = ["anna", "ben"];

fn random_gesture(random: &mut Random, scene: &GestureScene<'_>) -> (Named, Result<String, GestureRefusal>) {
    let count = scene.script.actions().len() - 1;
    let action = 1 + random.below(count);
    let several: Vec<usize> = (0..1 + random.below(3)).map(|_| 1 + random.below(count)).collect();
    let time = StageTime::from_seconds(random.below(200) as f64 / 24.0);
    let by = StageTime::from_seconds(random.below(96) as f64 / 24.0 - 2.0);
    let followers = random.choice(&[Followers::Follow, Followers::Stay]);
    let order = random.choice(&[SequenceOrder::Keep, SequenceOrder::Change]);
    let (who, camera) = (random.choice(&THINGS), random.choice(&["wide", "close"]));
    let all_of = |name: &str| -> Vec<usize> {
        (1..=count).filter(|&action| scene.script.element(action).row.name == name).collect()
    };
    let own =
        |name, actions: &[usize]| Named { name, actions: actions.to_vec(), things: vec![], adds: false };
    let added = |name| Named { name, actions: vec![], things: vec![who], adds: true };
    match random.below(GESTURES + 2) {
        0..=2 => (own("move", &[action]), move_clip(scene, action, time, order, followers)),
        3 => (own("start", &[action]), trim_start(scene, action, time)),
        4 => (own("end", &[action]), trim_end(scene, action, time, followers)),
        5 => {
            let end = random.choice(&[FadeEnd::In, FadeEnd::Out]);
            (own("fade", &[action]), set_fade(scene, action, end, time))
        }
        6 => (own("speed", &[action]), set_speed(scene, action, random.below(9) as f64 / 2.0 - 2.0)),
        7 => {
            let times = StageRepeat::Times(Decimal::parse("2.5").unwrap());
            (own("repeat", &[action]), set_repeat(scene, action, times))
        }
        8 => (own("delete", &[action]), delete_clip(scene, action, followers)),
        9 => (Named { adds: true, ..own("duplicate", &[action]) }, duplicate_clip(scene, action)),
        10 => (Named { adds: true, ..own("cut", &all_of("shot")) }, cut_to(scene, camera, time)),
        11 => (added("add"), add_clip(scene, who, "Survey", time)),
        12 => (own("move several", &several), move_clips(scene, &several, by, order, followers)),
        13 => (own("delete several", &several), delete_clips(scene, &several, followers)),
        14 => {
            let named = Named { adds: true, things: THINGS.to_vec(), ..own("duplicate several", &several) };
            (named, duplicate_clips(scene, &several))
        }
        15 => {
            let onto = random.choice(&[None, Some(who)]);
            let copied = copied_clips(scene, &several);
            let named = Named { things: THINGS.to_vec(), ..added("paste") };
            (named, copied.and_then(|text| paste_clips(scene, &text, time, onto)))
        }
        16 => {
            let named = Named { things: THINGS.to_vec(), ..own("other lane", &[action]) };
            (named, move_to_lane(scene, action, time, who, followers))
        }
        17 => (added("path"), follow_path(scene, who, "aisle", Some("Walk"), time)),
        18 => (added("attach"), attach_thing(scene, "sword", who, time)),
        19 => {
            let row = random.choice(NEW_ACTIONS);
            let target = random.choice(&["anna", "ben", "door", "aisle", "strength"]);
            let who = random.choice(&[None, Some(who), Some("sun")]);
            (added("new action"), add_new_action(scene, &row, who, Some(target), time))
        }
        20 => (Named { adds: true, ..own("wait", &[action]) }, wait_after(scene, action)),
        21 => {
            let named = Named { things: vec![who], ..own("place", &all_of("place")) };
            (named, place_thing(scene, who, time, DVec3::new(1.0, 0.0, random.below(9) as f64)))
        }
        22 => {
            let named = Named { things: vec![who], ..own("face", &all_of("place")) };
            (named, face_thing(scene, who, time, random.below(360) as f64))
        }
        _ => {
            let place = DVec3::new(random.below(9) as f64, 0.0, 1.0);
            let named = Named { things: vec!["aisle"], ..own("path point", &[]) };
            (named, move_path_point(scene.script, "aisle", 0, place))
        }
    }
}

/// Attributes of each element that has an id, its fades apart.
type Signatures = BTreeMap<String, [Vec<(&'static str, String)>; 2]>;

/// Returns the id of an element; with another one for the same id in the included file.
fn key(element: &ScriptElement) -> Option<String> {
    let file = if element.is_included() { "part.xml " } else { "" };
    element.value("id").map(|id| format!("{file}{id}"))
}

/// Returns begin and end of the takes and ways of a thing.
fn lane(script: &StageScript, plan: &StagePlan, who: &str) -> Vec<[StageTime; 2]> {
    let is_on = |action: &usize| {
        let element = script.element(*action);
        matches!(element.row.name, "play" | "move") && element.value("who") == Some(who)
    };
    let times = |action: usize| [plan.schedule().times()[action].begin, plan.schedule().times()[action].stop];
    let mut all: Vec<[StageTime; 2]> = (1..script.actions().len()).filter(is_on).map(times).collect();
    all.sort();
    all
}

fn signatures(script: &StageScript) -> Signatures {
    let elements = script.tree().elements().iter();
    // The casts of both files have the same things.
    let counts =
        |element: &&ScriptElement| !(element.is_included() && element.row.group == ElementGroup::Thing);
    let named = elements.filter(counts).filter_map(|element| Some((key(element)?, element)));
    let signature = |element: &ScriptElement| {
        let all = element.attributes.iter().map(|own| (own.row.name, own.value.to_string()));
        let (fades, others) = all.partition(|(name, _)| name.starts_with("fade-"));
        [others, fades]
    };
    named.map(|(id, element)| (id, signature(element))).collect()
}

/// Checks that only the elements changed, or are gone, that a gesture may change.
fn check_changes(
    named: &Named,
    (old, before_plan): (&StageScript, &StagePlan),
    (new, after_plan): (&StageScript, &StagePlan),
    seed: u64,
) {
    let id = |action: usize| key(old.element(action));
    let mut may: BTreeSet<String> = BTreeSet::new();
    let actions = old.actions();
    for &action in &named.actions {
        let is_inside = |&other: &usize| {
            std::iter::successors(Some(other), |&at| actions[at].parent).any(|around| around == action)
        };
        let inside = (1..actions.len()).filter(is_inside);
        may.extend(inside.filter_map(id));
        let parent = actions[action].parent.unwrap_or(0);
        may.extend(actions[parent].children.get(actions[action].position + 1).and_then(|&next| id(next)));
    }
    if ["place", "face", "path point"].contains(&named.name) {
        may.extend(named.things.iter().map(|thing| (*thing).to_owned()));
    }
    let (before, after) = (signatures(old), signatures(new));
    for (id, signature) in &before {
        let Some(now) = after.get(id) else {
            assert!(
                may.contains(id) && named.name.starts_with("delete"),
                "seed {seed}: {} deleted {id}",
                named.name
            );
            continue;
        };
        // A fade follows the overlaps of its lane, whatever changes these.
        let is_one = |action: &usize| key(old.element(*action)).as_ref() == Some(id);
        let who = (1..actions.len()).find(is_one).and_then(|action| old.element(action).value("who"));
        let lane_changes =
            || who.is_some_and(|who| lane(old, before_plan, who) != lane(new, after_plan, who));
        assert!(may.contains(id) || now[0] == signature[0], "seed {seed}: {} changed {id}", named.name);
        assert!(
            may.contains(id) || now[1] == signature[1] || (!id.starts_with("part.xml ") && lane_changes()),
            "seed {seed}: {} changed the fade of {id}",
            named.name
        );
    }
    let is_new = |id: &&String| !before.contains_key(*id);
    assert!(named.adds || after.keys().filter(is_new).count() == 0, "seed {seed}: {} added", named.name);
    let elements = |script: &StageScript| script.tree().elements().len();
    match named.adds {
        true => assert!(elements(new) >= elements(old), "seed {seed}: {}", named.name),
        false => assert!(elements(new) <= elements(old), "seed {seed}: {}", named.name),
    }
}

#[test]
fn random_gestures_change_only_what_they_name_and_their_inverses_lead_back_to_the_first_text() {
    let first = seed(1);
    println!("seed {first}");
    let model = fox();
    let assets: StageAssets = assets(&model);
    let (mut done, mut refused, mut scripts, mut including) = (BTreeMap::<&str, usize>::new(), 0, 0, 0);
    let mut at = first;
    while scripts < 300 {
        at += 1;
        let mut random = Random::new(at);
        let mut text = random_scripts::script(at);
        for take in ["PickUp", "Slash", "Idle", "Fall"] {
            text = text.replace(&format!("\"{take}\""), "\"Survey\"");
        }
        let mut context = ScriptContext::default();
        if at.is_multiple_of(2)
            && let Some((_, include, file)) = cut_out(&text, &mut random)
        {
            context = self::context("duel.xml", &include, &[("part.xml", &file)]);
            text = include;
        }
        let original = text.clone();
        let mut inverses: Vec<TextSplice> = Vec::new();
        for _ in 0..14 {
            let Ok(script) = StageScript::read_in(text.as_str(), &context) else { break };
            let Ok(plan) = StagePlan::new(&script, &assets) else { break };
            if script.actions().len() < 2 {
                break;
            }
            let scene = GestureScene { script: &script, plan: &plan };
            let lanes = SceneLanes::new(&script, &plan);
            assert!(
                lanes.list.iter().all(|lane| lane.bars.iter().all(|bar| bar.row < lane.rows)),
                "seed {at}"
            );
            match random_gesture(&mut random, &scene) {
                (named, Ok(new)) => {
                    let name = named.name;
                    let changed = StageScript::read_in(new.as_str(), &context)
                        .unwrap_or_else(|errors| panic!("seed {at} {name}: {}\n{new}", errors[0]));
                    let after = StagePlan::new(&changed, &assets)
                        .unwrap_or_else(|errors| panic!("seed {at} {name}: {}\n{text}\n{new}", errors[0]));
                    check_changes(&named, (&script, &plan), (&changed, &after), at);
                    including += usize::from(
                        changed
                            .actions()
                            .iter()
                            .any(|action| changed.tree().elements()[action.element].is_included()),
                    );
                    inverses.extend(TextSplice::between(&new, &text));
                    *done.entry(name).or_default() += 1;
                    text = new;
                }
                (_, Err(GestureRefusal(reason))) => {
                    assert!(!reason.is_empty() && !reason.ends_with('.'), "{reason}");
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
    println!("{done:?}, {refused} refused, {including} with another file");
    assert!(including > 100, "{including}");
    assert!(done.values().all(|&count| count > 0), "{done:?}");
    assert!(done.len() + 2 >= GESTURES - 2, "{} gestures: {done:?}", done.len());
}
