//! A root bone above a skeleton changes where no bone and no vertex is; a glTF file that is saved with it gets one node, and
//! loses it again where the bone is gone.

use crate::doors::data;
use crate::motion::load;
use crate::save_support::{OpenedFile, json_of, rest_stays};
use crate::support::{animation_data, bone, take};
use dragonfly_anim::animation::{final_poses, to_root};
use dragonfly_anim::data::{
    Channel, Interpolation, MeshInstance, ModelData, Skeleton, Skin, Take, Track, Transform,
};
use dragonfly_anim::format::gltf::save::{Plan, SaveError, plan_with_skeleton};
use dragonfly_anim::format::{EditedTake, NoFiles, ReadOptions, dfm, read};
use dragonfly_anim::limits::NODE_DEPTH;
use dragonfly_anim::root_bone::{BoneShift, RootBoneError, skeleton_with_root, with_root_bone};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Quat, Vec3};
use serde_json::{Value, json};
use std::sync::Arc;

const FILES: [&str; 9] = [
    "gltf/Fox.glb",
    "gltf/SimpleSkin_embedded.gltf",
    "gltf/InterpolationTest.glb",
    "bench/pab.glb",
    "collection/BoxAnimated.glb",
    "collection/RobotExpressive.glb",
    "collection/RecursiveSkeletons.glb",
    "collection/quaternius_Character4skins.glb",
    "collection/godot_enemy.glb",
];

/// Returns to-root of every bone at a time of a take.
fn matrices(skeleton: &Skeleton, take: Option<&Take>, time: f32) -> Vec<Mat4> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(take, skeleton, time, &mut poses);
    let mut out = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &poses, &mut out);
    out
}

/// Returns the final poses of the joints of a skin.
fn skinned(skin: &Skin, to_root: &[Mat4]) -> Vec<Mat4> {
    let mut out = vec![Mat4::IDENTITY; skin.bones.len()];
    final_poses(skin, to_root, &mut out);
    out
}

/// Returns at most 50 key times of a take, and times between them.
fn times(take: &Take) -> Vec<f32> {
    let mut keys: Vec<f32> = take.tracks.iter().flat_map(Track::key_times).collect();
    keys.sort_by(f32::total_cmp);
    keys.dedup();
    let step = keys.len().div_ceil(50).max(1);
    let between = (0..51).map(|step| take.start + take.length * (step as f32 + 0.37) / 51.0);
    keys.into_iter().step_by(step).chain(between).collect()
}

/// A take with no keys of `bones` bones, but for the first one, which moves along z and turns.
fn moving_root(bones: usize) -> Take {
    let mut tracks: Vec<Track> = (0..bones as u32).map(|bone| Track { bone, ..Track::default() }).collect();
    let turns = [0.0, 0.4, 0.8].map(Quat::from_rotation_y);
    let places = [Vec3::ZERO, Vec3::Z, 3.0 * Vec3::Z];
    tracks[0].rotation = Channel::new([0.0, 0.5, 1.0], turns, Interpolation::Linear);
    tracks[0].translation = Channel::new([0.0, 0.5, 1.0], places, Interpolation::Linear);
    take(tracks)
}

#[test]
fn every_bone_and_every_joint_stays_where_it_is_at_every_time_to_the_bit() {
    let mut compared = 0;
    for file in FILES {
        let before = load(&data().join(file));
        let after = with_root_bone(&before, "A new root").unwrap();
        let [old, new] = [&before, &after].map(|model| &model.animation);
        assert_eq!(
            (new.skeleton.len(), new.takes.len()),
            (old.skeleton.len() + 1, old.takes.len()),
            "{file}"
        );
        let resting = std::iter::once((None, None, vec![0.0]));
        let moving = old.takes.iter().zip(&new.takes);
        let moving = moving.map(|(old, new)| (Some(&**old), Some(&**new), times(old)));
        for (old_take, new_take, times) in resting.chain(moving) {
            for time in times {
                // Equal numbers; only a zero may have another sign.
                let was = matrices(&old.skeleton, old_take, time);
                let is = matrices(&new.skeleton, new_take, time);
                assert_eq!(is[0], Mat4::IDENTITY, "{file}");
                assert!(is[1..] == was[..], "{file} at {time} s");
                for (old, new) in before.skins.iter().zip(&after.skins) {
                    assert!(skinned(old, &was) == skinned(new, &is), "{file}: skin at {time} s");
                }
                for (old, new) in before.instances.iter().zip(&after.instances) {
                    let of = |instance: &MeshInstance, to_root: &[Mat4]| {
                        instance.bone.map(|bone| to_root[bone as usize] * instance.to_bone)
                    };
                    assert_eq!(of(old, &was), of(new, &is), "{file}: mesh at {time} s");
                }
                compared += was.len();
            }
        }
    }
    assert!(compared > 50_000, "{compared}");
}

#[test]
fn the_way_back_gives_the_same_model() {
    for file in FILES {
        let before = load(&data().join(file));
        let after = with_root_bone(&before, "A new root").unwrap();
        let [old, new] = [&before, &after].map(|model| &model.animation.skeleton);
        assert_eq!(BoneShift::between(old, new), Some(BoneShift::ROOT_ADDED), "{file}");
        let back = BoneShift::between(new, old).unwrap();
        assert_eq!((back.removed(), back.added(), back.bone(0), back.bone(1)), (1, 0, None, Some(0)));
        assert!(back.model(&after, old) == Some(before), "{file}");
    }
}

#[test]
fn the_keys_of_a_bone_that_is_gone_no_longer_count_for_the_length_of_a_take() {
    let mut moving = moving_root(3);
    moving.tracks[2].scale = Channel::new([0.25, 0.75], [Vec3::ONE; 2], Interpolation::Linear);
    let bones = [bone("a", None, Vec3::ZERO), bone("b", Some(0), Vec3::X), bone("c", Some(1), Vec3::X)];
    let below = [bone("b", None, Vec3::X), bone("c", Some(0), Vec3::X)];
    let [bones, below] = [bones.to_vec(), below.to_vec()].map(|bones| Skeleton { bones });
    let shift = BoneShift::between(&bones, &below).unwrap();
    let shifted = shift.take(&moving);
    assert_eq!((shifted.start, shifted.length, shifted.tracks.len()), (0.25, 0.5, 2));
    assert_eq!((shifted.tracks[1].bone, &shifted.tracks[1].scale), (1, &moving.tracks[2].scale));
}

#[test]
fn skeletons_that_differ_below_their_root_bones_have_no_renumbering() {
    let skeleton = |bones: &[(&str, Option<u32>)]| Skeleton {
        bones: bones.iter().map(|(name, parent)| bone(name, *parent, Vec3::ZERO)).collect(),
    };
    let figure = skeleton(&[("hips", None), ("leg", Some(0)), ("foot", Some(1))]);
    let shift = |other: &[(&str, Option<u32>)]| {
        BoneShift::between(&figure, &skeleton(other)).map(|shift| (shift.removed(), shift.added()))
    };
    assert_eq!(shift(&[("hips", None), ("leg", Some(0)), ("foot", Some(1))]), Some((0, 0)));
    let two = [("top", None), ("root", Some(0)), ("hips", Some(1)), ("leg", Some(2)), ("foot", Some(3))];
    assert_eq!(shift(&two), Some((0, 2)));
    assert_eq!(shift(&[("pelvis", None), ("leg", Some(0)), ("foot", Some(1))]), Some((1, 1)));
    // Another parent, another order, root bones next to each other, another figure.
    assert_eq!(shift(&[("hips", None), ("leg", Some(0)), ("foot", Some(0))]), None);
    assert_eq!(shift(&[("hips", None), ("foot", Some(0)), ("leg", Some(0))]), None);
    assert_eq!(shift(&[("root", None), ("hips", None), ("leg", Some(1)), ("foot", Some(2))]), None);
    assert_eq!(shift(&[("wheel", None), ("axle", None)]), None);
}

#[test]
fn a_root_bone_that_makes_no_sense_is_refused() {
    let mut model = ModelData::default();
    assert_eq!(with_root_bone(&model, "Root"), Err(RootBoneError::NoBones));
    model.animation = animation_data(vec![bone("Hips", None, Vec3::ZERO)], Vec::new());
    assert_eq!(with_root_bone(&model, " \t"), Err(RootBoneError::NoName));
    assert_eq!(with_root_bone(&model, "Hips"), Err(RootBoneError::NameTaken("Hips".to_owned())));
    assert!(with_root_bone(&model, "hips").is_ok(), "names differ by their capitals");
    let chain = |count: usize| {
        let parent = |index: usize| index.checked_sub(1).map(|parent| parent as u32);
        Skeleton { bones: (0..count).map(|index| bone("", parent(index), Vec3::ZERO)).collect() }
    };
    assert!(skeleton_with_root(&chain(NODE_DEPTH - 1), "Root").is_ok());
    assert_eq!(skeleton_with_root(&chain(NODE_DEPTH), "Root"), Err(RootBoneError::TooDeep(NODE_DEPTH)));
}

/// A file, and what a save with another skeleton writes into it.
struct RootSave {
    opened: OpenedFile,
    model: ModelData,
}

impl RootSave {
    fn of(name: &str, bytes: &[u8]) -> Self {
        let opened = OpenedFile::alone(name, bytes);
        let model = opened.model.clone();
        Self { opened, model }
    }

    fn file(path: &str) -> Self {
        Self::of(path.rsplit('/').next().unwrap(), &std::fs::read(data().join(path)).unwrap())
    }

    fn takes(&self) -> Vec<EditedTake> {
        let takes = self.model.animation.takes.iter().enumerate();
        let origin =
            |index: usize| Some(index).filter(|&index| index < self.opened.model.animation.takes.len());
        takes.map(|(index, take)| EditedTake { origin: origin(index), take: Arc::clone(take) }).collect()
    }

    fn plan(&self) -> Result<Plan<'_>, SaveError> {
        let skeleton = &self.model.animation.skeleton;
        plan_with_skeleton(&self.opened.source, &self.opened.model, skeleton, &self.takes())
    }

    fn add_root(&mut self, name: &str) {
        self.model = with_root_bone(&self.model, name).unwrap();
    }

    fn remove_root(&mut self) {
        let skeleton = &self.model.animation.skeleton;
        let below = |bone: &dragonfly_anim::data::Bone| {
            let parent = bone.parent.and_then(|parent| parent.checked_sub(1));
            dragonfly_anim::data::Bone { parent, ..bone.clone() }
        };
        let below = Arc::new(Skeleton { bones: skeleton.bones[1..].iter().map(below).collect() });
        self.model = BoneShift::between(skeleton, &below).unwrap().model(&self.model, &below).unwrap();
    }

    /// Saves, checks that the rest of the file stays, and opens the result.
    #[track_caller]
    fn saved(&self) -> Self {
        let plan = self.plan().unwrap();
        let bytes = plan.write().remove(0).bytes;
        rest_stays(self.opened.source.bytes(), &bytes, plan.changes());
        Self::of(self.opened.source.name(), &bytes)
    }

    fn json(&self) -> Value {
        json_of(self.opened.source.bytes())
    }

    fn bytes(&self) -> &[u8] {
        self.opened.source.bytes()
    }
}

/// Returns a file with a root bone that moves in a new take, and the same with the bone and the take removed again; for the programs
/// that judge saved files.
pub(crate) fn root_added_and_removed(name: &str, bytes: &[u8]) -> Vec<(&'static str, Vec<u8>)> {
    let mut file = RootSave::of(name, bytes);
    // The node of a skinned mesh should be a root of the scene; one that is animated is a bone, and gets a parent.
    let skinned = file.model.instances.iter().filter(|instance| instance.skin.is_some());
    let mut bones = file.model.animation.skeleton.bones.iter();
    let nodes: Vec<_> = skinned.map(|instance| instance.node).collect();
    if file.model.animation.skeleton.is_empty() || bones.any(|bone| nodes.contains(&bone.node)) {
        return Vec::new();
    }
    file.add_root("A new root");
    let moving = moving_root(file.model.animation.skeleton.len());
    file.model.animation.takes.push(Arc::new(moving));
    let saved = file.saved();
    same_poses(&file.model, &saved.model);
    let mut back = RootSave::of(name, saved.bytes());
    back.remove_root();
    let _ = back.model.animation.takes.pop();
    let gone = back.saved();
    vec![("root", saved.bytes().to_vec()), ("rootless", gone.bytes().to_vec())]
}

/// Fails if bones or joints of two models are more than a millionth of the figure apart, or have other names.
#[track_caller]
fn same_poses(a: &ModelData, b: &ModelData) {
    let names = |model: &ModelData| -> Vec<(String, Option<u32>)> {
        let bones = model.animation.skeleton.bones.iter();
        bones.map(|bone| (bone.name.clone(), bone.parent)).collect()
    };
    assert_eq!(names(a), names(b));
    assert_eq!(a.skins.iter().map(|skin| &skin.bones).collect::<Vec<_>>(), {
        b.skins.iter().map(|skin| &skin.bones).collect::<Vec<_>>()
    });
    for (a_take, b_take) in a.animation.takes.iter().zip(&b.animation.takes) {
        for time in times(a_take) {
            let was = matrices(&a.animation.skeleton, Some(a_take), time);
            let is = matrices(&b.animation.skeleton, Some(b_take), time);
            let largest = was.iter().flat_map(Mat4::to_cols_array).map(f32::abs).fold(1.0, f32::max);
            for (was, is) in was.iter().zip(&is) {
                assert!(was.abs_diff_eq(*is, 1e-6 * largest), "{was} {is}");
            }
        }
    }
}

#[test]
fn a_saved_root_bone_is_one_more_node_and_read_back_as_the_first_bone() {
    for path in FILES {
        let mut file = RootSave::file(path);
        let nodes = file.json()["nodes"].as_array().unwrap().len();
        file.add_root("Motion \"root\"");
        if let Some(first) = file.model.animation.takes.first_mut() {
            let moving = moving_root(file.model.animation.skeleton.len());
            Arc::make_mut(first).tracks[0] = moving.tracks[0].clone();
            let (start, end) = first.range_of_keys().unwrap();
            (Arc::make_mut(first).start, Arc::make_mut(first).length) = (start, end - start);
        }
        let saved = file.saved();
        let changes = file.plan().unwrap().changes().clone();
        assert_eq!(changes.bones_added, [(nodes as u32, "Motion \"root\"".to_owned())], "{path}");
        assert!(changes.to_string().contains("1 bone added"), "{changes}");
        assert!(changes.to_json().contains(r#""bonesAdded":[{"bone":"Motion \"root\"","node":"#), "{path}");
        same_poses(&file.model, &saved.model);
        let root = &saved.model.animation.skeleton.bones[0];
        assert_eq!((root.node, root.rest), (Some(nodes as u32), Transform::IDENTITY), "{path}");
        let json = saved.json();
        let new = json["nodes"][nodes].as_object().unwrap();
        assert_eq!(new.keys().map(String::as_str).collect::<Vec<_>>(), ["children", "name"], "{path}");
        for scene in json["scenes"].as_array().unwrap() {
            let listed = scene["nodes"].as_array().unwrap();
            let of_bones = listed.iter().filter(|node| new["children"].as_array().unwrap().contains(node));
            assert_eq!((listed.contains(&json!(nodes)), of_bones.count()), (true, 0), "{path}");
        }
        // Without another edit, nothing more is written.
        assert_eq!(saved.saved().bytes(), saved.bytes(), "{path}");
    }
}

/// Returns a document with the nodes of its scenes in ascending order.
fn in_order(mut json: Value) -> Value {
    for scene in json["scenes"].as_array_mut().unwrap() {
        scene["nodes"].as_array_mut().unwrap().sort_by_key(|node| node.as_u64());
    }
    json
}

#[test]
fn a_save_after_the_bone_is_gone_removes_its_node_and_its_keys() {
    let mut reordered = Vec::new();
    for path in FILES {
        let mut file = RootSave::file(path);
        file.add_root("A new root");
        let mut saved = file.saved();
        saved.remove_root();
        let plan = saved.plan().unwrap();
        assert!(plan.changes().to_string().contains("1 bone removed"), "{}", plan.changes());
        let gone = saved.saved();
        assert_eq!(in_order(gone.json()), in_order(file.json()), "{path}");
        // Only the order of the nodes of a scene may differ, where others were between the root nodes.
        let same = gone.json() == file.json();
        assert_eq!(gone.bytes() == file.bytes(), same, "{path}");
        if !same {
            reordered.push(path);
        }
        // With keys of the root.
        let moving = Arc::new(moving_root(file.model.animation.skeleton.len()));
        let takes = file.model.animation.takes.len();
        file.model.animation.takes.push(moving);
        let mut moved = file.saved();
        moved.remove_root();
        let back = moved.saved();
        assert_eq!(back.json()["nodes"], file.json()["nodes"], "{path}");
        assert_eq!(in_order(back.json())["scenes"], in_order(file.json())["scenes"], "{path}");
        let [old, new] = [&file.opened.model, &back.model].map(|model| &model.animation);
        assert_eq!((new.takes.len(), new.skeleton.len()), (takes + 1, old.skeleton.len()), "{path}");
        assert!(old.takes[..] == new.takes[..takes], "{path}");
    }
    // Their scenes list other nodes between the root nodes.
    let between = ["gltf/InterpolationTest.glb", "collection/RecursiveSkeletons.glb"];
    assert!(
        reordered.iter().all(|path| between.contains(path)),
        "files without their old bytes: {reordered:?}"
    );
}

#[test]
fn the_node_of_a_saved_root_bone_is_found_without_its_number() {
    let mut file = RootSave::file("gltf/SimpleSkin_embedded.gltf");
    file.add_root("Root");
    let saved = file.saved();
    // The model as an editor has it after the save, which did not read the file again.
    let mut kept = RootSave { opened: OpenedFile::alone("a.gltf", saved.bytes()), model: file.model.clone() };
    kept.opened.model = file.model.clone();
    assert_eq!(kept.saved().bytes(), saved.bytes());
    let moving = moving_root(kept.model.animation.skeleton.len());
    kept.model.animation.takes.push(Arc::new(moving));
    let again = kept.saved();
    assert_eq!(again.json()["nodes"], saved.json()["nodes"]);
    let target = &again.json()["animations"][1]["channels"][0]["target"];
    assert_eq!(target["node"], saved.model.animation.skeleton.bones[0].node.unwrap());
    let mut gone = RootSave { opened: OpenedFile::alone("a.gltf", again.bytes()), model: kept.model.clone() };
    gone.opened.model = kept.model.clone();
    gone.remove_root();
    assert_eq!(gone.saved().json()["nodes"], file.json()["nodes"]);
}

/// A file with two root bones, one of which two scenes list, and a node that is no bone.
fn two_scenes() -> Vec<u8> {
    let text = json!({
        "asset": {"version": "2.0"},
        "scene": 1,
        "scenes": [{"nodes": [2, 0]}, {"name": "both", "nodes": [3, 2, 1, 0]}, {"nodes": [3]}, {"name": "empty"}],
        "nodes": [{"name": "a", "children": [4]}, {"name": "b"}, {"name": "lamp"}, {"name": "camera"}, {"name": "c"}],
        "buffers": [{"byteLength": 16, "uri": "data:;base64,AAAAAAAAgD8AAAAAAACAPw=="}],
        "bufferViews": [{"buffer": 0, "byteLength": 16}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR", "min": [0], "max": [0]},
            {"bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 1, "type": "VEC3"}],
        "animations": [{"name": "go", "samplers": [{"input": 0, "output": 1}], "channels": [
            {"sampler": 0, "target": {"node": 1, "path": "translation"}},
            {"sampler": 0, "target": {"node": 4, "path": "translation"}}]}],
    });
    serde_json::to_vec_pretty(&text).unwrap()
}

#[test]
fn the_new_node_takes_the_place_of_the_root_bones_in_every_scene_that_lists_one() {
    let mut file = RootSave::of("scenes.gltf", &two_scenes());
    file.add_root("Root");
    let saved = file.saved();
    let json = saved.json();
    let lists: Vec<&Value> = (0..4).map(|scene| &json["scenes"][scene]["nodes"]).collect();
    assert_eq!(lists, [&json!([2, 5]), &json!([3, 2, 5]), &json!([3]), &Value::Null]);
    assert_eq!(json["nodes"][5], json!({"name": "Root", "children": [0, 1]}));
    same_poses(&file.model, &saved.model);
    // Another root bone above it, and another one instead of it.
    let mut two = saved.saved();
    two.add_root("Top");
    let above = two.saved();
    assert_eq!(above.json()["nodes"][6], json!({"name": "Top", "children": [5]}));
    assert_eq!(above.json()["scenes"][1]["nodes"], json!([3, 2, 6]));
    let mut other = above.saved();
    other.remove_root();
    other.remove_root();
    other.add_root("Other");
    let plan = other.plan().unwrap();
    let changes = (plan.changes().bones_added.len(), plan.changes().bones_removed.len());
    assert_eq!(changes, (1, 2));
    let other = other.saved();
    assert_eq!(other.json()["nodes"].as_array().unwrap().len(), 6);
    assert_eq!(other.json()["nodes"][5], json!({"name": "Other", "children": [0, 1]}));
    assert_eq!(other.json()["scenes"], json["scenes"]);
}

#[test]
fn a_node_with_others_after_it_stays_without_children_and_in_no_scene() {
    let mut file = RootSave::of("scenes.gltf", &two_scenes());
    file.add_root("Root");
    let mut json = file.saved().json();
    // Another program appends a node.
    json["nodes"].as_array_mut().unwrap().push(json!({"name": "prop"}));
    let mut grown = RootSave::of("scenes.gltf", &serde_json::to_vec(&json).unwrap());
    grown.remove_root();
    let plan = grown.plan().unwrap();
    assert_eq!(plan.changes().nodes_left, [5]);
    assert!(plan.changes().to_string().contains("node 5: stays without children"), "{}", plan.changes());
    let left = grown.saved();
    assert_eq!(left.json()["nodes"][5], json!({"name": "Root"}));
    assert_eq!(left.json()["nodes"][6], json!({"name": "prop"}));
    assert_eq!(left.json()["scenes"][1]["nodes"], json!([3, 2, 0, 1]));
    same_poses(&grown.model, &left.model);
}

#[test]
fn a_file_that_could_not_be_opened_again_is_not_written() {
    // The lowest node is no bone, so the skeleton is not too deep.
    let deep = |levels: usize| {
        let mut json: Value = serde_json::from_slice(&two_scenes()).unwrap();
        let nodes = json["nodes"].as_array_mut().unwrap();
        let first = nodes.len();
        nodes[4]["children"] = json!([first]);
        let more = levels - 2;
        for number in 0..more {
            let children = json!([first + number + 1]);
            nodes.push(if number + 1 < more { json!({"children": children}) } else { json!({}) });
        }
        let mut file = RootSave::of("deep.gltf", &serde_json::to_vec(&json).unwrap());
        file.add_root("Root");
        file.plan().map(|plan| plan.write().remove(0).bytes).map_err(|error| error.to_string())
    };
    let bytes = deep(NODE_DEPTH - 1).unwrap();
    assert!(read("deep.gltf", &bytes, &NoFiles, &ReadOptions::default()).is_ok());
    let error = deep(NODE_DEPTH).unwrap_err();
    assert!(error.contains("/nodes: a file has at most 512 levels of nodes"), "{error}");
}

#[test]
fn a_model_whose_bones_differ_otherwise_is_refused() {
    let file = RootSave::file("gltf/SimpleSkin_embedded.gltf");
    let other = RootSave::file("gltf/Fox.glb");
    let skeleton = &other.model.animation.skeleton;
    let refused = plan_with_skeleton(&file.opened.source, &file.opened.model, skeleton, &[]).err().unwrap();
    assert!(refused.to_string().contains("differ in more than root bones"), "{refused}");
}

#[test]
fn a_file_that_is_written_as_a_whole_has_the_root_bone_too() {
    let model = load(&data().join("gltf/Fox.glb"));
    let bytes = dfm::write(&model).unwrap();
    let file = dfm::DFM.edit("Fox.dfm", bytes, &NoFiles, &ReadOptions::default()).unwrap();
    let after = with_root_bone(&model, "Root").unwrap();
    let takes = after.animation.takes.iter().enumerate();
    let takes: Vec<_> =
        takes.map(|(index, take)| EditedTake { origin: Some(index), take: Arc::clone(take) }).collect();
    let plan = file.plan_with_skeleton(&model, &after.animation.skeleton, &takes).unwrap();
    let back = read("Fox.dfm", &plan.files[0].bytes, &NoFiles, &ReadOptions::default()).unwrap().model;
    same_poses(&after, &back);
    let other = load(&data().join("gltf/SimpleSkin_embedded.gltf"));
    let refused = file.plan_with_skeleton(&model, &other.animation.skeleton, &[]).unwrap_err();
    assert!(refused.to_string().contains("differ in more than root bones"), "{refused}");
}
