//! Projects: read, checked, and shared by their scripts.

use super::actors::{assets, fox};
use super::listed;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::splice::{ElementPlace, NewElement, insert, set_attribute};
use dragonfly_anim::stage::time::StageTime;

/// The project of the reference.
pub(super) const PROJECT: &str = include_str!("../../data/stage/duel.meproj");

fn read(text: &str) -> StageProject {
    StageProject::read(text).unwrap_or_else(|errors| panic!("{}", listed(&errors)))
}

#[test]
fn a_project_names_its_files_and_its_models_have_ids() {
    let project = read(PROJECT);
    assert_eq!(project.scripts().collect::<Vec<_>>(), ["duel.xml"]);
    assert_eq!(project.lines(), Some("duel.lines.xml"));
    assert_eq!(
        (project.source_of("anna"), project.source_of("models/x.glb")),
        ("models/anna.glb", "models/x.glb")
    );
    let wanted = [
        "models/anna.glb",
        "models/ben.m3d",
        "duel.edits/anna.jsonl",
        "sky/dusk.hdr",
        "duel.lines.xml",
        "duel.xml",
    ];
    assert_eq!(project.files(), wanted);
}

#[test]
fn everything_that_is_wrong_with_a_project_has_its_place_and_a_suggestion() {
    for (from, to, wanted) in [
        (
            "of=\"anna\"",
            "of=\"ana\"",
            "6:16: there is no model \"ana\"; did you mean \"anna\"? (models: anna, ben)",
        ),
        (
            "script=\"main\"",
            "script=\"mian\"",
            "there is no script \"mian\"; did you mean \"main\"? (scripts: main)",
        ),
        (
            "id=\"ben\"",
            "id=\"anna\"",
            "the id \"anna\" is used at 4:5 already; an id names one part of a project",
        ),
        ("src=\"duel.xml\"", "src=\"../duel.xml\"", "src=\"../duel.xml\" is not a relative path"),
        ("src=\"duel.xml\"", "src=\"/duel.xml\"", "src=\"/duel.xml\" is not a relative path"),
        (
            "tone=\"agx\"",
            "tone=\"agz\"",
            "tone=\"agz\" is not one of the listed words; did you mean \"agx\"?",
        ),
        ("<models>", "<modles>", "<modles> is no element of <project>; did you mean \"models\"?"),
        ("<movie ", "<scene/><movie ", "a project has one <scene>"),
        ("<movie ", "<play who=\"a\" take=\"b\"/><movie ", "<play> is no element of <project>"),
    ] {
        let mut text = PROJECT.replacen(from, to, 1);
        if from == "<models>" {
            text = text.replace("</models>", "</modles>");
        }
        let errors = StageProject::read(text).expect_err(wanted);
        let all = listed(&errors);
        assert!(all.contains(wanted), "{all}");
    }
}

#[test]
fn elements_and_attributes_of_other_namespaces_are_kept_and_ignored() {
    let text = PROJECT
        .replace("<project ", "<project xmlns:x=\"urn:x\" x:mood=\"dark\" ")
        .replace("<models>", "<x:notes><x:note/></x:notes><models>");
    assert_eq!(read(&text).files(), read(PROJECT).files());
}

#[test]
fn the_cast_of_a_project_is_that_of_its_scripts_and_so_are_frame_rate_and_size() {
    let project = read(
        "<project version=\"1\" fps=\"30\" size=\"640x360\" seed=\"5\"><cast><camera id=\"wide\" look=\"anna\"/>\
        <mark id=\"door\" at=\"3 0 0\"/></cast></project>",
    );
    let text = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/></cast>\
        <shot who=\"wide\"/><move who=\"anna\" to=\"door\" take=\"Walk\"/></script>";
    assert!(StageScript::read(text).is_err(), "alone, it has no camera and no door");
    let script =
        StageScript::read_of(text, Some(&project)).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    assert_eq!((script.rate().frame(30).seconds(), script.size(), script.seed()), (1.0, [640, 360], 5));
    let own = StageScript::read_of(text.replace("version=\"1\"", "version=\"1\" fps=\"60\""), Some(&project))
        .expect("a script");
    assert_eq!(own.rate().frame(60).seconds(), 1.0, "what the script says counts");
    let plan =
        StagePlan::new(&script, &assets(&fox())).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let mut scene = plan.new_scene();
    plan.scene_at(plan.length(), &mut scene);
    let anna = plan.thing_called("anna").expect("anna");
    assert!((scene.things[anna].transform.translation - glam::Vec3::X * 3.0).length() < 1e-4);
    assert_eq!(scene.camera.map(|camera| camera.thing), plan.thing_called("wide"));
    // Nothing of the script's text is the place of a shared thing.
    let shared: Vec<_> = script.things().filter(|thing| !thing.is_own()).collect();
    assert!(shared.len() == 2 && shared.iter().all(|thing| thing.range.start > text.len()));
    let twice = text.replace("id=\"anna\"", "id=\"wide\"");
    let errors = StageScript::read_of(twice, Some(&project)).expect_err("twice");
    assert_eq!(errors[0].message, "the id \"wide\" is used in the cast of the project already");
}

#[test]
fn a_small_change_of_a_project_changes_one_line() {
    let project = read(PROJECT);
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let changed = |new: &str| {
        let (old, new) = (lines(PROJECT), lines(new));
        let same = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
        let tail = old[same..].iter().rev().zip(new[same..].iter().rev()).take_while(|(a, b)| a == b).count();
        (old.len() - same - tail, new.len() - same - tail)
    };
    let at = |name: &str| {
        project.tree().elements().iter().position(|element| element.row.name == name).expect(name)
    };
    let scale = set_attribute(project.tree(), at("model"), "scale", "0.5").expect("a place").apply(PROJECT);
    assert_eq!(changed(&scale), (1, 1));
    let edits = NewElement::new("edits").with("of", "ben").with("src", "duel.edits/ben.jsonl");
    let added =
        insert(project.tree(), ElementPlace::After(at("edits")), &edits).expect("a place").apply(PROJECT);
    assert_eq!(changed(&added), (0, 1));
    assert!(read(&added).files().contains(&"duel.edits/ben.jsonl"));
}

#[test]
fn things_fall_to_the_ground_of_the_project_and_walk_on_it_and_its_name_and_range_are_read() {
    let text = "<project version=\"1\" name=\"A fox\" fps=\"30\" start=\"15f\" end=\"0:02.5\"><scene ground=\"-0.75\"/></project>";
    let project = read(text);
    let range = project.range().map(|time| time.expect("a time").seconds());
    assert_eq!((project.name(), range, project.ground()), (Some("A fox"), [0.5, 2.5], -0.75));
    let none = read("<project version=\"1\"/>");
    assert_eq!((none.name(), none.range(), none.ground()), (None, [None, None], 0.0));
    let script = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"0.01\" at=\"0 2 0\"/>\
        <mark id=\"cup\" at=\"0 1 0\"/><prop id=\"bag\" model=\"a.glb\" at=\"0 3 0\"/><path id=\"way\" points=\"0 2 0  4 2 0\"/></cast>\
        <move who=\"anna\" path=\"way\" speed=\"1\" ground=\"plane\" feet=\"free\"/>\
        <attach who=\"bag\" to=\"cup\"/><detach who=\"bag\" drop=\"ground\" begin=\"1\"/></script>";
    for (project, ground) in [(Some(&project), -0.75), (Some(&none), 0.0), (None, 0.0)] {
        let script =
            StageScript::read_of(script, project).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
        let plan =
            StagePlan::new(&script, &assets(&fox())).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
        let mut scene = plan.new_scene();
        let mut height = |id: &str, seconds: f64| {
            plan.scene_at(StageTime::from_seconds(seconds), &mut scene);
            scene.things[plan.thing_called(id).expect(id)].transform.translation.y
        };
        assert!((height("anna", 2.0) - ground).abs() < 1e-5);
        assert!((height("bag", 0.5) - 1.0).abs() < 1e-5, "it is held");
        // Half of 9.81 m/s² times a fifth of a second squared.
        assert!((height("bag", 1.2) - (1.0 - 0.5 * 9.81 * 0.04)).abs() < 2e-3, "{}", height("bag", 1.2));
        assert!((height("bag", 3.0) - ground).abs() < 1e-5);
    }
}
