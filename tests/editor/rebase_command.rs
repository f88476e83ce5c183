//! `dragonfly edit NEW --rebase OLD` applies edits that were made for another version of the file, and lists those that do not fit.

use crate::program::run;
use dragonfly_kit::document::new_version::{new_version, rename_nodes, reverse};
use dragonfly_kit::folder::{Folder, data};
use std::fs;
use std::path::Path;

/// Edits of Fox by index: the head (bone 6 of the old file) in the take Run, its name, and the tip of the tail.
const EDITS: &str = r#"{"edit":"rename_take","take":2,"name":"Sprint"}
{"edit":"set","take":2,"time":0.25,"poses":[{"bone":"b_Head_05","rotation":[0,0.2588190,0,0.9659258]}]}

{"edit":"set","take":"Sprint","time":0.25,"poses":[{"bone":"b_Tail03_014","rotation":[0,0,1,0]}]}
{"edit":"reverse_take","take":1}
"#;

struct Files {
    folder: Folder,
    old: String,
    new: String,
    edits: String,
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

/// Writes a new version of Fox, in which everything is in another order, and these nodes have other names.
fn files(name: &str, renamed: &[(&str, &str)]) -> Files {
    let folder = Folder::new(name);
    let old = data("gltf/Fox.glb");
    let bytes = new_version(&fs::read(&old).expect("a file"), |json| {
        reverse(json);
        renamed.iter().for_each(|(from, to)| rename_nodes(json, from, to));
    });
    let [new, edits] = ["new.glb", "edits.jsonl"].map(|name| folder.join(name));
    fs::write(&new, bytes).expect("a file");
    fs::write(&edits, EDITS).expect("a file");
    Files { old: text(&old), new: text(&new), edits: text(&edits), folder }
}

/// Returns the rotation of a bone at 0.25 s of the take Sprint.
fn rotation(file: &str, bone: &str) -> serde_json::Value {
    let arguments = ["explain", file, "--take", "Sprint", "--time", "0.25", "--bone", bone, "--json"];
    let explained = run(arguments).expect(0).json();
    explained["bones"].as_array().and_then(|bones| bones.last()).expect("a bone")["rotation"]["value"].clone()
}

#[test]
fn edits_of_an_older_version_do_the_same_in_a_file_with_another_order() {
    let files = files("rebase-order", &[]);
    let [plain, rebased] = ["plain.glb", "rebased.glb"].map(|name| text(&files.folder.join(name)));
    run(["edit", &files.old, "--edits", &files.edits, "-o", &plain]).expect(0);
    let report =
        run(["edit", &files.new, "--rebase", &files.old, "--edits", &files.edits, "-o", &rebased, "--json"])
            .expect(0)
            .json();
    assert_eq!((report["edits"].as_u64(), report.get("unfit")), (Some(4), None));
    for bone in ["b_Head_05", "b_Neck_04", "b_Tail03_014"] {
        assert_eq!(rotation(&rebased, bone), rotation(&plain, bone), "{bone}");
    }
    run(["diff", &plain, &rebased]).expect(0);
}

#[test]
fn what_does_not_fit_is_listed_with_its_line_and_the_rest_is_written() {
    let files = files("rebase-unfit", &[("b_Tail03_014", "b_TailTip")]);
    let out = text(&files.folder.join("out.glb"));
    let arguments = ["edit", &files.new, "--rebase", &files.old, "--edits", &files.edits, "-o", &out];
    let done = run(arguments).expect(1);
    let line = r#"edits.jsonl: line 4: Rotate (b_Tail03_014, Sprint, at 0.25 s): the new version has no bone "b_Tail03_014""#;
    assert!(done.stderr.contains(line), "{}", done.stderr);
    assert_eq!(rotation(&out, "b_Head_05").as_array().map(Vec::len), Some(4));
    let report = run([&arguments[..], &["--json"]].concat()).expect(1).json();
    let unfit = serde_json::json!([{
        "line": 4,
        "edit": "Rotate (b_Tail03_014, Sprint, at 0.25 s)",
        "applied_in_part": false,
        "reasons": [r#"the new version has no bone "b_Tail03_014""#],
    }]);
    assert_eq!(report["unfit"], unfit);
}

#[test]
fn an_edit_that_does_not_fit_the_older_version_stops_the_command() {
    let files = files("rebase-wrong", &[]);
    let wrong = files.folder.join("wrong.jsonl");
    fs::write(&wrong, "{\"edit\":\"reverse_take\",\"take\":\"Fly\"}\n").expect("a file");
    let out = files.folder.join("out.glb");
    let arguments = ["edit", &files.new, "--rebase", &files.old, "--edits", &text(&wrong), "-o", &text(&out)];
    let done = run(arguments).expect(2);
    assert!(done.stderr.contains("line 1: there is no take \"Fly\""), "{}", done.stderr);
    assert!(!out.exists());
}

#[test]
fn the_older_version_is_read_with_the_import_options_of_the_file() {
    let folder = Folder::new("rebase-options");
    let [new, edits, out] = ["new.bvh", "edits.jsonl", "out.bvh"].map(|name| folder.join(name));
    let old = data("bvh/pybvh_example.bvh");
    fs::copy(&old, &new).expect("a copy");
    // Only at 25 frames per second there is a key at 0.08 s.
    let edit = r#"{"edit":"delete_keys","take":0,"keys":[{"from":0.079,"to":0.081}]}"#;
    fs::write(&edits, format!("{edit}\n")).expect("a file");
    let [old, new, edits, out] = [&old, &new, &edits, &out].map(|path| text(path));
    let arguments = ["edit", &new, "--rebase", &old, "--edits", &edits, "-o", &out];
    run(arguments).expect(2);
    run([&arguments[..], &["--rate", "25"]].concat()).expect(0);
}
