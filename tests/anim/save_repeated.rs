//! Many saves leave a file no larger than one save, and unused remains can be removed.

use crate::doors::{MemoryFs, data};
use crate::fixture::{Fixture, accessor};
use crate::save_edits::shift;
use crate::save_support::{OpenedFile, Over, bin_of, rest_stays, same_scene, same_takes, take_mut};
use dragonfly_anim::data::Channel;
use dragonfly_anim::format::gltf::save::compact;
use dragonfly_anim::format::{AssetFs, NoFiles};

fn fox_bytes() -> Vec<u8> {
    std::fs::read(data().join("gltf/Fox.glb")).unwrap()
}

#[test]
fn ten_saves_of_the_same_channel_are_as_large_as_one() {
    let fixture = Fixture::new();
    for (name, bytes) in [
        ("a.glb", fox_bytes()),
        ("b.glb", fixture.glb()),
        ("c.gltf", fixture.gltf()),
        ("d.gltf", fixture.gltf_with_file()),
    ] {
        let door = MemoryFs::with(&[("all.bin", &fixture.bin)]);
        let mut opened = OpenedFile::new(name, &bytes, &door).unwrap();
        let (mut size, mut files) = (None, Vec::new());
        for save in 0..10 {
            let mut takes = opened.takes();
            shift(&mut takes, 0);
            let over = Over::new(&files, &door);
            let saved = opened.saved(&takes, &over);
            let lengths: Vec<usize> = saved.files.iter().map(|file| file.bytes.len()).collect();
            assert_eq!(*size.get_or_insert(lengths.clone()), lengths, "{name}, save {save}");
            files.clone_from(&saved.files);
            opened = saved.opened;
        }
    }
}

#[test]
fn room_freed_by_an_edit_is_reused_by_the_next_one() {
    let mut opened = OpenedFile::alone("Fox.glb", &fox_bytes());
    let mut sizes = Vec::new();
    let first =
        opened.model.animation.takes[0].tracks.iter().position(|track| track.rotation.len() > 4).unwrap();
    let original = opened.takes();
    for save in 0..12 {
        let mut takes = opened.takes();
        let track = &mut take_mut(&mut takes, 0).tracks[first];
        // Off, on, off: one save reuses what the previous one freed.
        track.rotation = match save % 2 {
            0 => Channel::default(),
            _ => original[0].take.tracks[first].rotation.clone(),
        };
        opened = opened.saved(&takes, &NoFiles).opened;
        sizes.push(opened.source.bytes().len());
    }
    println!("{sizes:?}");
    assert_eq!(sizes[3], sizes[11]);
}

#[test]
fn a_growing_channel_at_the_end_of_the_buffer_grows_in_place() {
    let mut opened = OpenedFile::alone("Fox.glb", &fox_bytes());
    let bin = bin_of(opened.source.bytes()).len();
    for keys in 2..40 {
        let mut takes = opened.takes();
        let times: Vec<f32> = (0..keys).map(|key| key as f32 * 0.1).collect();
        let values: Vec<glam::Vec3> = (0..keys).map(|key| glam::Vec3::splat(key as f32)).collect();
        take_mut(&mut takes, 0).tracks[4].scale = Channel::new(times, values, Default::default());
        opened = opened.saved(&takes, &NoFiles).opened;
    }
    let grown = bin_of(opened.source.bytes()).len() - bin;
    println!("{grown} bytes for 39 keys of 16");
    // Each channel needs new room while the other one follows it; the room before is reused.
    assert!(grown < 39 * 16 * 8, "{grown}");
    let plan = compact(&opened.source).unwrap();
    let compacted = OpenedFile::alone("Fox.glb", &plan.write()[0].bytes);
    same_takes(&opened.model, &opened.takes(), &compacted.model);
    assert_eq!(bin_of(compacted.source.bytes()).len() - bin, 39 * 16);
}

#[test]
fn compacting_removes_only_unused_data() {
    let mut fixture = Fixture::new();
    // A sampler without the range of its times is not one to take over accessors from.
    for (name, time) in [("min", 0.0), ("max", 1.0)] {
        fixture.set(&format!("/accessors/{}/{name}", accessor::TIMES), serde_json::json!([time]));
    }
    let door = MemoryFs::with(&[("all.bin", &fixture.bin)]);
    for (name, bytes) in [
        ("a.glb", fox_bytes()),
        ("b.glb", fixture.glb()),
        ("c.gltf", fixture.gltf()),
        ("d.gltf", fixture.gltf_with_file()),
    ] {
        let opened = OpenedFile::new(name, &bytes, &door).unwrap();
        assert!(
            compact(&opened.source).unwrap().changes().is_empty(),
            "the file has nothing that a save appended"
        );
        let mut takes = opened.takes();
        shift(&mut takes, 0);
        // And one more channel, which is removed again.
        let bone = takes[0].take.tracks.iter().position(|track| track.scale.is_empty()).unwrap();
        take_mut(&mut takes, 0).tracks[bone].scale = crate::save_edits::moving_track().scale;
        let once = opened.saved(&takes, &door);
        let over = Over::new(&once.files, &door);
        let mut takes = once.opened.takes();
        take_mut(&mut takes, 0).tracks[bone].scale = Channel::default();
        let twice = once.opened.saved(&takes, &over);
        let over = Over::new(&twice.files, &over);
        let plan = compact(&twice.opened.source).unwrap();
        println!("{name}\n{}", plan.changes());
        assert!(plan.changes().bytes_removed > 0);
        let files = plan.write();
        rest_stays(twice.bytes(), &files.last().unwrap().bytes, plan.changes());
        let over = Over::new(&files, &over as &dyn AssetFs);
        let again = OpenedFile::new(name, &files.last().unwrap().bytes, &over).unwrap();
        same_scene(&twice.opened.model, &again.model);
        same_takes(&twice.opened.model, &twice.opened.takes(), &again.model);
        assert!(compact(&again.source).unwrap().changes().is_empty(), "the second time nothing changes");
        // All edits are undone: after compacting, no appended number is left.
        let mut takes = again.takes();
        take_mut(&mut takes, 0).tracks.iter_mut().for_each(|track| track.translation = Channel::default());
        let back = again.saved(&takes, &over);
        let over = Over::new(&back.files, &over);
        let plan = compact(&back.opened.source).unwrap();
        let files = plan.write();
        let last = Over::new(&files, &over);
        let last = OpenedFile::new(name, &files.last().unwrap().bytes, &last).unwrap();
        same_takes(&back.opened.model, &back.opened.takes(), &last.model);
    }
}

#[test]
fn an_accessor_that_has_our_mark_but_not_our_form_is_not_overwritten() {
    // Everything in the file has the mark, and still nothing of it is overwritten.
    let mut fixture = Fixture::new();
    for list in ["accessors", "bufferViews"] {
        for item in fixture.json[list].as_array_mut().unwrap() {
            item["name"] = dragonfly_anim::format::gltf::save::MARK.into();
        }
    }
    let opened = OpenedFile::alone("liar.glb", &fixture.glb());
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    // Meshes, skins and the other channels keep their numbers: `saved` compares them.
    let saved = opened.saved(&takes, &NoFiles);
    let mut takes = saved.opened.takes();
    takes.push(takes[0].clone());
    shift(&mut takes, 0);
    saved.opened.saved(&takes, &NoFiles);
    compact(&opened.source).unwrap();
}

/// Returns the fixture, saved once, with its JSON changed by another program.
fn changed_by_another_program(change: impl Fn(&mut serde_json::Value)) -> OpenedFile {
    let opened = OpenedFile::alone("a.glb", &Fixture::new().glb());
    let mut takes = opened.takes();
    shift(&mut takes, 0);
    let saved = opened.saved(&takes, &NoFiles);
    let (mut json, bin) = (saved.json(), bin_of(saved.bytes()));
    change(&mut json);
    OpenedFile::alone("a.glb", &crate::fixture::glb(json.to_string().as_bytes(), Some(&bin)))
}

#[test]
fn data_with_references_from_another_program_is_not_overwritten() {
    let last = |json: &serde_json::Value, list: &str| json[list].as_array().unwrap().len() - 1;
    type ForeignChange<'a> = (&'a str, Box<dyn Fn(&mut serde_json::Value) + 'a>, bool);
    let ways: Vec<ForeignChange> = vec![
        ("nobody", Box::new(|_| ()), true),
        (
            "a view over the same bytes",
            Box::new(|json| {
                let mut view = json["bufferViews"][last(json, "bufferViews")].clone();
                view["name"] = "other".into();
                view["byteOffset"] = (view["byteOffset"].as_u64().unwrap() + 4).into();
                view["byteLength"] = 4.into();
                json["bufferViews"].as_array_mut().unwrap().push(view);
            }),
            false,
        ),
        (
            "an extension's own range",
            Box::new(|json| {
                let view = json["bufferViews"][last(json, "bufferViews")].clone();
                let range =
                    serde_json::json!({"buffer": 0, "byteOffset": view["byteOffset"], "byteLength": 4});
                json["bufferViews"][0]["extensions"] = serde_json::json!({"EXT_of_another_program": range});
            }),
            false,
        ),
        (
            "another accessor over the view",
            Box::new(|json| {
                let accessor = json["accessors"][last(json, "accessors")].clone();
                json["accessors"].as_array_mut().unwrap().push(accessor);
            }),
            false,
        ),
        (
            "an attribute of an extension",
            Box::new(|json| {
                let accessor = last(json, "accessors");
                json["nodes"][0]["extensions"] =
                    serde_json::json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": accessor}}});
            }),
            false,
        ),
        (
            "another take",
            Box::new(|json| {
                let copy = json["animations"][0].clone();
                json["animations"].as_array_mut().unwrap().push(copy);
            }),
            false,
        ),
        (
            "an accessor that reads shorts",
            Box::new(|json| {
                let accessor = last(json, "accessors");
                json["accessors"][accessor]["sparse"] = serde_json::json!({"count": 1,
                    "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 0}});
            }),
            false,
        ),
    ];
    for (who, change, may) in ways {
        let opened = changed_by_another_program(change);
        let mut takes = opened.takes();
        shift(&mut takes, 0);
        let saved = opened.saved(&takes, &NoFiles);
        assert_eq!(saved.changes.bytes_reused > 0, may, "{who}: {}", saved.changes);
        let compacted = compact(&opened.source).unwrap().write().remove(0).bytes;
        let compacted = OpenedFile::alone("a.glb", &compacted);
        same_takes(&opened.model, &opened.takes(), &compacted.model);
    }
}
