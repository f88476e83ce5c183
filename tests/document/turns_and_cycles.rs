//! Full turns and cycles of keys are made as keys, and undone to the bit.

use dragonfly_anim::data::{Interpolation, Take};
use dragonfly_anim::sample::sample_channel;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{
    BoneRef, Edit, KeyInterpolation, KeySet, Property, RepeatCount, RepeatKeys, RepeatMode, SetInterpolation,
    TakeRef, TurnKeys, TurnWay,
};
use dragonfly_document::history::Edited;
use dragonfly_document::{Cancel, Source, load_model};
use dragonfly_kit::folder::data;
use glam::{Quat, Vec3};
use std::sync::Arc;

fn fox() -> Edited {
    let source = Source::File(data("gltf/Fox.glb"));
    let loaded = load_model(&source, &mut |_| {}, &Cancel::default()).unwrap();
    Edited::new(ModelAdapter::new(&loaded.model.animation))
}

fn name() -> TakeRef {
    TakeRef::Name("Walk".to_owned())
}

fn walk(edited: &Edited) -> Arc<Take> {
    Arc::clone(&edited.adapter().slots().iter().find(|slot| slot.result.name == "Walk").unwrap().result)
}

/// Returns the rotation keys of a bone up to a time.
fn keys(bone: u32, to: Option<f32>) -> Vec<KeySet> {
    let (bones, properties) = (vec![BoneRef::Index(bone)], vec![Property::Rotation]);
    vec![KeySet { bones, properties, to, ..KeySet::default() }]
}

fn bone(take: &Take) -> u32 {
    take.tracks.iter().find(|track| track.rotation.len() > 8).unwrap().bone
}

/// Returns how far a bone turns in a take, degrees, summed from sample to sample.
fn turned(take: &Take, bone: u32, [from, to]: [f32; 2]) -> f64 {
    let rotation = &take.tracks[bone as usize].rotation;
    let at = |step: u32| {
        let time = from + (to - from) * step as f32 / 2000.0;
        sample_channel(rotation, Quat::IDENTITY, time).as_dquat().normalize()
    };
    let step = |step: u32| {
        let by = at(step).conjugate() * at(step + 1);
        2.0 * by.xyz().length().atan2(by.w.abs()).to_degrees()
    };
    (0..2000).map(step).sum()
}

#[test]
fn a_bone_turns_the_typed_number_of_times_between_two_keys_and_undo_restores_the_bits() {
    for interpolation in [KeyInterpolation::Linear, KeyInterpolation::CubicSpline] {
        let mut edited = fox();
        let bone = bone(&walk(&edited));
        let set = SetInterpolation { take: name(), bones: Vec::new(), properties: Vec::new(), interpolation };
        let _ = edited.ask(Edit::SetInterpolation(set), None);
        let before = walk(&edited);
        let times = before.tracks[bone as usize].rotation.times.clone();
        let pair = [times[2], times[3]];
        let mut chosen = keys(bone, Some(pair[1]));
        chosen[0].from = Some(pair[0]);
        let way = TurnWay::Full { turns: 3, axis: [0.0, 1.0, 0.0] };
        edited.ask(Edit::TurnKeys(TurnKeys { take: name(), keys: chosen, way }), None).unwrap();
        let after = walk(&edited);
        let more = turned(&after, bone, pair) - turned(&before, bone, pair);
        assert!((more - 3.0 * 360.0).abs() < 15.0, "{interpolation:?}: {more}° more");
        let rotation = &after.tracks[bone as usize].rotation;
        for (key, &time) in times.iter().enumerate() {
            let at = rotation.times.iter().position(|&other| other == time).expect("the keys stay");
            let [old, new] =
                [before.tracks[bone as usize].rotation.value(key), rotation.value(at)].map(Option::unwrap);
            assert!(old == new || old == -new, "key {key}");
        }
        assert!(edited.undo());
        assert_eq!(walk(&edited), before);
    }
}

#[test]
fn keys_are_repeated_until_the_end_of_the_take_and_the_take_keeps_its_length() {
    for mode in [RepeatMode::Repeat, RepeatMode::Offset, RepeatMode::Mirror] {
        let mut edited = fox();
        let before = walk(&edited);
        let bone = bone(&before);
        let old = before.tracks[bone as usize].rotation.clone();
        let [start, cut] = [old.times[0], old.times[4]];
        let repeat = |after| {
            let before = RepeatCount::Times(0);
            Edit::RepeatKeys(RepeatKeys { take: name(), keys: keys(bone, Some(cut)), mode, before, after })
        };
        edited.ask(repeat(RepeatCount::Take), None).unwrap();
        let after = walk(&edited);
        assert_eq!((after.start, after.end()), (before.start, before.end()), "{mode:?}");
        let new = &after.tracks[bone as usize].rotation;
        assert!((new.times.last().unwrap() - before.end()).abs() < 1e-5);
        assert_eq!(new.interpolation, Interpolation::Linear);
        let period = cut - start;
        let by = old.value(4).unwrap() * old.value(0).unwrap().conjugate();
        for part in [0.3, 0.6] {
            let (inside, later) = (start + period * part, start + period * (1.0 + part));
            let [first, now] = [inside, later].map(|time| sample_channel(new, Quat::IDENTITY, time));
            let back = sample_channel(new, Quat::IDENTITY, cut - period * part);
            let wanted = match mode {
                RepeatMode::Repeat => continue,
                RepeatMode::Offset => by * first,
                RepeatMode::Mirror => back,
            };
            assert!(wanted.dot(now).abs() > 0.999_99, "{mode:?} at {part}");
        }
        assert!(edited.undo());
        assert_eq!(walk(&edited), before);
        edited.ask(repeat(RepeatCount::Times(5)), None).unwrap();
        let end = *walk(&edited).tracks[bone as usize].rotation.times.last().unwrap();
        assert!((end - (start + 6.0 * period)).abs() < 1e-4, "{mode:?}: {end}");
    }
}

#[test]
fn what_cannot_be_turned_or_repeated_is_refused_with_the_reason() {
    let mut edited = fox();
    let bone = bone(&walk(&edited));
    let way = TurnWay::Full { turns: 0, axis: Vec3::Y.to_array() };
    for (edit, reason) in [
        (Edit::TurnKeys(TurnKeys { take: name(), keys: keys(bone, None), way }), "number of turns"),
        (
            Edit::RepeatKeys(RepeatKeys {
                take: name(),
                keys: keys(bone, Some(0.0)),
                mode: RepeatMode::Repeat,
                before: RepeatCount::Times(0),
                after: RepeatCount::Times(2),
            }),
            "two selected keys",
        ),
    ] {
        let error = edited.ask(edit, None).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}
