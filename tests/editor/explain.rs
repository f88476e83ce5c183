//! What `dragonfly explain` promises: the same numbers as `pose`, with the way to them.

use crate::program::{data, run};
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
fn a_bone_is_explained_up_to_the_very_matrix_that_pose_gives() {
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
fn a_vertex_is_explained_up_to_the_very_position_that_pose_gives() {
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

#[test]
fn people_get_formulas_and_sections() {
    let outcome = run(["explain", &fox(), "--time", "0.35", "--bone", "3"]).expect(0);
    for word in ["Fox.glb", "§2.1.5.2", "§2.1.5.1", "to_parent", "to_root", "final", "before", "mix"] {
        assert!(outcome.text().contains(word), "{word} is missing in\n{}", outcome.text());
    }
    assert_eq!(outcome.stderr, "");
    run(["explain", "demo:", "--time", "0.4", "--vertex", "12"]).expect(0);
}

#[test]
fn what_cannot_be_explained_is_code_2_and_says_what() {
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
