//! Triangles that are a line or a point.

use crate::check::channels::primitives;
use crate::check::{Findings, PathKind};
use crate::data::ModelData;

/// Twice the area, relative to the square of the longest side.
const SMALLEST: f64 = 1e-9;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, path) in primitives(model) {
        let position = |index: u32| primitive.vertices.positions.get(index as usize).map(|p| p.as_dvec3());
        for (number, corners) in primitive.indices.chunks_exact(3).enumerate() {
            let corners = [corners[0], corners[1], corners[2]];
            let [Some(a), Some(b), Some(c)] = corners.map(position) else { continue };
            let (one, other) = (b - a, c - a);
            let longest = one.length_squared().max(other.length_squared()).max((c - b).length_squared());
            if one.cross(other).length() <= SMALLEST * longest {
                let text = || format!("vertices {corners:?} lie on one line");
                findings.add(|| (path().then(PathKind::Triangle, number, ""), text()));
            }
        }
    }
}
