//! The bounds of a model in a pose of one of its takes.

use super::Bounds;
use crate::data::ModelData;
use crate::evaluator::Evaluator;
use std::sync::Arc;

/// Returns the bounds of `model` at `time` seconds of take number `take`; `None` is the rest pose.
///
/// Poses the model for this call alone; for several calls, keep an [`Evaluator`] and call [`Evaluator::bounds`].
pub fn bounds_of_pose(model: &Arc<ModelData>, take: Option<usize>, time: f32) -> Bounds {
    let mut evaluator = Evaluator::new(Arc::clone(model));
    evaluator.pose(take, time);
    evaluator.bounds()
}
