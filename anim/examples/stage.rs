//! Plays a script with two foxes, frame by frame and backward, and shows what it says about a mistake.
//!
//! `cargo run -p dragonfly-anim --example stage`

use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::stage::{LiveStage, StageAssets, StageModel};
use std::path::Path;
use std::sync::Arc;

const SCRIPT: &str = include_str!("stage.xml");

pub(crate) fn main() {
    // A model is prepared once; scripts name it.
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/gltf/Fox.glb");
    let bytes = std::fs::read(file).expect("a file");
    let model = read("Fox.glb", &bytes, &NoFiles, &ReadOptions::default()).expect("a model").model;
    let mut assets = StageAssets::default();
    assets.add_model("Fox.glb", Arc::new(StageModel::new(Arc::new(model))));

    let mut stage = LiveStage::default();
    assert!(stage.update(SCRIPT, &assets), "{:?}", stage.errors());
    let (script, plan) =
        (Arc::clone(stage.script().expect("a script")), Arc::clone(stage.plan().expect("a plan")));

    println!("begin    end      action");
    for (action, times) in plan.schedule().times().iter().enumerate().skip(1) {
        let element = script.element(action);
        let who = element.value("who").unwrap_or_default();
        println!("{:7.3}  {:7.3}  <{}> {who}", times.begin.seconds(), times.end.seconds(), element.row.name);
    }

    // Any frame can be asked for first: here the last one.
    let frames = (plan.length().seconds() * script.rate().per_second()) as i64;
    let mut scene = plan.new_scene();
    println!("frame   ann                    ben                    camera");
    for frame in (0..=frames).rev().step_by(48) {
        plan.frame(frame, &mut scene);
        let [ann, ben] = ["ann", "ben"].map(|id| {
            let thing = plan.thing_called(id).expect("a thing of the script");
            format!("{:.2}", scene.things[thing].transform.translation)
        });
        let camera = scene.camera.map_or("", |camera| &plan.things()[camera.thing].id);
        println!("{frame:5}   {ann:22} {ben:22} {camera}");
    }

    // The last plan stays while the text is wrong.
    assert!(!stage.update(SCRIPT.replace("\"Survey\"", "\"Survay\""), &assets));
    println!("{}", stage.errors()[0].in_file("stage.xml"));
    assert!(stage.plan().is_some());
}
