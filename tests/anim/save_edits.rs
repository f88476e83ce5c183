//! Every kind of edit is saved, and nothing else in the file changes.

use crate::doors::{MemoryFs, data};
use crate::fixture::{Fixture, accessor};
use crate::save_support::{OpenedFile, Over, bin_of, take_mut};
use dragonfly_anim::data::{Channel, Interpolation, MorphTrack, Track};
use dragonfly_anim::format::gltf::save::{ChannelChange, MARK, TakeChange};
use dragonfly_anim::format::{EditedTake, NoFiles};
use glam::{Quat, Vec3};
use serde_json::{Value, json};
use std::sync::Arc;

/// Moves every key of the first translation in take `index`, or of the first morph weights, by a small amount.
pub(crate) fn shift(takes: &mut [EditedTake], index: usize) {
    let take = take_mut(takes, index);
    let moving = take.tracks.iter_mut().find(|track| !track.translation.is_empty());
    match moving {
        Some(track) => {
            let values = track.translation.values.iter().map(|value| *value + Vec3::splat(0.125));
            track.translation.values = values.collect();
        }
        None => {
            let morph = take.morphs.first_mut().expect("something moves");
            morph.weights = morph.weights.iter().map(|weight| weight + 0.125).collect();
        }
    }
}

/// Returns a track with three keys in each channel.
pub(crate) fn moving_track() -> Track {
    let times: Arc<[f32]> = [0.25, 0.5, 1.5].into();
    let values = [Vec3::X, Vec3::Y, Vec3::Z];
    let turns = [0.1, 0.2, 0.3].map(Quat::from_rotation_z);
    Track {
        bone: 0,
        translation: Channel::new(times.clone(), values, Interpolation::Linear),
        rotation: Channel::new(times.clone(), turns, Interpolation::Step),
        scale: Channel::new(times, values, Interpolation::Linear),
    }
}

fn fox() -> OpenedFile {
    OpenedFile::alone("Fox.glb", &std::fs::read(data().join("gltf/Fox.glb")).unwrap())
}

fn marked(json: &Value, list: &str) -> usize {
    json[list].as_array().unwrap().iter().filter(|item| item["name"] == MARK).count()
}

#[test]
fn a_changed_channel_gets_one_new_accessor_and_keeps_its_times() {
    let fox = fox();
    let mut takes = fox.takes();
    shift(&mut takes, 0);
    let saved = fox.saved(&takes, &NoFiles);
    let changes = &saved.changes;
    println!("{changes}{}", changes.to_json());
    assert_eq!(changes.channels.len(), 1);
    assert_eq!(
        (changes.channels[0].change, changes.channels[0].path),
        (ChannelChange::Changed, "translation")
    );
    assert_eq!(changes.accessors.len(), 1, "the times are those of the file");
    assert_eq!(changes.bytes_appended, changes.accessors[0].bytes);
    // The output of one sampler, an accessor, a view, the length of the buffer.
    assert_eq!(changes.tokens.len(), 4);
    let _: Value = serde_json::from_str(&changes.to_json()).unwrap();
}

#[test]
fn a_changed_interpolation_is_one_token_and_changed_times_are_one_accessor() {
    let fox = fox();
    let mut takes = fox.takes();
    let track = take_mut(&mut takes, 0).tracks.iter_mut().find(|track| track.rotation.len() > 2).unwrap();
    track.rotation.interpolation = Interpolation::Step;
    let changes = fox.saved(&takes, &NoFiles).changes;
    println!("{changes}");
    assert_eq!((changes.accessors.len(), changes.bytes_appended), (0, 0));
    assert_eq!(changes.tokens.len(), 1);
    assert!(changes.tokens[0].new.contains("STEP"), "{changes}");
    let mut takes = fox.takes();
    let track = take_mut(&mut takes, 0).tracks.iter_mut().find(|track| track.rotation.len() > 2).unwrap();
    let keys = track.rotation.len();
    track.rotation.times = track.rotation.times.iter().map(|time| time * 2.0).collect();
    let changes = fox.saved(&takes, &NoFiles).changes;
    println!("{changes}");
    assert_eq!(
        (changes.accessors.len(), changes.bytes_appended),
        (1, keys * 4),
        "the values are those of the file"
    );
}

#[test]
fn changed_times_are_shared_by_the_channels_that_share_them() {
    let fox = fox();
    let mut takes = fox.takes();
    let mut slower = std::collections::HashMap::new();
    for track in &mut take_mut(&mut takes, 1).tracks {
        let mut slow = |times: &mut Arc<[f32]>| {
            let old = times.clone();
            *times = slower
                .entry(old.as_ptr())
                .or_insert_with(|| old.iter().map(|time| time * 2.0).collect::<Arc<[f32]>>())
                .clone();
        };
        slow(&mut track.translation.times);
        slow(&mut track.rotation.times);
    }
    let saved = fox.saved(&takes, &NoFiles);
    let inputs = saved.changes.accessors.iter().filter(|accessor| accessor.shape == "SCALAR").count();
    let distinct: std::collections::HashSet<Vec<u32>> = saved.opened.model.animation.takes[1]
        .tracks
        .iter()
        .flat_map(|track| [&track.translation.times, &track.rotation.times])
        .filter(|times| !times.is_empty())
        .map(|times| times.iter().map(|time| time.to_bits()).collect())
        .collect();
    assert_eq!(inputs, distinct.len());
    let json = saved.json();
    for accessor in
        json["accessors"].as_array().unwrap().iter().filter(|a| a["name"] == MARK && a["type"] == "SCALAR")
    {
        assert!(accessor["min"][0].as_f64().unwrap() < accessor["max"][0].as_f64().unwrap());
    }
}

#[test]
fn channels_are_added_and_removed() {
    let fox = fox();
    let mut takes = fox.takes();
    let take = take_mut(&mut takes, 0);
    let (still, moving) = (
        take.tracks.iter().position(Track::is_empty).unwrap(),
        take.tracks.iter().position(|track| !track.rotation.is_empty()).unwrap(),
    );
    let fresh = moving_track();
    take.tracks[still] = Track { bone: still as u32, ..fresh };
    take.tracks[moving].rotation = Channel::default();
    let saved = fox.saved(&takes, &NoFiles);
    let count = |change| saved.changes.channels.iter().filter(|channel| channel.change == change).count();
    assert_eq!((count(ChannelChange::Added), count(ChannelChange::Removed)), (3, 1));
    // Back to the start: added channels are removed, and removed ones added.
    let mut back = saved.opened.takes();
    *take_mut(&mut back, 0) = (*fox.model.animation.takes[0]).clone();
    let back = saved.opened.saved(&back, &NoFiles);
    assert!(back.bytes().len() > saved.bytes().len() - 2000);
}

#[test]
fn takes_are_renamed_added_deleted_and_reordered() {
    let fox = fox();
    let names = ["Survey", "Walk", "Run"];
    assert_eq!(fox.model.animation.takes.iter().map(|take| take.name.as_str()).collect::<Vec<_>>(), names);
    let mut takes = fox.takes();
    take_mut(&mut takes, 1).name = "Gehen \"1\"\n\u{1f98a}".to_owned();
    let renamed = fox.saved(&takes, &NoFiles);
    assert_eq!(renamed.changes.tokens.len(), 1);
    assert_eq!(renamed.changes.takes[0].1, TakeChange::Renamed);

    for order in [vec![1], vec![0, 2], vec![2, 1, 0], vec![2, 0], vec![1, 2], vec![0, 1]] {
        let takes: Vec<EditedTake> = order.iter().map(|&index| fox.takes()[index].clone()).collect();
        let saved = fox.saved(&takes, &NoFiles);
        assert_eq!(saved.changes.bytes_appended, 0);
        if order.windows(2).all(|pair| pair[0] < pair[1]) {
            assert!(saved.changes.takes.iter().all(|(_, change)| *change == TakeChange::Deleted));
            assert!(
                saved.changes.tokens.iter().all(|token| token.new.is_empty()),
                "{order:?}: {}",
                saved.changes
            );
        }
    }

    let mut takes = fox.takes();
    takes.insert(1, takes[0].clone());
    take_mut(&mut takes, 1).name = "Copy".to_owned();
    takes.swap(2, 3);
    let mut fresh = crate::support::take(vec![moving_track()]);
    fresh.tracks =
        (0..fox.model.animation.skeleton.len() as u32).map(|bone| Track { bone, ..moving_track() }).collect();
    takes.insert(0, EditedTake { origin: None, take: Arc::new(fresh) });
    shift(&mut takes, 2);
    let saved = fox.saved(&takes, &NoFiles);
    println!(
        "{}",
        saved.changes.takes.iter().map(|(name, change)| format!("{name} {change:?} ")).collect::<String>()
    );
    let none = fox.saved(&[], &NoFiles);
    assert!(none.json().get("animations").is_none(), "an empty list is not allowed");
}

#[test]
fn a_copy_costs_no_bytes_until_it_is_edited() {
    let fox = fox();
    let mut takes = fox.takes();
    takes.push(takes[0].clone());
    take_mut(&mut takes, 3).name = "Copy".to_owned();
    let saved = fox.saved(&takes, &NoFiles);
    assert_eq!(saved.changes.bytes_appended, 0);
    let mut takes = saved.opened.takes();
    shift(&mut takes, 3);
    let edited = saved.opened.saved(&takes, &NoFiles);
    assert_eq!(edited.changes.channels.len(), 1);
}

#[test]
fn every_interpolation_is_written() {
    let fox = fox();
    let mut takes = fox.takes();
    let track = &mut take_mut(&mut takes, 0).tracks[3];
    let times: Arc<[f32]> = [0.0, 0.5, 2.0].into();
    let turns: Vec<Quat> = (0..9).map(|n| Quat::from_rotation_x(n as f32 * 0.1)).collect();
    track.rotation = Channel::new(times.clone(), turns, Interpolation::CubicSpline);
    track.translation = Channel::new(times.clone(), [Vec3::X; 3], Interpolation::Step);
    track.scale = Channel::new(times, vec![Vec3::ONE; 9], Interpolation::CubicSpline);
    let saved = fox.saved(&takes, &NoFiles);
    let mut takes = saved.opened.takes();
    let track = &mut take_mut(&mut takes, 0).tracks[3];
    track.rotation = Channel::new(track.rotation.times.clone(), [Quat::IDENTITY; 3], Interpolation::Linear);
    saved.opened.saved(&takes, &NoFiles);
}

#[test]
fn closest_key_becomes_step_and_a_spline_of_one_key_that_key() {
    use dragonfly_anim::sample::sample_channel;
    let fox = fox();
    let mut takes = fox.takes();
    let track = &mut take_mut(&mut takes, 0).tracks[3];
    let closest = Channel::new([0.0, 0.3, 1.0], [Vec3::X, Vec3::Y, Vec3::Z], Interpolation::Closest);
    track.translation = closest.clone();
    track.scale = Channel::new([0.5], [Vec3::X, Vec3::Y, Vec3::Z], Interpolation::CubicSpline);
    let plan = dragonfly_anim::format::gltf::save::plan(&fox.source, &fox.model, &takes).unwrap();
    let again = OpenedFile::alone("Fox.glb", &plan.write()[0].bytes);
    let track = &again.model.animation.takes[0].tracks[3];
    assert_eq!(track.translation.interpolation, Interpolation::Step);
    assert_eq!(track.translation.range(), closest.range());
    for probe in 0..1200 {
        let time = probe as f32 / 1000.0 - 0.1;
        let [a, b] = [&closest, &track.translation].map(|channel| sample_channel(channel, Vec3::ZERO, time));
        assert_eq!(a, b, "at {time}");
    }
    assert_eq!(track.scale, Channel::new([0.5], [Vec3::Y], Interpolation::Linear));
}

#[test]
fn a_take_that_animates_nothing_keeps_a_bone_at_rest() {
    let fox = fox();
    let mut takes = fox.takes();
    for track in &mut take_mut(&mut takes, 2).tracks {
        *track = Track { bone: track.bone, ..Track::default() };
    }
    let saved = fox.saved(&takes, &NoFiles);
    let animation = &saved.json()["animations"][2];
    assert_eq!(animation["channels"].as_array().unwrap().len(), 1);
    let take = &saved.opened.model.animation.takes[2];
    assert_eq!((take.keys(), take.length), (1, 0.0));
    // Saving the same takes again changes nothing.
    let mut again = saved.opened.takes();
    for track in &mut take_mut(&mut again, 2).tracks {
        *track = Track { bone: track.bone, ..Track::default() };
    }
    assert!(saved.opened.saved(&again, &NoFiles).changes.is_empty());
}

/// Returns a fixture with a second take that uses the same sampler and accessors, with channels that the importer
/// leaves out, and with a skin that shares an accessor.
fn shared_fixture() -> Fixture {
    let mut fixture = Fixture::new();
    let animation = fixture.json["animations"][0].clone();
    fixture.json["animations"].as_array_mut().unwrap().push(animation);
    let channels = fixture.json["animations"][0]["channels"].as_array_mut().unwrap();
    // A second user of sampler 0, a second channel of its target, an unknown path, and one for an extension.
    channels.push(json!({"sampler": 0, "target": {"node": 0, "path": "translation"}}));
    channels.push(channels[0].clone());
    channels.push(json!({"sampler": 1, "target": {"node": 1, "path": "color"}}));
    channels.push(json!({"sampler": 0, "target": {"path": "pointer", "extensions": {
        "KHR_animation_pointer": {"pointer": "/nodes/0/translation"}}}}));
    fixture
}

#[test]
fn shared_samplers_and_accessors_are_not_changed() {
    let fixture = shared_fixture();
    let opened = OpenedFile::alone("shared.glb", &fixture.glb());
    let before = &fixture.json["animations"];
    for index in 0..2 {
        let mut takes = opened.takes();
        shift(&mut takes, index);
        let saved = opened.saved(&takes, &NoFiles);
        println!("{}", saved.changes);
        let after = &saved.json()["animations"];
        assert_eq!(after[1 - index], before[1 - index], "the other take");
        let own = |value: &Value| value[index]["channels"].as_array().unwrap()[1..].to_vec();
        if index == 0 {
            assert_eq!(
                after[0]["samplers"].as_array().unwrap().len(),
                before[0]["samplers"].as_array().unwrap().len() + 1
            );
        }
        assert_eq!(own(after)[4..], own(before)[4..], "omitted content stays");
    }
}

#[test]
fn removing_a_channel_removes_the_second_one_of_its_target() {
    let opened = OpenedFile::alone("shared.glb", &shared_fixture().glb());
    let mut takes = opened.takes();
    let take = take_mut(&mut takes, 0);
    for track in &mut take.tracks {
        track.translation = Channel::default();
    }
    // Otherwise the second one would be used when the file is opened again, which `saved` would detect.
    opened.saved(&takes, &NoFiles);
}

#[test]
fn morph_weights_are_saved_too() {
    let fixture = Fixture::new();
    for (name, bytes) in [("a.glb", fixture.glb()), ("a.gltf", fixture.gltf())] {
        let opened = OpenedFile::alone(name, &bytes);
        let mut takes = opened.takes();
        let take = take_mut(&mut takes, 0);
        assert_eq!(take.morphs.len(), 1);
        let targets = take.morphs[0].targets;
        take.morphs[0] = MorphTrack {
            times: [0.0, 2.0].into(),
            weights: (0..6 * targets).map(|n| n as f32 * 0.1).collect(),
            interpolation: Interpolation::CubicSpline,
            ..take.morphs[0].clone()
        };
        let saved = opened.saved(&takes, &NoFiles);
        let mut takes = saved.opened.takes();
        take_mut(&mut takes, 0).morphs.clear();
        let removed = saved.opened.saved(&takes, &NoFiles);
        let mut takes = removed.opened.takes();
        take_mut(&mut takes, 0).morphs.clone_from(&opened.model.animation.takes[0].morphs);
        removed.opened.saved(&takes, &NoFiles);
    }
}

#[test]
fn quantized_and_sparse_keys_become_floats_only_where_they_are_edited() {
    let mut fixture = Fixture::new();
    // Rotations as normalized shorts, translations sparse.
    let bytes: Vec<u8> = [0i16, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 32767, 0]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    let quantised = fixture.accessor("VEC4", 5122, 3, &bytes);
    fixture.json["accessors"][quantised]["normalized"] = json!(true);
    let samplers = fixture.json["animations"][0]["samplers"].as_array_mut().unwrap();
    for sampler in samplers.iter_mut().filter(|sampler| sampler["output"] == accessor::ROTATIONS) {
        sampler["output"] = json!(quantised);
    }
    let opened = OpenedFile::alone("quantised.glb", &fixture.glb());
    let mut takes = opened.takes();
    let track = take_mut(&mut takes, 0).tracks.iter_mut().find(|track| !track.rotation.is_empty()).unwrap();
    track.rotation.values =
        track.rotation.values.iter().map(|q| Quat::from_rotation_y(0.5) * *q).map(Quat::normalize).collect();
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(saved.changes.accessors.len(), 1);
    assert_eq!(saved.json()["accessors"][quantised], fixture.json["accessors"][quantised]);
    // An edit of another channel leaves it unchanged.
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(
        saved.opened.model.animation.takes[0].tracks[1].rotation,
        opened.model.animation.takes[0].tracks[1].rotation
    );
}

#[test]
fn keys_that_the_importer_sorted_are_written_with_their_own_times() {
    let mut fixture = Fixture::new();
    fixture.float(accessor::TIMES, 0, 1.0).float(accessor::TIMES, 2, 0.0);
    let opened = OpenedFile::alone("unsorted.glb", &fixture.glb());
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(saved.changes.accessors.len(), 2);
}

#[test]
fn new_keys_of_a_file_with_a_separate_buffer_get_another_buffer_file() {
    let fixture = Fixture::new();
    let door = MemoryFs::with(&[("all.bin", &fixture.bin)]);
    let opened = OpenedFile::new("my fox.gltf", &fixture.gltf_with_file(), &door).unwrap();
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    let saved = opened.saved(&takes, &door);
    assert_eq!(saved.files.len(), 2);
    assert!(saved.files[0].name.starts_with("my_fox.dragonfly-"), "{}", saved.files[0].name);
    assert_eq!(saved.changes.files, [&*saved.files[0].name, "my fox.gltf"]);
    assert_eq!(saved.json()["buffers"][1]["byteLength"], saved.files[0].bytes.len());
    // The next save writes another file and reports that the first one is no longer needed.
    let over = Over::new(&saved.files, &door);
    let mut takes = saved.opened.takes();
    shift(&mut takes, 0);
    let again = saved.opened.saved(&takes, &over);
    assert_eq!(again.changes.files_left, [saved.files[0].name.clone()]);
    assert_eq!(again.files[0].bytes.len(), saved.files[0].bytes.len());
    assert_ne!(again.files[0].name, saved.files[0].name);
    assert_eq!(again.json()["buffers"].as_array().unwrap().len(), 2);
}

#[test]
fn a_container_without_a_binary_chunk_gets_a_binary_chunk() {
    let fixture = Fixture::new();
    let opened = OpenedFile::alone("embedded.glb", &crate::fixture::glb(&fixture.gltf(), None));
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    // Its buffer is a data URI, which becomes longer.
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(bin_of(saved.bytes()), b"");
    assert_eq!(saved.json()["buffers"].as_array().unwrap().len(), 1);
    assert_eq!(marked(&saved.json(), "bufferViews"), 1);
}

#[test]
fn a_node_with_a_matrix_can_be_animated() {
    let mut fixture = Fixture::new();
    let matrix = glam::Mat4::from_scale_rotation_translation(
        Vec3::new(1.0, 2.0, 3.0),
        Quat::from_rotation_z(0.7),
        Vec3::new(4.0, 5.0, 6.0),
    );
    let animation = &mut fixture.json["animations"][0]["channels"];
    let moved: std::collections::HashSet<u64> = animation
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|channel| channel["target"]["node"].as_u64())
        .collect();
    let joints: Vec<u64> =
        fixture.json["skins"][0]["joints"].as_array().unwrap().iter().filter_map(Value::as_u64).collect();
    println!("moved {moved:?} joints {joints:?}");
    let nodes = fixture.json["nodes"].as_array_mut().unwrap();
    nodes.push(json!({"name": "still", "matrix": matrix.to_cols_array(), "extras": 1}));
    let still = nodes.len() - 1;
    fixture.json["skins"][0]["joints"].as_array_mut().unwrap().push(json!(still));
    fixture.json["skins"][0].as_object_mut().unwrap().remove("inverseBindMatrices");
    let opened = OpenedFile::alone("matrix.glb", &fixture.glb());
    let bone = opened.model.animation.skeleton.find("still").unwrap() as usize;
    let mut takes = opened.takes();
    take_mut(&mut takes, 0).tracks[bone].rotation = moving_track().rotation;
    let saved = opened.saved(&takes, &NoFiles);
    assert_eq!(saved.changes.nodes, [still as u32]);
    let node = &saved.json()["nodes"][still];
    assert!(node.get("matrix").is_none() && node["translation"][0] == 4.0 && node["extras"] == 1, "{node}");
}
