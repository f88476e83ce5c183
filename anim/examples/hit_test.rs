//! Casts rays at a running fox and prints the hits: `cargo run -p dragonfly-anim --example hit_test`.

use dragonfly_anim::bounds::BoneBoxes;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::hit::{HitPose, HitSettings, HitTree, Ray};
use glam::Vec3;
use std::sync::Arc;

const FOX: &[u8] = include_bytes!("../../tests/data/gltf/Fox.glb");

pub(crate) fn main() {
    let model = read("Fox.glb", FOX, &NoFiles, &ReadOptions::default()).expect("a valid file").model;
    let model = Arc::new(model);

    // Once per model. `tree.parts()` can be stored with it, and restored by `HitTree::from_parts`.
    let tree = Arc::new(HitTree::of(&model).expect("the model is not too large"));
    let boxes = BoneBoxes::of(&model);

    // Once per scene.
    let mut evaluator = Evaluator::new(Arc::clone(&model));
    let mut pose = HitPose::new(tree);

    for frame in 0..5 {
        // Every frame: the pose, then its boxes. Allocates nothing.
        let time = frame as f32 * 0.1;
        evaluator.pose(Some(2), time);
        pose.refit(&evaluator);

        // From the side, at the middle of the fox.
        let middle = boxes.bounds(&evaluator).center();
        let ray = Ray { origin: middle + Vec3::X * 200.0, direction: Vec3::NEG_X };
        match pose.ray(&evaluator, &ray, &HitSettings::default()) {
            Some(hit) => {
                let bone = hit.bone.map_or("no bone", |bone| {
                    let bone = &model.animation.skeleton.bones[bone as usize];
                    bone.name.as_str()
                });
                println!("{time:.1} s: triangle {} at {:.1}, moved by {bone}", hit.triangle, hit.position);
            }
            None => println!("{time:.1} s: missed"),
        }

        // The point of the surface that is nearest to a point on the ground below the head.
        let paw = pose.sphere(&evaluator, Vec3::new(0.0, 0.0, 40.0), 30.0);
        println!("       nearest to the ground: {:?}", paw.map(|hit| hit.distance));
    }
}
