//! `dragonfly explain` prints the same numbers as `pose`, with the steps that lead to them.

use crate::program::run;
use dragonfly_kit::folder::data;
use serde_json::Value;

fn fox() -> String {
    data("gltf/Fox.glb").display().to_string()
}

fn explained(arguments: &[&str]) -> Value {
    let file = fox();
    let all = [&["explain", &file, "--take", "Run", "--time", "0.35", "--json"], arguments].concat();
    run(all).expect(0).json()
}

fn posed() -> Value {
    run(["pose", &fox(), "--take", "Run", "--time", "0.35", "--json"]).expect(0).json()
}

#[test]
fn explaining_a_bone_ends_with_the_matrix_that_the_pose_command_prints() {
    let (explained, posed) = (explained(&["--bone", "b_Head_05"]), posed());
    let bones = explained["bones"].as_array().expect("bones");
    assert_eq!(explained["take"]["name"], "Run");
    assert!(bones[0]["parent"].is_null() && bones.len() > 4, "{bones:?}");
    for bone in bones {
        let index = bone["index"].as_u64().expect("an index") as usize;
        assert_eq!(bone["to_root"], posed["poses"][0]["bones"][index]["to_root"]);
    }
    let head = bones.last().expect("the head");
    assert_eq!(head["name"], "b_Head_05");
    let keys = &head["rotation"]["keys"];
    let time = |key: &str| keys[key]["time"].as_f64().expect("seconds");
    assert!(time("before") <= 0.35 && 0.35 <= time("after"), "{keys}");
    let mix = (0.35 - time("before")) / (time("after") - time("before"));
    assert!((keys["mix"].as_f64().expect("a number") - mix).abs() < 1e-5, "{keys}");
    assert_eq!(explained["bone"]["final"].as_array().map(Vec::len), Some(16));
}

#[test]
fn explaining_a_vertex_ends_with_the_position_that_the_pose_command_prints() {
    let (explained, posed) = (explained(&["--vertex", "9"]), posed());
    let vertex = &explained["vertex"];
    assert_eq!(vertex["final_position"], posed["poses"][0]["meshes"][0]["positions"][9]);
    let influences = vertex["influences"].as_array().expect("influences");
    for axis in 0..3 {
        let adds = |influence: &Value| influence["contribution"][axis].as_f64().expect("a number");
        let sum: f64 = influences.iter().map(adds).sum();
        let position = vertex["final_position"][axis].as_f64().expect("a number");
        assert!((sum - position).abs() < 1e-3, "{sum} is not {position}");
    }
}

/// Asserts that no number is missing: JSON has `null` for NaN and infinity, which only the listed fields may have.
fn no_missing_numbers(value: &Value, place: &str) {
    const MAY_BE_MISSING: [&str; 12] = [
        "take",
        "keys",
        "tangent",
        "parent",
        "node",
        "normal",
        "final_normal",
        "morphed_normal",
        "morph_keys",
        "skin",
        "carrier",
        "to_bone",
    ];
    match value {
        Value::Null => assert!(MAY_BE_MISSING.iter().any(|name| place.ends_with(name)), "{place} is null"),
        Value::Array(values) => values.iter().for_each(|value| no_missing_numbers(value, place)),
        Value::Object(fields) => {
            fields.iter().for_each(|(name, value)| no_missing_numbers(value, &format!("{place}.{name}")));
        }
        _ => {}
    }
}

fn names(value: &Value) -> Vec<&str> {
    let mut names: Vec<&str> = value.as_object().expect("an object").keys().map(String::as_str).collect();
    names.sort_unstable();
    names
}

#[test]
fn a_json_document_has_the_names_and_numbers_of_the_other_commands() {
    let info = run(["info", &fox(), "--json"]).expect(0).json();
    let bone = explained(&["--bone", "b_Head_05"]);
    let vertex = explained(&["--vertex", "9"]);
    for document in [&bone, &vertex] {
        no_missing_numbers(document, "");
        assert_eq!(document["file"], posed()["file"]);
        let take = &document["take"];
        for name in ["index", "name", "start", "end"] {
            assert_eq!(take[name], info["takes"][2][name], "take.{name}");
        }
        assert_eq!(document["time"].as_f64().map(|time| time as f32), Some(0.35));
        for step in document["bones"].as_array().expect("bones") {
            let index = step["index"].as_u64().expect("an index") as usize;
            for name in ["index", "name", "node", "parent"] {
                assert_eq!(step[name], info["bones"][index][name], "bone {index}: {name}");
            }
            assert_eq!(step["to_parent"].as_array().map(Vec::len), Some(16));
        }
    }
    // The fields that scripts may rely on.
    assert_eq!(names(&bone), ["bone", "bones", "file", "take", "time"]);
    assert_eq!(names(&vertex), ["bones", "file", "take", "time", "vertex"]);
    assert_eq!(names(&bone["bone"]), ["final", "index", "offset"]);
    let posed = posed();
    let told = &vertex["vertex"];
    assert_eq!(told["node"], posed["poses"][0]["meshes"][0]["node"]);
    assert_eq!(told["primitive"], posed["poses"][0]["meshes"][0]["primitive"]);
    assert_eq!(told["mesh"], info["meshes"][0]["name"]);
    let joints = info["skins"][0]["bones"].as_array().expect("joints");
    for influence in told["influences"].as_array().expect("influences") {
        let joint = influence["joint"].as_u64().expect("a joint") as usize;
        assert_eq!(influence["bone"], joints[joint]);
        assert_eq!(influence["final"], posed["poses"][0]["skins"][0]["final"][joint]);
    }
}

#[test]
fn a_model_without_takes_is_explained_at_rest_and_times_are_clamped() {
    let late =
        run(["explain", &fox(), "--take", "2", "--time", "1e9", "--bone", "3", "--json"]).expect(0).json();
    assert_eq!(late["time"], late["take"]["end"], "clamped to the take");
    let by_name = run(["explain", &fox(), "--take", "Run", "--time", "1e9", "--bone", "3", "--json"]);
    assert_eq!(by_name.expect(0).json(), late, "a name or a number");
    let first = run(["explain", &fox(), "--time", "0", "--bone", "3", "--json"]).expect(0).json();
    assert_eq!(first["take"]["index"], 0, "without --take the first");
    let demo = run(["explain", "demo:", "--time", "0.4", "--vertex", "12", "--json"]).expect(0).json();
    assert_eq!(demo["file"], run(["pose", "demo:", "--time", "0.4", "--json"]).expect(0).json()["file"]);
    no_missing_numbers(&demo, "");
}

#[test]
fn the_text_output_has_formulas_and_sections() {
    let outcome = run(["explain", &fox(), "--time", "0.35", "--bone", "3"]).expect(0);
    for word in ["Fox.glb", "§2.1.5.2", "§2.1.5.1", "to_parent", "to_root", "final", "before", "mix"] {
        assert!(outcome.text().contains(word), "{word} is missing in\n{}", outcome.text());
    }
    assert_eq!(outcome.stderr, "");
    run(["explain", "demo:", "--time", "0.4", "--vertex", "12"]).expect(0);
}

#[test]
fn a_request_that_cannot_be_explained_exits_with_2_and_gives_the_reason() {
    for (arguments, word) in [
        (vec!["--time", "0"], "--bone"),
        (vec!["--bone", "3"], "--time"),
        (vec!["--time", "0", "--bone", "3", "--vertex", "3"], "cannot be used with"),
        (vec!["--time", "0", "--bone", "nobody"], "no bone is called \"nobody\""),
        (vec!["--time", "0", "--bone", "99"], "no bone is called \"99\""),
        (vec!["--time", "0", "--vertex", "99999"], "no vertex 99999"),
        (vec!["--time", "0", "--vertex", "0", "--primitive", "7"], "no primitive 7"),
        (vec!["--time", "0", "--vertex", "0", "--instance", "7"], "no instance 7"),
    ] {
        let file = fox();
        let outcome = run(["explain", &file].into_iter().chain(arguments.iter().copied())).expect(2);
        assert!(outcome.stderr.contains(word), "{arguments:?}: {}", outcome.stderr);
        assert_eq!(outcome.text(), "", "{arguments:?}");
    }
}
