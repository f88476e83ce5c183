//! A sequence of OBJ files: one for each frame of a take.

use super::write::{shapes, write};
use crate::data::ModelData;
use crate::evaluator::Evaluator;
use crate::format::losses::avatar_lost;
use crate::format::{ExportError, OutputFile, SavePlan};
use crate::frames::frames_within;
use std::sync::Arc;
use thiserror::Error;

/// Largest size of all files together, bytes: they are made in memory.
const MOST_BYTES: u64 = 1 << 30;

/// Error of a sequence that is too large.
#[derive(Debug, Error)]
#[error("{frames} frames of {bytes} bytes each are too many; use fewer frames per second")]
struct TooManyFrames {
    frames: u64,
    bytes: u64,
}

/// Returns the files of the first take at `rate` frames per second: images and materials once, `<stem>_0000.obj` for the first
/// frame and so on, and `<stem>.obj` with the pose at the start, where `name` is `<stem>.obj`. Without a take, or at a rate that is
/// not positive, only the last one.
///
/// # Errors
///
/// All files together would have more than 1 GiB.
pub fn write_sequence(model: &ModelData, name: &str, rate: f32) -> Result<SavePlan, ExportError> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let mut evaluator = Evaluator::new(Arc::new(model.clone()));
    let take = model.animation.takes.first();
    let (start, length) = take.map_or((0.0, 0.0), |take| (take.start, f64::from(take.length)));
    evaluator.pose(take.map(|_| 0), start);
    let mut plan = write(&evaluator, stem);
    plan.lost.extend(avatar_lost(model));
    if take.is_none() || !(rate.is_finite() && rate > 0.0) {
        return Ok(plan);
    }
    let Some(main) = plan.files.pop() else { return Ok(plan) };
    let frames = frames_within(length, f64::from(rate)) as u64;
    let bytes = main.bytes.len() as u64;
    if frames.saturating_mul(bytes) > MOST_BYTES {
        return Err(ExportError::new(TooManyFrames { frames, bytes }));
    }
    for frame in 0..frames {
        let time = f64::from(start) + frame as f64 / f64::from(rate);
        evaluator.pose(Some(0), time as f32);
        let name = format!("{stem}_{frame:04}.obj");
        plan.files.push(OutputFile { name, bytes: shapes(&evaluator, stem) });
    }
    plan.files.push(main);
    Ok(plan)
}
