//! Things that follow a bone: a sword in a hand, a rider on a horse (thesis §1.7, "carried weapons").
//!
//! A [`Socket`] is a place on a skeleton. Once the carrier's bones are chained, the socket has a to-root of its own, and
//! whatever is attached gets it in front of its own to-root:
//!
//! ```text
//! socket_to_root   = to_root of the bone * offset          carrier's scene space
//! object to_root_i = root * to_root_i of the object alone
//! root             = socket_to_root * handle⁻¹             so that the object's handle lies in the socket
//! ```
//!
//! The other hand follows the object: [`Grip`] gives where it has to be, for inverse kinematics to bring it there.

mod grip;
mod socket;

pub use grip::{Grip, Target};
pub use socket::{NoSuchSocketBone, ScaleOf, Socket};

use glam::Mat4;

/// Root of an attached object: object's scene space → carrier's scene space.
///
/// `socket_to_root` is where it is held, `handle` the to-root of the point (or bone) of the object that lies there, in
/// the object's own scene space: the identity when the object is held at its origin. A handle without an inverse counts
/// as the identity: a product that is not finite is the socket's place.
pub fn attached_root(socket_to_root: Mat4, handle: Mat4) -> Mat4 {
    let root = socket_to_root * handle.inverse();
    if root.is_finite() { root } else { socket_to_root }
}

/// Moves an attached model to its carrier: each of `to_root` (of its bones, alone: bone space → its scene space) becomes
/// `root * to_root`, bone space → the carrier's scene space.
///
/// [`crate::animation::final_poses`] then takes them as they are; meshes without a skin are moved by `root * to_root`
/// likewise. A product that is not finite is `root`. Allocates nothing.
pub fn carry(root: Mat4, to_root: &mut [Mat4]) {
    for to_root in to_root {
        let carried = root * *to_root;
        *to_root = if carried.is_finite() { carried } else { root };
    }
}
