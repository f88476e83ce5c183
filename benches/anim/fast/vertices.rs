//! Tasks on the vertices of one character.

use super::FastInputs;
use crate::case::BenchCase;
use crate::inputs::{INFLUENCES, primitive};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{SkinnedVertices, skin_vertices, skin_vertices_by_matrix};
use std::hint::black_box;

/// Normals exact and of unit length, and normals by the matrix.
const FUNCTIONS: [(&str, bool); 2] = [("skin", false), ("skin_by_matrix", true)];

pub(super) fn skinning(ready: &'static FastInputs, level: SimdLevel) -> Vec<BenchCase> {
    let cases = FUNCTIONS.into_iter().flat_map(|function| INFLUENCES.map(|most| (function, most)));
    cases.map(|((task, by_matrix), most)| case(ready, level, task, by_matrix, most)).collect()
}

fn case(ready: &'static FastInputs, level: SimdLevel, task: &str, by_matrix: bool, most: usize) -> BenchCase {
    let subject = ready.subject;
    let count = subject.primitive().vertices.len();
    BenchCase::new(level.name(), format!("{task}/{}/{most}", subject.name), count, "vertex", move || {
        let vertices = SkinnedVertices::new(&primitive(subject, most));
        let finals = ready.finals();
        let (mut positions, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let skin = if by_matrix { skin_vertices_by_matrix } else { skin_vertices };
        move || {
            skin(level, &vertices, &finals, &mut positions, &mut normals);
            black_box((&positions, &normals));
        }
    })
}
