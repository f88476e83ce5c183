//! Objects that follow a bone: a sword in a hand, a rider on a horse (thesis §1.7, "carried weapons").
//!
//! A [`Socket`] is an attachment point on a skeleton. Once the carrier's bones are chained, the socket has a to-root of
//! its own, and each to-root of an attached object is multiplied by it from the left:
//!
//! ```text
//! socket_to_root   = to_root of the bone * offset          carrier's scene space
//! object to_root_i = root * to_root_i of the object alone
//! root             = socket_to_root * handle⁻¹             puts the object's handle into the socket
//! ```
//!
//! The other hand follows the object: [`Grip`] gives the position that it has to reach, as the target of inverse
//! kinematics.

mod grip;
mod socket;

pub use grip::{Grip, GripTarget};
pub use socket::{NoSuchSocketBone, ScaleOf, Socket};

use glam::Mat4;

/// Returns the root of an attached object: object's scene space → carrier's scene space.
///
/// `socket_to_root` is the socket's pose, `handle` the to-root of the point (or bone) of the object that is put there,
/// in the object's own scene space: the identity when the object is held at its origin. A handle without an inverse
/// counts as the identity; where the product is not finite, the result is `socket_to_root`.
pub fn attached_root(socket_to_root: Mat4, handle: Mat4) -> Mat4 {
    let root = socket_to_root * handle.inverse();
    if root.is_finite() { root } else { socket_to_root }
}

/// Moves an attached model to its carrier: multiplies the to-root matrix of each of the model's bones by `root` from
/// the left.
///
/// Before the call, `to_root` maps bone space → the model's own scene space; after it, bone space → the carrier's scene
/// space. The result can be passed to [`crate::animation::final_poses`] as it is; meshes without a skin are moved by
/// the same matrices. A product that is not finite is replaced by `root`. Allocates nothing.
pub fn carry(root: Mat4, to_root: &mut [Mat4]) {
    for to_root in to_root {
        let carried = root * *to_root;
        *to_root = if carried.is_finite() { carried } else { root };
    }
}
