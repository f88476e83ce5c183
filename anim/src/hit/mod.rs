//! Ray and sphere queries on an animated mesh (thesis §2.1.7.2).
//!
//! Two methods with the same results:
//!
//! * The *open* one tests every triangle: [`ray_open`], [`sphere_open`]. The formulas are those of [`crossing`] and
//!   [`nearest_on_triangle`]; there is no state.
//! * The *tree* (a bounding volume hierarchy): triangles are grouped by the bone that moves them most, each group is
//!   halved until a few are left, and each group and leaf stores one box per joint of the vertices that the joint
//!   moves. [`HitTree`] is built once per model and can be stored with it; [`HitPose`] fits its boxes to a pose, from
//!   the final poses alone, without reading a vertex; a ray descends only where it meets a box, and skins only the
//!   leaves that it reaches.
//!
//! A triangle whose corners are moved by several bones is in the box of its leaf in every pose: each vertex is a mean
//! of its images under its bones, and the box contains all of those ([`crate::bounds::BoneBoxes`] explains it in
//! detail). So the tree never misses a hit of the open method.
//!
//! `README.md` of this crate compares the tree with testing every triangle, with and without a new pose for each ray
//! (`cargo bench -p dragonfly-anim -- hit/`).
//!
//! Both compute in `f64` on the positions of [`crate::skin`], so a result is exact up to the rounding of those. A
//! triangle without area, one whose plane contains the ray, and anything that is not finite is no hit.

mod build;
mod candidate;
mod open;
mod pose;
mod tree;
mod triangle;

pub use open::{ray_open, sphere_open};
pub use pose::HitPose;
pub use tree::{
    HitLeaf, HitNode, HitTree, HitTreeError, HitTreeParts, LEAF_TRIANGLES, TREE_DEPTH, TREE_TRIANGLES,
};
pub use triangle::{Crossing, crossing, nearest_on_triangle};

use crate::data::BoneIndex;
use glam::Vec3;

/// A half line in scene space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start of the ray.
    pub origin: Vec3,
    /// Direction of any length but zero; with zero, NaN or infinity nothing is hit.
    pub direction: Vec3,
}

/// Conditions for hits of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HitSettings {
    /// Largest distance from the origin in scene units. Infinity for no limit, NaN for no hit at all.
    pub max_distance: f32,
    /// Whether back faces are hit too. A matrix that mirrors reverses the winding, and so exchanges front and back.
    pub back_faces: bool,
}

impl Default for HitSettings {
    /// Returns settings without a limit of the distance, for hits from both sides.
    fn default() -> Self {
        Self { max_distance: f32::INFINITY, back_faces: true }
    }
}

/// A point on an animated mesh, the result of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Position in [`crate::data::ModelData::instances`].
    pub instance: u32,
    /// Position in the primitives of the instance's mesh.
    pub primitive: u32,
    /// Index of the triangle: its corners are [`crate::data::Primitive::indices`] from `3 * triangle` on.
    pub triangle: u32,
    /// Barycentric coordinates: shares of the three corners, not negative, together 1.
    pub barycentric: Vec3,
    /// The bone with the greatest weight at the point: the corners' weights, mixed by `barycentric` and summed per
    /// bone. For a mesh without skin the bone that carries it; `None` where no bone moves it.
    pub bone: Option<BoneIndex>,
    /// Position of the point in scene space.
    pub position: Vec3,
    /// Normal of the triangle, unit length, towards the front; scene space.
    pub normal: Vec3,
    /// Scene units from the origin of the ray, or from the center of the sphere.
    pub distance: f32,
    /// Whether the triangle was hit from the front.
    pub front: bool,
}
