//! A small model with every kind of channel, made in code, for tests of edits.

use crate::random::Random;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Interpolation, MorphTrack, Skeleton, Take, Track, Transform,
};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{BonePose, BoneRef, TakeRef};
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// Bones of the model: `root`, `hip`, `hand.L`, `hand.R`, `still`.
pub const BONES: [&str; 5] = ["root", "hip", "hand.L", "hand.R", "still"];

/// Returns three takes. The first has linear, step and cubic channels and morph weights, and one column of times for most
/// channels; the second has one key per channel; the third has two equal keys per channel, with step interpolation, as
/// exporters write channels that do not move.
pub fn animation(random: &mut Random) -> AnimationData {
    let bones = BONES.iter().enumerate().map(|(index, name)| Bone {
        name: (*name).to_owned(),
        parent: (index > 0).then_some(index as u32 / 2),
        rest: Transform { translation: Vec3::new(0.0, 1.0, 0.0), ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: Some(index as u32),
    });
    let skeleton = Arc::new(Skeleton { bones: bones.collect() });
    let times: Arc<[f32]> = (0..9).map(|key| key as f32 * 0.125).collect();
    let other: Arc<[f32]> = Arc::new([0.1, 0.4, 0.41, 0.9]);
    let one: Arc<[f32]> = Arc::new([0.0]);
    let walk = vec![
        track(random, 0, &times, Interpolation::Linear),
        track(random, 1, &times, Interpolation::CubicSpline),
        track(random, 2, &times, Interpolation::Step),
        track(random, 3, &other, Interpolation::Linear),
        Track { bone: 4, ..Track::default() },
    ];
    let wave = (0..5).map(|bone| track(random, bone, &one, Interpolation::Linear)).collect();
    let ends: Arc<[f32]> = Arc::new([0.0, 1.0]);
    let stand = (0..5).map(|bone| standing(track(random, bone, &ends, Interpolation::Step))).collect();
    let take = |name: &str, tracks, length, morphs| Take {
        name: name.to_owned(),
        start: 0.0,
        length,
        tracks,
        morphs,
        ..Take::default()
    };
    let morph = MorphTrack {
        instance: 0,
        targets: 2,
        times: Arc::clone(&times),
        weights: (0..18).map(|_| random.unit()).collect(),
        interpolation: Interpolation::Linear,
    };
    AnimationData {
        skeleton,
        takes: vec![
            Arc::new(take("walk", walk, 1.0, vec![morph])),
            Arc::new(take("wave", wave, 0.0, Vec::new())),
            Arc::new(take("stand", stand, 1.0, Vec::new())),
        ],
    }
}

fn track(random: &mut Random, bone: u32, times: &Arc<[f32]>, interpolation: Interpolation) -> Track {
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let count = times.len() * per_key;
    let vector = |random: &mut Random| {
        Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0))
    };
    let translation: Vec<Vec3> = (0..count).map(|_| vector(random)).collect();
    let scale: Vec<Vec3> = (0..count).map(|_| vector(random) * 0.25 + 1.0).collect();
    let rotation: Vec<Quat> = (0..count)
        .map(|at| {
            let turn = Quat::from_scaled_axis(vector(random) * 0.5);
            if per_key == 3 && at % 3 != 1 { turn * 0.1 } else { turn }
        })
        .collect();
    Track {
        bone,
        translation: Channel::new(Arc::clone(times), translation, interpolation),
        rotation: Channel::new(Arc::clone(times), rotation, interpolation),
        scale: Channel::new(Arc::clone(times), scale, interpolation),
    }
}

/// Returns the track with two keys per channel that are equal except for rounding.
fn standing(mut track: Track) -> Track {
    let near = |value: Vec3| value * (1.0 + 2e-7);
    track.translation.values = [track.translation.values[0], near(track.translation.values[0])].into();
    track.rotation.values = [track.rotation.values[0], -track.rotation.values[0]].into();
    track.scale.values = [track.scale.values[0], near(track.scale.values[0])].into();
    track
}

/// Returns the model of [`animation`] with the seed `number`, as an editable document.
pub fn model(number: u64) -> ModelAdapter {
    ModelAdapter::new(&animation(&mut Random::new(number)))
}

/// Returns a reference to the take "walk".
pub fn walk() -> TakeRef {
    TakeRef::Name("walk".to_owned())
}

/// Returns a reference to the bone named `name`.
pub fn bone(name: &str) -> BoneRef {
    BoneRef::Name(name.to_owned())
}

/// Returns a pose of the bone named `name` that sets no values yet.
pub fn pose(name: &str) -> BonePose {
    BonePose { bone: bone(name), translation: None, rotation: None, scale: None }
}
