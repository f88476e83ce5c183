//! The protocol returns all errors of a scene: also those of its lines, its models and the edits that its project keeps.

use super::projects::{LINES, MAIN, PROJECT, project};
use dragonfly_document::protocol::Session;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::folder::Folder;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn session(path: &Path) -> Session {
    let source = Source::File(path.to_owned());
    Session::new(Editable::open(&source, &Cancel::default()).expect("a project"))
}

/// Returns the whole answer to a query without more words.
fn answer(session: &mut Session, query: &str) -> Value {
    let answer = session.answer(&format!("{{\"query\":\"{query}\"}}")).expect("an answer");
    serde_json::from_str(&answer).expect("JSON")
}

fn errors(path: &Path) -> Value {
    answer(&mut session(path), "errors")["ok"].clone()
}

/// Returns the messages of a list of errors.
fn messages(errors: &Value) -> Vec<&str> {
    errors.as_array().expect("a list").iter().filter_map(|error| error["message"].as_str()).collect()
}

#[test]
fn errors_of_lines_and_edits_that_do_not_fit_are_part_of_the_answer() {
    let folder = Folder::new("answers-lines");
    let path = project(&folder);
    fs::create_dir(folder.join("foxes.edits")).expect("a folder");
    fs::write(folder.join("foxes.edits/fox.jsonl"), "{\"edit\":\"reverse_take\",\"take\":\"Dance\"}\n")
        .expect("a file");
    let edits = "models/Fox.glb\"/>\n    <edits of=\"fox\" src=\"foxes.edits/fox.jsonl\"/>";
    fs::write(&path, PROJECT.replace("models/Fox.glb\"/>", edits)).expect("a file");
    let answer = errors(&path);
    assert!(answer["errors"].as_array().is_some_and(Vec::is_empty), "{answer}");
    assert!(answer["edits"][0].as_str().is_some_and(|text| text.contains("no take \"Dance\"")), "{answer}");
    fs::write(folder.join("foxes.lines.xml"), LINES.replace("3 0 0", "3 0")).expect("a file");
    let answer = errors(&path);
    assert_eq!(answer["lines"]["text"], "foxes.lines.xml", "{answer}");
    assert_eq!(answer["lines"]["errors"][0]["line"], 2, "{answer}");
}

#[test]
fn an_error_is_listed_although_its_text_is_the_name_of_a_missing_model() {
    let folder = Folder::new("answers-missing");
    let path = project(&folder);
    let cast = "<role id=\"ben\" model=\"gone\"/></cast><play who=\"ann\" take=\"gone\"/>";
    fs::write(folder.join("main.xml"), MAIN.replace("</cast>", cast)).expect("a file");
    let answer = errors(&path);
    let messages = messages(&answer["errors"]);
    assert_eq!(messages.len(), 2, "{messages:?}");
    assert!(messages.iter().any(|message| message.contains("no take \"gone\"")), "{messages:?}");
}

#[test]
fn a_missing_model_is_reported_where_scripts_use_it_and_once_more_looked_for_with_the_next_question() {
    let folder = Folder::new("answers-used");
    let path = project(&folder);
    let cup = "<model id=\"cup\" src=\"cup.glb\"/>\n    <model id=\"hat\" src=\"hat.glb\"/>\n  </models>";
    fs::write(&path, PROJECT.replace("</models>", cup)).expect("a file");
    let cast = "<prop id=\"cup\" model=\"cup\"/></cast>";
    fs::write(folder.join("main.xml"), MAIN.replace("</cast>", cast)).expect("a file");
    let mut session = session(&path);
    let all = answer(&mut session, "errors")["ok"].clone();
    let text = |name: &str| {
        let texts = all["texts"].as_array().expect("a list");
        let found = texts.iter().find(|text| text["text"] == name).expect(name);
        messages(&found["errors"]).iter().map(|message| (*message).to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(text("foxes.meproj"), ["hat.glb: does not exist"], "no script uses it");
    assert_eq!(text("main.xml"), ["cup.glb: does not exist"]);
    for name in ["cup.glb", "hat.glb"] {
        fs::copy(folder.join("models/Fox.glb"), folder.join(name)).expect("a copy");
    }
    let now = answer(&mut session, "errors")["ok"].clone();
    for text in now["texts"].as_array().expect("a list") {
        assert_eq!(messages(&text["errors"]), [""; 0], "{text}");
    }
}

#[test]
fn a_project_without_any_script_that_can_be_read_has_errors_of_its_own_and_of_its_lines() {
    let folder = Folder::new("answers-no-script");
    let path = project(&folder);
    for name in ["main.xml", "end.xml"] {
        fs::remove_file(folder.join(name)).expect("a file");
    }
    fs::write(folder.join("foxes.lines.xml"), LINES.replace("3 0 0", "3 0")).expect("a file");
    let answer = errors(&path);
    assert_eq!(answer["text"], "foxes.meproj", "{answer}");
    assert_eq!(messages(&answer["errors"]).len(), 2, "{answer}");
    assert_eq!(answer["lines"]["errors"][0]["line"], 2, "{answer}");
    fs::write(&path, "<project version=\"1\">\n</project>\n").expect("a file");
    assert_eq!(messages(&errors(&path)["errors"]), ["the project has no script"]);
}

#[test]
fn sounds_are_looked_at_for_errors_only_and_a_hundred_that_are_missing_are_enough() {
    let folder = Folder::new("answers-sounds");
    let path = folder.join("scene.xml");
    let sounds = |count: usize| {
        (0..count).map(|number| format!("  <sound src=\"gone{number}.wav\"/>\n")).collect::<String>()
    };
    let script = |inner: &str| format!("<script version=\"1\">\n{inner}</script>\n");
    fs::write(&path, script(&sounds(150))).expect("a file");
    assert_eq!(messages(&errors(&path)["errors"]).len(), 100);
    let cast = "  <cast><prop id=\"cup\" model=\"cup.glb\"/></cast>\n".to_owned();
    fs::write(&path, script(&(cast + &sounds(1)))).expect("a file");
    let mut session = session(&path);
    let refused = answer(&mut session, "schedule")["error"].as_str().expect("a reason").to_owned();
    assert!(refused.contains("cup.glb") && !refused.contains("gone0.wav"), "{refused}");
    // The same sound in two places is wrong in both.
    fs::write(&path, script(&sounds(1).repeat(2))).expect("a file");
    let answer = errors(&path);
    let lines: Vec<_> =
        answer["errors"].as_array().expect("a list").iter().map(|error| &error["line"]).collect();
    assert_eq!(lines, [2, 3]);
}

#[test]
fn the_help_about_folders_is_for_files_that_are_not_found_and_what_is_no_text_says_why() {
    let folder = Folder::new("answers-help");
    let path = project(&folder);
    let models = "<model id=\"bad\" src=\"bad.glb\"/>\n    <model id=\"out\" src=\"gone.glb\"/>\n  </models>";
    fs::write(&path, PROJECT.replace("</models>", models)).expect("a file");
    fs::write(folder.join("bad.glb"), "this is no model").expect("a file");
    fs::write(folder.join("end.xml"), b"<script>\n\xff</script>").expect("a file");
    let answer = errors(&path);
    let own = answer["texts"][0]["errors"].as_array().expect("a list");
    let helps: Vec<&str> = own.iter().filter_map(|error| error["help"].as_str()).collect();
    let not_found = "files are named relative to the folder of the project, and are in it or below it";
    assert_eq!(helps, ["", not_found, ""], "{answer}");
    let unread = own[2]["message"].as_str().expect("a text");
    assert!(unread.starts_with("end.xml:2:1: this is not UTF-8 text"), "{unread}");
}
