//! A VRM animation moves a VRM model: bones are found by the parts of the body, and expressions set its shape keys.

use dragonfly_anim::data::{
    AnimationData, Mesh, MeshInstance, ModelData, MorphTarget, Primitive, Skeleton, Take, Vertices,
};
use dragonfly_anim::format::{NoFiles, ReadOptions, gltf, read};
use dragonfly_anim::sample::sample_morph_weights;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{AddTakes, Edit};
use dragonfly_document::{
    Cancel, ClipOrder, ClipSettings, Decision, DocumentMessage, Editable, Source, TakeNames, clip_takes,
};
use dragonfly_kit::document::new_version::new_version;
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::{Folder, data};
use glam::{Mat4, Vec3};
use serde_json::{Map, Value, json};
use std::path::PathBuf;
use std::sync::Arc;

fn wave() -> ModelData {
    let bytes = std::fs::read(data("gltf/wave.vrma")).expect("a file");
    read("wave.vrma", &bytes, &NoFiles, &ReadOptions::default()).expect("a VRM animation").model
}

/// Writes a VRM model whose bones have names that say nothing. Its expression `happy` sets the second of three shape keys to 0.5.
fn hero(folder: &Folder) -> PathBuf {
    let figure = wave();
    let mut bones = figure.animation.skeleton.bones.clone();
    bones.iter_mut().enumerate().for_each(|(index, bone)| bone.name = format!("N{index}"));
    let vertices = Vertices {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        ..Vertices::default()
    };
    let target = MorphTarget { positions: vec![Vec3::Z; 3], ..MorphTarget::default() };
    let primitive =
        Primitive { vertices, indices: vec![0, 1, 2], material: None, morph_targets: vec![target; 3] };
    let mesh = Mesh { name: "face".to_owned(), primitives: vec![primitive], morph_weights: vec![0.0; 3] };
    let instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: vec![0.0; 3],
    };
    let animation = AnimationData { skeleton: Arc::new(Skeleton { bones }), takes: Vec::new() };
    let model =
        ModelData { meshes: vec![mesh], instances: vec![instance], animation, ..ModelData::default() };
    let bytes = gltf::write::glb(&model).expect("a model").bytes;
    let bytes = new_version(&bytes, |json| {
        let nodes = json["nodes"].as_array().expect("nodes").clone();
        let node = |wanted: &dyn Fn(&Value) -> bool| nodes.iter().position(wanted).expect("a node");
        let human = |human: &dragonfly_anim::data::HumanBone| {
            let name = format!("N{}", human.bone);
            (human.name.clone(), json!({"node": node(&|node| node["name"] == name.as_str())}))
        };
        let humans: Map<String, Value> = figure.avatar.bones.iter().map(human).collect();
        let bind = json!({"node": node(&|node| node.get("mesh").is_some()), "index": 1, "weight": 0.5});
        json["extensionsUsed"] = json!(["VRMC_vrm"]);
        json["extensions"] = json!({"VRMC_vrm": {"specVersion": "1.0", "humanoid": {"humanBones": humans},
            "expressions": {"preset": {"happy": {"morphTargetBinds": [bind]}}}}});
    });
    let path = folder.join("hero.vrm");
    std::fs::write(&path, bytes).expect("a file");
    path
}

/// Returns the weights of the shape keys of a take at a time.
fn shapes(take: &Take, time: f32) -> [f32; 3] {
    let mut weights = [0.0; 3];
    sample_morph_weights(Some(take), 0, &[0.0; 3], time, &mut weights);
    weights
}

/// Checks that the take has the weights of the expression, which are limited to 0..1, times 0.5.
fn assert_happy(take: &Take) {
    let source = wave();
    let happy = source.avatar.expressions.iter().find(|it| it.name == "happy").expect("the expression");
    let bone = happy.weight_bone.expect("a bone") as usize;
    let keys = &source.animation.takes[0].tracks[bone].translation;
    assert!(keys.len() > 2);
    for (time, value) in keys.times.iter().zip(keys.values.iter()) {
        assert_eq!(shapes(take, *time), [0.0, 0.5 * value.x.clamp(0.0, 1.0), 0.0], "at {time}");
    }
}

#[test]
fn an_imported_vrm_animation_moves_the_bones_and_the_shape_keys_of_a_vrm_model() {
    let folder = Folder::new("import-vrma");
    let (path, autosave) = (hero(&folder), folder.join("autosave"));
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.send(DocumentMessage::ImportTakes(ClipOrder::of(vec![data("gltf/wave.vrma")])));
    let view = document.wait_for_view(|view| view.history.done == 1);
    let take = view.takes.last().expect("a take");
    assert_happy(take);
    let source = wave();
    let source_take = &source.animation.takes[0];
    for human in &source.avatar.bones {
        let bone = view.loaded.model.avatar.bone(&human.name).expect("the part of the body") as usize;
        let moves = !source_take.tracks[human.bone as usize].rotation.is_empty();
        assert_eq!(!take.tracks[bone].rotation.is_empty(), moves, "{}", human.name);
    }
    // The weights are in the journal.
    drop(document);
    let mut again = TestDocument::new(&autosave);
    again.open(&path);
    let offer = again.wait_for_offers().remove(0);
    again.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    assert_eq!(again.wait_for_view(|view| view.history.done == 1).takes, view.takes);
}

#[test]
fn a_take_with_expressions_is_saved_with_its_shape_keys() {
    let folder = Folder::new("save-vrma");
    let path = hero(&folder);
    let editable = Editable::open(&Source::File(path), &Cancel::default()).expect("a model");
    let mut adapter = ModelAdapter::of(&editable.model);
    let (mut names, settings) = (TakeNames::of(&adapter), ClipSettings::default());
    let clip = wave();
    let done = clip_takes("wave.vrma", &clip, &|_, _| true, &editable.model, &mut names, &settings)
        .expect("the bones have the same parts of the body");
    assert_eq!((done.bound, done.unmatched.len()), (clip.avatar.bones.len(), 0));
    adapter.apply(&Edit::AddTakes(AddTakes { takes: done.takes })).expect("an edit");
    let plan = editable.plan(&adapter).expect("a save");
    let bytes = &plan.files.last().expect("a file").bytes;
    let saved = read("hero.vrm", bytes, &NoFiles, &ReadOptions::default()).expect("a model").model;
    assert_happy(&saved.animation.takes[0]);
    assert_eq!(saved.avatar, editable.model.avatar);
}
