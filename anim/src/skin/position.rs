//! Positions: `positionN = Σ final[index_i] * positionO * weight_i` (thesis §2.1.4).

use super::{Movement, final_of, morphed};
use crate::data::Primitive;
use glam::Vec3;

/// Moves the first vertices of `primitive`, as many as `out` has room for, to scene space.
///
/// `morph_weights`: one a morph target; missing ones count as 0. Returns how many positions were written. Allocates
/// nothing.
pub fn skin_positions(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    out: &mut [Vec3],
) -> usize {
    let vertices = &primitive.vertices;
    for (index, (&stored, out)) in vertices.positions.iter().zip(out.iter_mut()).enumerate() {
        let position =
            morphed(primitive, morph_weights, stored, |target| target.positions.get(index).copied());
        let moved = match movement {
            Movement::Rigid(matrix) => matrix.transform_point3(position),
            Movement::Skin(finals) => {
                let mut sum = Vec3::ZERO;
                for influence in vertices.influences_of(index) {
                    // Skipped not for speed: zero times a product that overflowed would be NaN.
                    if influence.weight != 0.0 {
                        sum +=
                            final_of(finals, influence.joint).transform_point3(position) * influence.weight;
                    }
                }
                sum
            }
        };
        *out = first_finite([moved, stored]);
    }
    vertices.len().min(out.len())
}

/// The first of `candidates` without NaN or infinity; the origin when there is none.
fn first_finite(candidates: [Vec3; 2]) -> Vec3 {
    candidates.into_iter().find(|candidate| candidate.is_finite()).unwrap_or(Vec3::ZERO)
}
