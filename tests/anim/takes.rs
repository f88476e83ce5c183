//! Random edits of takes, and the comparison of models by their poses: for the tests of formats that save takes.

use dragonfly_anim::data::{Channel, Interpolation, ModelData, Take};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{EditedTake, Format, NoFiles, ReadOptions, SavePlan};
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec3};
use std::path::PathBuf;
use std::sync::Arc;

/// Returns the files of a folder of `tests/data`, and those of the same folder of the collection of models if it is there.
pub(crate) fn files_of(folder: &str) -> Vec<PathBuf> {
    let folders = [
        Some(crate::doors::data().join(folder)),
        dragonfly_kit::skip::models().map(|models| models.join(folder)),
    ];
    let mut found: Vec<PathBuf> = folders
        .into_iter()
        .flatten()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .collect();
    found.sort();
    found
}

/// Returns the model in the bytes of a file without neighbors.
pub(crate) fn imported(format: &Format, bytes: &[u8]) -> ModelData {
    format.import(bytes, &NoFiles, &ReadOptions::default()).unwrap().model
}

/// Returns the takes of a model as they were opened.
pub(crate) fn opened_takes(model: &ModelData) -> Vec<EditedTake> {
    let takes = model.animation.takes.iter().enumerate();
    takes.map(|(index, take)| EditedTake { origin: Some(index), take: Arc::clone(take) }).collect()
}

/// Plans a save of `takes` into a file.
pub(crate) fn plan(format: &Format, bytes: &[u8], opened: &ModelData, takes: &[EditedTake]) -> SavePlan {
    let file = format.edit("a", bytes, &NoFiles, &ReadOptions::default()).unwrap();
    file.plan(opened, takes).unwrap()
}

/// Returns the takes of a model, one of them changed.
pub(crate) fn edited(model: &ModelData, index: usize, change: impl FnOnce(&mut Take)) -> Vec<EditedTake> {
    let mut takes = opened_takes(model);
    change(Arc::make_mut(&mut takes[index].take));
    takes
}

/// Returns a model with these takes.
pub(crate) fn with_takes(model: &ModelData, takes: &[EditedTake]) -> ModelData {
    let mut model = model.clone();
    model.animation.takes = takes.iter().map(|edited| Arc::clone(&edited.take)).collect();
    model
}

/// Returns the value of each key of a channel, changed.
pub(crate) fn change_key<T: Copy>(channel: &mut Channel<T>, key: usize, change: impl FnOnce(T) -> T) {
    let mut values = channel.values.to_vec();
    values[key] = change(values[key]);
    *channel = Channel::new(Arc::clone(&channel.times), values, Interpolation::Linear);
}

/// Removes a key.
pub(crate) fn remove_key<T: Copy>(channel: &mut Channel<T>, key: usize) {
    let (mut times, mut values) = (channel.times.to_vec(), channel.values.to_vec());
    times.remove(key);
    values.remove(key);
    *channel = Channel::new(times, values, Interpolation::Linear);
}

/// Adds a key, unless there is one at this time.
pub(crate) fn add_key<T: Copy>(channel: &mut Channel<T>, time: f32, value: T) {
    let (mut times, mut values) = (channel.times.to_vec(), channel.values.to_vec());
    if let Err(place) = times.binary_search_by(|known| known.total_cmp(&time)) {
        times.insert(place, time);
        values.insert(place, value);
    }
    *channel = Channel::new(times, values, Interpolation::Linear);
}

/// Changes, adds or removes some keys of one track. New keys are at multiples of `step` seconds.
pub(crate) fn change_track(take: &mut Take, bone: usize, step: f32, random: &mut Random) {
    let track = &mut take.tracks[bone];
    for _ in 0..=random.below(4) {
        let axis = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.3).normalize();
        let turn = Quat::from_axis_angle(axis, random.between(-3.0, 3.0));
        let offset =
            Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        let time = (random.below(40) as f32) * step;
        let [turns, moves] = [track.rotation.len(), track.translation.len()];
        match random.below(7) {
            0 => add_key(&mut track.rotation, time, turn),
            1 => add_key(&mut track.translation, time, offset),
            2 => add_key(&mut track.scale, time, Vec3::ONE + 0.5 * offset.abs()),
            3 if turns > 1 => remove_key(&mut track.rotation, random.below(turns)),
            4 if moves > 1 => remove_key(&mut track.translation, random.below(moves)),
            5 if moves > 0 => change_key(&mut track.translation, random.below(moves), |value| value + offset),
            _ if turns > 0 => {
                change_key(&mut track.rotation, random.below(turns), |value| (value * turn).normalize());
            }
            _ => {}
        }
    }
    hemisphere(&mut track.rotation);
}

/// Negates rotations so that each is in the hemisphere of the one before, as importers do.
fn hemisphere(channel: &mut Channel<Quat>) {
    let mut values = channel.values.to_vec();
    for key in 1..values.len() {
        if values[key].dot(values[key - 1]) < 0.0 {
            values[key] = -values[key];
        }
    }
    *channel = Channel::new(Arc::clone(&channel.times), values, Interpolation::Linear);
}

/// Returns every time at which a take has a key.
pub(crate) fn key_times(take: &Take) -> Vec<f32> {
    let mut times: Vec<f32> = take.tracks.iter().flat_map(|track| track.key_times()).collect();
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

/// Returns the largest difference of the poses of two models in a take, relative to the largest number or 1.
pub(crate) fn pose_difference(a: &ModelData, b: &ModelData, take: usize, times: &[f32]) -> f32 {
    let [mut first, mut second] = [a, b].map(|model| Evaluator::new(Arc::new(model.clone())));
    let mut worst = 0.0_f32;
    for &time in times {
        first.pose(Some(take), time);
        second.pose(Some(take), time);
        let numbers = |evaluator: &Evaluator| -> Vec<f32> {
            evaluator.to_root().iter().flat_map(Mat4::to_cols_array).collect()
        };
        worst = worst.max(difference(&numbers(&first), &numbers(&second)));
    }
    worst
}

/// Returns the largest difference of two lists of numbers, relative to the largest number or 1.
pub(crate) fn difference(a: &[f32], b: &[f32]) -> f32 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(1.0_f32, |largest, number| largest.max(number.abs()));
    a.iter().zip(b).fold(0.0, |worst, (a, b)| worst.max((a - b).abs() / largest))
}

/// Returns the positions of all vertices that triangles use, in a take at a time.
pub(crate) fn used_positions(model: &Arc<ModelData>, take: Option<usize>, time: f32) -> Vec<Vec3> {
    let mut evaluator = Evaluator::new(Arc::clone(model));
    evaluator.pose(take, time);
    let mut used = Vec::new();
    for instance in 0..model.instances.len() {
        for (number, primitive) in evaluator.primitives(instance).iter().enumerate() {
            let mut all = vec![Vec3::ZERO; primitive.vertices.len()];
            evaluator.positions(instance, number, &mut all);
            let mut indices = primitive.indices.clone();
            indices.sort_unstable();
            indices.dedup();
            used.extend(indices.into_iter().map(|index| all[index as usize]));
        }
    }
    used
}

/// Returns the largest distance of one of about a hundred positions from the nearest of the others, relative to the size of
/// all.
pub(crate) fn distance_of_nearest(ours: &[Vec3], theirs: &[Vec3]) -> f32 {
    let size = ours.iter().fold(1e-3_f32, |size, position| size.max(position.abs().max_element()));
    let nearest =
        |position: &Vec3| theirs.iter().map(|other| position.distance(*other)).fold(f32::INFINITY, f32::min);
    ours.iter().step_by((ours.len() / 97).max(1)).map(nearest).fold(0.0, f32::max) / size
}

/// Returns the number of triangles whose corners are counter-clockwise seen from where their normals point to, and of the others.
pub(crate) fn windings(model: &ModelData) -> (usize, usize) {
    let (mut right, mut wrong) = (0, 0);
    for primitive in model.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        for corners in primitive.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| primitive.vertices.positions[corners[corner] as usize]);
            let normal: Vec3 =
                corners.iter().map(|&corner| primitive.vertices.normals[corner as usize]).sum();
            match (b - a).cross(c - a).dot(normal) {
                side if side > 0.0 => right += 1,
                side if side < 0.0 => wrong += 1,
                _ => {}
            }
        }
    }
    (right, wrong)
}

/// Returns the lines that differ between two texts, as pairs; both have the same number of lines.
pub(crate) fn changed_lines(before: &str, after: &str) -> Vec<(String, String)> {
    assert_eq!(before.lines().count(), after.lines().count());
    let pairs = before.lines().zip(after.lines()).filter(|(before, after)| before != after);
    pairs.map(|(before, after)| (before.to_owned(), after.to_owned())).collect()
}
