//! Scripts of scenes on the command line: checked, timed, posed.

use crate::program::run;
use dragonfly_kit::folder::{Folder, data};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// A role that walks along x at 2 m/s and turns, and a prop in its hand.
const SCENE: &str = r#"<script version="1" fps="24">
  <cast>
    <role id="fox" model="models/Fox.glb" scale="0.01" at="1 0 2" facing="90"/>
    <prop id="box" model="models/box_sparse.glb" at="0 3 0"/>
    <camera id="wide" at="0 1 6" look="fox"/>
    <path id="aisle" points="1 0 2  5 0 2"/>
  </cast>
  <seq>
    <move id="walk" who="fox" path="aisle" take="Walk" speed="2" feet="free"/>
    <play id="looks" who="fox" take="Survey"/>
  </seq>
</script>
"#;

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// Writes a script next to a folder with its models.
fn scene(name: &str, script: &str) -> (Folder, PathBuf) {
    let folder = Folder::new(name);
    fs::create_dir_all(folder.join("models")).expect("a folder");
    for model in ["Fox.glb", "box_sparse.glb"] {
        fs::copy(data(&format!("gltf/{model}")), folder.join(&format!("models/{model}"))).expect("a copy");
    }
    let path = folder.join("scene.xml");
    fs::write(&path, script).expect("a file");
    (folder, path)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn the_times_of_a_script_follow_from_ways_speeds_and_takes() {
    let (_folder, path) = scene("scene-times", SCENE);
    let times = run(["script", text(&path), "--json"]).expect(0).json();
    let fox = run(["info", text(&path.with_file_name("models/Fox.glb")), "--json"]).expect(0).json();
    let takes = fox["takes"].as_array().expect("takes");
    let survey = takes.iter().find(|take| take["name"] == "Survey").expect("a take");
    let action = |id: &str| {
        let all = times["actions"].as_array().expect("actions");
        let found = all.iter().find(|action| action["id"] == id).expect(id);
        (number(&found["begin"]), number(&found["end"]), found["line"].clone())
    };
    // Four meters at two meters a second.
    let (begin, end, line) = action("walk");
    assert_eq!((begin, end, line), (0.0, 2.0, 9.into()));
    let (begin, end, _) = action("looks");
    assert_eq!(begin, 2.0);
    assert!((end - 2.0 - number(&survey["end"])).abs() < 1e-3, "{end} {survey}");
    assert_eq!(times["length"], end);
    let table = run(["script", text(&path)]).expect(0).text().to_owned();
    assert!(table.lines().any(|line| line.contains("walk") && line.contains("2.000")), "{table}");
}

#[test]
fn a_role_stands_where_its_way_leads_at_each_time() {
    let (_folder, path) = scene("scene-pose", SCENE);
    let order =
        ["pose", text(&path), "--role", "fox", "--time", "0.5", "--time", "2", "--time", "9", "--json"];
    let poses = run(order).expect(0).json();
    assert_eq!((&poses["kind"], poses["poses"].as_array().map(Vec::len)), (&"role".into(), Some(3)));
    // Along x from (1 0 2), at two meters a second, for two seconds.
    // Within a step it is faster and slower, as its feet are.
    for (at, (x, tolerance)) in [(2.0, 0.05), (5.0, 1e-4), (5.0, 1e-4)].into_iter().enumerate() {
        let pose = &poses["poses"][at];
        let place: Vec<f64> = pose["translation"].as_array().expect("a place").iter().map(number).collect();
        let near = [x, 0.0, 2.0].iter().zip(&place).all(|(wanted, found)| (wanted - found).abs() < tolerance);
        assert!(near, "{place:?} at {}", pose["time"]);
        assert!((number(&pose["scale"][0]) - 0.01).abs() < 1e-6);
        let bones = pose["bones"].as_array().expect("bones");
        assert_eq!(bones.len(), 25);
        // The fox is less than two meters long, so its bones are near its place.
        for bone in bones {
            let x_of_bone = number(&bone["to_scene"][12]);
            assert!((x_of_bone - x).abs() < 2.0, "{bone}");
        }
    }
    let text_of = run(["pose", text(&path), "--role", "fox", "--time", "2"]).expect(0).text().to_owned();
    assert!(text_of.contains("2 s at 5.0000 0.0000 2.0000"), "{text_of}");
    let wrong = run(["pose", text(&path), "--role", "cat", "--time", "0"]).expect(2);
    assert!(wrong.stderr.contains("nothing is called \"cat\"; there is fox, box, wide"), "{}", wrong.stderr);
}

#[test]
fn the_weights_of_the_shape_keys_of_a_role_are_printed() {
    let cube = SCENE
        .replace("models/box_sparse.glb", "models/cube.glb")
        .replace("  <seq>", "  <play who=\"box\" take=\"Square\" from=\"1\"/>\n  <seq>");
    let (folder, path) = scene("scene-shapes", &cube);
    let model = folder.join("models/cube.glb");
    fs::copy(data("gltf/AnimatedMorphCube.glb"), &model).expect("a copy");
    let poses = run(["pose", text(&path), "--role", "box", "--time", "0.5", "--json"]).expect(0).json();
    let shapes = poses["poses"][0]["shapes"].as_array().expect("shape keys").clone();
    let names: Vec<[&str; 2]> =
        shapes.iter().map(|row| ["mesh", "shape"].map(|name| row[name].as_str().expect("a name"))).collect();
    assert_eq!(names, [["Cube", "Shape 1"], ["Cube", "Shape 2"]]);
    // The weights of a vertex at 1.5 s of the take.
    let order = ["explain", text(&model), "--take", "Square", "--time", "1.5", "--vertex", "0", "--json"];
    let explained = run(order).expect(0).json();
    let weights: Vec<f64> =
        shapes.iter().map(|row| number(&row["weight"])).filter(|weight| *weight != 0.0).collect();
    let told = explained.to_string();
    assert!(
        !weights.is_empty() && weights.iter().all(|weight| told.contains(&weight.to_string())),
        "{shapes:?} {told}"
    );
    let printed = run(["pose", text(&path), "--role", "box", "--time", "0.5"]).expect(0).text().to_owned();
    assert!(printed.contains("  Cube, shape key Shape 1: "), "{printed}");
}

#[test]
fn what_is_wrong_with_a_script_is_listed_with_line_column_and_a_suggestion() {
    let wrong =
        SCENE.replace("take=\"Survey\"", "take=\"Survy\"").replace("models/box_sparse.glb", "models/box.glb");
    let (_folder, path) = scene("scene-check", &wrong);
    // Without all models, takes and bones are not checked.
    let found = run(["check", text(&path), "--json"]).expect(1).json();
    let finding = &found[0]["findings"][0];
    assert_eq!((&finding["severity"], &finding["place"]), (&"error".into(), &"4:27".into()), "{found}");
    let message = finding["text"].as_str().expect("a text");
    assert!(message.starts_with("models/box.glb: "), "{message}");
    fs::write(&path, wrong.replace("models/box.glb", "models/box_sparse.glb")).expect("a file");
    let printed = run(["check", text(&path)]).expect(1).text().to_owned();
    assert!(printed.contains("scene.xml: 1 error"), "{printed}");
    assert!(printed.contains("10:38: ") && printed.contains("did you mean \"Survey\""), "{printed}");
    fs::write(&path, SCENE).expect("a file");
    run(["check", text(&path)]).expect(0);
    let other = run(["pose", text(&path.with_file_name("models/Fox.glb")), "--role", "fox", "--time", "0"]);
    assert!(other.expect(2).stderr.contains("has to be a scene"));
}

#[test]
fn options_that_a_scene_would_ignore_are_refused() {
    let (folder, path) = scene("scene-options", SCENE);
    let image = folder.join("image.png");
    for option in [["--take", "Walk"], ["--scale", "0.01"], ["--up", "z"]] {
        let refused = run(["render", text(&path), option[0], option[1], "-o", text(&image)]).expect(2);
        assert!(refused.stderr.contains(option[0]), "{}", refused.stderr);
        let refused =
            run(["pose", text(&path), "--role", "fox", "--time", "0", option[0], option[1]]).expect(2);
        assert!(refused.stderr.contains(option[0]), "{}", refused.stderr);
    }
    assert!(!image.exists());
    // The message names the options that were given, and it holds for a script without a project.
    let refused =
        run(["render", text(&path), "--hand", "left", "--rate", "24", "-o", text(&image)]).expect(2);
    let wanted = "--hand, --rate: these options are for a model file; a scene does not use them";
    assert!(refused.stderr.contains(wanted), "{}", refused.stderr);
    let model = path.with_file_name("models/Fox.glb");
    let refused = run(["render", text(&model), "--camera", "wide", "-o", text(&image)]).expect(2);
    assert!(refused.stderr.contains("(.meproj)"), "{}", refused.stderr);
}

#[test]
fn models_outside_of_the_folder_of_the_script_are_refused() {
    let (folder, path) = scene("scene-outside", SCENE);
    fs::create_dir(folder.join("inner")).expect("a folder");
    let inner = folder.join("inner/scene.xml");
    fs::copy(&path, &inner).expect("a copy");
    let climbing = fs::read_to_string(&inner).expect("a text").replace("models/", "../models/");
    fs::write(&inner, climbing).expect("a file");
    let refused = run(["check", text(&inner)]).expect(1).text().to_owned();
    assert!(refused.contains("a relative path with `/`, below the folder of the script"), "{refused}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.join("models"), folder.join("inner/models")).expect("a link");
        fs::write(&inner, SCENE).expect("a file");
        let refused = run(["check", text(&inner)]).expect(1).text().to_owned();
        assert!(refused.contains("leads out of"), "{refused}");
    }
    let binary = folder.join("binary.xml");
    fs::write(&binary, b"<script>\n\xff\xfe</script>").expect("a file");
    let refused = run(["check", text(&binary)]).expect(2);
    assert!(refused.stderr.contains("2:1: this is not UTF-8"), "{}", refused.stderr);
}

#[test]
fn the_schema_of_scripts_is_printed() {
    let schema = run(["script", "--schema"]).expect(0).text().to_owned();
    assert!(
        schema.starts_with("<?xml") && schema.contains("relaxng.org"),
        "{}",
        &schema[..200.min(schema.len())]
    );
    assert_eq!(schema, dragonfly_anim::stage::table::schema());
    run(["script"]).expect(2);
}

#[test]
fn errors_of_an_included_script_are_found_with_its_name_line_and_column() {
    let main = "<script version=\"1\">\n  <include src=\"intro.xml\"/>\n</script>\n";
    let (folder, path) = scene("scene-include", main);
    let intro = folder.join("intro.xml");
    fs::write(&intro, SCENE).expect("a file");
    run(["check", text(&path)]).expect(0);
    let times = run(["script", text(&path), "--json"]).expect(0).json();
    assert_eq!(
        (&times["actions"][3]["file"], &times["actions"][3]["line"]),
        (&"intro.xml".into(), &9.into())
    );
    fs::write(&intro, SCENE.replace("Survey", "Fly")).expect("a file");
    let found = run(["check", text(&path), "--json"]).expect(1).json();
    let row = &found[0]["findings"][0];
    assert_eq!(
        (&found[0]["file"], &row["file"], &row["place"]),
        (&"scene.xml".into(), &"intro.xml".into(), &"10:38".into()),
        "{found}"
    );
    assert!(
        row["text"].as_str().is_some_and(|text| text.starts_with("\"fox\" has no take \"Fly\"")),
        "{found}"
    );
    let printed = run(["check", text(&path)]).expect(1).text().to_owned();
    assert!(printed.contains("error: intro.xml:10:38: \"fox\" has no take \"Fly\""), "{printed}");
    // The included script alone has the same error.
    assert!(
        run(["check", text(&intro)]).expect(1).text().contains("error: 10:38: \"fox\" has no take \"Fly\"")
    );
    fs::remove_file(&intro).expect("a file");
    let printed = run(["check", text(&path)]).expect(1).text().to_owned();
    assert!(printed.contains("error: 2:17: intro.xml cannot be read: there is no such file"), "{printed}");
}
