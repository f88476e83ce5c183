//! Blends two takes: a walk that changes to a run in step, while the figure looks around.
//!
//! `cargo run -p dragonfly-anim --example blend_two`

use dragonfly_anim::animation::to_root;
use dragonfly_anim::blend::{CrossFade, Cycle, FadeCurve, Layer, Mask, blend};
use dragonfly_anim::data::{AnimationData, Take, Transform};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::sample::sample_take;
use glam::Mat4;
use std::error::Error;

const FOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/gltf/Fox.glb");

fn take<'a>(data: &'a AnimationData, name: &str) -> Result<&'a Take, String> {
    let found = data.takes.iter().find(|take| take.name == name);
    found.map(AsRef::as_ref).ok_or_else(|| format!("no take is called {name}"))
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let data = read("Fox.glb", &std::fs::read(FOX)?, &NoFiles, &ReadOptions::default())?.model.animation;
    let (skeleton, bones) = (&*data.skeleton, data.skeleton.len());
    let (walk, run, survey) = (take(&data, "Walk")?, take(&data, "Run")?, take(&data, "Survey")?);
    let neck = skeleton.find("b_Neck_04").ok_or("the fox has no neck")?;
    // The neck has the weight 0.5, the head 1.
    let head = Mask::of_branch(skeleton, neck).feathered(skeleton, 1);
    let body = head.clone().inverted();

    let mut poses = [(); 5].map(|()| vec![Transform::IDENTITY; bones]);
    let [rest, walking, running, looking, blended] = &mut poses;
    sample_take(None, skeleton, 0.0, rest);
    let mut matrices = vec![Mat4::IDENTITY; bones];
    let mut fade = CrossFade::new(Cycle::of(walk), Cycle::of(run), 0.3, FadeCurve::SmoothStep);
    for frame in 0..30 {
        let now = fade.advance(1.0 / 60.0);
        sample_take(Some(walk), skeleton, now.from_time, walking);
        sample_take(Some(run), skeleton, now.to_time, running);
        sample_take(Some(survey), skeleton, frame as f32 / 60.0, looking);
        let legs = [Layer::new(walking, 1.0 - now.weight), Layer::new(running, now.weight)];
        let layers = [legs[0].masked(&body), legs[1].masked(&body), Layer::new(looking, 1.0).masked(&head)];
        blend(rest, &layers, blended);
        to_root(skeleton, blended, &mut matrices);
        let nose = matrices[neck as usize + 1].w_axis.truncate();
        println!(
            "walk {:.3} s, run {:.3} s, {:.2}: head at {nose:.2}",
            now.from_time, now.to_time, now.weight
        );
    }
    Ok(())
}
