//! Makes levels of detail of a fox and chooses one by distance: `cargo run -p dragonfly-anim --example levels`.

use dragonfly_anim::bounds::BoneBoxes;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::level::{LevelSettings, Screen, choose_level, levels, radius_in_pixels};
use glam::Vec3;
use std::sync::Arc;

const FOX: &[u8] = include_bytes!("../../tests/data/gltf/Fox.glb");

pub(crate) fn main() {
    let model = read("Fox.glb", FOX, &NoFiles, &ReadOptions::default()).expect("a valid file").model;

    // Once per model: other indices for the same vertices, and the error of each level in the poses of the takes.
    let chain = levels(&model, &LevelSettings::default());
    for (number, level) in chain.iter().enumerate() {
        println!("level {number}: {} triangles, {:.2} units off at most", level.triangles, level.error);
    }

    let model = Arc::new(model);
    let boxes = BoneBoxes::of(&model);
    let mut evaluator = Evaluator::new(model);

    // The camera moves away; one pixel of error is allowed, and a third less before a coarser level is chosen.
    let mut shown = None;
    for step in 0..8 {
        evaluator.pose(Some(1), step as f32 * 0.1);
        let sphere = boxes.bounds(&evaluator).sphere;
        let eye = sphere.center + Vec3::Z * 150.0 * 2.0_f32.powi(step);
        let screen = Screen { eye, vertical_fov: 0.8, height: 1080.0 };
        let level = choose_level(&chain, &screen, &sphere, 1.0, 0.33, shown);
        shown = Some(level);
        let pixels = radius_in_pixels(&screen, &sphere);
        println!("{pixels:6.0} pixels in radius: level {level}, {} triangles", chain[level].triangles);
    }
}
