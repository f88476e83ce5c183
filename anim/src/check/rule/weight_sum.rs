//! Weights that leave a part of the vertex in the origin, or move it too far.

use crate::check::column::primitives;
use crate::check::{Findings, Kind};
use crate::data::ModelData;

/// How far from 1 a sum may be: what weights of 8 bits lose is less.
const TOLERANCE: f32 = 4e-3;

pub(crate) fn look(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, place) in primitives(model) {
        for vertex in 0..primitive.vertices.len() {
            let influences = primitive.vertices.influences_of(vertex);
            let sum: f32 = influences.iter().map(|influence| influence.weight).sum();
            if !influences.is_empty() && (sum - 1.0).abs() > TOLERANCE && sum.is_finite() {
                findings
                    .add(|| (place().then(Kind::Vertex, vertex, ""), format!("the weights sum to {sum}")));
            }
        }
    }
}
