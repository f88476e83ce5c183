//! Gestures in scripts that include others: what is in another file is locked, and everything else works around it.

use super::actors::{assets, fox, seconds};
use super::includes::{context, including};
use super::listed;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureRefusal, GestureScene, SequenceOrder, add_clip, copied_clips, cut_to,
    delete_clip, delete_clips, duplicate_clip, duplicate_clips, face_thing, move_clip, move_clips,
    move_clips_to_lane, move_path_point, move_to_lane, place_thing, set_fade, set_repeat, set_speed,
    split_clips, trim_end, trim_start,
};
use dragonfly_anim::stage::lanes::{LaneSubject, SceneLanes};
use dragonfly_anim::stage::script::{ScriptContext, StageRepeat, StageScript};
use dragonfly_anim::stage::splice::{
    AttachedComments, ElementPlace, NewElement, delete, duplicate, insert, move_to, remove_attribute, rename,
    set_attribute,
};
use dragonfly_anim::stage::time::Decimal;
use dragonfly_anim::stage::writing::{CompletionNames, completions};
use glam::DVec3;

/// The other file: everything that gestures change is in it.
pub(super) const PART: &str = "<script version=\"1\"><cast><role id=\"ben\" model=\"b.glb\" scale=\"0.01\"/><camera id=\"close\"/>\
    <path id=\"way\" points=\"0 0 0  1 0 0\"/></cast>\n<seq id=\"acts\"><play id=\"x\" who=\"ben\" take=\"Survey\" fade-in=\"0.2\"/>\
    <place id=\"put\" who=\"ben\" at=\"1 0 0\"/></seq><shot who=\"close\" begin=\"x.begin+1\"/></script>";

pub(super) const MAIN: &str = "<script version=\"1\"><cast>\n<role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/>\n<camera id=\"wide\"/>\n</cast>\n\
    <shot who=\"wide\"/>\n<seq>\n<include id=\"in\" src=\"part.xml\"/>\n<play id=\"y\" who=\"anna\" take=\"Run\"/>\n</seq>\n</script>\n";

pub(super) fn main() -> StageScript {
    including(MAIN, &[("part.xml", PART)]).unwrap_or_else(|errors| panic!("{}", listed(&errors)))
}

pub(super) fn plan(script: &StageScript) -> StagePlan {
    StagePlan::new(script, &assets(&fox())).unwrap_or_else(|errors| panic!("{}", listed(&errors)))
}

/// Returns the action that is called `name` as its element, or has this id.
pub(super) fn action(script: &StageScript, name: &str) -> usize {
    let is_one = |action: &usize| {
        let element = script.element(*action);
        element.value("id") == Some(name) || element.row.name == name
    };
    (0..script.actions().len()).rfind(is_one).expect(name)
}

#[test]
fn every_gesture_on_what_is_in_another_file_is_refused_with_its_name() {
    let script = main();
    let plan = plan(&script);
    let scene = GestureScene { script: &script, plan: &plan };
    let y = action(&script, "y");
    for name in ["acts", "x", "put"] {
        let at = action(&script, name);
        let twice = StageRepeat::Times(Decimal::parse("2").expect("a number"));
        let gestures: [Result<String, GestureRefusal>; 15] = [
            move_clip(&scene, at, seconds(0.5), SequenceOrder::Keep, Followers::Follow),
            trim_start(&scene, at, seconds(0.1)),
            trim_end(&scene, at, seconds(0.2), Followers::Stay),
            set_fade(&scene, at, FadeEnd::In, seconds(0.5)),
            set_speed(&scene, at, 2.0),
            set_repeat(&scene, at, twice),
            delete_clip(&scene, at, Followers::Stay),
            duplicate_clip(&scene, at),
            move_clips(&scene, &[at, y], seconds(0.5), SequenceOrder::Keep, Followers::Follow),
            delete_clips(&scene, &[at, y], Followers::Stay),
            copied_clips(&scene, &[at, y]),
            duplicate_clips(&scene, &[at, y]),
            move_to_lane(&scene, at, seconds(0.5), "anna", Followers::Follow),
            move_clips_to_lane(&scene, &[at], seconds(0.5), "anna", Followers::Follow)
                .map(|moved| moved.text),
            split_clips(&scene, &[at, y], seconds(0.3)).map(|split| split.text),
        ];
        for gesture in gestures {
            assert_eq!(
                gesture,
                Err(GestureRefusal(format!("\"{name}\" is in part.xml: open it to change it")))
            );
        }
    }
    let things = [
        place_thing(&scene, "ben", seconds(9.0), DVec3::X),
        face_thing(&scene, "ben", seconds(9.0), 45.0),
        place_thing(&scene, "ben", seconds(0.0), DVec3::X),
        move_path_point(&script, "way", 0, DVec3::X),
    ];
    for (gesture, id) in things.into_iter().zip(["put", "put", "ben", "way"]) {
        assert_eq!(gesture, Err(GestureRefusal(format!("\"{id}\" is in part.xml: open it to change it"))));
    }
    // The shot at this time would get another camera.
    let cut = cut_to(&scene, "wide", seconds(1.0));
    assert_eq!(cut, Err(GestureRefusal("This <shot> is in part.xml: open it to change it".to_owned())));
}

#[test]
fn no_splice_of_a_text_is_at_a_place_of_another_file() {
    let script = main();
    let tree = script.tree();
    let foreign: Vec<usize> =
        (0..tree.elements().len()).filter(|&element| tree.elements()[element].is_included()).collect();
    assert_eq!(foreign.len(), 8);
    let new = NewElement::new("wait");
    for &element in &foreign {
        let splices = [
            set_attribute(tree, element, "id", "other"),
            remove_attribute(tree, element, "id"),
            rename(tree, element, "other").ok(),
            delete(tree, element, AttachedComments::Stay),
            duplicate(tree, element),
            move_to(tree, element, ElementPlace::First(0), AttachedComments::Stay),
            move_to(tree, 1, ElementPlace::After(element), AttachedComments::Stay),
            insert(tree, ElementPlace::After(element), &new),
            insert(tree, ElementPlace::First(element), &new),
        ];
        assert!(splices.iter().all(Option::is_none), "{}: {splices:?}", tree.elements()[element].row.name);
    }
}

#[test]
fn gestures_on_an_include_and_next_to_it_change_the_script_itself() {
    let script = main();
    let plan = plan(&script);
    let scene = GestureScene { script: &script, plan: &plan };
    let include = action(&script, "in");
    let done = |text: Result<String, GestureRefusal>| {
        let text = text.unwrap_or_else(|refusal| panic!("{refusal}"));
        let new = including(&text, &[("part.xml", PART)]);
        (text.clone(), self::plan(&new.unwrap_or_else(|errors| panic!("{}\n{text}", listed(&errors)))))
    };
    let (text, _) = done(move_clip(&scene, include, seconds(0.5), SequenceOrder::Keep, Followers::Follow));
    assert_eq!(text, MAIN.replace("src=\"part.xml\"", "src=\"part.xml\" begin=\"0.5\""));
    let (text, _) = done(trim_end(&scene, include, seconds(0.5), Followers::Follow));
    assert_eq!(text, MAIN.replace("src=\"part.xml\"", "src=\"part.xml\" dur=\"0.5\""));
    // The copy brings the actions of the file a second time, as long as the first.
    let (text, copied) = done(duplicate_clip(&scene, include));
    assert!(
        text.contains("<include id=\"in\" src=\"part.xml\"/>\n<include id=\"in-2\" src=\"part.xml\"/>"),
        "{text}"
    );
    let once = plan.schedule().times()[include];
    assert_eq!(copied.schedule().times()[script.branch(include).end].begin, once.end);
    let (text, _) = done(delete_clip(&scene, include, Followers::Stay));
    assert_eq!(
        text,
        MAIN.replace("<include id=\"in\" src=\"part.xml\"/>\n", "")
            .replace("take=\"Run\"", "take=\"Run\" begin=\"3.416\"")
    );
    // New actions of things whose last one is in the other file come after the include.
    let (text, _) = done(add_clip(&scene, "ben", "Walk", seconds(9.0)));
    assert!(text.contains("</seq>\n<play who=\"ben\" take=\"Walk\" begin=\"9\"/>\n</script>"), "{text}");
    let (text, _) = done(cut_to(&scene, "wide", seconds(2.0)));
    assert!(text.contains("</seq>\n<shot who=\"wide\" begin=\"2\"/>\n</script>"), "{text}");
    // The file refers to its own `x`.
    let other = MAIN.replace("\"y\"", "\"x\"");
    let script =
        including(&other, &[("part.xml", PART)]).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let planned = self::plan(&script);
    let scene = GestureScene { script: &script, plan: &planned };
    let text = delete_clip(&scene, script.action_called("x").expect("x"), Followers::Follow);
    assert_eq!(text, Ok(other.replace("<play id=\"x\" who=\"anna\" take=\"Run\"/>\n", "")));
    // An include that something depends on stays, and so do the things that only it has.
    let shot = MAIN.replace("</seq>", "<shot who=\"close\"/></seq>");
    let script =
        including(&shot, &[("part.xml", PART)]).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let planned = self::plan(&script);
    let scene = GestureScene { script: &script, plan: &planned };
    let refused = delete_clip(&scene, action(&script, "in"), Followers::Follow).expect_err("it is needed");
    assert!(refused.0.contains("no thing of the cast has the id \"close\""), "{refused}");
}

#[test]
fn included_actions_have_bars_with_the_name_of_their_file_and_the_include_has_one_of_its_own() {
    let script = main();
    let plan = plan(&script);
    let lanes = SceneLanes::new(&script, &plan);
    let bars: Vec<_> = lanes
        .list
        .iter()
        .flat_map(|lane| lane.bars.iter().map(|bar| (&*lane.name, bar.kind, bar.file.as_deref())))
        .collect();
    let part = Some("part.xml");
    assert_eq!(
        bars,
        [
            ("Shots", "shot", None),
            ("Shots", "shot", part),
            ("anna", "play", None),
            ("ben", "play", part),
            ("ben", "place", part),
            ("Scripts", "include", None)
        ]
    );
    let last = lanes.list.last().expect("a lane");
    assert_eq!((last.subject, &*last.bars[0].label), (LaneSubject::Includes, "part.xml"));
    // Two at the same time are below each other.
    let twice = MAIN.replace("</seq>", "</seq><include src=\"part.xml\"/>");
    let script =
        including(&twice, &[("part.xml", PART)]).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    assert_eq!(SceneLanes::new(&script, &self::plan(&script)).list.last().map(|lane| lane.rows), Some(2));
}

#[test]
fn what_belongs_to_an_include_is_found_from_its_actions() {
    let script = main();
    let include = action(&script, "in");
    assert_eq!(script.branch(include), include..include + 5);
    for at in script.branch(include) {
        assert_eq!(script.action_in_text(at), include);
        let range = script.tree().range_in_text(script.element(at)).expect("bytes");
        assert_eq!(&MAIN[range], "<include id=\"in\" src=\"part.xml\"/>");
    }
    let x = script.element(action(&script, "x"));
    assert_eq!(
        (script.tree().file_of(x), script.tree().place(x.range.start).to_string()),
        (Some("part.xml"), "2:16".to_owned())
    );
    // A caret is in the script itself, never in what another file has.
    let include = script.actions()[include].element;
    for at in MAIN.find("<include").expect("it") + 1..MAIN.find("/>\n<play id=\"y\"").expect("its end") {
        assert_eq!(script.tree().element_at(at), Some(include), "{at}");
    }
    let is_own = |element: usize| script.tree().elements()[element].is_own();
    assert!((0..=MAIN.len()).all(|at| script.tree().element_at(at).is_none_or(is_own)));
    let file = script.action_called("y").expect("y") - 1;
    assert!(script.element(file).is_included());
    assert_eq!(script.tree().element_at(script.element(file).range.start), None);
    // A text that is read again has the same files.
    let context: &ScriptContext = script.context();
    assert_eq!(context.files.texts().count(), context_of_main().files.texts().count());
    assert_eq!(script.reread(MAIN).expect("a script").actions().len(), script.actions().len());
}

fn context_of_main() -> ScriptContext {
    context("duel.xml", MAIN, &[("part.xml", PART)])
}

#[test]
fn an_include_is_completed_with_the_names_of_scripts() {
    let names = CompletionNames { scripts: &["part.xml"], sounds: &["a.ogg"], ..CompletionNames::default() };
    let at = |tag: &str| {
        let text = format!("<script version=\"1\">{tag}</script>");
        let cursor = text.find('|').expect("a cursor");
        let found = completions(&text.replace('|', ""), cursor, &names);
        found.map_or(Vec::new(), |found| found.items.into_iter().map(|item| item.label).collect::<Vec<_>>())
    };
    assert_eq!(at("<include src=\"|\"/>"), ["part.xml"]);
    assert_eq!(at("<sound src=\"|\"/>"), ["a.ogg"]);
    assert!(at("<inc|").contains(&"include".to_owned()));
}
