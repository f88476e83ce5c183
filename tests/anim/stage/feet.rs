//! Feet on a path: they are still while they are on the ground.

use super::actors::{at, bone, fox, planned, rogue, seconds, thing};
use dragonfly_anim::stage::{StageAssets, StageModel};
use std::sync::Arc;

/// The slide of the feet of a role that walks along a bent path at the stride of its take.
struct PathSlide {
    /// Largest distance of a foot in contact from where it was at the start of the contact, meters.
    farthest: f32,
    /// Largest distance of the knee of a held leg per frame at 120 frames per second, meters: a pop.
    jump: f32,
    contacts: usize,
}

fn slide(model: &Arc<StageModel>, scale: f64, take: &str, attributes: &str, turn: f64) -> PathSlide {
    let mut assets = StageAssets::default();
    assets.add_model("a.glb", Arc::clone(model));
    let text = format!(
        "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"{scale}\"/>\
         <path id=\"bend\" points=\"0 0 0  3 0 0  5 0 {turn}  8 0 {turn}\" curve=\"smooth\"/></cast>\
         <move who=\"anna\" path=\"bend\" take=\"{take}\" {attributes}/></script>"
    );
    let plan = planned(&text, &assets);
    let walk = &model.takes()[model.take_called(take).unwrap()];
    let (cycle, end) = (walk.length().seconds(), plan.length().seconds());
    let mut found = PathSlide { farthest: 0.0, jump: 0.0, contacts: 0 };
    let mut scene = plan.new_scene();
    for contact in walk.contacts() {
        let foot = model.feet()[contact.foot].bone;
        let mut start = contact.from.seconds();
        let length = contact.to.seconds() - start;
        while start + length <= end {
            plan.scene_at(seconds(start + 1e-6), &mut scene);
            let first = bone(&plan, &scene, "anna", foot);
            for step in 0..=20 {
                plan.scene_at(seconds(start + 1e-6 + (length - 2e-6) * f64::from(step) / 20.0), &mut scene);
                let now = bone(&plan, &scene, "anna", foot);
                found.farthest = found.farthest.max((now - first).length());
            }
            found.contacts += 1;
            start += cycle;
        }
    }
    let knees: Vec<u32> =
        model.feet().iter().filter_map(|foot| model.skeleton().bones[foot.bone as usize].parent).collect();
    for &knee in &knees {
        let (mut before, steps) = (bone(&plan, &at(&plan, 0.0), "anna", knee), (end * 120.0) as usize);
        for step in 1..steps {
            plan.scene_at(seconds(step as f64 / 120.0), &mut scene);
            let now = bone(&plan, &scene, "anna", knee);
            found.jump = found.jump.max(now.distance(before));
            before = now;
        }
    }
    assert!(thing(&plan, &scene, "anna").transform.is_finite());
    found
}

#[test]
fn feet_of_a_human_in_contact_slide_less_than_five_millimeters_on_a_bent_path() {
    let Some(model) = rogue() else { return };
    let mut measured = 0;
    let walks = |name: &str| name.starts_with("Walking") || name.starts_with("Running");
    for take in model.takes().iter().filter(|take| walks(take.name())) {
        let name = take.name();
        let (kept, free) =
            (slide(&model, 1.0, name, "", 1.0), slide(&model, 1.0, name, "feet=\"free\"", 1.0));
        println!(
            "{name}: stride {:.3} m/s, {} contacts, kept {:.2} mm, free {:.1} mm, knees {:.1} and {:.1} mm a frame",
            take.stride_speed().unwrap(),
            kept.contacts,
            1000.0 * kept.farthest,
            1000.0 * free.farthest,
            1000.0 * kept.jump,
            1000.0 * free.jump,
        );
        {
            assert!(kept.farthest < 0.005 && kept.contacts > 4, "{name}: {:.1} mm", 1000.0 * kept.farthest);
            assert!(kept.jump < 1.5 * free.jump, "{name}");
            measured += 1;
        }
    }
    assert!(measured >= 3);
}

#[test]
fn paws_of_a_fox_slide_less_than_five_millimeters() {
    let model = fox();
    for take in ["Walk", "Run"] {
        let (kept, free) =
            (slide(&model, 0.01, take, "", 1.0), slide(&model, 0.01, take, "feet=\"free\"", 1.0));
        println!(
            "{take}: {} contacts, kept {:.2} mm, free {:.1} mm, knees {:.1} and {:.1} mm a frame",
            kept.contacts,
            1000.0 * kept.farthest,
            1000.0 * free.farthest,
            1000.0 * kept.jump,
            1000.0 * free.jump
        );
        assert!(kept.farthest < 0.005 && kept.contacts > 4, "{take}");
    }
}
