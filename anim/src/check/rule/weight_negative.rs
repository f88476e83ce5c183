//! Negative weights, which push a vertex away from its bone.

use crate::check::channels::primitives;
use crate::check::{Findings, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, path) in primitives(model) {
        let vertices = &primitive.vertices;
        let each = vertices.influences_per_vertex.max(1);
        for (at, influence) in vertices.influences.iter().enumerate().filter(|(_, i)| i.weight < 0.0) {
            let text = || format!("the weight of joint {} is {}", influence.joint, influence.weight);
            findings.add(|| (path().then(PathKind::Vertex, at / each, ""), text()));
        }
    }
}
