//! Plays a take: from a file and a clock to matrices for the GPU, frame by frame.
//!
//! `cargo run -p dragonfly-anim --example play_a_take [FILE.glb]`

use dragonfly_anim::animation::Animation;
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::sample::PlayMode;
use std::error::Error;

const FOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/gltf/Fox.glb");

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    // The library opens no file: the caller passes the bytes.
    let file = std::env::args().skip(1).find(|argument| argument.ends_with(".glb"));
    let bytes = std::fs::read(file.as_deref().unwrap_or(FOX))?;
    let model = read("model.glb", &bytes, &NoFiles, &ReadOptions::default())?.model;

    let mut animation = Animation::of(&model);
    let take = model.animation.takes.last().ok_or("the file has no take")?.clone();
    let number = model.animation.takes.len() - 1;
    println!("{:?}: {:.3} s, {} bones", take.name, take.length, model.animation.skeleton.len());

    for frame in 0..30 {
        // The clock runs on; the take is repeated.
        let time = PlayMode::Loop.map(&take, frame as f32 / 20.0);
        animation.to_root_bone_poses(Some(number), time);
        for skin in &model.skins {
            // One matrix per joint, ready for a uniform buffer.
            let finals = animation.skin_poses(skin);
            assert!(finals.iter().all(|matrix| matrix.is_finite()));
        }
        let head = model.animation.skeleton.len() / 2;
        println!("{time:.3} s: bone {head} at {:.2}", animation.to_root()[head].w_axis.truncate());
    }
    Ok(())
}
