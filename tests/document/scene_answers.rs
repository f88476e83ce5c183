//! The protocol returns all errors of a scene: also those of its lines, its models and the edits that its project keeps.

use super::projects::{LINES, MAIN, PROJECT, project};
use dragonfly_document::protocol::Session;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::folder::Folder;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn errors(path: &Path) -> Value {
    let editable = Editable::open(&Source::File(path.to_owned()), &Cancel::default()).expect("a project");
    let answer = Session::new(editable).answer(r#"{"query":"errors"}"#).expect("an answer");
    let answer: Value = serde_json::from_str(&answer).expect("JSON");
    answer["ok"].clone()
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
    let messages: Vec<&str> = answer["errors"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|error| error["message"].as_str())
        .collect();
    assert_eq!(messages.len(), 2, "{messages:?}");
    assert!(messages.iter().any(|message| message.contains("no take \"gone\"")), "{messages:?}");
}
