//! Models for scenes.

use super::{listed, read};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{NoFiles, ReadOptions, read as read_model};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan, StageScene, ThingState};
use dragonfly_kit::skip::models;
use glam::Vec3;
use std::path::Path;
use std::sync::Arc;

/// Returns the fox: takes `Survey`, `Walk` and `Run` on the spot, a length of about a hundred units.
pub(super) fn fox() -> Arc<StageModel> {
    model(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/gltf/Fox.glb"))
}

/// Returns a human figure with many takes, if there is a folder with models.
pub(super) fn rogue() -> Option<Arc<StageModel>> {
    let path = models()?.join("gltf/kaykit_Rogue.glb");
    Some(model(&path))
}

/// Returns the fox with another name for its first take.
pub(super) fn fox_with(take: &str) -> Arc<StageModel> {
    let mut model = data(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/gltf/Fox.glb"));
    Arc::make_mut(&mut model.animation.takes[0]).name = take.to_owned();
    Arc::new(StageModel::new(Arc::new(model)))
}

fn model(path: &Path) -> Arc<StageModel> {
    Arc::new(StageModel::new(Arc::new(data(path))))
}

fn data(path: &Path) -> ModelData {
    let bytes = std::fs::read(path).unwrap();
    read_model("model.glb", &bytes, &NoFiles, &ReadOptions::default()).unwrap().model
}

/// Returns assets with `model` under the names `a.glb` and `b.glb`, and a prop without bones as `s.glb`.
pub(super) fn assets(model: &Arc<StageModel>) -> StageAssets {
    let mut assets = StageAssets::default();
    assets.add_model("a.glb", Arc::clone(model));
    assets.add_model("b.glb", Arc::clone(model));
    assets.add_model("s.glb", Arc::new(StageModel::new(Arc::default())));
    assets
}

/// Plans actions for a cast of two foxes at 1/100 of their size, `anna` and `ben`, and a sword.
pub(super) fn foxes(actions: &str) -> StagePlan {
    planned(&fox_script(actions), &assets(&fox()))
}

pub(super) fn fox_script(actions: &str) -> String {
    format!(
        "<script version=\"1\" seed=\"7\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"0.01\" at=\"1 0 2\" facing=\"90\"/>\
         <role id=\"ben\" model=\"b.glb\" scale=\"0.01\" at=\"4 0 0\"/><prop id=\"sword\" model=\"s.glb\" at=\"0 2 0\"/>\
         <camera id=\"wide\" at=\"0 1 9\" look=\"0 1 0\"/><camera id=\"close\" at=\"-1 1 2\" look=\"anna\" lens=\"85mm\" focus=\"anna\" aperture=\"2.8\"/>\
         <light id=\"sun\" kind=\"sun\" strength=\"3\" color=\"#ffffff\"/><effect id=\"rain\" kind=\"particles\" rate=\"50\"/>\
         <path id=\"aisle\" points=\"0 0 0  3 0 4\"/><path id=\"bend\" points=\"0 0 0  2 0 0  3 0 1.5  5 0 2\" curve=\"smooth\"/>\
         <mark id=\"door\" at=\"5 0 3\" facing=\"180\"/></cast>\n{actions}\n</script>"
    )
}

pub(super) fn planned(text: &str, assets: &StageAssets) -> StagePlan {
    StagePlan::new(&read(text), assets).unwrap_or_else(|errors| panic!("{}", listed(&errors)))
}

pub(super) fn seconds(seconds: f64) -> StageTime {
    StageTime::from_seconds(seconds)
}

/// Returns the scene at a time in seconds.
pub(super) fn at(plan: &StagePlan, time: f64) -> StageScene {
    let mut scene = plan.new_scene();
    plan.scene_at(seconds(time), &mut scene);
    scene
}

/// Returns a thing of a scene.
pub(super) fn thing<'a>(plan: &StagePlan, scene: &'a StageScene, id: &str) -> &'a ThingState {
    &scene.things[plan.thing_called(id).unwrap()]
}

/// Returns the position of a bone in the scene.
pub(super) fn bone(plan: &StagePlan, scene: &StageScene, id: &str, bone: u32) -> Vec3 {
    let state = thing(plan, scene, id);
    let to_root = state.pose.as_ref().unwrap().to_root.get(bone as usize);
    let point = Vec3::new(to_root[3], to_root[7], to_root[11]);
    state.transform.translation + state.transform.rotation * (state.transform.scale * point)
}

/// Returns all numbers of a scene as bits.
pub(super) fn bits(scene: &StageScene) -> Vec<u32> {
    let mut bits = Vec::new();
    let mut add = |numbers: &[f32]| bits.extend(numbers.iter().map(|number| number.to_bits()));
    for state in &scene.things {
        add(&state.transform.translation.to_array());
        add(&state.transform.rotation.to_array());
        if let Some(pose) = &state.pose {
            pose.to_root.matrices().for_each(|matrix| add(matrix));
            add(&pose.shapes);
        }
        if let Some(light) = &state.light {
            add(&[light.color.x, light.color.y, light.color.z, light.strength]);
        }
        if let Some(effect) = &state.effect {
            add(&[effect.weight, effect.seconds as f32, effect.rate, f32::from_bits(effect.seed)]);
        }
    }
    if let Some(camera) = &scene.camera {
        add(&camera.position.to_array());
        add(&camera.rotation.to_array());
        add(&[camera.lens, camera.focus.unwrap_or(-1.0), camera.aperture, camera.thing as f32]);
    }
    scene.titles.iter().for_each(|title| add(&[title.title as f32, title.weight]));
    scene.sounds.iter().for_each(|sound| add(&[sound.sound as f32, sound.seconds as f32, sound.gain]));
    bits
}
