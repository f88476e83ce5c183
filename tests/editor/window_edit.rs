//! Edits made with mouse and keys in the real window have the same result on screen, in the accessibility tree, in the
//! saved file, in another program that reads it, and byte for byte through `--stdio`.

use crate::program::run;
use crate::screen::key;
use crate::window::alone;
use crate::window_visit::Visit;
use dragonfly_kit::folder::data;
use dragonfly_kit::skip;
use dragonfly_picture::gizmo::{GizmoAxis, GizmoSpace, Handle};
use glam::{DMat4, DQuat, DVec3};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Requested angle, degrees.
const ASKED: f64 = 30.0;

/// Returns the rotation of the head relative to its parent in the first take, as three.js plays it.
fn head_by_three(evaluators: &Path, file: &Path, time: f32) -> DQuat {
    let output = Command::new("node")
        .arg(evaluators.join("ref_gltf.mjs"))
        .arg(file)
        .args(["--clip", "0", "--all-nodes", "--times", &time.to_string()])
        .output()
        .expect("node runs");
    let answer: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)));
    let nodes = answer["nodes"].as_array().expect("nodes");
    let head = nodes.iter().position(|node| node[0] == "b_Head_05").expect("a head");
    let world = &answer["clips"][0]["samples"][0]["world"];
    let matrix = |node: u64| {
        let numbers = world[node.to_string()].as_array().expect("a matrix");
        let numbers: Vec<f64> = numbers.iter().map(|number| number.as_f64().expect("a number")).collect();
        DMat4::from_cols_slice(&numbers)
    };
    let parent = matrix(nodes[head][1].as_u64().expect("a parent"));
    (parent.inverse() * matrix(head as u64)).to_scale_rotation_translation().1
}

/// Returns the largest difference of two rotations, component by component.
fn apart(one: DQuat, other: DQuat) -> f64 {
    let other = if one.dot(other) < 0.0 { -other } else { other };
    (one - other).to_array().into_iter().fold(0.0, |most: f64, number| most.max(number.abs()))
}

#[track_caller]
fn same_bytes(one: &[u8], other: &[u8], otherwise: &str) {
    assert!(one == other, "{otherwise}: {} and {} bytes", one.len(), other.len());
}

#[test]
fn rotating_a_head_agrees_with_the_accessibility_tree_stdio_and_three_js() {
    let _one = alone();
    let mut visit = Visit::new("edit-turn");
    let original = std::fs::read(&visit.file).unwrap();
    let time = visit.go_on(5);
    visit.pick_head();
    visit.until_number("Rotation change X", 0.0, 0.0);
    // About the axes of the parent, in which the panel shows the change.
    visit.screen.press(key::T);
    let mut inside = visit.inside();
    inside.state.settings_mut().tools.space = GizmoSpace::Parent;
    let ring = inside.handle("b_Head_05", Handle::Axis(GizmoAxis::X));
    visit.screen.point(ring.x as i16, ring.y as i16);
    visit.screen.hold();
    visit.screen.point(ring.x as i16 + 9, ring.y as i16 + 14);
    visit.screen.type_text("30");
    visit.screen.press(key::ENTER);
    visit.screen.release_button();

    visit.until_steps(1, 1);
    visit.until_number("Rotation change X", ASKED, 2e-4);
    for axis in ["Y", "Z"] {
        visit.until_number(&format!("Rotation change {axis}"), 0.0, 2e-4);
    }
    visit.control_and(key::Z);
    visit.until_number("Rotation change X", 0.0, 0.0);
    visit.until_steps(0, 1);
    visit.control_and(key::Y);
    visit.until_number("Rotation change X", ASKED, 2e-4);
    visit.until_steps(1, 1);
    let saved = visit.save();
    assert!(saved != original);

    same_bytes(&saved, &visit.by_stdio(), "another file by --stdio");
    let edit =
        visit.asked().into_iter().rfind(|request| request["do"] == "edit").expect("an edit")["edit"].clone();
    let [lines, done] = ["edits.jsonl", "done.glb"].map(|name| visit.folder.join(name).display().to_string());
    std::fs::write(&lines, edit.to_string()).unwrap();
    run(["edit", &data("gltf/Fox.glb").display().to_string(), "--edits", &lines, "-o", &done]).expect(0);
    same_bytes(&saved, &std::fs::read(done).unwrap(), "another file by `dragonfly edit`");

    if let Some(evaluators) = skip::evaluators() {
        let before = head_by_three(&evaluators, &data("gltf/Fox.glb"), time);
        let after = head_by_three(&evaluators, &visit.file, time);
        let wanted = DQuat::from_axis_angle(DVec3::X, ASKED.to_radians()) * before;
        let apart = apart(after, wanted);
        println!("three.js: {apart:e} from what was asked");
        assert!(apart < 1e-5, "{after} is {apart:e} from {wanted}");
    }
    visit.end();
}

#[test]
fn edits_in_the_panels_give_the_same_file_as_stdio() {
    let _one = alone();
    let mut visit = Visit::new("edit-panels");
    let original = std::fs::read(&visit.file).unwrap();
    visit.control_and(key::F);
    visit.screen.type_text("head");
    visit.click_on("b_Head_05");
    visit.until_shown("bone", "b_Head_05");
    visit.click_on("Rotation result Z");
    visit.until("the cursor in it", |visit| {
        (visit.control_now("Rotation result Z")?["focused"] == true).then_some(())
    });
    visit.screen.type_text("45/2");
    visit.screen.press(key::TAB);
    visit.until_steps(1, 1);
    visit.until_number("Rotation result Z", 22.5, 2e-4);
    for _ in 0..3 {
        visit.click_on("Next frame");
    }
    visit.click_on("Key");
    visit.until_steps(2, 2);
    visit.click_on("Rename take");
    visit.until("the cursor in it", |visit| {
        (visit.control_now("Name of the take")?["focused"] == true).then_some(())
    });
    visit.screen.type_text("look");
    visit.screen.press(key::ENTER);
    visit.until_steps(3, 3);
    visit.control("look");
    visit.click_on("Delete take");
    visit.until_steps(4, 4);
    visit.until("the take is gone", |visit| visit.control_now("look").is_none().then_some(()));

    // A click undoes everything, and another one redoes it.
    visit.click_on("History");
    visit.click_on("Opened");
    visit.until_steps(0, 4);
    visit.control("Survey");
    same_bytes(&visit.save(), &original, "with everything undone the file is another one");
    visit.click_on("Delete take, look, undone");
    visit.until_steps(4, 4);
    let saved = visit.save();
    same_bytes(&saved, &visit.by_stdio(), "another file by --stdio");
    visit.end();
}

#[test]
fn with_auto_key_off_a_pose_is_pending_until_it_is_keyed() {
    let _one = alone();
    let mut visit = Visit::new("edit-pending");
    let original = std::fs::read(&visit.file).unwrap();
    visit.screen.press_with(key::SHIFT, key::I);
    visit.until("auto-key is off", |visit| (visit.control_now("Auto-key")?["on"] == false).then_some(()));
    let time = visit.go_on(5);
    visit.pick_head();
    let ring = visit.inside().handle("b_Head_05", Handle::Axis(GizmoAxis::X));
    visit.screen.point(ring.x as i16, ring.y as i16);
    visit.screen.hold();
    for by in 1..20 {
        visit.screen.point(ring.x as i16 + by, ring.y as i16 + 2 * by);
    }
    visit.screen.release_button();
    visit.control("1 pose pending");
    same_bytes(&visit.save(), &original, "what is pending is in the file");
    visit.control("1 pose pending");
    visit.screen.press(key::K);
    visit.until("it is keyed", |visit| visit.control_now("1 pose pending").is_none().then_some(()));
    visit.until_steps(2, 2);
    let saved = visit.save();
    same_bytes(&saved, &visit.by_stdio(), "another file by --stdio");
    let turned =
        DQuat::from_array(crate::window_bone_rotation::numbers::<4>(&visit.shown("rotation")).map(f64::from));
    if let Some(evaluators) = skip::evaluators() {
        let before = head_by_three(&evaluators, &data("gltf/Fox.glb"), time);
        let after = head_by_three(&evaluators, &visit.file, time);
        assert!(apart(before, after) > 0.01, "it was turned");
        assert!(apart(after, turned) < 1e-5, "{after} is not {turned}");
    }
    visit.end();
}
