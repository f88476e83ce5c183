//! `dragonfly edit` applies edits read from a text file and saves them without touching the rest of the model.

use crate::program::{dragonfly, outcome, run};
use dragonfly_document::edit::EDITS;
use dragonfly_kit::folder::{Folder, data};
use std::path::{Path, PathBuf};
use std::process::Stdio;

const TURN: &str = r#"{"edit":"set","take":"Run","time":0.25,"poses":[{"bone":"b_Head_05","rotation":[0,0.2588190,0,0.9659258]}]}"#;

fn fox() -> String {
    data("gltf/Fox.glb").display().to_string()
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

/// Writes `lines` to a file and returns its path.
fn edits(folder: &Folder, lines: &str) -> String {
    let path = folder.join("edits.jsonl");
    std::fs::write(&path, lines).expect("a file");
    text(&path)
}

/// Returns the rotation of a bone relative to its parent, as `explain` prints it.
fn rotation(file: &str, bone: &str, time: &str) -> Vec<f64> {
    let arguments = ["explain", file, "--take", "Run", "--time", time, "--bone", bone, "--json"];
    let explained = run(arguments).expect(0).json();
    let bones = explained["bones"].as_array().expect("bones").clone();
    let numbers = bones.last().expect("a bone")["rotation"]["value"].as_array().expect("numbers").clone();
    numbers.iter().map(|number| number.as_f64().expect("a number")).collect()
}

#[test]
fn without_an_edit_every_file_is_saved_byte_for_byte() {
    let folder = Folder::new("edit-same");
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(data("gltf")).expect("models").flatten().map(|e| e.path()).collect();
    files.retain(|path| path.extension().is_some_and(|end| end == "glb" || end == "gltf"));
    assert!(files.len() > 5);
    for file in files {
        let saved = folder.join("same");
        run(["edit", &text(&file), "-o", &text(&saved)]).expect(0);
        assert_eq!(
            std::fs::read(&file).expect("bytes"),
            std::fs::read(&saved).expect("bytes"),
            "{}",
            file.display()
        );
    }
}

#[test]
fn an_edit_is_saved_and_the_rest_of_the_file_keeps_its_bytes() {
    let folder = Folder::new("edit-turn");
    let saved = text(&folder.join("turned.glb"));
    let report =
        run(["edit", &fox(), "--edits", &edits(&folder, TURN), "-o", &saved, "--json"]).expect(0).json();
    assert_eq!((report["file"].as_str(), report["edits"].as_u64()), (Some("Fox.glb"), Some(1)));
    assert_eq!(report["changes"]["channels"][0]["bone"], "b_Head_05");
    assert_eq!(report["changes"]["channels"].as_array().map(Vec::len), Some(1));
    let wanted = [0.0, 0.258819, 0.0, 0.9659258];
    for (number, wanted) in rotation(&saved, "b_Head_05", "0.25").iter().zip(wanted) {
        assert!((number - wanted).abs() < 1e-6, "{number} is not {wanted}");
    }
    assert_eq!(rotation(&saved, "b_Neck_04", "0.25"), rotation(&fox(), "b_Neck_04", "0.25"));
    // The binary chunk starts with its old bytes; new data is appended after them.
    let (before, after) = (std::fs::read(data("gltf/Fox.glb")).unwrap(), std::fs::read(&saved).unwrap());
    let chunk = |bytes: &[u8]| {
        let json = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let from = 12 + 8 + json + 8;
        bytes[from..].to_vec()
    };
    assert!(chunk(&after).starts_with(&chunk(&before)));
    // A second edit reuses the space that the first one appended.
    let again = text(&folder.join("again.glb"));
    run(["edit", &saved, "--edits", &edits(&folder, &TURN.replace("0.2588190", "0.3")), "-o", &again])
        .expect(0);
    assert_eq!(std::fs::metadata(&again).unwrap().len(), after.len() as u64);
}

#[test]
fn a_dry_run_reports_what_would_change_and_writes_nothing() {
    let folder = Folder::new("edit-dry");
    let edits = edits(&folder, TURN);
    let before: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.file_name()).collect();
    let said = run(["edit", &fox(), "--edits", &edits, "--dry-run"]).expect(0);
    assert!(said.text().starts_with("1 take changed\n1 channel of 1 bone in 1 take, "), "{}", said.text());
    for word in ["take \"Run\", \"b_Head_05\"", "accessor", "bytes appended", "will be written"] {
        assert!(said.text().contains(word), "{word} is missing in\n{}", said.text());
    }
    let after: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.file_name()).collect();
    assert_eq!(before, after);
    let nothing = run(["edit", &fox(), "--dry-run"]).expect(0);
    assert_eq!(nothing.text(), "nothing changes\n");
}

#[test]
fn an_extension_of_another_format_is_refused() {
    let folder = Folder::new("edit-ending");
    let edits = edits(&folder, TURN);
    for ending in ["gltf", "fbx", "vrm", "DFM"] {
        let out = text(&folder.join(&format!("out.{ending}")));
        let said = run(["edit", &fox(), "--edits", &edits, "-o", &out]).expect(2);
        assert!(said.stderr.contains("the format of the file stays .glb"), "{}", said.stderr);
        assert!(!std::path::Path::new(&out).exists());
    }
    // An unknown extension, or the same one in another case, is the user's choice.
    for name in ["out.model", "out.GLB", "out"] {
        run(["edit", &fox(), "--edits", &edits, "-o", &text(&folder.join(name))]).expect(0);
    }
}

#[test]
fn a_file_can_be_overwritten_and_edits_read_from_standard_input() {
    let folder = Folder::new("edit-place");
    let file = folder.join("Fox.glb");
    std::fs::copy(data("gltf/Fox.glb"), &file).unwrap();
    let mut command = dragonfly(["edit", &text(&file), "--edits", "-", "-o", &text(&file)]);
    let lines = folder.join("lines");
    std::fs::write(&lines, "{\"edit\":\"rename_take\",\"take\":0,\"name\":\"Look\"}\n\n{\"edit\":\"delete_take\",\"take\":\"Walk\"}\n").unwrap();
    outcome(command.stdin(Stdio::from(std::fs::File::open(&lines).unwrap()))).expect(0);
    let info = run(["info", &text(&file), "--json"]).expect(0).json();
    let names: Vec<&str> =
        info["takes"].as_array().unwrap().iter().filter_map(|take| take["name"].as_str()).collect();
    assert_eq!(names, ["Look", "Run"]);
    let left: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.file_name()).collect();
    assert_eq!(left.len(), 2, "nothing else is left in the folder: {left:?}");
}

#[test]
fn saving_a_model_copies_its_external_files() {
    let folder = Folder::new("edit-beside");
    let source = data("gltf/SimpleSkin2/SimpleSkin.gltf");
    let line = r#"{"edit":"retime_take","take":0,"length":2}"#;
    let saved = folder.join("out/Skin.gltf");
    std::fs::create_dir(folder.join("out")).unwrap();
    run(["edit", &text(&source), "--edits", &edits(&folder, line), "-o", &text(&saved)]).expect(0);
    let info = run(["info", &text(&saved), "--json"]).expect(0).json();
    let take = &info["takes"][0];
    assert_eq!(take["end"].as_f64().unwrap() - take["start"].as_f64().unwrap(), 2.0);
    assert_eq!(info["meshes"], run(["info", &text(&source), "--json"]).expect(0).json()["meshes"]);
}

#[test]
fn an_invalid_edit_exits_with_2_names_its_line_and_writes_nothing() {
    let folder = Folder::new("edit-wrong");
    let out = folder.join("out.glb");
    for (lines, word) in [
        ("{\"edit\":\"fly\"}", "line 1"),
        (
            "{\"edit\":\"reverse_take\",\"take\":0}\n{\"edit\":\"delete_take\",\"take\":\"Nap\"}",
            "line 2: there is no take \"Nap\"",
        ),
        ("{\"edit\":\"reverse_take\",\"take\":0,\"twice\":true}", "unknown field `twice`"),
        ("nonsense", "line 1: column"),
        ("\u{0}", "line 1"),
    ] {
        let outcome = run(["edit", &fox(), "--edits", &edits(&folder, lines), "-o", &text(&out)]).expect(2);
        assert!(outcome.stderr.contains(word), "{lines}: {}", outcome.stderr);
        assert!(!out.exists());
    }
    run(["edit", &fox(), "--edits", "/nowhere", "-o", &text(&out)]).expect(2);
    run(["edit", &fox()]).expect(2);
    run(["edit", "demo:", "-o", "/nowhere/out.glb"]).expect(2);
}

#[test]
fn the_name_of_a_take_must_be_unique() {
    let folder = Folder::new("edit-names");
    let output = folder.join("out.glb");
    for (edit, reason) in [
        (r#"{"edit":"rename_take","take":"Run","name":"Walk"}"#, "another take has the name \"Walk\""),
        (r#"{"edit":"rename_take","take":"Run","name":" "}"#, "a take needs a name"),
        (r#"{"edit":"create_take","name":""}"#, "a take needs a name"),
        (r#"{"edit":"create_take","name":"Run","copy":"Walk"}"#, "another take has the name \"Run\""),
        (
            r#"{"edit":"split_take","take":"Run","time":0.5,"name":"Survey"}"#,
            "another take has the name \"Survey\"",
        ),
    ] {
        let lines = edits(&folder, &format!("{edit}\n"));
        let told = run(["edit", &fox(), "--edits", &lines, "-o", &text(&output)]).expect(2);
        assert!(told.stderr.contains(&format!("line 1: {reason}")), "{}", told.stderr);
        assert!(!output.exists());
    }
    let lines = edits(&folder, r#"{"edit":"rename_take","take":"Run","name":"Run"}"#);
    let told = run(["edit", &fox(), "--edits", &lines, "-o", &text(&output)]).expect(2);
    assert!(told.stderr.contains("has that name already"), "{}", told.stderr);
}

#[test]
fn the_list_of_edits_and_their_schema_can_be_read_by_programs() {
    let list = run(["edit", "--list", "--json"]).expect(0).json();
    let names: Vec<&str> = list["edits"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|entry| entry["example"]["edit"].as_str())
        .collect();
    assert!(names.len() == EDITS.len() && names.contains(&"split_take"), "{names:?}");
    assert_eq!(list["version"], 1);
    let people = run(["edit", "--list"]).expect(0);
    assert!(people.text().contains("# Rotates the head 30°"));
    let schema = run(["edit", "--schema"]).expect(0).json();
    assert_eq!(schema["oneOf"].as_array().map(Vec::len), Some(EDITS.len()));
}

#[test]
fn the_native_format_can_be_edited() {
    let folder = Folder::new("edit-dfm");
    let (dfm, saved) = (folder.join("fox.dfm"), folder.join("saved.dfm"));
    let model = dragonfly_anim::format::read(
        "Fox.glb",
        &std::fs::read(data("gltf/Fox.glb")).unwrap(),
        &dragonfly_anim::format::NoFiles,
        &dragonfly_anim::format::ReadOptions::default(),
    );
    std::fs::write(&dfm, dragonfly_anim::format::dfm::write(&model.unwrap().model).unwrap()).unwrap();
    run(["edit", &text(&dfm), "--edits", &edits(&folder, TURN), "-o", &text(&saved)]).expect(0);
    assert!((rotation(&text(&saved), "b_Head_05", "0.25")[1] - 0.258819).abs() < 1e-6);
}

/// Two nodes without a skin, each moved by a channel of its own.
const PLAIN: &str = r#"{"asset":{"version":"2.0"},
    "nodes":[{"name":"arm"},{"name":"fan"}],"scenes":[{"nodes":[0,1]}],"scene":0,
    "buffers":[{"byteLength":32,"uri":"data:;base64,AAAAAAAAgD8AAAAAAACAPwAAAAAAAAAAAAAAAAAAAAA="}],
    "bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":24}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
                 {"bufferView":1,"componentType":5126,"count":2,"type":"VEC3"}],
    "animations":[{"name":"turn","channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},
                                             {"sampler":0,"target":{"node":1,"path":"translation"}}],
                   "samplers":[{"input":0,"output":1}]}]}"#;

#[test]
fn a_node_that_loses_its_animation_is_reported_before_saving() {
    let folder = Folder::new("edit-plain");
    let file = folder.join("plain.gltf");
    std::fs::write(&file, PLAIN).expect("a file");
    let delete = r#"{"edit":"delete_keys","take":"turn","keys":[{"bones":["fan"]}]}"#;
    let delete = edits(&folder, delete);
    let plan = run(["edit", &text(&file), "--edits", &delete, "--dry-run"]).expect(0);
    let said = String::from_utf8_lossy(&plan.stdout).into_owned();
    assert!(said.contains("\"fan\" (node 1): no take animates it any more"), "{said}");
    let saved = text(&folder.join("saved.gltf"));
    let report = run(["edit", &text(&file), "--edits", &delete, "-o", &saved, "--json"]).expect(0).json();
    assert_eq!(report["changes"]["bonesLost"], serde_json::json!([{"node": 1, "bone": "fan"}]));
    let bones = |file: &str| {
        let listed = run(["pose", file, "--take", "turn", "--time", "0", "--json"]).expect(0).json();
        listed["poses"][0]["bones"].as_array().map(Vec::len)
    };
    assert_eq!((bones(&text(&file)), bones(&saved)), (Some(2), Some(1)), "as was reported");
    // Deleting one of several keys is not reported.
    let one = r#"{"edit":"delete_keys","take":"turn","keys":[{"bones":["fan"],"at":[1]}]}"#;
    let report = run(["edit", &text(&file), "--edits", &edits(&folder, one), "-o", &saved, "--json"]);
    assert_eq!(report.expect(0).json()["changes"]["bonesLost"], serde_json::json!([]));
}

#[test]
fn compacting_removes_the_buffer_files_of_earlier_saves_that_no_model_uses() {
    let folder = Folder::new("edit-compact-files");
    for name in ["AnimatedMorphCube.gltf", "AnimatedMorphCube.bin"] {
        std::fs::copy(data("gltf/AnimatedMorphCube_Quantized").join(name), folder.join(name))
            .expect("a copy");
    }
    let file = text(&folder.join("AnimatedMorphCube.gltf"));
    for length in 1..=5 {
        let lines = edits(&folder, &format!(r#"{{"edit":"retime_take","take":0,"length":{length}}}"#));
        run(["edit", &file, "--edits", &lines, "-o", &file]).expect(0);
    }
    let buffers = || {
        let names = std::fs::read_dir(folder.path()).expect("a folder").flatten();
        names.filter(|entry| entry.path().extension().is_some_and(|end| end == "bin")).count()
    };
    assert_eq!(buffers(), 6);
    run(["edit", &file, "--compact", "--dry-run"]).expect(0);
    assert_eq!(buffers(), 6, "nothing is removed without a save");
    let takes = run(["info", &file, "--json"]).expect(0).json()["takes"].clone();
    let report = run(["edit", &file, "--compact", "-o", &file, "--json"]).expect(0).json();
    assert_eq!(report["removed"].as_array().map(Vec::len), Some(4), "{report}");
    assert_eq!(buffers(), 2, "that of the model and the newest");
    assert_eq!(run(["info", &file, "--json"]).expect(0).json()["takes"], takes);
}
