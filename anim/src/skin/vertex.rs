//! One vertex at a time: for whoever needs a few of many.

use super::{Movement, final_of, morphed};
use crate::data::Primitive;
use glam::Vec3;

/// The position of vertex `index` of `primitive` in scene space, bit for bit what [`super::skin_positions`] writes
/// there; the origin where there is no such vertex.
///
/// ```text
/// positionN = Σ final[joint_i] * morphed * weight_i          thesis §2.1.4
/// ```
///
/// `morph_weights`: one a morph target; missing ones count as 0. Always finite. Allocates nothing.
pub fn skin_position(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    index: usize,
) -> Vec3 {
    let Some(&stored) = primitive.vertices.positions.get(index) else { return Vec3::ZERO };
    let position = morphed(primitive, morph_weights, stored, |target| target.positions.get(index).copied());
    let moved = match movement {
        Movement::Rigid(matrix) => matrix.transform_point3(position),
        Movement::Skin(finals) => {
            let mut sum = Vec3::ZERO;
            for influence in primitive.vertices.influences_of(index) {
                if influence.weight != 0.0 {
                    sum += final_of(finals, influence.joint).transform_point3(position) * influence.weight;
                }
            }
            sum
        }
    };
    [moved, stored].into_iter().find(|candidate| candidate.is_finite()).unwrap_or(Vec3::ZERO)
}
