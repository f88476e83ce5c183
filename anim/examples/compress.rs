//! Compresses every take of a model and prints the results: `cargo run --example compress -- model.glb`.

use dragonfly_anim::compressed::{CompressedTake, CompressionSettings, Exactness, compress};
use dragonfly_anim::fast::Pose;
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use std::error::Error;

pub(crate) const FOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/gltf/Fox.glb");

fn main() -> Result<(), Box<dyn Error>> {
    show(&std::env::args().nth(1).unwrap_or_else(|| FOX.to_owned()))
}

pub(crate) fn show(path: &str) -> Result<(), Box<dyn Error>> {
    let model = read(path, &std::fs::read(path)?, &NoFiles, &ReadOptions::default())?.model;
    let skeleton = &model.animation.skeleton;

    // Tolerance of a thousandth of the model's size, at a tenth of it from the bones: 1 mm at 10 cm for a figure of 1 m.
    let rest = dragonfly_anim::animation::Animation::of(&model);
    let size = rest.to_root().iter().map(|bone| bone.w_axis.truncate().length()).fold(0.0, f32::max);
    let everywhere = Exactness { tolerance: size * 0.001, shell: size * 0.1 };
    let settings = CompressionSettings { everywhere, ..CompressionSettings::default() };

    for take in &model.animation.takes {
        let (compressed, report) = compress(take, skeleton, &settings)?;
        let worst = report.largest_error;
        println!(
            "{}: {} bytes of {} ({:.1} to 1), at most {} off, at {} in {} s",
            take.name,
            report.bytes.total(),
            report.raw_bytes,
            report.raw_bytes as f32 / report.bytes.total() as f32,
            worst.distance,
            skeleton.bones[worst.bone].name,
            worst.time,
        );

        // Only the bytes have to be stored.
        let stored = compressed.as_bytes().to_vec();
        let back = CompressedTake::from_bytes(stored)?;
        let mut pose = Pose::new(back.bones());
        back.sample(back.start() + back.length() / 2.0, &mut pose);
        if let Some(last) = pose.get(back.bones().saturating_sub(1)) {
            println!("  half way, the last bone is at {}", last.translation);
        }
    }
    Ok(())
}
