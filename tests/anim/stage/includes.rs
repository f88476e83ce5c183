//! Scripts that include others: when their actions are, what they name, and what is wrong with them.

use super::actors::{assets, bits, fox};
use super::{lengths, listed, random_scripts, scene};
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::schedule::resolve;
use dragonfly_anim::stage::script::{
    IncludedScripts, MOST_BYTES, MOST_ERRORS, MOST_INCLUDES, ScriptContext, ScriptError, ScriptTree,
    StageScript,
};
use dragonfly_anim::stage::splice::{TextSplices, remove_attribute};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_kit::random::{Random, seed};
use std::collections::BTreeMap;

/// Returns what a script called `name` is read with, where these are the files.
pub(super) fn context(name: &str, text: &str, files: &[(&str, &str)]) -> ScriptContext {
    let files: BTreeMap<&str, &str> = files.iter().copied().collect();
    let read = |file: &str| files.get(file).map(|text| (*text).into()).ok_or_else(|| "is not there".into());
    let files = IncludedScripts::default().collected(name, text, read);
    ScriptContext { name: name.into(), files, ..ScriptContext::default() }
}

pub(super) fn including(text: &str, files: &[(&str, &str)]) -> Result<StageScript, Vec<ScriptError>> {
    StageScript::read_in(text, &context("duel.xml", text, files))
}

fn read(text: &str, files: &[(&str, &str)]) -> StageScript {
    including(text, files).unwrap_or_else(|errors| panic!("{}", listed(&errors)))
}

/// Returns the errors of a script, as a command shows them.
fn errors(text: &str, files: &[(&str, &str)]) -> String {
    let errors = including(text, files).expect_err("it is wrong");
    errors.iter().map(|error| error.in_file("duel.xml")).collect::<Vec<_>>().join("\n")
}

/// Returns begin and end in seconds of all actions of a script.
fn times(script: &StageScript) -> Vec<(&'static str, f64, f64)> {
    let schedule = resolve(script, &lengths(script)).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let name = |action: usize| script.element(action).row.name;
    let times = schedule.times().iter().enumerate();
    times.map(|(action, times)| (name(action), times.begin.seconds(), times.stop.seconds())).collect()
}

const INTRO: &str = "<script version=\"1\" fps=\"12\" size=\"64x64\" seed=\"9\">\n<cast>\n  <camera id=\"wide\" at=\"9 9 9\"/>\n  <mark id=\"start\"/>\n</cast>\n\
    <seq id=\"scene\"><wait id=\"a\" dur=\"12f\"/><title id=\"b\" text=\"x\" dur=\"6f\"/></seq>\n</script>";

#[test]
fn a_random_part_of_a_script_has_the_same_moments_in_a_file_of_its_own() {
    let first = seed(1);
    println!("seed {first}");
    let model = fox();
    let assets = assets(&model);
    let (mut at, mut cut, mut planned, mut actions) = (first, 0, 0, 0);
    while cut < 500 {
        at += 1;
        let mut random = Random::new(at);
        let Some((by_hand, include, file)) = cut_out(&random_scripts::script(at), &mut random) else {
            continue;
        };
        let Ok(written) = StageScript::read(by_hand.as_str()) else { continue };
        let Ok(expected) = resolve(&written, &lengths(&written)) else { continue };
        let included = read(&include, &[("part.xml", &file)]);
        let found = resolve(&included, &lengths(&included))
            .unwrap_or_else(|errors| panic!("seed {at}: {}", listed(&errors)));
        assert_eq!(found.times(), expected.times(), "seed {at}\n{by_hand}\n{include}\n{file}");
        let passive =
            |script: &StageScript| script.actions().iter().map(|action| action.passive).collect::<Vec<_>>();
        assert_eq!(passive(&included), passive(&written), "seed {at}");
        cut += 1;
        actions += found.times().len();
        if planned < 60 {
            let [by_hand, include, file] = [by_hand, include, file].map(|text| {
                let takes = ["PickUp", "Slash", "Idle", "Fall"];
                takes.iter().fold(text, |text, take| text.replace(&format!("\"{take}\""), "\"Survey\""))
            });
            let Ok(expected) = StagePlan::new(&super::read(&by_hand), &assets) else { continue };
            let found = StagePlan::new(&read(&include, &[("part.xml", &file)]), &assets);
            let found = found.unwrap_or_else(|errors| panic!("seed {at}: {}", listed(&errors)));
            let (mut one, mut other) = (expected.new_scene(), found.new_scene());
            for frame in [0, 7, 24, 25, 61, 120, 400] {
                expected.frame(frame, &mut one);
                found.frame(frame, &mut other);
                assert_eq!(
                    bits(&other),
                    bits(&one),
                    "seed {at}, frame {frame}\n{by_hand}\n{include}\n{file}"
                );
                assert_eq!(
                    (&other.titles, &other.sounds),
                    (&one.titles, &one.sounds),
                    "seed {at}, frame {frame}"
                );
            }
            planned += 1;
        }
    }
    println!("{cut} parts, {actions} actions, {planned} plans");
    assert!(planned == 60 && actions > 3000, "{actions}");
}

/// Returns a script without references into or out of one of its `par`, the same with an `include` in its place, and the file of that.
pub(super) fn cut_out(text: &str, random: &mut Random) -> Option<(String, String, String)> {
    let tree = ScriptTree::read(text).ok()?;
    let pars: Vec<usize> =
        (0..tree.elements().len()).filter(|&element| tree.elements()[element].row.name == "par").collect();
    let par = (!pars.is_empty()).then(|| random.choice(&pars))?;
    let range = tree.elements()[par].range.clone();
    let id_of = |element: usize| tree.elements()[element].value("id");
    let is_inside = |element: usize| {
        let own = &tree.elements()[element].range;
        element != par && range.start <= own.start && own.end <= range.end
    };
    let all = || 0..tree.elements().len();
    let inner: Vec<&str> = all().filter(|&element| is_inside(element)).filter_map(id_of).collect();
    let mut splices = Vec::new();
    for element in all() {
        for name in ["begin", "end"] {
            let Some((other, _)) =
                tree.elements()[element].value(name).and_then(|value| value.split_once('.'))
            else {
                continue;
            };
            let is_id = other == "prev"
                || id_of(par) == Some(other)
                || all().any(|element| id_of(element) == Some(other));
            if is_id && other != "prev" && inner.contains(&other) != is_inside(element) {
                splices.push(remove_attribute(&tree, element, name)?);
            }
        }
    }
    let by_hand = TextSplices::joined(splices)?.apply(text);
    let tree = ScriptTree::read(by_hand.as_str()).ok()?;
    let own = &tree.elements()[par];
    let whole = &by_hand[own.range.clone()];
    let tag = whole.find('>')? + 1;
    let (start, content) = (&whole[..tag], whole[tag..].strip_suffix("</par>")?);
    let include = start.replacen("<par", "<include src=\"part.xml\"", 1).replace('>', "/>");
    let include = format!("{}{include}{}", &by_hand[..own.range.start], &by_hand[own.range.end..]);
    let file = scene(content);
    Some((by_hand, include, file))
}

#[test]
fn frames_of_an_included_script_are_its_own_and_its_size_and_seed_count_not() {
    let text = "<script version=\"1\" fps=\"24\" seed=\"3\"><seq><wait dur=\"12f\"/><include id=\"in\" src=\"intro.xml\" begin=\"6f\"/>\
                <wait dur=\"12f\"/></seq></script>";
    let script = read(text, &[("intro.xml", INTRO)]);
    assert_eq!(
        times(&script),
        [
            ("script", 0.0, 2.75),
            ("seq", 0.0, 2.75),
            ("wait", 0.0, 0.5),
            ("include", 0.75, 2.25),
            ("seq", 0.75, 2.25),
            ("wait", 0.75, 1.75),
            ("title", 1.75, 2.25),
            ("wait", 2.25, 2.75)
        ]
    );
    assert_eq!((script.seed(), script.size(), script.rate().frame(24).seconds()), (3, [1280, 720], 1.0));
    // As if it were read alone, the frames of a second are those of the project.
    let project = StageProject::read("<project version=\"1\" fps=\"6\"/>").unwrap();
    let (intro, outer) = (
        INTRO.replace(" fps=\"12\"", ""),
        "<script version=\"1\" fps=\"24\"><include src=\"intro.xml\"/></script>",
    );
    let context =
        ScriptContext { project: Some(project), ..context("duel.xml", outer, &[("intro.xml", &intro)]) };
    let script = StageScript::read_in(outer, &context).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    assert_eq!(times(&script)[0].2, 3.0);
}

#[test]
fn an_end_and_a_duration_cut_what_is_included_as_they_cut_a_par() {
    let of = |attribute: &str| {
        let text = format!(
            "<script version=\"1\"><include id=\"in\" src=\"intro.xml\"{attribute}/><wait begin=\"in.end\" dur=\"1\"/></script>"
        );
        times(&read(&text, &[("intro.xml", INTRO)]))
            .into_iter()
            .map(|(_, begin, stop)| (begin, stop))
            .collect::<Vec<_>>()
    };
    assert_eq!(of(""), [(0.0, 2.5), (0.0, 1.5), (0.0, 1.5), (0.0, 1.0), (1.0, 1.5), (1.5, 2.5)]);
    assert_eq!(of(" dur=\"0.5\"")[1..5], [(0.0, 0.5), (0.0, 0.5), (0.0, 0.5), (1.0, 1.0)]);
    assert_eq!(of(" end=\"1.25\"")[4], (1.0, 1.25));
    assert_eq!(of(" dur=\"4\"")[5], (4.0, 5.0));
}

#[test]
fn names_of_actions_are_those_of_their_file_and_things_of_one_id_are_one_thing() {
    let text = "<script version=\"1\"><cast><camera id=\"wide\" at=\"1 2 3\"/></cast>\
        <include id=\"in\" src=\"intro.xml\"/><include id=\"a\" src=\"intro.xml\"/><wait id=\"scene\" begin=\"a.end\" dur=\"1\"/></script>";
    let script = read(text, &[("intro.xml", INTRO)]);
    let ids: Vec<_> = script
        .things()
        .filter_map(|thing| Some((thing.row.name, thing.value("id")?, thing.value("at")?)))
        .collect();
    assert_eq!(ids, [("camera", "wide", "1 2 3"), ("mark", "start", "0 0 0")], "the first one decides");
    assert_eq!(script.element(script.action_called("a").unwrap()).row.name, "include");
    assert_eq!(script.element(script.action_called("scene").unwrap()).row.name, "wait");
    // From outside, only the id of the include is seen.
    let outside = text.replace("begin=\"a.end\"", "begin=\"b.end\"");
    assert!(
        errors(&outside, &[("intro.xml", INTRO)]).starts_with("duel.xml:1:"),
        "{}",
        errors(&outside, &[("intro.xml", INTRO)])
    );
    // And from inside, nothing of the script around.
    let inside = INTRO.replace("id=\"b\"", "id=\"b\" begin=\"in.begin\"");
    let wanted = "intro.xml:6:62: no action has the id \"in\"; ids of actions: a, b, scene";
    assert_eq!(errors(text, &[("intro.xml", &inside)]), wanted, "once, although it is included twice");
    let who = INTRO.replace("<title id=\"b\" text=\"x\" dur=\"6f\"/>", "<shot who=\"door\"/>");
    let cast = text.replace("<cast>", "<cast><camera id=\"door\"/>");
    assert!(errors(&cast, &[("intro.xml", &who)]).contains("no thing of the cast has the id \"door\""));
    // A file sees the things of those that it includes as its own cast.
    let (middle, shot) = (
        "<script version=\"1\"><include src=\"intro.xml\"/><shot who=\"wide\"/></script>",
        "<shot who=\"wide\"/>",
    );
    let outer = format!("<script version=\"1\"><include src=\"middle.xml\"/>{shot}</script>");
    assert_eq!(read(&outer, &[("middle.xml", middle), ("intro.xml", INTRO)]).things().len(), 2);
}

#[test]
fn a_thing_of_another_kind_or_model_is_an_error_that_names_both_places() {
    let text = "<script version=\"1\">\n<cast>\n  <prop id=\"start\" model=\"a.glb\"/></cast>\n<include src=\"intro.xml\"/></script>";
    assert_eq!(
        errors(text, &[("intro.xml", INTRO)]),
        "intro.xml:4:13: \"start\" is a prop at 3:3; things of the same id are one thing: give one of them another id"
    );
    let other = INTRO.replace("<mark id=\"start\"/>", "<prop id=\"start\" model=\"b.glb\"/>");
    assert!(errors(text, &[("intro.xml", &other)]).contains("\"start\" is model=\"a.glb\" at 3:3"));
    let again = "<script version=\"1\"><include src=\"intro.xml\"/><include src=\"b.xml\"/></script>";
    let found = errors(again, &[("intro.xml", INTRO), ("b.xml", &other)]);
    assert!(found.starts_with("b.xml:4:13: \"start\" is a mark at intro.xml:4:3"), "{found}");
}

#[test]
fn errors_of_an_included_file_have_its_places_and_the_bytes_of_the_include() {
    let text = "<script version=\"1\">\n  <include src=\"scenes/intro.xml\"/></script>";
    let wrong = INTRO.replace("text=\"x\"", "txt=\"x\" text=\"x\"");
    let list = including(text, &[("scenes/intro.xml", &wrong)]).unwrap_err();
    assert_eq!(&text[list[0].range.clone()], "include");
    assert_eq!(list[0].place.to_string(), "2:4");
    let inside = list[0].inside.as_ref().unwrap();
    assert_eq!((&*inside.file, inside.place.to_string()), ("scenes/intro.xml", "6:55".to_owned()));
    assert_eq!(&wrong[inside.range.clone()], "txt");
    assert!(
        list[0]
            .in_file("duel.xml")
            .starts_with("scenes/intro.xml:6:55: \"txt\" is not an attribute of <title>")
    );
    assert!(list[0].to_string().starts_with("2:4: scenes/intro.xml:6:55: "), "{}", list[0]);
    // Of a plan: a take that the model of the thing lacks, in a file that an included file includes.
    let inner = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\"/></cast>\n<play who=\"anna\" take=\"Fly\"/></script>";
    let middle = "<script version=\"1\"><include src=\"inner.xml\"/></script>";
    let outer = "<script version=\"1\"><cast><role id=\"anna\" model=\"scenes/a.glb\"/></cast><include src=\"scenes/middle.xml\"/></script>";
    let script = read(outer, &[("scenes/middle.xml", middle), ("scenes/inner.xml", inner)]);
    let mut assets = assets(&fox());
    assets.add_model("scenes/a.glb", fox());
    let found = StagePlan::new(&script, &assets).unwrap_err();
    assert!(
        found[0].in_file("duel.xml").starts_with("scenes/inner.xml:2:24: \"anna\" has no take \"Fly\""),
        "{}",
        found[0]
    );
    assert_eq!(&outer[found[0].range.clone()], "include");
    assert_eq!(&inner[found[0].inside.as_ref().unwrap().range.clone()], "Fly");
}

#[test]
fn models_and_sounds_of_an_included_script_are_relative_to_its_folder_unless_a_project_says_what_they_are() {
    let inner = "<script version=\"1\"><cast><prop id=\"box\" model=\"box.glb\"/></cast><sound src=\"../a.ogg\"/></script>".replace("../", "");
    let outer = "<script version=\"1\"><include src=\"./parts/inner.xml\"/></script>";
    let given = context("duel.xml", outer, &[("parts/inner.xml", &inner)]);
    let names = |context: &ScriptContext| {
        let script =
            StageScript::read_in(outer, context).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
        let sound = script.element(2).value("src").unwrap().to_owned();
        (script.things().next().unwrap().value("model").unwrap().to_owned(), sound)
    };
    assert_eq!(names(&given), ("parts/box.glb".to_owned(), "parts/a.ogg".to_owned()));
    let project = Some(StageProject::read("<project version=\"1\"/>").unwrap());
    assert_eq!(names(&ScriptContext { project, ..given }), ("box.glb".to_owned(), "a.ogg".to_owned()));
}

#[test]
fn files_that_include_each_other_are_missing_or_are_too_deep_are_errors_that_name_them() {
    let of = |file: &str| format!("<script version=\"1\"><include src=\"{file}\"/></script>");
    let (duel, a) = (of("a.xml"), of("duel.xml"));
    assert_eq!(
        errors(&duel, &[("a.xml", &a), ("duel.xml", &duel)]),
        "a.xml:1:35: files include each other: duel.xml → a.xml → duel.xml"
    );
    assert_eq!(
        errors(&of("duel.xml"), &[("duel.xml", &duel)]),
        "duel.xml:1:35: files include each other: duel.xml → duel.xml"
    );
    assert_eq!(errors(&duel, &[]), "duel.xml:1:35: a.xml is not there");
    let deep: Vec<(String, String)> =
        (0..20).map(|at| (format!("{at}.xml"), of(&format!("{}.xml", at + 1)))).collect();
    let files = |last: usize| {
        let mut files: Vec<(&str, &str)> =
            deep[..last].iter().map(|(name, text)| (&**name, &**text)).collect();
        files.push((&deep[last].0, "<script version=\"1\"/>"));
        files
    };
    assert_eq!(read(&of("0.xml"), &files(MOST_INCLUDES - 1)).actions().len(), 1 + MOST_INCLUDES);
    let found = errors(&of("0.xml"), &files(MOST_INCLUDES));
    assert!(
        found.starts_with("7.xml:1:35: files are included more than 8 deep: duel.xml → 0.xml → 1.xml"),
        "{found}"
    );
    for above in ["../a.xml", "/a.xml", "c:/a.xml", "a\\b.xml", "x/../a.xml"] {
        let found = errors(&of(above), &[]);
        assert!(
            found.contains("is not a relative path with `/`, below the folder of the script"),
            "{above}: {found}"
        );
    }
}

#[test]
fn the_limits_of_a_script_hold_for_all_included_files_together() {
    let large = format!("<script version=\"1\"><!--{}--></script>", " ".repeat(MOST_BYTES / 100));
    let outer =
        |count: usize| format!("<script version=\"1\">{}</script>", "<include src=\"a.xml\"/>".repeat(count));
    assert!(including(&outer(99), &[("a.xml", &large)]).is_ok());
    let found = errors(&outer(5000), &[("a.xml", &large)]);
    assert!(found.contains("a.xml has, together with the others, more than the 8388608 bytes"), "{found}");
    assert_eq!(found.lines().count(), 1);
    // Eight files of ten includes each are 10^8 scripts.
    let files: Vec<(String, String)> = (0..8)
        .map(|at| (format!("{at}.xml"), outer(10).replace("a.xml", &format!("{}.xml", at + 1))))
        .collect();
    let mut files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (&**name, &**text)).collect();
    files.push(("8.xml", "<script version=\"1\"><wait dur=\"1\"/></script>"));
    let found = errors("<script version=\"1\"><include src=\"1.xml\"/></script>", &files);
    assert!(found.contains("together with the others, more than the"), "{found}");
    // Files that no one could hold are not even kept.
    let text = outer(1).replace("a.xml", "1.xml");
    let huge: Vec<(String, String)> = (0..8)
        .map(|at| {
            (
                format!("{at}.xml"),
                format!("{large}<!--{}-->", " ".repeat(MOST_BYTES / 3))
                    .replace("</script>", &format!("<include src=\"{}.xml\"/></script>", at + 1)),
            )
        })
        .collect();
    let huge: Vec<(&str, &str)> = huge.iter().map(|(name, text)| (&**name, &**text)).collect();
    let kept: usize = context("duel.xml", &text, &huge).files.texts().map(|(_, text)| text.len()).sum();
    assert!(kept <= MOST_BYTES, "{kept}");
}

/// With a place for each error again, these take hours.
#[test]
fn a_hundred_thousand_includes_of_a_wrong_file_are_its_errors_once() {
    let text = format!("<script version=\"1\">{}</script>", "<include src=\"a.xml\"/>".repeat(100_000));
    let tables = "<script version=\"1\"><plai/></script>";
    let found = errors(&text, &[("a.xml", tables)]);
    assert!(found.starts_with("a.xml:1:22: <plai> is no element of <script>") && found.lines().count() == 1);
    let names = "<script version=\"1\"><shot who=\"none\"/></script>";
    let found = errors(&text, &[("a.xml", names)]);
    assert!(found.starts_with("a.xml:1:32: ") && found.lines().count() == 1, "{found}");
    let found = errors(&text, &[]);
    assert!(found.lines().count() <= MOST_ERRORS, "{}", found.lines().count());
}

#[test]
fn a_file_is_read_again_only_where_its_text_is_another() {
    let text =
        "<script version=\"1\"><include src=\"intro.xml\"/><include src=\"intro.xml\" begin=\"9\"/></script>";
    let mut reads = 0;
    let mut collect = |from: &IncludedScripts, intro: &str| {
        from.collected("duel.xml", text, |_| {
            reads += 1;
            Ok(intro.into())
        })
    };
    let first = collect(&IncludedScripts::default(), INTRO);
    let second = collect(&first, &INTRO.replace("12f", "24f"));
    assert_eq!(reads, 2, "each file once");
    let length = |files: &IncludedScripts| {
        let context =
            ScriptContext { name: "duel.xml".into(), files: files.clone(), ..ScriptContext::default() };
        let script =
            StageScript::read_in(text, &context).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
        resolve(&script, &lengths(&script)).unwrap().length()
    };
    assert_eq!([length(&first), length(&second)], [10.5, 11.5].map(StageTime::from_seconds));
}
