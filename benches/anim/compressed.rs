//! What a compressed take costs: bytes, error, time to make, time to sample.

use dragonfly_anim::compressed::{CompressionSettings, Exactness, compress};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::fast::Pose;
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_kit::bench::measure;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// Poses of one measured call.
const POSES: usize = 100;

/// The rig of the bench where it is there, and the fox.
pub(crate) fn run() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let millimetre = [("0.1mm", Exactness::FINE), ("1mm", Exactness::COARSE)];
    let hundredth = [("fine", Exactness { tolerance: 0.01, shell: 3.0 })];
    model("pab", &root.join("../shared/assets/bench/pab.glb"), &millimetre);
    model("fox", &root.join("tests/data/gltf/Fox.glb"), &hundredth);
}

fn model(name: &str, path: &Path, settings: &[(&str, Exactness)]) {
    let Ok(bytes) = std::fs::read(path) else { return };
    let Ok(imported) = read("model.glb", &bytes, &NoFiles, &ReadOptions::default()) else { return };
    for (setting, exactness) in settings {
        takes(&format!("anim/compressed/{name}_{setting}"), &imported.model, *exactness);
    }
}

fn takes(name: &str, model: &ModelData, everywhere: Exactness) {
    let skeleton = &model.animation.skeleton;
    let settings = CompressionSettings { everywhere, ..CompressionSettings::default() };
    for take in &model.animation.takes {
        let name = format!("{name}_{}", take.name);
        let begin = Instant::now();
        let Ok((compressed, report)) = compress(take, skeleton, &settings) else { continue };
        println!(
            "{name:<48} {} bytes of {} ({:.1} to 1), {} in memory, error {:.3e}, made in {:.1} ms",
            report.bytes.total(),
            report.raw_bytes,
            report.raw_bytes as f64 / report.bytes.total() as f64,
            compressed.bytes_in_memory(),
            report.largest_error.distance,
            begin.elapsed().as_secs_f64() * 1e3,
        );
        let mut pose = Pose::new(compressed.bones());
        let length = compressed.length();
        let forward: Vec<f32> = (0..POSES).map(|step| step as f32 / 60.0 % length).collect();
        let mut random = forward.clone();
        let mut state = 1_u32;
        for time in &mut random {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *time = state as f32 / u32::MAX as f32 * length;
        }
        for (order, times) in [("forward", &forward), ("random", &random)] {
            measure(&format!("{name}/{order}_{POSES}_poses"), 1, || {
                times.iter().for_each(|&time| compressed.sample(time, black_box(&mut pose)));
            });
        }
    }
}
