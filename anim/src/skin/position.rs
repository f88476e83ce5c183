//! Positions: `positionN = Σ final[index_i] * positionO * weight_i` (thesis §2.1.4).

use super::{Movement, final_of, morphed};
use crate::data::{Influence, Primitive};
use glam::{Mat4, Vec3};

/// Moves vertices of `primitive` to scene space, up to the length of `out`.
///
/// `morph_weights`: one per morph target; missing ones count as 0. Returns the number of positions written. Allocates
/// nothing.
#[doc(alias = "linear blend skinning")]
pub fn skin_positions(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    out: &mut [Vec3],
) -> usize {
    let stored = &primitive.vertices.positions;
    for (index, (&stored, out)) in stored.iter().zip(out.iter_mut()).enumerate() {
        *out = moved(primitive, movement, morph_weights, index, stored);
    }
    stored.len().min(out.len())
}

/// Returns the position of vertex `index` of `primitive` in scene space: [`skin_positions`] for one vertex; `None` past
/// the end.
pub fn skin_position(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    index: usize,
) -> Option<Vec3> {
    let stored = *primitive.vertices.positions.get(index)?;
    Some(moved(primitive, movement, morph_weights, index, stored))
}

/// Returns the contribution of one influence to the position of a vertex: `final[joint] * position * weight`, scene
/// space.
///
/// `finals` are the final poses of the skin, `position` that of the vertex after morphing. Zero without weight.
pub fn contribution(finals: &[Mat4], influence: Influence, position: Vec3) -> Vec3 {
    // Required for correctness: zero times a product that overflowed would be NaN.
    if influence.weight == 0.0 {
        return Vec3::ZERO;
    }
    final_of(finals, influence.joint).transform_point3(position) * influence.weight
}

fn moved(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    index: usize,
    stored: Vec3,
) -> Vec3 {
    let position = morphed(primitive, morph_weights, stored, |target| target.positions.get(index).copied());
    let moved = match movement {
        Movement::Rigid(matrix) => matrix.transform_point3(position),
        Movement::Skin(finals) => {
            let mut sum = Vec3::ZERO;
            for &influence in primitive.vertices.influences_of(index) {
                sum += contribution(finals, influence, position);
            }
            sum
        }
    };
    first_finite([moved, stored])
}

/// Returns the first of `candidates` without NaN or infinity; the origin when there is none.
fn first_finite(candidates: [Vec3; 2]) -> Vec3 {
    candidates.into_iter().find(|candidate| candidate.is_finite()).unwrap_or(Vec3::ZERO)
}
