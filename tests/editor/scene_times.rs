//! Times on the command line are exact: what begins at 2.3 s has begun at `--time 2.3`, for `pose` and `render` alike, and bones are where a
//! calculation by hand puts them.

use crate::program::run;
use dragonfly_kit::folder::Folder;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// A mast that rises two meters a second for four seconds, with a flag a meter in front of it.
const MAST: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"mast","children":[1]},{"name":"flag","translation":[0,0,1]}],
"buffers":[{"byteLength":56,"uri":"mast.bin"}],
"bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":24},
{"buffer":0,"byteOffset":32,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[4]},
{"bufferView":1,"componentType":5126,"count":2,"type":"VEC3"},
{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],
"animations":[{"name":"Rise","samplers":[{"input":0,"output":1},{"input":0,"output":2}],
"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},
{"sampler":1,"target":{"node":1,"path":"translation"}}]}]}"#;

/// None of these times is a number of single precision.
const SCENE: &str = r#"<script version="1" fps="30">
  <cast>
    <role id="ship" model="mast.gltf" at="1 0 2" facing="90" scale="0.5"/>
    <prop id="box" model="box.glb" at="0 0 -50"/>
    <camera id="wide" at="0 1 6" look="0 0.5 0"/>
  </cast>
  <play who="ship" take="Rise" begin="0.3"/>
  <place who="box" at="0 0 0" begin="2.3"/>
  <place who="box" at="0 0 -50" begin="2.71"/>
</script>
"#;

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn scene(name: &str) -> (Folder, PathBuf) {
    let folder = Folder::new(name);
    let times = [0.0_f32, 4.0];
    let places = [0.0_f32, 0.0, 0.0, 0.0, 8.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    let bytes: Vec<u8> = times.iter().chain(&places).flat_map(|number| number.to_le_bytes()).collect();
    let box_model = dragonfly_kit::folder::data("gltf/box_sparse.glb");
    for (file, bytes) in [
        ("mast.gltf", MAST.as_bytes().to_vec()),
        ("mast.bin", bytes),
        ("box.glb", fs::read(box_model).expect("a model")),
        ("scene.xml", SCENE.as_bytes().to_vec()),
        ("scene.meproj", b"<project version=\"1\"><script id=\"a\" src=\"scene.xml\"/></project>".to_vec()),
    ] {
        fs::write(folder.join(file), bytes).expect("a file");
    }
    let path = folder.join("scene.xml");
    (folder, path)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number")).collect()
}

/// Returns the height in depth of the box at a time, meters: 0 while it is in sight.
fn depth(path: &Path, time: &str) -> f64 {
    let poses = run(["pose", text(path), "--role", "box", "--time", time, "--json"]).expect(0).json();
    numbers(&poses["poses"][0]["translation"])[2]
}

#[test]
fn what_begins_at_a_time_has_begun_at_this_time_however_it_is_written() {
    let (_folder, path) = scene("times-exact");
    for time in ["2.3", "2.3s", "2300ms", "69f", "0:02.3", "2.300000001"] {
        assert_eq!(depth(&path, time), 0.0, "{time}");
    }
    for time in ["2.299999999", "68f", "0:02.299", "1e-3"] {
        assert_eq!(depth(&path, time), -50.0, "{time}");
    }
    assert_eq!((depth(&path, "2.709999999"), depth(&path, "2.71")), (0.0, -50.0));
    let poses = run(["pose", text(&path), "--role", "box", "--time", "2.3", "--json"]).expect(0).json();
    assert_eq!(poses["poses"][0]["time"], 2.3);
}

#[test]
fn bones_of_a_scene_are_at_computed_places() {
    let (_folder, path) = scene("times-bones");
    let project = path.with_extension("meproj");
    // The take began 2 s before, in which the mast rises 4 m; half as large, from (1 0 2). The flag is a meter ahead, which is along +x.
    for (time, height) in [("2.3", 2.0), ("0.8", 0.5), ("24f", 0.5), ("9", 4.0)] {
        for path in [&path, &project] {
            let poses =
                run(["pose", text(path), "--role", "ship", "--time", time, "--json"]).expect(0).json();
            let bones = poses["poses"][0]["bones"].as_array().expect("bones");
            for (name, wanted) in [("mast", [1.0, height, 2.0]), ("flag", [1.5, height, 2.0])] {
                let bone = bones.iter().find(|bone| bone["name"] == name).expect(name);
                let place = &numbers(&bone["to_scene"])[12..15];
                let is_near = place.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-5);
                assert!(is_near, "{name} at {time} is at {place:?}, not at {wanted:?}");
            }
        }
    }
}

#[test]
fn an_image_and_a_pose_of_the_same_time_are_the_same_moment() {
    let (folder, path) = scene("times-images");
    let image = |path: &Path, order: [&str; 2], name: &str| {
        let out = folder.join(&format!("{name}.png"));
        let all = ["render", text(path), order[0], order[1], "--size", "160x90", "-o", text(&out)];
        run(all).expect(0);
        let out = if order[0] == "--frames" { folder.join(&format!("{name}-0069.png")) } else { out };
        image::open(out).expect("an image").into_rgba8()
    };
    let before = image(&path, ["--time", "2.29"], "before");
    let at = image(&path, ["--time", "2.3"], "at");
    assert!(at != before, "the box is there");
    assert!(image(&path, ["--frames", "69..69"], "frame") == at);
    assert!(image(&path, ["--time", "69f"], "frames") == at);
    assert!(image(&path.with_extension("meproj"), ["--time", "0:02.3"], "project") == at);
    // Between two frames, and just before a frame.
    assert!(image(&path, ["--time", "2.71"], "gone") == image(&path, ["--time", "2.72"], "later"));
    assert!(image(&path, ["--time", "2.299999999"], "tick") == before);
}

#[test]
fn a_time_that_is_none_and_frames_of_a_model_are_refused_with_what_to_write() {
    let (_folder, path) = scene("times-refused");
    for wrong in ["soon", "2:5", "1:75", "nan", "2.3m"] {
        let refused = run(["pose", text(&path), "--role", "box", "--time", wrong]).expect(2);
        assert!(refused.stderr.contains("--time"), "{}", refused.stderr);
    }
    let model = path.with_file_name("mast.gltf");
    for command in [&["pose"][..], &["explain", "--bone", "flag"], &["render", "-o", "-"]] {
        let all = [&command[..1], &[text(&model), "--time", "36f"], &command[1..]].concat();
        let refused = run(all).expect(2);
        assert!(refused.stderr.contains("frames are times of scenes"), "{}", refused.stderr);
    }
    // A model has the same units, apart from frames.
    let pose = |time: &str| run(["pose", text(&model), "--time", time, "--json"]).expect(0).json();
    assert_eq!(pose("1500ms")["poses"], pose("1.5")["poses"]);
    assert_eq!(pose("0:01.5")["poses"], pose("1.5")["poses"]);
}
