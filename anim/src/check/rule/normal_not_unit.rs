//! Normals that are not of unit length and make a surface too bright or too dark.

use crate::check::channels::primitives;
use crate::check::measure::UNIT_TOLERANCE;
use crate::check::{Findings, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, path) in primitives(model) {
        for (vertex, normal) in primitive.vertices.normals.iter().enumerate() {
            let length = normal.length();
            if length.is_finite() && (length - 1.0).abs() > UNIT_TOLERANCE {
                let text = format!("the normal has length {length}");
                findings.add(|| (path().then(PathKind::Vertex, vertex, ""), text));
            }
        }
    }
}
