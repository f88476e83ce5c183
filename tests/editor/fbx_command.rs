//! FBX on the command line: the program starts itself as the parser, and reports what is wrong with a file.

use crate::program::{dragonfly, outcome, run};
use dragonfly_kit::folder::{Folder, data};
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn fbx_files_are_listed_checked_and_posed_like_others() {
    let skin = data("fbx/max_transformed_skin_7500_binary.fbx");
    let info = run(["info", text(&skin), "--json"]).expect(0).json();
    assert_eq!(info["format"], "fbx");
    assert_eq!(info["takes"][0]["name"], "Take 001");
    assert_eq!(info["bones"].as_array().map(Vec::len), Some(5), "{info}");
    run(["check", text(&skin)]).expect(0);
    let pose = run(["pose", text(&skin), "--time", "0.4", "--json"]).expect(0);
    assert!(pose.text().contains("Bone003"), "{}", pose.text());
}

#[test]
fn fbx_files_are_converted_and_lose_no_take() {
    let folder = Folder::new("fbx-convert");
    let cube = data("fbx/maya_blend_shape_cube_7700_binary.fbx");
    for name in ["cube.dfm", "cube.glb"] {
        let output = folder.join(name);
        let printed = run(["convert", text(&cube), "-o", text(&output)]).expect(0);
        assert!(printed.text().contains("1 unit = 0.01 m (file), Y up (file)"), "{}", printed.text());
        let takes = |path: &Path| {
            let takes = run(["takes", "list", text(path), "--json"]).expect(0).json();
            (
                takes[0]["name"].clone(),
                takes[0]["start"].clone(),
                takes[0]["end"].clone(),
                takes[0]["keys"].clone(),
            )
        };
        assert_eq!(takes(&cube), takes(&output));
    }
    // In glTF the node of a mesh whose weights move is a bone; .dfm has none.
    run(["diff", text(&cube), text(&folder.join("cube.dfm")), "--tolerance", "0.00001"]).expect(0);
}

#[test]
fn models_are_written_as_fbx_for_another_program() {
    let folder = Folder::new("fbx-preset");
    let fox = data("gltf/Fox.glb");
    let output = folder.join("Fox.fbx");
    run(["convert", text(&fox), "-o", text(&output), "--preset", "blender"]).expect(0);
    let printed = run(["convert", text(&output), "-o", text(&folder.join("again.glb"))]).expect(0);
    assert!(printed.text().contains("1 unit = 1 m (file), Z up (file)"), "{}", printed.text());
    let clips = folder.join("clips");
    run(["takes", "extract", text(&fox), "--each", "--to", "fbx", "--preset", "unity", "-o", text(&clips)])
        .expect(0);
    for take in ["Survey", "Walk", "Run"] {
        assert!(clips.join(format!("Fox@{take}.fbx")).is_file(), "{take}");
    }
    let unknown = run(["convert", text(&fox), "-o", text(&output), "--preset", "cinema"]).expect(2);
    assert!(unknown.stderr.contains("use unity, unreal, maya, blender"), "{}", unknown.stderr);
    let none = run(["convert", text(&fox), "-o", text(&folder.join("a.glb")), "--preset", "unity"]).expect(2);
    assert!(none.stderr.contains(".glb files have no presets"), "{}", none.stderr);
}

#[test]
fn textures_are_written_beside_an_fbx_file_where_the_user_wants_them_and_listed_before() {
    let folder = Folder::new("fbx-textures");
    let fox = data("gltf/Fox.glb");
    let output = folder.join("Hero.fbx");
    let beside = |more: &[&str]| {
        let mut words = vec!["convert", text(&fox), "-o", text(&output), "--textures", "beside"];
        words.extend(more);
        run(words)
    };
    let listed = beside(&["--dry-run", "--json"]).expect(0).json();
    let name = listed["files"][0]["beside"][0]["name"].as_str().expect("a name").to_owned();
    assert!(name.starts_with("Hero_") && name.ends_with(".png"), "{name}");
    let printed = beside(&["--dry-run"]).expect(0);
    assert!(printed.text().contains(&format!("beside it: {name}")), "{}", printed.text());
    assert!(!output.exists() && !folder.join(&name).exists());
    beside(&[]).expect(0);
    let image = std::fs::read(folder.join(&name)).expect("the image");
    assert!(image.starts_with(b"\x89PNG"));
    let small = std::fs::metadata(&output).expect("the file").len();
    // The parser in its cage asks for the image by name.
    run(["convert", text(&output), "-o", text(&folder.join("again.glb"))]).expect(0);
    let again = std::fs::read(folder.join("again.glb")).expect("a file");
    assert!(again.windows(image.len()).any(|bytes| bytes == image), "the image is in the new file");
    run(["convert", text(&fox), "-o", text(&output)]).expect(0);
    let large = std::fs::metadata(&output).expect("the file").len();
    assert!(large > small + image.len() as u64 / 2, "{small}, then {large}");
    let extracted = folder.join("clips");
    let words = [
        "takes",
        "extract",
        text(&fox),
        "--each",
        "--to",
        "fbx",
        "--textures",
        "beside",
        "-o",
        text(&extracted),
    ];
    let printed = run(words).expect(0);
    assert!(
        printed.stderr.contains("Fox@Walk_") && extracted.join("Fox@Walk.fbx").is_file(),
        "{}",
        printed.stderr
    );
    let none =
        run(["convert", text(&fox), "-o", text(&folder.join("a.glb")), "--textures", "beside"]).expect(2);
    assert!(none.stderr.contains("--textures") && none.stderr.contains(".fbx files only"), "{}", none.stderr);
    assert!(!folder.join("a.glb").exists());
}

#[test]
fn an_edited_fbx_file_is_replaced_as_a_whole_and_an_unedited_one_keeps_its_bytes() {
    let folder = Folder::new("fbx-edit");
    let cube = data("fbx/maya_blend_shape_cube_7700_binary.fbx");
    let (same, other) = (folder.join("same.fbx"), folder.join("other.fbx"));
    run(["edit", text(&cube), "-o", text(&same)]).expect(0);
    assert!(std::fs::read(&same).unwrap() == std::fs::read(&cube).unwrap());
    let edits = folder.join("edits.jsonl");
    std::fs::write(&edits, r#"{"edit":"rename_take","take":0,"name":"Grow"}"#).unwrap();
    let plan = run(["edit", text(&cube), "--edits", text(&edits), "--dry-run"]).expect(0);
    assert!(plan.text().contains("the whole file is written"), "{}", plan.text());
    run(["edit", text(&cube), "--edits", text(&edits), "-o", text(&other)]).expect(0);
    let takes = |file: &Path| run(["info", text(file), "--json"]).expect(0).json()["takes"].clone();
    let (before, after) = (takes(&cube), takes(&other));
    assert_eq!(after[0]["name"], "Grow", "{after}");
    assert_eq!((&after[0]["start"], &after[0]["end"]), (&before[0]["start"], &before[0]["end"]), "{before}");
    // Content that the format does not store is listed, also where the file is written.
    std::fs::write(&edits, r#"{"edit":"add_layer","take":0,"name":"More"}"#).unwrap();
    let edit = |more: &[&str]| {
        let words = ["edit", text(&cube), "--edits", text(&edits), "-o", text(&other)];
        run(words.into_iter().chain(more.iter().copied()).collect::<Vec<_>>()).expect(0)
    };
    let lost = edit(&["--json"]).json()["lost"].clone();
    assert_eq!(lost.as_array().map(Vec::len), Some(1), "{lost}");
    let lost = lost[0].as_str().expect("a sentence");
    assert!(lost.contains("layers, contacts and events are not stored"), "{lost}");
    assert!(edit(&[]).stderr.contains(&format!("not saved: {lost}")));
    let refused = run(["edit", text(&cube), "-o", text(&folder.join("cube.glb"))]).expect(2);
    assert!(refused.stderr.contains("fbx"), "{}", refused.stderr);
    assert!(!folder.join("cube.glb").exists());
}

#[test]
fn a_broken_file_is_wrong_input_with_place_and_reason() {
    let folder = Folder::new("fbx-broken");
    let whole = std::fs::read(data("fbx/maya_blend_shape_cube_7700_binary.fbx")).expect("a file");
    let broken = folder.join("broken.fbx");
    std::fs::write(&broken, &whole[..9000]).expect("a file");
    let refused = run(["info", text(&broken)]).expect(2);
    assert!(refused.stderr.contains("broken.fbx: byte "), "{}", refused.stderr);
}

#[cfg(target_os = "linux")]
#[test]
fn the_parser_of_the_program_runs_with_every_protection_of_this_system() {
    let mut command = dragonfly(["info", text(&data("fbx/maya_interpolation_modes_7500_ascii.fbx"))]);
    let done = outcome(command.env("DRAGONFLY_LOG", "debug")).expect(0);
    let line = done.stderr.lines().find(|line| line.contains("the parser of FBX runs with"));
    let line = line.unwrap_or_else(|| panic!("{}", done.stderr));
    // A kernel without Landlock, or with an old one, is named in the log; nothing else may be missing.
    let old = ["Landlock: not in this kernel", "Landlock: this kernel enforces a part only"];
    let is_old = old.iter().any(|old| line.contains(&format!("missing=\"{old}\"")));
    assert!(line.contains("every protection") || is_old, "{line}");
}
