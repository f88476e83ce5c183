//! What a ray or a sphere meets of an animated mesh (thesis §2.1.7.2).
//!
//! Two ways that give the same answer:
//!
//! * The *open* one tests every triangle: [`ray_open`], [`sphere_open`]. The formulas are those of [`crossing`] and
//!   [`nearest_on_triangle`]; nothing is kept.
//! * The *tree*: triangles are grouped by the bone that moves them most, each group is halved until a handful is left,
//!   and each group and handful keeps one box a joint of the vertices that the joint moves. [`HitTree`] is made once a
//!   model and can be stored beside it; [`HitPose`] puts its boxes around a pose, from the final poses alone, without
//!   looking at a vertex; a ray goes down only where it meets a box, and skins only the handfuls that it reaches.
//!
//! A triangle whose corners several bones move lies in the box of its handful in every pose: each vertex is a mean of
//! where its bones would carry it, and the box holds all of those ([`crate::bounds::BoneBoxes`] says it at length). So
//! the tree never misses what the open way finds.
//!
//! `README.md` of this crate compares the tree with testing every triangle, with and without a new pose for each ray
//! (`cargo bench -p dragonfly-anim -- hit/`).
//!
//! Both work in `f64` on the positions that [`crate::skin`] gives, so an answer is right to the rounding of those. A
//! triangle without area, one whose plane holds the ray, and anything that is not finite is no hit.

mod build;
mod open;
mod place;
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
    /// Where it begins.
    pub origin: Vec3,
    /// Where it goes; of any length but zero, which with NaN and infinity meets nothing.
    pub direction: Vec3,
}

/// What counts as a hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HitSettings {
    /// Scene units from the origin; nothing beyond is met. Infinity for no end, NaN for nothing at all.
    pub max_distance: f32,
    /// Are triangles met from behind? Where a matrix mirrors, front and back are exchanged with the winding.
    pub back_faces: bool,
}

impl Default for HitSettings {
    /// Without end, from both sides.
    fn default() -> Self {
        Self { max_distance: f32::INFINITY, back_faces: true }
    }
}

/// A place on an animated mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Position in [`crate::data::ModelData::instances`].
    pub instance: u32,
    /// Position in the primitives of the instance's mesh.
    pub primitive: u32,
    /// Which three of [`crate::data::Primitive::indices`]: `3 * triangle` is the first.
    pub triangle: u32,
    /// Shares of the three corners, not negative, together 1.
    pub barycentric: Vec3,
    /// The bone with the greatest weight at the place: the corners' weights, mixed by `barycentric`, added up by bone.
    /// For a mesh without skin the bone that carries it; `None` where no bone moves it.
    pub bone: Option<BoneIndex>,
    /// Scene space.
    pub position: Vec3,
    /// Of the triangle, unit length, towards the front; scene space.
    pub normal: Vec3,
    /// Scene units from the origin of the ray, or from the centre of the sphere.
    pub distance: f32,
    /// Was it met from the front?
    pub front: bool,
}
