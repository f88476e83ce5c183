//! Prints every number in the computation of a bone's pose, with its formula.
//!
//! ```text
//! cargo run -p dragonfly-anim --example explain_a_bone -- [FILE.glb [BONE [SECONDS]]]
//! ```

use dragonfly_anim::explain::{ExplainTarget, Subject, explain};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use std::error::Error;

pub(crate) const FOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/gltf/Fox.glb");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or_else(|| FOX.to_owned());
    let name = arguments.next().unwrap_or_else(|| "b_Head_05".to_owned());
    show(&file, &name, arguments.next().unwrap_or_else(|| "0.35".to_owned()).parse()?)
}

pub(crate) fn show(file: &str, name: &str, time: f32) -> Result<(), Box<dyn Error>> {
    let model = read(file, &std::fs::read(file)?, &NoFiles, &ReadOptions::default())?.model;
    let bone = model.animation.skeleton.find(name).ok_or("no bone has that name")?;
    let take = if model.animation.takes.is_empty() { None } else { Some(0) };

    let explanation = explain(&model, take, time, ExplainTarget::Bone(bone))?;
    println!("{explanation}");

    // The same steps are also data, so that the text need not be parsed.
    for step in &explanation.bones {
        let keys = step.rotation.keys.as_ref();
        let mix = keys.map_or_else(|| "no keys".to_owned(), |keys| format!("mix {}", keys.mix));
        println!("{:>24}  rotation {mix}", step.name);
    }
    if let Subject::Bone(result) = explanation.subject {
        println!("final pose {}", result.final_pose);
    }
    Ok(())
}
