//! Tangents of many keys are computed at once, and undone to the bit.

use dragonfly_anim::data::{Interpolation, Take};
use dragonfly_anim::sample::sample_channel;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{
    BoneRef, Edit, KeySet, KeyTangents, Property, SetTangents, ShapeTangents, TakeRef,
};
use dragonfly_document::history::Edited;
use dragonfly_document::{Cancel, Source, load_model};
use dragonfly_kit::folder::data;
use std::sync::Arc;

fn fox() -> Edited {
    let source = Source::File(data("gltf/Fox.glb"));
    let loaded = load_model(&source, &mut |_| {}, &Cancel::default()).unwrap();
    Edited::new(ModelAdapter::new(&loaded.model.animation))
}

fn walk(edited: &Edited) -> Arc<Take> {
    Arc::clone(&edited.adapter().slots().iter().find(|slot| slot.result.name == "Walk").unwrap().result)
}

fn shape(keys: Vec<KeySet>, kind: KeyTangents) -> Edit {
    Edit::ShapeTangents(ShapeTangents { take: TakeRef::Name("Walk".to_owned()), keys, kind })
}

/// The first bone whose rotation has many keys.
fn bone(take: &Take) -> u32 {
    take.tracks.iter().find(|track| track.rotation.len() > 8).unwrap().bone
}

#[test]
fn clamped_tangents_make_a_spline_that_stays_between_the_keys() {
    let mut edited = fox();
    let before = walk(&edited);
    let bone = bone(&before);
    let keys = KeySet { bones: vec![BoneRef::Index(bone)], ..KeySet::default() };
    edited.ask(shape(vec![keys.clone()], KeyTangents::Clamped), None).unwrap();
    let after = walk(&edited);
    let [old, new] = [&before, &after].map(|take| &take.tracks[bone as usize].rotation);
    assert_eq!((new.interpolation, new.times.len()), (Interpolation::CubicSpline, old.times.len()));
    for key in 0..old.len() {
        assert_eq!(new.value(key), old.value(key), "the keys keep their values");
    }
    // Each number of a rotation is a curve of its own; normalization moves it a little.
    for key in 0..old.len() - 1 {
        let [a, b] = [key, key + 1].map(|key| old.value(key).unwrap().to_array());
        for part in 1..10 {
            let time = old.times[key] + (old.times[key + 1] - old.times[key]) * part as f32 / 10.0;
            let now = sample_channel(new, old.value(0).unwrap(), time).to_array();
            for at in 0..4 {
                let (low, high) = (a[at].min(b[at]), a[at].max(b[at]));
                assert!((low - 2e-3..=high + 2e-3).contains(&now[at]), "key {key}: {now:?} {a:?} {b:?}");
            }
        }
    }
    // The second time nothing changes, which is an error with its reason.
    let error = edited.ask(shape(vec![keys], KeyTangents::Clamped), None).unwrap_err();
    assert!(error.to_string().contains("these tangents already"), "{error}");
    assert!(edited.undo());
    assert_eq!(walk(&edited), before);
}

#[test]
fn only_the_tangents_of_the_selected_keys_change_in_a_spline() {
    let mut edited = fox();
    let bone = bone(&walk(&edited));
    let all = KeySet { bones: vec![BoneRef::Index(bone)], ..KeySet::default() };
    edited.ask(shape(vec![all.clone()], KeyTangents::Auto), None).unwrap();
    let before = walk(&edited);
    let some = KeySet { from: Some(0.2), to: Some(0.5), ..all };
    edited.ask(shape(vec![some], KeyTangents::Flat), None).unwrap();
    let after = walk(&edited);
    let [old, new] = [&before, &after].map(|take| &take.tracks[bone as usize].rotation);
    let mut flat = 0;
    for (key, time) in new.times.iter().enumerate() {
        let [was, is] = [old, new].map(|channel| &channel.values[key * 3..key * 3 + 3]);
        if (0.2 - 1e-4..=0.5 + 1e-4).contains(time) {
            assert_eq!([is[0].to_array(), is[2].to_array()], [[0.0; 4]; 2], "key {key}");
            flat += 1;
        } else {
            assert_eq!(is, was, "key {key}");
        }
    }
    assert!(flat > 2, "{flat} keys");
}

#[test]
fn broken_tangents_are_unified_to_their_mean() {
    let mut edited = fox();
    let bone = bone(&walk(&edited));
    let keys = KeySet { bones: vec![BoneRef::Index(bone)], ..KeySet::default() };
    edited.ask(shape(vec![keys.clone()], KeyTangents::Flat), None).unwrap();
    let time = walk(&edited).tracks[bone as usize].rotation.times[3];
    let broken = SetTangents {
        take: TakeRef::Name("Walk".to_owned()),
        time,
        bone: BoneRef::Index(bone),
        property: Property::Rotation,
        arrive: Some(vec![1.0, 0.0, 0.0, 2.0]),
        leave: Some(vec![3.0, 0.0, 0.0, -1.0]),
    };
    edited.ask(Edit::SetTangents(broken), None).unwrap();
    edited.ask(shape(vec![keys], KeyTangents::Unified), None).unwrap();
    let rotation = walk(&edited).tracks[bone as usize].rotation.clone();
    assert_eq!(rotation.values[9].to_array(), [2.0, 0.0, 0.0, 0.5]);
    assert_eq!(rotation.values[11].to_array(), [2.0, 0.0, 0.0, 0.5]);
}
