//! Skinning on the CPU: the reference for the shader, and the base of hit tests and bounds.
//!
//! ```text
//! morphed  = position + Σ weight_t * difference_t                   morph targets first
//! skinned  = Σ final[joint_i] * morphed * weight_i                  thesis §2.1.4, any number of influences
//! rigid    = to_root[bone] * to_bone * morphed                      a mesh without skin
//! ```
//!
//! Joints are positions in the skin's list, so `final` is that of the skin ([`crate::animation::final_poses`]), not of
//! the skeleton. The weights of a vertex sum to 1; they are used as stored.
//!
//! No result is NaN or infinite: a position that cannot be computed stays at its stored value, or is the origin if that
//! is not finite; a direction that cannot be computed keeps its last valid value, or is +Y without one.

mod direction;
mod position;

pub(crate) use direction::{first_direction, near_one};
pub use direction::{normal_matrix, skin_normal, skin_normals, skin_tangents};
pub use position::{contribution, skin_position, skin_positions};

use crate::data::{MeshInstance, Primitive};
use glam::Mat4;

/// The matrices that move a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Movement<'a> {
    /// Final poses of a skin, one per joint: bind space → scene space.
    Skin(&'a [Mat4]),
    /// One matrix for all vertices: mesh space → scene space.
    Rigid(Mat4),
}

impl<'a> Movement<'a> {
    /// Returns the movement of `primitive` as part of `instance`: by `finals`, the final poses of the instance's skin,
    /// where the instance has a skin and the primitive has influences; else rigid.
    ///
    /// `to_root` are the relative poses of the skeleton's bones.
    pub fn of(instance: &MeshInstance, primitive: &Primitive, to_root: &[Mat4], finals: &'a [Mat4]) -> Self {
        if instance.skin.is_some() && primitive.vertices.influences_per_vertex > 0 {
            Self::Skin(finals)
        } else {
            Self::Rigid(rigid(instance, to_root))
        }
    }

    /// Returns the matrix that moves vertex `index` of `primitive`: `Σ final[joint_i] * weight_i`, or the rigid one.
    ///
    /// For directions and for the shader; positions are summed one by one as in the thesis. Influences without weight
    /// are skipped; a joint that the skin does not have counts as the identity.
    pub fn matrix(&self, primitive: &Primitive, index: usize) -> Mat4 {
        match self {
            Self::Rigid(matrix) => *matrix,
            Self::Skin(finals) => {
                let mut sum = Mat4::ZERO;
                for influence in primitive.vertices.influences_of(index) {
                    if influence.weight != 0.0 {
                        sum += final_of(finals, influence.joint) * influence.weight;
                    }
                }
                sum
            }
        }
    }
}

/// Returns `to_root[bone] * to_bone`: mesh space → scene space of a mesh that a bone carries, or that is static.
///
/// Where the product is not finite: the bone's `to_root` alone; a missing bone is ignored.
pub fn rigid(instance: &MeshInstance, to_root: &[Mat4]) -> Mat4 {
    let carrier = instance.bone.and_then(|bone| to_root.get(bone as usize)).copied();
    crate::animation::final_pose(carrier.unwrap_or(Mat4::IDENTITY), instance.to_bone)
}

/// Returns the final pose of `joint`; the identity where the skin has no such joint.
fn final_of(finals: &[Mat4], joint: u16) -> Mat4 {
    finals.get(usize::from(joint)).copied().unwrap_or(Mat4::IDENTITY)
}

/// Returns `base` plus the weighted differences that `difference` returns for each morph target.
pub(crate) fn morphed(
    primitive: &Primitive,
    morph_weights: &[f32],
    base: glam::Vec3,
    difference: impl Fn(&crate::data::MorphTarget) -> Option<glam::Vec3>,
) -> glam::Vec3 {
    let mut sum = base;
    for (target, &weight) in primitive.morph_targets.iter().zip(morph_weights) {
        if weight != 0.0
            && let Some(difference) = difference(target)
        {
            sum += difference * weight;
        }
    }
    sum
}
