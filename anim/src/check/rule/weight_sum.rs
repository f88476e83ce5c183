//! Weights whose sum is not 1: a part of the vertex stays at the origin, or it moves too far.

use crate::check::channels::primitives;
use crate::check::{Findings, PathKind};
use crate::data::ModelData;

/// Tolerance of a sum; weights of 8 bits lose less.
const TOLERANCE: f32 = 4e-3;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, path) in primitives(model) {
        for vertex in 0..primitive.vertices.len() {
            let influences = primitive.vertices.influences_of(vertex);
            let sum: f32 = influences.iter().map(|influence| influence.weight).sum();
            if !influences.is_empty() && (sum - 1.0).abs() > TOLERANCE && sum.is_finite() {
                findings
                    .add(|| (path().then(PathKind::Vertex, vertex, ""), format!("the weights sum to {sum}")));
            }
        }
    }
}
