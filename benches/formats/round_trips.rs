//! Largest distances between a model and what is read again after it was written in another format.
//!
//! A model without bones, and any model as OBJ, is compared by its vertices, each with the nearest one; others by the origins of
//! their bones. The distance is the largest one over times of all takes that the new file contains.

use crate::sources::{NeighborFiles, WrittenFiles, formats, models};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{Conventions, Format, ReadOptions};
use dragonfly_kit::figures::FigureBench;
use glam::Vec3;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

/// Shares of the length of a take at which models are compared.
const SHARES: [f32; 7] = [0.0, 0.1, 0.21, 1.0 / 3.0, 0.55, 0.8, 1.0];

/// Number of vertices whose nearest ones are looked for.
const VERTICES: usize = 400;

/// A difference between two models.
#[derive(Clone, Copy, Default)]
struct RoundTripError {
    /// Largest distance in meters.
    distance: f32,
    /// Size of the original, in meters.
    size: f32,
}

/// Measures all pairs of formats.
pub(crate) fn all(bench: &mut FigureBench) {
    let formats = formats();
    for path in models() {
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Some(original) = read(&path, &file) else { continue };
        let from = original.1.name;
        let model = Arc::new(original.0);
        for format in formats.iter().filter(|format| format.export.is_some()) {
            let task = format!("{from}/{}", format.name);
            if !bench.wants(&task) {
                continue;
            }
            match round_trip(&model, format) {
                Ok(Some(error)) => {
                    let millimeters = f64::from(error.distance) * 1e3;
                    bench.value(&task, &file, "largest", "mm", millimeters);
                    let relative = f64::from(error.distance / error.size.max(1e-6));
                    bench.value(&task, &file, "relative", "of the size", relative);
                }
                Ok(None) => {}
                Err(reason) => {
                    println!("{task}/{file}: {reason}");
                    bench.value(&task, &file, "refused", "files", 1.0);
                }
            }
        }
    }
}

fn read(path: &Path, name: &str) -> Option<(ModelData, Format)> {
    let bytes = std::fs::read(path).ok()?;
    let files = NeighborFiles(path.parent()?.to_owned());
    match formats().read(name, &bytes, &files, &ReadOptions::default()) {
        Ok(imported) => Some((imported.model, imported.format)),
        Err(error) => {
            println!("{name}: {error}");
            None
        }
    }
}

/// Writes a model, reads it again and compares; `None` if there is nothing to compare.
fn round_trip(model: &Arc<ModelData>, format: &Format) -> Result<Option<RoundTripError>, String> {
    let name = format!("again.{}", format.extension());
    let export = format.export.ok_or("not written")?;
    let plan = export(model, &name).map_err(|error| error.to_string())?;
    let has_vertices = |model: &ModelData| {
        let mut parts = model.meshes.iter().flat_map(|mesh| &mesh.primitives);
        parts.any(|part| !part.vertices.is_empty()) && !model.instances.is_empty()
    };
    if format.name == "obj" && !has_vertices(model) {
        return Ok(None);
    }
    let bytes = &plan.files.iter().find(|file| file.name == name).ok_or("no main file")?.bytes;
    // A BVH file does not contain the centimeters in which it is written.
    let unit = (format.name == "bvh").then_some(0.01);
    let conventions = Conventions { meters_per_unit: unit, ..Conventions::default() };
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    let again = format
        .import(bytes, &WrittenFiles(&plan.files), &options)
        .map_err(|error| format!("cannot be read again: {error}"))?;
    Ok(compared(model, &Arc::new(again.model)))
}

fn compared(model: &Arc<ModelData>, again: &Arc<ModelData>) -> Option<RoundTripError> {
    let mut pair = [model, again].map(|model| Evaluator::new(Arc::clone(model)));
    let by_vertices =
        [model, again].iter().any(|model| model.animation.skeleton.is_empty()) && !again.instances.is_empty();
    let names = pairs(model, again);
    let takes = again.animation.takes.len().min(model.animation.takes.len());
    let mut looks: Vec<(Option<usize>, Option<usize>, [f32; 2])> = Vec::new();
    for take in 0..takes {
        let played = &model.animation.takes[take];
        // BVH has no time before the first row.
        let start = again.animation.takes[take].start;
        let times = SHARES.map(|share| [played.start, start].map(|start| start + played.length * share));
        looks.extend(times.map(|times| (Some(take), Some(take), times)));
    }
    if looks.is_empty() {
        // A still model has the pose at the start of the first take, unless it has a rest pose of its own.
        let first = model.animation.takes.first().map(|take| take.start);
        let is_posed = again.animation.skeleton.is_empty();
        looks.push((first.filter(|_| is_posed).map(|_| 0), None, [first.unwrap_or(0.0); 2]));
    }
    let mut error = RoundTripError::default();
    for (ours, theirs, times) in looks {
        pair[0].pose(ours, times[0]);
        pair[1].pose(theirs, times[1]);
        let [before, after] = if by_vertices {
            pair.each_ref().map(used_positions)
        } else {
            pair.each_ref().map(|one| one.to_root().iter().map(|root| root.w_axis.truncate()).collect())
        };
        let distance = match &names {
            Some(names) if !by_vertices => {
                names.iter().map(|&(a, b)| before[a].distance(after[b])).fold(0.0, f32::max)
            }
            _ if by_vertices => nearest(&before, &after).max(nearest(&after, &before)),
            // Formats add bones, for tips and meshes, or leave out those that no skin needs.
            _ => nearest(&after, &before).min(nearest(&before, &after)),
        };
        let all = pair[0].bounds();
        let of_bones =
            before.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), &at| (low.min(at), high.max(at)));
        let extents = [all.max - all.min, of_bones.1 - of_bones.0];
        let size = extents.iter().filter(|extent| extent.is_finite()).map(|extent| extent.length());
        error.size = size.fold(error.size, f32::max);
        error.distance = error.distance.max(distance);
    }
    Some(error)
}

/// Returns the bones that correspond: those with the same name, which no other bone has, or all in order where the names are
/// the same in order; `None` where too few names stay.
fn pairs(model: &ModelData, again: &ModelData) -> Option<Vec<(usize, usize)>> {
    let (ours, theirs) = (&model.animation.skeleton.bones, &again.animation.skeleton.bones);
    if ours.iter().map(|bone| &bone.name).eq(theirs.iter().map(|bone| &bone.name)) {
        return Some((0..ours.len()).map(|bone| (bone, bone)).collect());
    }
    let numbers = |bones: &[dragonfly_anim::data::Bone]| {
        let mut numbers: HashMap<String, Option<usize>> = HashMap::new();
        for (number, bone) in bones.iter().enumerate() {
            numbers.entry(bone.name.clone()).and_modify(|known| *known = None).or_insert(Some(number));
        }
        numbers
    };
    let (ours, theirs) = (numbers(ours), numbers(theirs));
    let common: Vec<(usize, usize)> =
        ours.iter().filter_map(|(name, &number)| Some((number?, (*theirs.get(name)?)?))).collect();
    (common.len() * 2 > ours.len().min(theirs.len())).then_some(common)
}

/// Returns the positions of the vertices that triangles have: formats do not keep others.
fn used_positions(evaluator: &Evaluator) -> Vec<Vec3> {
    let mut all = Vec::new();
    for instance in 0..evaluator.model().instances.len() {
        for (number, primitive) in evaluator.primitives(instance).iter().enumerate() {
            let mut positions = vec![Vec3::ZERO; primitive.vertices.len()];
            evaluator.positions(instance, number, &mut positions);
            let used: BTreeSet<u32> = primitive.indices.iter().copied().collect();
            all.extend(used.into_iter().filter_map(|index| positions.get(index as usize)));
        }
    }
    all
}

/// Returns the largest distance of some of the points to the nearest of the others.
fn nearest(points: &[Vec3], others: &[Vec3]) -> f32 {
    let step = (points.len() / VERTICES).max(1);
    let to_nearest = |point: &Vec3| {
        others.iter().map(|other| point.distance_squared(*other)).fold(f32::INFINITY, f32::min).sqrt()
    };
    points.iter().step_by(step).map(to_nearest).fold(0.0, f32::max)
}
