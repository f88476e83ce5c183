//! `dragonfly takes`: takes of other files onto a model, out of it, and removed from it.

use crate::program::run;
use dragonfly_kit::folder::{Folder, data};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn names(path: &Path) -> Vec<String> {
    let takes = run(["takes", "list", text(path), "--json"]).expect(0).json();
    let takes = takes.as_array().expect("a list").iter();
    takes.map(|take| take["name"].as_str().expect("a name").to_owned()).collect()
}

#[test]
fn each_take_becomes_a_file_and_comes_back_onto_the_model_as_it_was() {
    let folder = Folder::new("takes-round");
    let fox = data("gltf/Fox.glb");
    let (clips, bare, back) = (folder.join("clips"), folder.join("bare.glb"), folder.join("back.glb"));
    run(["takes", "extract", text(&fox), "--each", "-o", text(&clips), "--to", "glb", "--no-mesh"]).expect(0);
    let mut files: Vec<_> =
        fs::read_dir(&clips).expect("a folder").map(|file| file.expect("a file").path()).collect();
    files.sort();
    let stems: Vec<_> = files.iter().map(|path| path.file_stem().and_then(|stem| stem.to_str())).collect();
    assert_eq!(stems, [Some("Fox@Run"), Some("Fox@Survey"), Some("Fox@Walk")]);
    run(["takes", "extract", text(&fox), "--no-takes", "-o", text(&bare)]).expect(0);
    assert_eq!(names(&bare), [""; 0]);
    let arguments = ["takes", "add", text(&bare)].into_iter().chain(files.iter().map(|path| text(path)));
    let added = run(arguments.chain(["-o", text(&back), "--json"])).expect(0).json();
    for file in added.as_array().expect("a list") {
        assert_eq!(file["copied"], Value::Bool(true), "{file}");
    }
    assert_eq!(names(&back), ["Run", "Survey", "Walk"]);
    run(["diff", text(&fox), text(&back), "--tolerance", "0.001"]).expect(0);
    // The same takes once more, and two of them removed again.
    let twice = folder.join("twice.glb");
    run(["takes", "add", text(&fox), text(&files[0]), "-o", text(&twice)]).expect(0);
    assert_eq!(names(&twice), ["Survey", "Walk", "Run", "Run 2"]);
    run(["takes", "remove", text(&twice), "--take", "0", "--take", "Run", "-o", text(&twice)]).expect(0);
    assert_eq!(names(&twice), ["Walk", "Run 2"]);
}

#[test]
fn clips_of_another_figure_are_retargeted_and_a_broken_one_does_not_stop_the_others() {
    let folder = Folder::new("takes-add");
    let (model, clip) = (data("collection/quaternius_Character4skins.glb"), data("bench/pab.glb"));
    let (broken, out) = (folder.join("broken.glb"), folder.join("out.glb"));
    fs::write(&broken, b"glTF").expect("a file");
    let before = names(&model).len();
    let done =
        run(["takes", "add", text(&model), text(&broken), text(&clip), "-o", text(&out), "--names", "file"]);
    let done = done.expect(2);
    assert!(
        done.stderr.contains("broken.glb") && done.stderr.contains("1 of 2 files were not added"),
        "{}",
        done.stderr
    );
    assert!(done.text().contains("retargeted"), "{}", done.text());
    let after = names(&out);
    assert!(after.len() > before && after.iter().any(|name| name.starts_with("pab")), "{after:?}");
    // Nothing is written where nothing fits.
    let none = folder.join("none.glb");
    run(["takes", "add", text(&model), text(&broken), "-o", text(&none)]).expect(2);
    assert!(!none.exists());
}

#[test]
fn a_model_is_written_without_takes_and_takes_that_are_not_there_are_errors() {
    let folder = Folder::new("takes-extract");
    let fox = data("gltf/Fox.glb");
    let (bare, one) = (folder.join("bare.dfm"), folder.join("one.glb"));
    run(["takes", "extract", text(&fox), "--no-takes", "-o", text(&bare)]).expect(0);
    assert_eq!(names(&bare), [""; 0]);
    run(["takes", "extract", text(&fox), "--take", "Run", "-o", text(&one)]).expect(0);
    assert_eq!(names(&one), ["Run"]);
    let wrong = run(["takes", "extract", text(&fox), "--take", "Swim", "-o", text(&one)]).expect(2);
    assert!(wrong.stderr.contains("there is no take \"Swim\""), "{}", wrong.stderr);
    run(["takes", "remove", text(&fox), "--take", "9", "-o", text(&one)]).expect(2);
    run(["takes", "extract", text(&fox), "-o", text(&folder.join("a.png"))]).expect(2);
    assert_eq!(names(&one), ["Run"], "the file is as it was");
}
