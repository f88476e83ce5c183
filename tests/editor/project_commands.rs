//! Projects on the command line: all texts are checked, each error has its file, line and column.

use crate::program::run;
use dragonfly_kit::folder::{Folder, data};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const PROJECT: &str = r#"<project version="1" fps="30" size="320x180">
  <models>
    <model id="fox" src="models/Fox.glb"/>
  </models>
  <cast>
    <camera id="wide" at="0 2 9" look="0 1 0"/>
  </cast>
  <lines src="foxes.lines.xml"/>
  <script id="main" src="main.xml"/>
  <script id="end" src="end.xml"/>
</project>
"#;

const MAIN: &str = r#"<script version="1">
  <cast>
    <role id="ann" model="fox" scale="0.01"/>
    <path id="way" line="aisle"/>
  </cast>
  <move who="ann" path="way" speed="1"/>
</script>
"#;

const END: &str = r#"<script version="1">
  <cast>
    <role id="ann" model="fox" scale="0.01" at="0 0 2"/>
  </cast>
  <play who="ann" take="Survey"/>
</script>
"#;

const LINES: &str =
    "<lines version=\"1\">\n  <line id=\"aisle\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\"/>\n</lines>\n";

/// A tenth of a second of silence.
fn wave() -> Vec<u8> {
    let samples = 800_u32;
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + 2 * samples).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16_u32.to_le_bytes());
    for half in [1_u16, 1] {
        bytes.extend(half.to_le_bytes());
    }
    for word in [8000_u32, 16_000] {
        bytes.extend(word.to_le_bytes());
    }
    for half in [2_u16, 16] {
        bytes.extend(half.to_le_bytes());
    }
    bytes.extend(b"data");
    bytes.extend((2 * samples).to_le_bytes());
    bytes.extend(std::iter::repeat_n(0, 2 * samples as usize));
    bytes
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn write(folder: &Folder, name: &str, text: &str) {
    fs::write(folder.join(name), text).expect("a file");
}

fn project(name: &str) -> (Folder, PathBuf) {
    let folder = Folder::new(name);
    fs::create_dir(folder.join("models")).expect("a folder");
    fs::copy(data("gltf/Fox.glb"), folder.join("models/Fox.glb")).expect("a copy");
    for (name, text) in
        [("foxes.meproj", PROJECT), ("main.xml", MAIN), ("end.xml", END), ("foxes.lines.xml", LINES)]
    {
        write(&folder, name, text);
    }
    let path = folder.join("foxes.meproj");
    (folder, path)
}

/// Returns file and place of each error, with the start of its text.
fn errors(path: &Path) -> Vec<(String, String, String)> {
    let found = run(["check", text(path), "--json"]).expect(1).json();
    let of = |value: &Value| value.as_str().expect("a text").to_owned();
    let findings = found[0]["findings"].as_array().expect("findings").iter();
    let errors = findings.filter(|finding| finding["severity"] == "error");
    errors.map(|row| (of(&row["file"]), of(&row["place"]), of(&row["text"]))).collect()
}

/// Checks that exactly these errors are found: file, place, part of the text.
#[track_caller]
fn expect(path: &Path, wanted: &[(&str, &str, &str)]) {
    let found = errors(path);
    let fits = found.len() == wanted.len()
        && found.iter().zip(wanted).all(|(found, wanted)| {
            (found.0.as_str(), found.1.as_str()) == (wanted.0, wanted.1) && found.2.contains(wanted.2)
        });
    assert!(fits, "{found:#?}\nand not {wanted:#?}");
    // The text has the same.
    let printed = run(["check", text(path)]).expect(1).text().to_owned();
    for (file, place, part) in wanted {
        let line = printed.lines().find(|line| line.contains(&format!("error: {file}:{place}: ")));
        assert!(line.is_some_and(|line| line.contains(part)), "{printed}");
    }
}

#[test]
fn a_project_without_errors_is_rendered_and_posed() {
    let (folder, path) = project("project-clean");
    run(["check", text(&path)]).expect(0);
    // Thirty frames are a second, in which she walks one meter along the line.
    let poses = run(["pose", text(&path), "--role", "ann", "--time", "30f", "--json"]).expect(0).json();
    let place: Vec<f64> = poses["poses"][0]["translation"]
        .as_array()
        .expect("a place")
        .iter()
        .filter_map(Value::as_f64)
        .collect();
    assert!((place[0] - 1.0).abs() < 0.05 && place[1].abs() < 1e-6 && place[2].abs() < 1e-6, "{place:?}");
    let image = folder.join("foxes.png");
    run(["render", text(&path), "--time", "1", "--camera", "wide", "-o", text(&image)]).expect(0);
    let with_fox = image::open(&image).expect("an image").into_rgba8();
    assert_eq!(with_fox.dimensions(), (320, 180), "the size of the project");
    run(["render", text(&path), "--time", "3", "--camera", "wide", "-o", text(&image)]).expect(0);
    assert!(image::open(&image).expect("an image").into_rgba8() != with_fox, "she walked on");
    let refused = run(["render", text(&path), "--camera", "no", "-o", text(&image)]).expect(2);
    assert!(refused.stderr.contains("there is shot, free, wide"), "{}", refused.stderr);
}

#[test]
fn errors_of_a_project_have_file_line_and_column() {
    let (folder, path) = project("project-wrong");
    write(
        &folder,
        "foxes.meproj",
        &PROJECT.replace("<models>", "<modles>").replace("</models>", "</modles>"),
    );
    expect(&path, &[("foxes.meproj", "2:4", "did you mean \"models\"")]);
    write(&folder, "foxes.meproj", "<project version=\"1\">");
    let found = errors(&path);
    assert!(found.len() == 1 && found[0].0 == "foxes.meproj", "{found:?}");
    for command in [&["pose", "--role", "ann", "--time", "0"][..], &["render", "-o", "x.png"]] {
        let all = [&command[..1], &[text(&path)], &command[1..]].concat();
        let refused = run(all).expect(2);
        assert!(refused.stderr.contains("foxes.meproj:1:"), "{}", refused.stderr);
    }
}

#[test]
fn all_scripts_of_a_project_are_checked_and_a_missing_model_hides_no_other_error() {
    let (folder, path) = project("project-all");
    let role =
        "<role id=\"ben\" model=\"models/gone.glb\"/>\n  </cast>\n  <look who=\"ann\" at=\"ann.Hed\"/>";
    write(&folder, "main.xml", &MAIN.replace("</cast>", role));
    write(&folder, "end.xml", &END.replace("Survey", "Survy"));
    expect(
        &path,
        &[
            ("main.xml", "5:25", "models/gone.glb: "),
            ("main.xml", "7:23", "Hed"),
            ("end.xml", "5:25", "did you mean \"Survey\""),
        ],
    );
    let refused = run(["render", text(&path), "-o", text(&folder.join("x.png"))]).expect(2);
    assert!(refused.stderr.contains("main.xml:5:25: ") && refused.stderr.contains("main.xml:7:23: "));
}

#[test]
fn errors_of_the_shared_cast_are_in_the_project_and_are_listed_once() {
    let (folder, path) = project("project-shared");
    let cast = PROJECT.replace("look=\"0 1 0\"", "look=\"ann.Hed\"");
    write(&folder, "foxes.meproj", &cast);
    expect(&path, &[("foxes.meproj", "6:40", "Hed")]);
    // The same with a model that is missing.
    let cast = PROJECT.replace("  </cast>", "    <prop id=\"cup\" model=\"models/cup.glb\"/>\n  </cast>");
    write(&folder, "foxes.meproj", &cast);
    expect(&path, &[("foxes.meproj", "7:27", "models/cup.glb: ")]);
    let refused = run(["pose", text(&path), "--role", "ann", "--time", "0"]).expect(2);
    assert!(refused.stderr.contains("foxes.meproj:7:27: "), "{}", refused.stderr);
}

#[test]
fn files_that_are_missing_are_errors_where_they_are_named() {
    let (folder, path) = project("project-missing");
    let more = "<model id=\"cat\" src=\"models/Cat.glb\"/>\n  </models>";
    let own = PROJECT.replace("</models>", more).replace("src=\"end.xml\"", "src=\"fin.xml\"");
    write(&folder, "foxes.meproj", &own);
    expect(&path, &[("foxes.meproj", "4:24", "models/Cat.glb: "), ("foxes.meproj", "11:25", "fin.xml ")]);
}

#[test]
fn a_sound_that_is_missing_or_no_sound_is_an_error() {
    let (folder, path) = project("project-sounds");
    let sounds =
        "<sound src=\"bell.wav\"/>\n  <sound src=\"gone.ogg\"/>\n  <sound src=\"note.ogg\"/>\n</script>";
    write(&folder, "main.xml", &MAIN.replace("</script>", sounds));
    fs::write(folder.join("bell.wav"), wave()).expect("a file");
    write(&folder, "note.ogg", "this is a text, and no sound");
    let wanted = [("main.xml", "8:15", "gone.ogg "), ("main.xml", "9:15", "note.ogg cannot be read")];
    expect(&path, &wanted);
    // A scene without a project, too.
    let alone = END
        .replace("\"fox\"", "\"models/Fox.glb\"")
        .replace("</script>", "<sound src=\"gone.ogg\"/>\n</script>");
    write(&folder, "alone.xml", &alone);
    let printed = run(["check", text(&folder.join("alone.xml"))]).expect(1).text().to_owned();
    assert!(printed.contains("error: 6:13: gone.ogg "), "{printed}");
    // It can be shown: it is quiet there.
    run(["pose", text(&path), "--role", "ann", "--time", "0"]).expect(0);
}

#[test]
fn an_error_of_an_included_file_names_that_file_and_its_line_and_column() {
    let (folder, path) = project("project-include");
    write(&folder, "intro.xml", "<script version=\"1\">\n  <wait dur=\"soon\"/>\n</script>\n");
    // Each error is listed once, although two scripts include the file.
    for (name, script) in [("main.xml", MAIN), ("end.xml", END)] {
        write(&folder, name, &script.replace("</script>", "  <include src=\"intro.xml\"/>\n</script>"));
    }
    expect(&path, &[("intro.xml", "2:14", "dur=\"soon\" is not a time")]);
}

#[test]
fn each_script_of_a_project_is_chosen_by_its_id_or_its_file() {
    let (_folder, path) = project("project-choice");
    let at = |script: &[&str]| {
        let all = [&["pose", text(&path), "--role", "ann", "--time", "0", "--json"], script].concat();
        let printed: Value = serde_json::from_str(run(all).expect(0).text()).expect("JSON");
        printed["poses"][0]["translation"][2].as_f64().expect("a number")
    };
    // In the first script it begins on the line, in the other one two meters in front of it.
    assert_eq!((at(&[]), at(&["--script", "main"])), (0.0, 0.0));
    assert_eq!((at(&["--script", "end"]), at(&["--script", "end.xml"])), (2.0, 2.0));
    let listed = run(["script", text(&path), "--script", "end"]).expect(0).text().to_owned();
    assert!(listed.contains("play") && !listed.contains("move"), "{listed}");
    let wrong = run(["pose", text(&path), "--script", "fin", "--role", "ann", "--time", "0"]).expect(2);
    assert!(wrong.stderr.contains("no script is called \"fin\"; there is main, end"), "{}", wrong.stderr);
    let folder = path.parent().expect("a folder");
    let alone = folder.join("end.xml");
    let refused = run(["script", text(&alone), "--script", "end"]).expect(2);
    assert!(refused.stderr.contains("only a project"), "{}", refused.stderr);
}
