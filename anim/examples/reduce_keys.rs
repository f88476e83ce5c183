//! Prints the number of keys that remain after key reduction, for several tolerances.
//!
//! ```text
//! cargo run --release -p dragonfly-anim --example reduce_keys -- [FILE.glb [MILLIMETERS PER UNIT]]
//! ```

use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::reduce::{ReduceSettings, reduce};
use std::error::Error;
use std::time::Instant;

pub(crate) const FOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/gltf/Fox.glb");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or_else(|| FOX.to_owned());
    // The fox is modeled in centimeters, which are 10 mm. glTF requires meters, which are 1000 mm.
    show(&file, arguments.next().unwrap_or_else(|| "10".to_owned()).parse()?)
}

pub(crate) fn show(file: &str, millimeters_per_unit: f32) -> Result<(), Box<dyn Error>> {
    let model = read(file, &std::fs::read(file)?, &NoFiles, &ReadOptions::default())?.model;
    let skeleton = &model.animation.skeleton;
    for take in &model.animation.takes {
        println!("{}: {} keys", take.name, take.keys());
        for tolerance in [0.1, 1.0, 5.0] {
            let settings = ReduceSettings { tolerance, millimeters_per_unit, ..ReduceSettings::default() };
            let began = Instant::now();
            let reduced = reduce(take, skeleton, &settings)?;
            let took = began.elapsed();
            let Some(largest) = reduced.measurement.largest else { continue };
            println!(
                "  within {tolerance:>4} mm: {:>6} keys ({:>4.1} %), {} contacts, off by at most {:.3} mm at {} ({:.2} s); {took:.0?}",
                reduced.keys_after,
                100.0 * reduced.keys_after as f64 / reduced.keys_before.max(1) as f64,
                reduced.contacts.len(),
                largest.millimeters,
                skeleton.bones[largest.bone as usize].name,
                largest.time,
            );
        }
    }
    Ok(())
}
