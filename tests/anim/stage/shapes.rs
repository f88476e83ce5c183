//! Shape keys of roles: their weights follow the takes as bones do.

use super::actors::{at, bits, fox, planned, seconds};
use dragonfly_anim::data::{
    AnimationData, Bone, Influence, Interpolation, Mesh, MeshInstance, ModelData, MorphTarget, MorphTrack,
    Primitive, Skeleton, Skin, Take, Track, Vertices,
};
use dragonfly_anim::sample::sample_morph_weights;
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan};
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Vec3};
use std::fmt::Write;
use std::sync::Arc;

/// Weights where nothing animates them: of `Smile` and `Fist` of the body, and of `Blink` of the eyes.
const REST: [f32; 3] = [0.25, 0.0, 0.5];

fn mesh(name: &str, targets: &[(&str, &[f32])], joints: &[u16]) -> Mesh {
    let target = |&(name, moved): &(&str, &[f32])| MorphTarget {
        name: name.to_owned(),
        positions: moved.iter().map(|&length| Vec3::Y * length).collect(),
        ..MorphTarget::default()
    };
    let influence = |&joint: &u16| {
        let none = Influence::default();
        [Influence { joint, weight: 1.0 }, none, none, none]
    };
    let vertices = Vertices {
        positions: vec![Vec3::ZERO; 3],
        influences: joints.iter().flat_map(influence).collect(),
        influences_per_vertex: if joints.is_empty() { 0 } else { 4 },
        ..Vertices::default()
    };
    let morph_targets = targets.iter().map(target).collect();
    let primitive = Primitive { vertices, indices: vec![0, 1, 2], morph_targets, ..Primitive::default() };
    Mesh { name: name.to_owned(), primitives: vec![primitive], morph_weights: vec![0.0; targets.len()] }
}

fn track(instance: u32, interpolation: Interpolation, times: &[f32], weights: &[f32]) -> MorphTrack {
    let targets = (weights.len() / times.len()) as u32;
    MorphTrack { instance, targets, times: times.into(), weights: weights.into(), interpolation }
}

/// Returns a figure of hips, head and arm. A body with a skin has the shape keys `Smile`, which moves the head and a little of the hips, and `Fist`,
/// which moves the arm; eyes that the head carries have `Blink`. `Talk`, whose first key is at 1 s, animates both meshes over 2 s, `Shout` the body
/// alone, `Snap` in steps, `Still` nothing.
pub(super) fn face() -> Arc<StageModel> {
    let child = |name: &str| Bone { parent: Some(0), ..Bone::root(name) };
    let skeleton = Skeleton { bones: vec![Bone::root("hips"), child("Head"), child("Arm")] };
    let linear = Interpolation::Linear;
    let take = |name: &str, start: f32, morphs: Vec<MorphTrack>| {
        let tracks = (0..3).map(|bone| Track { bone, ..Track::default() }).collect();
        Arc::new(Take { name: name.to_owned(), start, length: 2.0, tracks, morphs, ..Take::default() })
    };
    let talk = vec![
        track(0, linear, &[1.0, 2.0, 3.0], &[0.0, 1.0, 1.0, 0.0, 0.5, 0.5]),
        track(1, linear, &[1.0, 3.0], &[0.0, 1.0]),
    ];
    let shout = vec![track(0, linear, &[0.0, 2.0], &[1.0, 0.75, 1.0, 0.75])];
    let snap = vec![track(0, Interpolation::Step, &[0.0, 1.0, 2.0], &[0.0, 0.0, 1.0, 1.0, 0.0, 0.0])];
    let takes = vec![
        take("Talk", 1.0, talk),
        take("Shout", 0.0, shout),
        take("Snap", 0.0, snap),
        take("Still", 0.0, vec![]),
    ];
    let meshes = vec![
        mesh("Body", &[("Smile", &[1.0, 0.0, 0.2]), ("Fist", &[0.0, 1.0, 0.0])], &[1, 2, 0]),
        mesh("Eyes", &[("Blink", &[1.0, 1.0, 1.0])], &[]),
    ];
    let instance = |mesh: u32, skin: Option<u32>, bone: Option<u32>, weights: &[f32]| MeshInstance {
        mesh,
        node: None,
        skin,
        bone,
        to_bone: Mat4::IDENTITY,
        morph_weights: weights.to_vec(),
    };
    let skin = Skin { name: String::new(), bones: vec![0, 1, 2], offsets: vec![Mat4::IDENTITY; 3] };
    Arc::new(StageModel::new(Arc::new(ModelData {
        meshes,
        instances: vec![instance(0, Some(0), None, &REST[..2]), instance(1, None, Some(1), &REST[2..])],
        skins: vec![skin],
        animation: AnimationData { skeleton: Arc::new(skeleton), takes },
        ..ModelData::default()
    })))
}

/// Plans actions of two roles with the same model.
fn faces(actions: &str) -> StagePlan {
    let mut assets = StageAssets::default();
    assets.add_model("face.glb", face());
    let roles = ["anna", "ben"].map(|id| format!("<role id=\"{id}\" model=\"face.glb\"/>")).concat();
    planned(&format!("<script version=\"1\"><cast>{roles}</cast>{actions}</script>"), &assets)
}

fn weights(plan: &StagePlan, role: usize, time: f64) -> Vec<f32> {
    at(plan, time).things[role].pose.as_ref().unwrap().shapes.clone()
}

/// Checks the weights of `Smile`, `Fist` and `Blink` of anna.
fn check(plan: &StagePlan, time: f64, expected: [f32; 3]) {
    let found = weights(plan, 0, time);
    let is_near = found.len() == 3 && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(is_near, "{time} s: {found:?} instead of {expected:?}");
}

/// Returns the weights of a take at a time of its keys, by the sampling of a single model.
fn alone(model: &StageModel, take: &str, time: f32) -> Vec<f32> {
    let take = &model.data().animation.takes[model.take_called(take).unwrap()];
    let mut out = vec![0.0; 3];
    sample_morph_weights(Some(take), 0, &REST[..2], time, &mut out[..2]);
    sample_morph_weights(Some(take), 1, &REST[2..], time, &mut out[2..]);
    out
}

#[test]
fn without_a_take_the_weights_are_those_of_the_model() {
    let plan = faces("<play who=\"ben\" take=\"Shout\"/>");
    check(&plan, 1.0, REST);
    assert_eq!(weights(&plan, 1, 1.0), [1.0, 0.75, 0.5], "the other role has its own");
    let mut assets = StageAssets::default();
    assets.add_model("a.glb", fox());
    let text = "<script version=\"1\"><cast><role id=\"a\" model=\"a.glb\"/></cast></script>";
    assert_eq!(weights(&planned(text, &assets), 0, 0.0), [0.0; 0], "a fox has no shape keys");
}

#[test]
fn a_take_has_the_weights_of_the_model_alone_bit_for_bit() {
    let model = face();
    for take in ["Talk", "Shout", "Snap", "Still"] {
        let plan = faces(&format!("<play who=\"anna\" take=\"{take}\"/>"));
        let start = model.data().animation.takes[model.take_called(take).unwrap()].start;
        for step in 0..=64 {
            // Exact in binary and in ticks.
            let time = f64::from(step) / 32.0;
            let (found, expected) = (weights(&plan, 0, time), alone(&model, take, start + time as f32));
            assert_eq!(found, expected, "{take} at {time} s");
        }
    }
}

#[test]
fn parts_speeds_and_repetitions_of_a_take_are_those_of_its_poses() {
    let plan = faces("<play who=\"anna\" take=\"Talk\" from=\"0.5\" to=\"1.5\" speed=\"0.5\" repeat=\"2\"/>");
    // From 0.5 s to 1.5 s of the take in 2 s, twice; then it holds.
    check(&plan, 0.0, [0.5, 0.5, 0.25]);
    check(&plan, 1.0, [1.0, 0.0, 0.5]);
    check(&plan, 1.5, [0.875, 0.125, 0.625]);
    check(&plan, 3.0, [1.0, 0.0, 0.5]);
    check(&plan, 9.0, [0.75, 0.25, 0.75]);
    let plan = faces("<play who=\"anna\" take=\"Talk\" speed=\"-2\" fill=\"release\"/>");
    check(&plan, 0.25, [0.75, 0.25, 0.75]);
    check(&plan, 1.0, REST);
    let plan = faces("<par dur=\"7\"><play who=\"anna\" take=\"Talk\" repeat=\"fill\"/></par>");
    check(&plan, 5.0, [1.0, 0.0, 0.5]);
}

#[test]
fn a_fade_mixes_the_weights() {
    let plan = faces(
        "<play who=\"anna\" take=\"Talk\"/><play who=\"anna\" take=\"Shout\" begin=\"1\" fade-in=\"1\"/>",
    );
    // The share x²(3 - 2x) of the second take is 0.15625 at a quarter of the fade and a half at its middle; Shout does not animate Blink.
    let [talk, shout, share] = [[0.875, 0.125, 0.625], [1.0, 0.75, 0.5], [0.156_25; 3]];
    check(&plan, 1.25, std::array::from_fn(|at| talk[at] + (shout[at] - talk[at]) * share[at]));
    check(&plan, 1.5, [0.5 * (0.75 + 1.0), 0.5 * (0.25 + 0.75), 0.5 * (0.75 + 0.5)]);
    check(&plan, 2.0, [1.0, 0.75, 0.5]);
    // A take that fades in over nothing is mixed with the weights of the model.
    let plan = faces("<play who=\"anna\" take=\"Shout\" fade-in=\"2\"/>");
    check(&plan, 1.0, [0.625, 0.375, 0.5]);
}

#[test]
fn a_layer_with_bones_moves_the_shape_keys_that_belong_to_them() {
    let talk = "<play who=\"anna\" take=\"Talk\"/>";
    let layer =
        |bones: &str| faces(&format!("{talk}<play who=\"anna\" take=\"Shout\" {bones} begin=\"0\"/>"));
    // Most of what Smile moves is the head's.
    check(&layer("bones=\"Head\""), 1.0, [1.0, 0.0, 0.5]);
    check(&layer("bones=\"Head\""), 0.5, [1.0, 0.5, 0.5]);
    check(&layer("bones=\"Arm\""), 0.5, [0.5, 0.75, 0.25]);
    // The head is below the hips, and so are all shape keys; a layer without bones moves everything.
    check(&layer("bones=\"hips\" weight=\"0.5\""), 0.5, [0.75, 0.625, 0.375]);
    check(&layer("layer=\"top\" weight=\"0.5\""), 0.5, [0.75, 0.625, 0.375]);
    // After its end a layer is released.
    check(&layer("bones=\"Head,Arm\" dur=\"1\""), 1.0, [1.0, 0.0, 0.5]);
    check(&layer("bones=\"Head,Arm\" dur=\"1\" fade-out=\"1\""), 0.5, [0.75, 0.625, 0.375]);
}

/// Returns random takes and layers of a role, all of which overlap.
fn random_actions(random: &mut Random, role: &str) -> String {
    let mut text = String::new();
    for _ in 0..6 {
        let take = random.choice(&["Talk", "Shout", "Snap", "Still"]);
        let part =
            random.choice(&["", "bones=\"Head\"", "bones=\"Arm,Head\"", "layer=\"l\"", "repeat=\"2.5\""]);
        let fill = random.choice(&["", "fill=\"hold\"", "fill=\"release\"", "fade-out=\"0.5\""]);
        let [begin, fade, weight] = [2.0, 1.0, 1.0].map(|most| random.between(0.0, most));
        let speed = random.choice(&["1", "-1", "0.7"]);
        let _ = write!(
            text,
            "<play who=\"{role}\" take=\"{take}\" {part} {fill} speed=\"{speed}\" begin=\"{begin:.3}\" fade-in=\"{fade:.3}\"{}/>",
            if part.is_empty() { String::new() } else { format!(" weight=\"{weight:.3}\"") },
        );
    }
    text
}

#[test]
fn weights_have_the_same_bits_in_any_order_on_any_thread_and_stay_between_those_of_the_takes() {
    let first = seed(11);
    println!("seed {first}");
    let mut random = Random::new(first);
    for _ in 0..40 {
        let actions = ["anna", "ben"].map(|role| random_actions(&mut random, role)).concat();
        let plan = faces(&actions);
        let mut scene = plan.new_scene();
        let times: Vec<f64> = (0..120).map(|step| f64::from(step) / 24.0).collect();
        let forward: Vec<Vec<u32>> = times
            .iter()
            .map(|&time| {
                plan.scene_at(seconds(time), &mut scene);
                for pose in scene.things.iter().filter_map(|thing| thing.pose.as_ref()) {
                    // All weights of all takes are from 0 to 1.
                    let inside = pose.shapes.iter().all(|weight| (-1e-6..=1.0 + 1e-6).contains(weight));
                    assert!(inside && pose.shapes.len() == 3, "{time} s: {:?}\n{actions}", pose.shapes);
                }
                bits(&scene)
            })
            .collect();
        std::thread::scope(|scope| {
            let (plan, times, forward) = (&plan, &times, &forward);
            scope.spawn(move || {
                let mut scene = plan.new_scene();
                for (time, forward) in times.iter().zip(forward).rev() {
                    plan.scene_at(seconds(*time), &mut scene);
                    assert_eq!(&bits(&scene), forward, "{time} s");
                }
            });
        });
        let (asked, ()) = count(|| {
            for _ in 0..60 {
                plan.scene_at(seconds(times[random.below(times.len())]), &mut scene);
            }
        });
        assert_eq!(asked.allocations, 0);
    }
}

#[test]
fn a_scene_of_a_model_with_other_shape_keys_is_replaced() {
    let plan = faces("<play who=\"anna\" take=\"Shout\"/>");
    let mut data = ModelData::clone(face().data());
    data.instances.truncate(1);
    let mut assets = StageAssets::default();
    assets.add_model("face.glb", Arc::new(StageModel::new(Arc::new(data))));
    let roles = ["anna", "ben"].map(|id| format!("<role id=\"{id}\" model=\"face.glb\"/>")).concat();
    let other = planned(&format!("<script version=\"1\"><cast>{roles}</cast></script>"), &assets);
    let mut scene = other.new_scene();
    plan.scene_at(seconds(1.0), &mut scene);
    assert_eq!(scene.things[0].pose.as_ref().unwrap().shapes, [1.0, 0.75, 0.5]);
}
