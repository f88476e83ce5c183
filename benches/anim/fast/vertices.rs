//! Works on the vertices of one character.

use super::Ready;
use crate::case::Case;
use crate::inputs::{INFLUENCES, primitive};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{SkinnedVertices, skin_vertices};
use std::hint::black_box;

pub(super) fn skinning(ready: &'static Ready, level: SimdLevel) -> [Case; 3] {
    let subject = ready.subject;
    let count = subject.primitive().vertices.len();
    INFLUENCES.map(|most| {
        Case::new(level.name(), format!("skin/{}/{most}", subject.name), count, "vertex", move || {
            let vertices = SkinnedVertices::new(&primitive(subject, most));
            let finals = ready.finals();
            let (mut positions, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
            move || {
                skin_vertices(level, &vertices, &finals, &mut positions, &mut normals);
                black_box((&positions, &normals));
            }
        })
    })
}
