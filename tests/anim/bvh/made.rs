//! Files and takes for the tests of the format.

use crate::doors::data;
use dragonfly_anim::data::{Channel, Interpolation, ModelData, Take};
use dragonfly_anim::format::{
    Conventions, EditedTake, ImportError, Imported, NoFiles, ReadOptions, SavePlan, bvh::BVH,
};
use glam::Quat;
use std::path::PathBuf;
use std::sync::Arc;

/// Two roots, names with blanks and colons and twice, positions on a joint that is no root, orders that differ, an end site
/// after a joint, a leaf without one, and rows over several lines.
pub(crate) const ODD: &str = "\
HIERARCHY
ROOT mixamorig:Hips
{
  OFFSET 0 94 0
  CHANNELS 6 Yposition Xposition Zposition Zrotation Xrotation Yrotation
  JOINT Left Arm {
    OFFSET 10 20 0
    CHANNELS 4 yROTATION XPOSITION Zrotation Xrotation
    JOINT Left Arm
    {
      CHANNELS 2 Xrotation Zrotation
      OFFSET 30 0 0
    }
    End Site
    {
      OFFSET 5 0 0
    }
  }
}
ROOT Prop
{
  OFFSET 1 2 3
  CHANNELS 3 Xrotation Xrotation Yrotation
}
MOTION
Frames : 3
Frame Time:   .0083333
 90.0 1.00 2.0   0 10.5 -20  15 12 7.25 0   -30 45   1 2 3
 91.0 1.50 2.5   359 11.5 -21
 16 12.5 8.25 0.5   -31 46   2 3 4

 92.0 2.00 3.0   +5e0 12.5 -22  17 13 9.25 1   -32 47   3 4 5
";

pub(crate) fn import(bytes: &[u8]) -> Result<Imported, ImportError> {
    BVH.import(bytes, &NoFiles, &ReadOptions::default())
}

/// Returns the options of a user who chooses meters, so that numbers are those of the file.
pub(crate) fn in_meters() -> ReadOptions<'static> {
    let conventions = Conventions { meters_per_unit: Some(1.0), ..Conventions::default() };
    ReadOptions { conventions, ..ReadOptions::default() }
}

pub(crate) fn import_in_meters(bytes: &[u8]) -> ModelData {
    BVH.import(bytes, &NoFiles, &in_meters()).unwrap().model
}

/// Returns the files in `tests/data/bvh`, and those of the collection of models if it is there.
pub(crate) fn files() -> Vec<PathBuf> {
    let folders = [Some(data().join("bvh")), dragonfly_kit::skip::models().map(|models| models.join("bvh"))];
    let mut found: Vec<PathBuf> = folders
        .into_iter()
        .flatten()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "bvh"))
        .collect();
    found.sort();
    found
}

/// Plans a save of `takes` into a file, in meters.
pub(crate) fn plan(bytes: &[u8], opened: &ModelData, takes: &[EditedTake]) -> SavePlan {
    let file = BVH.edit("a.bvh", bytes, &NoFiles, &in_meters()).unwrap();
    file.plan(opened, takes).unwrap()
}

/// Returns the take of a model, changed.
pub(crate) fn edited(model: &ModelData, change: impl FnOnce(&mut Take)) -> Vec<EditedTake> {
    let mut take = Take::clone(&model.animation.takes[0]);
    change(&mut take);
    vec![EditedTake { origin: Some(0), take: Arc::new(take) }]
}

/// Returns the saved text.
pub(crate) fn text(plan: &SavePlan) -> String {
    assert_eq!(plan.files.len(), 1);
    String::from_utf8(plan.files[0].bytes.clone()).unwrap()
}

/// Multiplies one key of a rotation channel by `turn`.
pub(crate) fn turn_key(channel: &mut Channel<Quat>, key: usize, turn: Quat) {
    let mut values = channel.values.to_vec();
    values[key] *= turn;
    *channel = Channel::new(Arc::clone(&channel.times), values, Interpolation::Linear);
}

/// Returns the largest difference of two models' poses at these times, relative to the largest number.
pub(crate) fn pose_difference(a: &ModelData, b: &ModelData, times: &[f32]) -> f32 {
    use dragonfly_anim::evaluator::Evaluator;
    let [mut first, mut second] = [a, b].map(|model| Evaluator::new(Arc::new(model.clone())));
    let mut worst = 0.0_f32;
    for &time in times {
        first.pose(Some(0), time);
        second.pose(Some(0), time);
        let numbers = |evaluator: &Evaluator| -> Vec<f32> {
            evaluator.to_root().iter().flat_map(glam::Mat4::to_cols_array).collect()
        };
        let (one, other) = (numbers(&first), numbers(&second));
        assert_eq!(one.len(), other.len());
        let largest = one.iter().fold(1.0_f32, |largest, number| largest.max(number.abs()));
        worst = one.iter().zip(&other).fold(worst, |worst, (a, b)| worst.max((a - b).abs() / largest));
    }
    worst
}
