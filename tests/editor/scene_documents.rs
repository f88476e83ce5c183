//! Scripts and projects on the command line as documents: edited, queried, merged, recorded, packed.

use crate::program::run;
use crate::stdio::StdioSession;
use dragonfly_document::{Decision, DocumentMessage, SceneModel, View};
use dragonfly_kit::document::test_document::{TestDocument, fox};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::skip::{TestNeed, skip};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const SCENE: &str = "<script version=\"1\">\n  <cast>\n    <role id=\"fox\" model=\"Fox.glb\" scale=\"0.01\"/>\n  </cast>\n  \
    <!-- two takes -->\n  <seq>\n    <play id=\"first\" who=\"fox\" take=\"Walk\"/>\n    <play who=\"fox\" take=\"Run\" speed=\"2\"/>\n  </seq>\n</script>\n";

fn scene(folder: &Folder) -> PathBuf {
    fox(folder);
    let path = folder.join("scene.xml");
    fs::write(&path, SCENE).expect("a file");
    path
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// Returns an edit of a script as a line.
fn line(of: &str, old: &str, new: &str) -> String {
    let at = of.find(old).expect(old);
    json!({"edit": "script", "splices": [{"at": at, "old": old, "new": new}]}).to_string()
}

#[test]
fn a_script_is_edited_and_queried_over_standard_input_and_saved_with_only_the_edited_bytes_changed() {
    let folder = Folder::new("stdio-scene");
    let path = scene(&folder);
    let mut session = StdioSession::about(&path);
    assert_eq!(session.ask(&json!({"query": "texts"})), json!([{"name": "scene.xml", "bytes": SCENE.len()}]));
    assert_eq!(session.ask(&json!({"query": "text"}))["text"], SCENE);
    assert_eq!(
        session.ask(&json!({"query": "errors"})),
        json!({"text": "scene.xml", "errors": [], "notes": []})
    );
    let before = session.ask(&json!({"query": "schedule"}));
    assert!(
        before["length"].as_f64().is_some_and(|length| (length - (0.708_333 + 0.579_166)).abs() < 1e-3),
        "{before}"
    );
    let answer = session.say(&line(SCENE, "Walk", "Survey"));
    assert_eq!(answer["ok"], json!({"steps": 1, "done": 1}));
    let after = session.ask(&json!({"query": "schedule"}));
    assert!(
        after["length"].as_f64().is_some_and(|length| (length - (3.416_666 + 0.579_166)).abs() < 1e-3),
        "{after}"
    );
    let refused = session.say(&line(SCENE, "Walk", "Survey"));
    assert!(
        refused["error"].as_str().is_some_and(|reason| reason.contains("the text there is not \"Walk\"")),
        "{refused}"
    );
    let survey = SCENE.replace("Walk", "Survey");
    session.say(&line(&survey, "Run", "Rnu"));
    let errors = session.ask(&json!({"query": "errors"}));
    assert_eq!(errors["errors"][0]["line"], 8);
    assert_eq!(errors["errors"][0]["help"], "did you mean \"Run\"? (takes: Survey, Walk, Run)");
    assert!(
        session.say(r#"{"query": "schedule"}"#)["error"].as_str().is_some_and(|reason| reason.contains("8:"))
    );
    session.ask(&json!({"do": "undo"}));
    let saved = session.ask(&json!({"do": "save"}));
    assert_eq!(
        saved["changes"]["texts"],
        json!([{"name": "scene.xml", "line": 7, "removed": 1, "added": 1}])
    );
    assert_eq!(fs::read_to_string(&path).expect("a file"), survey);
    session.ask(&json!({"do": "go_to", "steps": 0}));
    assert_eq!(session.ask(&json!({"query": "text"}))["text"], SCENE);
}

#[test]
fn edits_of_a_script_are_applied_listed_and_merged_by_the_command_line() {
    let folder = Folder::new("edit-scene");
    let path = scene(&folder);
    let edits = folder.join("edits.jsonl");
    fs::write(&edits, format!("{}\n", line(SCENE, "Walk", "Survey"))).expect("a file");
    let output = folder.join("out.xml");
    let plan = run(["edit", text(&path), "--edits", text(&edits), "--dry-run"]).expect(0);
    assert_eq!(plan.text().trim(), "scene.xml: from line 7, 1 lines become 1");
    run(["edit", text(&path), "--edits", text(&edits), "-o", text(&output)]).expect(0);
    assert_eq!(fs::read_to_string(&output).expect("a file"), SCENE.replace("Walk", "Survey"));
    // Another program changed another line, and then the same one.
    let new = folder.join("new.xml");
    fs::write(&new, SCENE.replace("two takes", "two takes of the fox")).expect("a file");
    run(["edit", text(&new), "--rebase", text(&path), "--edits", text(&edits), "-o", text(&output)])
        .expect(0);
    let merged = SCENE.replace("two takes", "two takes of the fox").replace("Walk", "Survey");
    assert_eq!(fs::read_to_string(&output).expect("a file"), merged);
    fs::write(&new, SCENE.replace("Walk", "Run")).expect("a file");
    let refused =
        run(["edit", text(&new), "--rebase", text(&path), "--edits", text(&edits), "-o", text(&output)])
            .expect(1);
    assert!(
        refused.stderr.contains("line 1: Edit script: line 7 of scene.xml is another one"),
        "{}",
        refused.stderr
    );
}

/// Restores the offered work of a file.
fn restored(path: &Path, journals: &Path) -> View {
    let mut document = TestDocument::new(journals);
    document.open(path);
    let offer = document.wait_for_offers().remove(0);
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    document.wait_for_view(|view| view.history.done > 0)
}

#[test]
fn a_kill_while_three_models_and_a_script_are_edited_loses_nothing_that_was_answered() {
    let folder = Folder::new("kill-four");
    let path = scene(&folder);
    let models: Vec<PathBuf> = (0..3)
        .map(|number| {
            let copy = folder.join(&format!("Fox{number}.glb"));
            fs::copy(folder.join("Fox.glb"), &copy).expect("a copy");
            copy
        })
        .collect();
    let journals = folder.join("journals");
    let mut script = StdioSession::recording(&path, &journals);
    let mut sessions: Vec<StdioSession> =
        models.iter().map(|model| StdioSession::recording(model, &journals)).collect();
    let mut now = SCENE.to_owned();
    for round in 0..5 {
        let (old, new) = (
            if round == 0 { "speed=\"2\"".to_owned() } else { format!("speed=\"2.{}\"", round - 1) },
            format!("speed=\"2.{round}\""),
        );
        assert!(script.say(&line(&now, &old, &new))["ok"].is_object());
        now = now.replace(&old, &new);
        for session in &mut sessions {
            session.ask(&json!({"edit": "rename_take", "take": 0, "name": format!("take {round}")}));
        }
    }
    script.kill();
    sessions.iter_mut().for_each(StdioSession::kill);
    let view = restored(&path, &journals);
    assert_eq!((&*view.scene.expect("a scene").text, view.history.done), (&*now, 5));
    for model in &models {
        let view = restored(model, &journals);
        assert_eq!((view.takes[0].name.as_str(), view.history.done), ("take 4", 5));
    }
}

/// A project of three models, whose edits it keeps.
fn project_of_three(folder: &Folder) -> PathBuf {
    fox(folder);
    let roles =
        (0..3).map(|number| format!("    <role id=\"r{number}\" model=\"m{number}\" scale=\"0.01\"/>\n"));
    let main = format!(
        "<script version=\"1\">\n  <cast>\n{}  </cast>\n  <wait dur=\"1\"/>\n</script>\n",
        roles.collect::<String>()
    );
    fs::write(folder.join("main.xml"), main).expect("a file");
    let models = (0..3).map(|number| {
        fs::copy(folder.join("Fox.glb"), folder.join(&format!("Fox{number}.glb"))).expect("a copy");
        format!("    <model id=\"m{number}\" src=\"Fox{number}.glb\"/>\n")
    });
    let project = format!(
        "<project version=\"1\">\n  <models>\n{}  </models>\n  <script id=\"main\" src=\"main.xml\"/>\n</project>\n",
        models.collect::<String>()
    );
    let path = folder.join("foxes.meproj");
    fs::write(&path, project).expect("a file");
    path
}

#[test]
fn a_kill_while_a_project_keeps_edits_of_three_models_and_its_script_is_edited_loses_nothing_that_was_answered()
 {
    let folder = Folder::new("kill-project");
    let path = project_of_three(&folder);
    let journals = folder.join("journals");
    let mut session = StdioSession::recording(&path, &journals);
    let mut main = fs::read_to_string(folder.join("main.xml")).expect("a file");
    let mut project = fs::read_to_string(&path).expect("a file");
    let mut kept = vec![String::new(); 3];
    let mut steps = 0;
    for round in 0..4 {
        for (number, kept) in kept.iter_mut().enumerate() {
            let (name, id) = (format!("foxes.edits/m{number}.jsonl"), format!("m{number}"));
            let edit =
                json!({"edit": "rename_take", "take": round % 3, "name": format!("take {number} {round}")});
            let new = format!("{edit}\n");
            let splice = json!([{"at": kept.len(), "new": new}]);
            let mut step = json!({"edit": "script", "text": name, "splices": splice, "label": "Edit model"});
            if round == 0 {
                let model = format!("<model id=\"{id}\" src=\"Fox{number}.glb\"/>");
                let edits = format!("{model}\n    <edits of=\"{id}\" src=\"{name}\"/>");
                let at = project.find(&model).expect("a model");
                step["create"] = json!(true);
                step["also"] = json!([{"splices": [{"at": at, "old": model, "new": edits}]}]);
                project = project.replace(&model, &edits);
            }
            session.ask(&step);
            *kept += &new;
            let (old, now) = (format!("<role id=\"r{number}\""), format!("<role  id=\"r{number}\""));
            let (old, now) = if round % 2 == 0 { (old, now) } else { (now, old) };
            let at = main.find(&old).expect("a role");
            session.ask(&json!({"edit": "script", "text": "main.xml", "splices": [{"at": at, "old": old, "new": now}]}));
            main = main.replace(&old, &now);
            steps += 2;
        }
    }
    session.kill();
    let mut document = TestDocument::new(&journals);
    document.open(&path);
    let offer = document.wait_for_offers().remove(0);
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    // The models are shown as the files have them until they were read with their edits.
    let is_edited = |model: &SceneModel| match model {
        SceneModel::Loaded(loaded) => {
            loaded.model.animation.takes.iter().all(|take| take.name.starts_with("take "))
        }
        SceneModel::Loading | SceneModel::Missing(_) => false,
    };
    let is_read = |view: &View| {
        let models = view.scene.as_ref().map(|scene| scene.models.clone()).unwrap_or_default();
        view.history.done == steps && models.len() == 3 && models.values().all(is_edited)
    };
    let view = document.wait_for_view(is_read);
    let scene = view.scene.expect("a scene");
    let text_of = |name: &str| scene.texts.called(name).map(|file| file.text.to_string()).expect(name);
    assert_eq!((text_of("foxes.meproj"), text_of("main.xml")), (project, main));
    for (number, kept) in kept.iter().enumerate() {
        assert_eq!(text_of(&format!("foxes.edits/m{number}.jsonl")), *kept);
        let Some(SceneModel::Loaded(loaded)) = scene.models.get(&format!("m{number}")) else {
            panic!("m{number}")
        };
        // The scene plays the edits: the last name of each take.
        let names: Vec<&str> = loaded.model.animation.takes.iter().map(|take| take.name.as_str()).collect();
        assert_eq!(names, [3, 1, 2].map(|round| format!("take {number} {round}")));
    }
}

#[test]
fn a_project_is_checked_packed_and_unpacked_and_its_schema_is_printed() {
    let folder = Folder::new("pack-command");
    scene(&folder);
    let project = folder.join("foxes.meproj");
    let text_of = "<project version=\"1\">\n  <script id=\"main\" src=\"scene.xml\"/>\n</project>\n";
    fs::write(&project, text_of).expect("a file");
    run(["check", text(&project)]).expect(0);
    let times = run(["script", text(&project), "--json"]).expect(0).json();
    assert_eq!(times["file"], "scene.xml");
    let archive = folder.join("foxes.zip");
    run(["pack", text(&project), "-o", text(&archive)]).expect(0);
    let out = folder.join("out");
    run(["unpack", text(&archive), "-o", text(&out)]).expect(0);
    for name in ["foxes.meproj", "scene.xml", "Fox.glb"] {
        assert_eq!(fs::read(out.join(name)).expect(name), fs::read(folder.join(name)).expect(name));
    }
    run(["unpack", text(&archive), "-o", text(&out)]).expect(2);
    fs::remove_file(folder.join("Fox.glb")).expect("a file");
    let refused = run(["pack", text(&project), "-o", text(&archive)]).expect(2);
    assert!(refused.stderr.contains("Fox.glb: does not exist"), "{}", refused.stderr);
    for (kind, root) in [("script", "script"), ("project", "project"), ("lines", "lines")] {
        let schema = run(["script", "--schema", kind]).expect(0).text().to_owned();
        assert!(schema.contains(&format!("<start><ref name=\"{root}\"/></start>")), "{schema}");
        let path = folder.join("schema.rng");
        fs::write(&path, schema).expect("a file");
        if kind != "project" {
            continue;
        }
        match Command::new("xmllint").arg("--noout").arg("--relaxng").args([&path, &project]).output() {
            Ok(done) => assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr)),
            Err(_) => skip(TestNeed::Evaluators, "there is no xmllint"),
        }
    }
    let [short, long] = [vec!["script", "--schema"], vec!["script", "--schema", "script"]]
        .map(|arguments| run(arguments).expect(0));
    assert_eq!(short.text(), long.text());
}
