//! Random edits: a saved and reopened file has exactly the edited takes, and saving it again changes nothing.

use crate::doors::data;
use crate::fixture::Fixture;
use crate::made::{rotation, vector};
use crate::save_support::{OpenedFile, take_mut};
use dragonfly_anim::data::{Channel, Interpolation, MorphTrack, Track};
use dragonfly_anim::format::gltf::save::compact;
use dragonfly_anim::format::{EditedTake, NoFiles};
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use std::sync::Arc;

fn times(random: &mut Random, count: usize) -> Arc<[f32]> {
    let mut time = random.unit();
    (0..count)
        .map(|_| {
            time += 0.01 + random.unit();
            time
        })
        .collect()
}

fn interpolation(random: &mut Random, keys: usize) -> Interpolation {
    let ways = [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline];
    // A spline of one key is written as that key.
    random.choice(&ways[..if keys > 1 { 3 } else { 2 }])
}

fn vectors(random: &mut Random, times: &Arc<[f32]>) -> Channel<Vec3> {
    let interpolation = interpolation(random, times.len());
    let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let values: Vec<Vec3> = (0..times.len() * parts).map(|_| vector(random, 10.0)).collect();
    Channel::new(times.clone(), values, interpolation)
}

/// Returns rotations as the importer leaves them: normalized, and neighbors in one hemisphere.
fn rotations(random: &mut Random, times: &Arc<[f32]>) -> Channel<Quat> {
    let interpolation = interpolation(random, times.len());
    let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let mut last: Option<Quat> = None;
    let values: Vec<Quat> = (0..times.len() * parts)
        .map(|_| {
            // One of a few exact ones, which the importer does not correct.
            let exact =
                [Quat::IDENTITY, Quat::from_xyzw(1.0, 0.0, 0.0, 0.0), Quat::from_xyzw(0.5, 0.5, 0.5, 0.5)];
            let mut turn = if parts == 1 { random.choice(&exact) } else { rotation(random) };
            if parts == 3 {
                turn = random.choice(&exact);
            } else if last.is_some_and(|last| last.dot(turn) < 0.0) {
                turn = -turn;
            }
            last = Some(turn);
            turn
        })
        .collect();
    Channel::new(times.clone(), values, interpolation)
}

/// Changes something in the takes at random.
fn edit(random: &mut Random, opened: &OpenedFile, takes: &mut Vec<EditedTake>) {
    let index = random.below(takes.len());
    let bones = opened.model.animation.skeleton.len();
    let bone = random.below(bones);
    let keys = 1 + random.below(6);
    let fresh = times(random, keys);
    match random.below(14) {
        0 => take_mut(takes, index).name = format!("take {} \"é\"", random.below(1000)),
        1 if takes.len() > 1 => _ = takes.remove(index),
        2 => takes.insert(random.below(takes.len() + 1), takes[index].clone()),
        3 => {
            let other = random.below(takes.len());
            takes.swap(index, other);
        }
        4 => {
            let mut take = (*takes[index].take).clone();
            take.name = "fresh".to_owned();
            takes.push(EditedTake { origin: None, take: Arc::new(take) });
        }
        5 => take_mut(takes, index).tracks[bone] = Track { bone: bone as u32, ..Track::default() },
        6 | 7 => take_mut(takes, index).tracks[bone].translation = vectors(random, &fresh),
        8 => take_mut(takes, index).tracks[bone].scale = vectors(random, &fresh),
        9 => take_mut(takes, index).tracks[bone].rotation = rotations(random, &fresh),
        10 => {
            // All with the same times.
            for track in &mut take_mut(takes, index).tracks {
                track.translation = vectors(random, &fresh);
            }
        }
        11 => {
            let with_targets =
                opened.model.instances.iter().position(|instance| !instance.morph_weights.is_empty());
            if let Some(instance) = with_targets {
                let targets = opened.model.instances[instance].morph_weights.len();
                let interpolation = interpolation(random, keys);
                let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
                let weights: Vec<f32> = (0..keys * targets * parts).map(|_| random.unit()).collect();
                let instance = instance as u32;
                let morph = MorphTrack {
                    instance,
                    targets: targets as u32,
                    times: fresh,
                    weights: weights.into(),
                    interpolation,
                };
                take_mut(takes, index).morphs = vec![morph];
            }
        }
        12 => take_mut(takes, index).morphs.clear(),
        _ => {
            let track = &mut take_mut(takes, index).tracks[bone];
            track.translation.values = track.translation.values.iter().map(|value| *value * 2.0).collect();
        }
    }
}

/// Saves after some edits, several times, each time starting from the saved file.
fn sessions(name: &str, bytes: &[u8], random: &mut Random, saves: usize) {
    let mut opened = OpenedFile::alone(name, bytes);
    for _ in 0..saves {
        let mut takes = opened.takes();
        for _ in 0..1 + random.below(5) {
            edit(random, &opened, &mut takes);
        }
        let saved = opened.saved(&takes, &NoFiles);
        let again = saved.opened.saved(&saved.opened.takes(), &NoFiles);
        assert!(again.bytes() == saved.bytes(), "saving again changes something");
        opened = saved.opened;
        if random.below(4) == 0 {
            let bytes = compact(&opened.source).unwrap().write().remove(0).bytes;
            let compacted = OpenedFile::alone(name, &bytes);
            crate::save_support::same_scene(&opened.model, &compacted.model);
            crate::save_support::same_takes(&opened.model, &opened.takes(), &compacted.model);
            opened = compacted;
        }
        crate::save_judges::crate_has_the_same_result(bytes, opened.source.bytes(), name);
    }
}

#[test]
fn any_edits_are_saved_and_opened_again() {
    let first = seed(81);
    println!("DRAGONFLY_SEED={first}");
    let fixture = Fixture::new();
    let fox = std::fs::read(data().join("gltf/Fox.glb")).unwrap();
    let pretty =
        serde_json::to_vec_pretty(&serde_json::from_slice::<serde_json::Value>(&fixture.gltf()).unwrap())
            .unwrap();
    for round in 0..60 {
        let mut random = Random::new(first + round);
        println!("round {round}");
        sessions("a.glb", &fixture.glb(), &mut random, 6);
        sessions("b.gltf", &pretty, &mut random, 6);
        if round % 6 == 0 {
            sessions("Fox.glb", &fox, &mut random, 4);
        }
    }
}
