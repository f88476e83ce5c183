//! `dragonfly check` and `dragonfly diff`: findings and differences as text, as JSON and as an exit code.

use crate::program::run;
use dragonfly_kit::folder::{Folder, data};
use std::path::{Path, PathBuf};

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn fox() -> PathBuf {
    data("gltf/Fox.glb")
}

/// A copy of Fox to which `edits` were applied, one JSON object per line.
fn edited(folder: &Folder, name: &str, edits: &str) -> PathBuf {
    let (lines, out) = (folder.join("edits.jsonl"), folder.join(name));
    std::fs::write(&lines, edits).expect("written");
    run(["edit", text(&fox()), "--edits", text(&lines), "-o", text(&out)]).expect(0);
    out
}

#[test]
fn the_help_of_check_states_how_many_rules_there_are() {
    let rules = format!("{} rules", dragonfly_anim::check::RULES.len());
    assert!(run(["check", "--help"]).expect(0).text().contains(&rules), "{rules}");
}

#[test]
fn a_valid_model_passes_the_check() {
    let outcome = run(["check", "demo:"]).expect(0);
    assert!(outcome.text().contains("0 errors, 0 warnings"), "{}", outcome.text());
    let reports = run(["check", "demo:", text(&fox()), "--json"]).expect(0).json();
    assert_eq!(reports.as_array().map(Vec::len), Some(2), "{reports}");
    assert_eq!(reports[0]["errors"], 0);
}

#[test]
fn warnings_fail_a_check_only_where_they_are_denied() {
    let path = data("collection/RobotExpressive.glb");
    let report = run(["check", text(&path), "--json"]).expect(0).json();
    assert_eq!((&report[0]["errors"], &report[0]["warnings"]), (&0.into(), &1.into()), "{report}");
    let denied = run(["check", text(&path), "--deny", "warning"]).expect(1);
    let listed = report[0]["findings"].as_array().expect("findings").iter();
    for finding in listed.filter(|finding| finding["severity"] == "warning") {
        let words = finding["text"].as_str().expect("a text");
        assert!(denied.text().contains(words), "{words} is not in {}", denied.text());
    }
}

#[test]
fn a_damaged_image_is_a_warning_of_check_info_and_render() {
    let folder = Folder::new("check-image");
    let whole = image::RgbaImage::from_fn(64, 64, |x, y| image::Rgba([x as u8, y as u8, 7, 255]));
    let mut png = std::io::Cursor::new(Vec::new());
    whole.write_to(&mut png, image::ImageFormat::Png).expect("encoded");
    let png = png.into_inner();
    std::fs::write(folder.join("skin.png"), &png[..png.len() / 2]).expect("written");
    let material = r#"{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}"#;
    let file = format!(
        r#"{{"asset":{{"version":"2.0"}},"images":[{{"uri":"skin.png"}}],"textures":[{{"source":0}}],"materials":[{material}]}}"#
    );
    let path = folder.join("model.gltf");
    std::fs::write(&path, file).expect("written");
    let warning = "image 0 \"skin.png\" is not shown: ";
    for command in ["check", "info"] {
        let outcome = run([command, text(&path)]).expect(0);
        assert_eq!(outcome.text().matches(warning).count(), 1, "{command}: {}", outcome.text());
    }
    if dragonfly_kit::picture::studio::studio().is_some() {
        let outcome = run(["render", text(&path), "-o", text(&folder.join("model.png"))]).expect(0);
        assert_eq!(outcome.stderr.matches(warning).count(), 1, "{}", outcome.stderr);
    }
}

#[test]
fn a_file_that_cannot_be_read_does_not_hide_the_findings_of_the_others() {
    let outcome = run(["check", "nowhere.glb", "demo:"]).expect(2);
    assert!(outcome.stderr.contains("nowhere.glb"), "{}", outcome.stderr);
    assert!(outcome.text().contains("0 errors"), "{}", outcome.text());
}

#[test]
fn a_file_does_not_differ_from_itself() {
    let outcome = run(["diff", text(&fox()), text(&fox()), "--tolerance", "0"]).expect(0);
    assert_eq!(outcome.text(), "no difference in 3 takes\n");
}

#[test]
fn a_changed_key_is_found_with_its_bone_its_distance_and_its_time() {
    let folder = Folder::new("diff");
    // Half a turn of the head at a key of the second take.
    let edit =
        r#"{"edit":"set","take":"Walk","time":0.0,"poses":[{"bone":"b_Head_05","rotation":[0,0,1,0]}]}"#;
    let other = edited(&folder, "Fox2.glb", edit);
    let outcome = run(["diff", text(&fox()), text(&other)]).expect(1);
    assert!(
        outcome.text().contains("take Walk: ") && outcome.text().contains("b_Head_05"),
        "{}",
        outcome.text()
    );
    assert!(!outcome.text().contains("take Survey") && !outcome.text().contains("take Run"));
    let json = run(["diff", text(&fox()), text(&other), "--json"]).expect(1).json();
    assert_eq!(json["differs"], true);
    let walk = &json["takes"][1];
    let bones = walk["bones"].as_array().expect("bones");
    let head = bones.iter().find(|bone| bone["name"] == "b_Head_05").expect("the head");
    assert!(head["angle_degrees"]["value"].as_f64() > Some(10.0), "{head}");
    assert_eq!(head["distance_mm"]["value"], 0.0, "its joint stays");
    // The rest of the body has not moved.
    assert!(bones.iter().all(|bone| bone["name"] != "b_Hip_01"), "{walk}");
    // With a tolerance above all differences the files count as equal.
    run(["diff", text(&fox()), text(&other), "--tolerance", "1e9", "--angle", "181"]).expect(0);
}

#[test]
fn takes_and_bones_without_a_counterpart_are_differences() {
    let folder = Folder::new("diff-names");
    let other = edited(&folder, "Fox3.glb", r#"{"edit":"rename_take","take":"Run","name":"Sprint"}"#);
    let outcome = run(["diff", text(&fox()), text(&other)]).expect(1);
    assert!(outcome.text().contains("Fox.glb: take Run is not in Fox3.glb"), "{}", outcome.text());
    assert!(outcome.text().contains("Fox3.glb: take Sprint is not in Fox.glb"), "{}", outcome.text());
    let json = run(["diff", text(&fox()), "demo:", "--json"]).expect(1).json();
    assert!(json["only_in_first"]["bones"].as_array().is_some_and(|bones| bones.len() > 10), "{json}");
}

#[test]
fn the_defects_of_takes_are_listed_with_bone_frame_amount_and_unit() {
    let folder = Folder::new("check-takes");
    let limits = folder.join("lint.json");
    let rules =
        r#""foot_slide":null,"floor":null,"jitter":null,"stretch":null,"spare_keys":null,"flip":null"#;
    std::fs::write(&limits, format!(r#"{{{rules},"pop":80,"meters_per_unit":0.01}}"#)).expect("written");
    let check = |file: &Path| run(["check", text(file), "--takes", "--thresholds", text(&limits), "--json"]);
    let clean = check(&fox()).expect(0).json();
    assert_eq!(clean[0]["takes"].as_array().map(Vec::len), Some(0), "{clean}");
    let pop = r#"{"edit":"offset","take":"Walk","time":0.3333333,"poses":[{"bone":"b_Hip_01","translation":[0,0,60]}]}"#;
    let popped = edited(&folder, "popped.glb", pop);
    let found = check(&popped).expect(1).json();
    let defects = found[0]["takes"].as_array().expect("defects");
    let hip = defects.iter().find(|defect| defect["bone"] == "b_Hip_01").expect("the hips");
    assert_eq!((&hip["take"], &hip["rule"], &hip["unit"]), (&"Walk".into(), &"pop".into(), &"mm".into()));
    let lines = run(["check", text(&popped), "--takes", "--thresholds", text(&limits)]).expect(1);
    assert!(lines.text().contains("pop: take Walk, bone b_Hip_01, frame "), "{}", lines.text());
    assert!(run(["check", text(&popped), "--json"]).expect(0).json()[0]["takes"].is_null());
}

#[test]
fn limits_of_joints_beside_a_model_are_used_for_its_takes() {
    let folder = Folder::new("check-joints");
    let model = folder.join("Fox.glb");
    std::fs::copy(fox(), &model).expect("copied");
    let beyond = |joint: &str, code: i32| {
        let rules = r#""foot_slide":null,"floor":null,"jitter":null,"stretch":null,"spare_keys":null,"flip":null,"pop":null"#;
        let content = format!(r#"{{{rules},"joints":{{"b_Neck_04":{joint}}}}}"#);
        std::fs::write(folder.join("Fox.check.json"), content).expect("written");
        let found = run(["check", text(&model), "--takes", "--json"]).expect(code).json();
        let rows = found[0]["takes"].as_array().cloned().unwrap_or_default();
        rows.into_iter().map(|row| row["amount"].as_f64().expect("an amount")).collect::<Vec<_>>()
    };
    // The neck may not turn at all: each take turns it by some degrees, and by less than 170.
    let none = beyond(r#"{"ball":{"axis":"x","swing":0,"twist":[0,0]}}"#, 1);
    assert_eq!(none.len(), 3, "{none:?}");
    let least = none.iter().copied().fold(f64::INFINITY, f64::min);
    let round =
        beyond(&format!(r#"{{"ball":{{"axis":"x","swing":{},"twist":[-170,170]}}}}"#, least - 1.5), 1);
    assert!(
        !round.is_empty() && round.iter().zip(&none).all(|(some, all)| some < all),
        "{round:?} of {none:?}"
    );
    assert_eq!(beyond(r#"{"ball":{"axis":"x","swing":170,"twist":[-180,180]}}"#, 0), [0.0; 0]);
    assert_eq!(beyond(r#"{"hinge":{"axis":[0,0,0],"range":[0,1]}}"#, 2), [0.0; 0]);
}

#[test]
fn a_limit_of_a_joint_that_the_model_does_not_have_is_a_warning_and_the_rest_is_checked() {
    let folder = Folder::new("check-unknown-joint");
    let limits = folder.join("lint.json");
    let joint = r#"{"ball":{"axis":"x","swing":0,"twist":[0,0]}}"#;
    let content = format!(r#"{{"joint_limit":1,"joints":{{"Nose":{joint},"b_Neck_04":{joint}}}}}"#);
    std::fs::write(&limits, content).expect("written");
    let found =
        run(["check", text(&fox()), "--takes", "--thresholds", text(&limits), "--json"]).expect(1).json();
    let warnings: Vec<&str> = found[0]["findings"]
        .as_array()
        .expect("findings")
        .iter()
        .filter(|finding| finding["severity"] == "warning" && finding["rule"] == "JOINTS")
        .filter_map(|finding| finding["text"].as_str())
        .collect();
    assert_eq!(warnings, ["\"joints\" names bones that the model does not have: \"Nose\""], "{found}");
    let defects = found[0]["takes"].as_array().expect("defects");
    assert!(defects.iter().any(|defect| defect["rule"] == "joint_limit"), "{found}");
}

#[test]
fn wrong_thresholds_are_an_input_error_that_names_them() {
    let folder = Folder::new("check-thresholds");
    let limits = folder.join("lint.json");
    for (content, wanted) in [
        ("[]", "an object"),
        (r#"{"pops":1}"#, "\"pops\""),
        (r#"{"pop":"much"}"#, "\"pop\" has to be a number"),
        (r#"{"rate":0}"#, "above 0"),
        (r#"{"up":"w"}"#, "\"up\" has to be"),
        (r#"{"joints":[]}"#, "\"joints\" has to be an object"),
        (r#"{"joints":{"Head":{"screw":{}}}}"#, "the joint of \"Head\": unknown variant `screw`"),
        (r#"{"joints":{"Head":{"hinge":{"axis":[0,0,0],"range":[0,1]}}}}"#, "an axis has no direction"),
        (
            r#"{"joints":{"Head":{"hinge":{"axis":"x","range":[150,0]}}}}"#,
            "the joint of \"Head\": the range [150, 0] ends before it begins",
        ),
    ] {
        std::fs::write(&limits, content).expect("written");
        let outcome = run(["check", "demo:", "--takes", "--thresholds", text(&limits)]).expect(2);
        assert!(outcome.stderr.contains(wanted), "{content}: {}", outcome.stderr);
    }
}

#[test]
fn the_picture_of_a_difference_shows_both_models_from_one_camera_and_the_bars_where_they_differ() {
    let folder = Folder::new("diff-picture");
    // One pose of the head, in the second half of the take.
    let turn = r#"{"edit":"offset","take":"Survey","time":2.5,"poses":[{"bone":"b_Head_05","rotation":[0,0,0.38,0.92]},{"bone":"b_Neck_04","rotation":[0,0,0.38,0.92]}]}"#;
    let other = edited(&folder, "Fox4.glb", turn);
    let picture = folder.join("diff.png");
    let run_it = |a: &Path, b: &Path| run(["diff", text(a), text(b), "--picture", text(&picture)]);
    let outcome = run_it(&fox(), &other).expect(1);
    assert!(outcome.text().contains("b_Head_05"), "the text is printed, too: {}", outcome.text());
    let drawn = image::open(&picture).expect("a PNG file").into_rgba8();
    assert_eq!(drawn.dimensions(), (1604, 820));
    let half = |left: u32| image::imageops::crop_imm(&drawn, left, 0, 800, 720).to_image();
    let (left, right) = (half(0), half(804));
    let differing = left.pixels().zip(right.pixels()).filter(|(a, b)| a != b).count();
    // The head alone differs: the camera is the same.
    assert!((500..150_000).contains(&differing), "{differing} pixels differ");
    // Red bars are where the head is turned, around 2.5 s of 3.42 s, and none at the start.
    let red = |columns: std::ops::Range<u32>| {
        let pixels = columns.flat_map(|x| (724..819).map(move |y| (x, y)));
        pixels.filter(|&(x, y)| matches!(drawn.get_pixel(x, y).0, [200..=255, 0..=110, 0..=80, 255])).count()
    };
    let middle = (1604.0 * 2.5 / 3.416_667) as u32;
    assert!(red(middle - 12..middle + 12) > 100, "{}", red(middle - 12..middle + 12));
    assert_eq!(red(0..400), 0);
    // Without a difference there is no picture.
    std::fs::remove_file(&picture).expect("removed");
    run_it(&fox(), &fox()).expect(0);
    assert!(!picture.exists());
}
