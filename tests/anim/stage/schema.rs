//! The schema that is made from the tables, checked with an independent validator.

use super::DUEL;
use super::projects::PROJECT;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::table::{ELEMENTS, LINE_FILES, PROJECTS, Vocabulary, schema};
use dragonfly_kit::skip::{TestNeed, skip};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns whether xmllint finds `script` valid; `None` without xmllint.
fn is_valid(folder: &Path, name: &str, script: &str) -> Option<(bool, String)> {
    let (rng, xml) = (folder.join("script.rng"), folder.join(name));
    std::fs::write(&rng, schema()).unwrap();
    std::fs::write(&xml, script).unwrap();
    let output = Command::new("xmllint").arg("--noout").arg("--relaxng").args([&rng, &xml]).output().ok()?;
    Some((output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned()))
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("dragonfly-schema-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn an_independent_validator_accepts_every_example_and_refuses_what_we_refuse() {
    let folder = folder("examples");
    if is_valid(&folder, "duel.xml", DUEL).is_none() {
        return skip(TestNeed::Evaluators, "there is no xmllint");
    }
    let folders = ["../tests/data/stage", "examples"];
    let mut examples = 0;
    for entry in folders.into_iter().flat_map(|folder| {
        std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap().map(Result::unwrap)
    }) {
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == "xml") {
            let (valid, message) =
                is_valid(&folder, "example.xml", &std::fs::read_to_string(&path).unwrap()).unwrap();
            assert!(valid, "{}: {message}", path.display());
            examples += 1;
        }
    }
    assert!(examples >= 2);
    let foreign = DUEL
        .replace("<script ", "<script xmlns:x=\"urn:x\" x:y=\"1\" ")
        .replace("<par id", "<x:a><x:b c=\"d\"/></x:a><par id");
    assert!(is_valid(&folder, "foreign.xml", &foreign).unwrap().0);
    for (from, to) in [
        ("take=\"Slash\"", "tak=\"Slash\""),
        ("take=\"Slash\"", ""),
        ("dur=\"0.25\"", "dur=\"soon\""),
        ("ease=\"in-out\"", "ease=\"slow\""),
        ("begin=\"grab.touch-0.5\"", "begin=\"grab.touch-\""),
        ("<detach who=\"sword\" drop=\"ground\"/>", "<at name=\"a\" time=\"1\"/>"),
        ("to=\"door\" take=\"Run\"", "to=\"door\" path=\"rail\" take=\"Run\""),
        ("version=\"1\" fps", "fps"),
        ("color=\"#fff2e0\"", "color=\"red\""),
        ("at=\"4 0 1\"", "at=\"4 0\""),
        ("size=\"1280x720\"", "size=\"1280\""),
    ] {
        let wrong = DUEL.replacen(from, to, 1);
        assert_ne!(wrong, DUEL, "{from}");
        assert!(StageScript::read(wrong.as_str()).is_err(), "{to}");
        let (valid, _) = is_valid(&folder, "wrong.xml", &wrong).unwrap();
        assert!(!valid, "{from} → {to}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_element_and_attribute_is_in_the_schema_with_its_help() {
    let schema = schema();
    for row in ELEMENTS {
        assert!(schema.contains(&format!("<element name=\"{}\">", row.name)), "{}", row.name);
        for attribute in row.rows() {
            assert!(
                schema.contains(&format!("<attribute name=\"{}\"", attribute.name)),
                "{}",
                attribute.name
            );
            let usable = attribute.default.is_empty()
                || attribute.value.accepts(attribute.default, Default::default());
            assert!(usable, "the default of {} {}", row.name, attribute.name);
            assert!(attribute.help.ends_with('.') && row.help.ends_with('.'), "{}", attribute.name);
        }
    }
}

#[test]
fn an_independent_validator_accepts_the_projects_and_lines_that_we_accept_and_refuses_what_we_refuse() {
    let folder = folder("projects");
    let valid = |vocabulary: &Vocabulary, text: &str| {
        let [rng, xml] = ["other.rng", "other.xml"].map(|name| folder.join(name));
        std::fs::write(&rng, vocabulary.schema()).unwrap();
        std::fs::write(&xml, text).unwrap();
        let run = Command::new("xmllint").arg("--noout").arg("--relaxng").args([&rng, &xml]).output().ok()?;
        Some(run.status.success())
    };
    if valid(&PROJECTS, PROJECT).is_none() {
        return skip(TestNeed::Evaluators, "there is no xmllint");
    }
    assert_eq!(valid(&PROJECTS, PROJECT), Some(true));
    for (from, to) in [
        ("<scene ", "<scenery "),
        ("src=\"duel.xml\"", ""),
        ("hash=\"0123456789abcdef\"", "hash=\"0123\""),
        ("tone=\"agx\"", "tone=\"film\""),
        ("samples=\"64\"", "samples=\"many\""),
    ] {
        let text = PROJECT.replacen(from, to, 1);
        assert_ne!(text, PROJECT);
        assert_eq!(valid(&PROJECTS, &text), Some(false), "{to}");
        assert!(StageProject::read(text).is_err(), "{to}");
    }
    let lines =
        "<lines version=\"1\"><line id=\"a\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\" width=\"2\"/></lines>";
    assert_eq!(valid(&LINE_FILES, lines), Some(true));
    assert_eq!(valid(&LINE_FILES, &lines.replace("width=\"2\"", "width=\"wide\"")), Some(false));
    assert_eq!(valid(&LINE_FILES, &lines.replace("points", "point")), Some(false));
}
