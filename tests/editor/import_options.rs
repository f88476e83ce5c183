//! Import options: in the window and on the command line, a file is read with the unit, the axes and the frame rate that the user chose.

use crate::panels::{Bench, harness};
use crate::pictures::states::view_of;
use crate::program::run;
use dragonfly::panels::FileChoice;
use dragonfly::panels::commands::Id;
use dragonfly::panels::prompts::Overlay;
use dragonfly::panels::{Effect, FileAction, Request};
use dragonfly_anim::format::{Conventions, UpAxis};
use dragonfly_document::{Source, Then};
use dragonfly_kit::folder::{Folder, data};
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// Returns the JSON that a command prints.
fn printed(arguments: &[&str]) -> serde_json::Value {
    run(arguments.iter().copied()).expect(0).json()
}

/// Returns the height of each bone in the first pose that a command prints.
fn heights(arguments: &[&str]) -> Vec<f64> {
    let json = printed(arguments);
    let bones = json["poses"][0]["bones"].as_array().cloned().unwrap_or_default();
    bones.iter().map(|bone| bone["to_root"][13].as_f64().expect("a matrix")).collect()
}

#[test]
fn the_command_line_reads_a_capture_in_the_chosen_unit() {
    let file = data("bvh/pybvh_example.bvh");
    let plain = heights(&["pose", text(&file), "--json", "--time", "0"]);
    let info = printed(&["info", text(&file), "--json"]);
    let unit = info["conventions"]["meters_per_unit"].as_f64().expect("a unit");
    let twice = (2.0 * unit).to_string();
    let large = heights(&["pose", text(&file), "--json", "--time", "0", "--scale", &twice]);
    assert!(plain.len() > 5 && plain.iter().any(|height| height.abs() > 0.1), "{plain:?}");
    for (plain, large) in plain.iter().zip(large) {
        assert!((2.0 * plain - large).abs() < 1e-4 * (1.0 + large.abs()), "{plain} and {large}");
    }
    let chosen = run(["info", text(&file), "--up", "z", "--hand", "left", "--scale", "0.25"]).expect(0);
    assert!(chosen.text().contains("1 unit = 0.25 m (chosen), Z up (chosen), left-handed (chosen)"));
    run(["info", text(&file), "--scale", "0"]).expect(2);
    run(["render", text(&file), "--up", "w", "-o", "-"]).expect(2);
}

#[test]
fn edits_of_a_file_that_was_read_in_another_unit_are_saved_in_that_unit() {
    let folder = Folder::new("import-options-edit");
    let (out, edits) = (folder.join("out.bvh"), folder.join("edits.jsonl"));
    let file = data("bvh/pybvh_example.bvh");
    let root =
        printed(&["pose", text(&file), "--json", "--time", "0"])["poses"][0]["bones"][0]["name"].clone();
    let edit = serde_json::json!({"edit": "set", "take": 0, "time": 0, "poses": [{"bone": root, "translation": [0.0, 2.0, 0.0]}]});
    std::fs::write(&edits, edit.to_string()).expect("a file");
    run(["edit", text(&file), "--edits", text(&edits), "-o", text(&out), "--scale", "0.5"]).expect(0);
    // Two meters are four units of half a meter.
    let first = |path: &Path| {
        let all = std::fs::read_to_string(path).expect("text");
        let after = all.split("Frame Time:").nth(1).and_then(|motion| motion.lines().nth(1));
        let row =
            after.expect("a row").split_whitespace().map(|number| number.parse::<f64>().expect("a number"));
        row.collect::<Vec<f64>>()
    };
    assert_eq!(first(&out)[..3], [0.0, 4.0, 0.0]);
    assert_eq!(first(&out)[3..], first(&file)[3..]);
}

#[test]
fn the_dialog_opens_the_file_again_with_the_chosen_options() {
    let file = data("bvh/pybvh_example.bvh");
    let before = Conventions { up: Some(UpAxis::Z), ..Conventions::default() };
    let mut harness = harness(Bench::new(Some(view_of(&Source::of(file.clone(), before)))));
    harness.run_steps(4);
    harness.state_mut().state.execute(Request::Command(Id::ImportOptions));
    harness.run_steps(4);
    // The dialog shows guesses and choices, and nothing about formats that have no choice.
    assert!(harness.query_by_label_contains("(guessed), Z up (chosen)").is_some());
    assert!(harness.query_by_label_contains("have no effect").is_none());
    harness.get_by_role_and_label(Role::ComboBox, "Unit").click();
    harness.run_steps(4);
    harness.get_by_label("Centimeter").click();
    harness.run_steps(4);
    harness.get_by_label("Open again").click();
    harness.run_steps(4);
    let chosen = Conventions { meters_per_unit: Some(0.01), ..before };
    let expected = Effect::File(FileAction::Leave(Then::Open(Source::of(file, chosen))));
    assert_eq!(harness.state().effects, [expected]);
    // A file that is opened by path starts without options.
    harness.state_mut().state.execute(Request::Command(Id::OpenPath));
    harness.run_steps(4);
    harness.get_by_label("Open").click();
    harness.run_steps(4);
    let Some(Effect::File(FileAction::Leave(Then::Open(source)))) = harness.state().effects.last() else {
        panic!("nothing is opened")
    };
    assert_eq!(source.conventions(), Conventions::default());
}

#[test]
fn the_path_of_a_file_is_typed_where_the_desktop_has_no_dialog_for_files() {
    for choice in [FileChoice::Takes, FileChoice::NewScene, FileChoice::DemoScene] {
        let mut harness = harness(Bench::new(Some(view_of(&Source::File(data("gltf/Fox.glb"))))));
        harness.run_steps(4);
        harness.state_mut().state.show_overlay(Some(Overlay::FilePath(choice)));
        harness.run_steps(4);
        assert!(harness.query_by_label(choice.title()).is_some(), "{choice:?}");
        harness.event(egui::Event::Text("/models/other.glb".to_owned()));
        harness.run_steps(2);
        harness.get_by_label("Choose").click();
        harness.run_steps(4);
        assert_eq!(harness.state().state.read().overlay, None, "{choice:?}");
        let effects = format!("{:?}", harness.state().effects);
        assert!(effects.contains("/models/other.glb"), "{choice:?}: {effects}");
    }
}
