//! Ground that is a mesh: the surfaces of props over a point, and the one that a way follows.
//!
//! A ground prop does not move: it is at its place in the cast, in its rest pose. At a point of the ground plane its triangles have a height each. They are
//! cut by the vertical line through the point, in `f64`, with edges that belong to both of their triangles, so that a closed surface has no gaps.
//!
//! Of several surfaces over each other, a way chooses in two steps:
//!
//! 1. *Room.* What faces down is a ceiling, and no ground. Ground is what faces up with nothing over it, or with a ceiling at least half a meter
//!    over it. So the floor inside of a hill is not ground, nor the underside of the hill, but the floor below a bridge is. (A bridge
//!    needs an underside for that: a sheet without one hides what is below it, as a hill does.)
//! 2. *Height.* Of what is left, the surface nearest to the height of the way itself; the higher of two equally near ones.
//!
//! The nearest of all surfaces, without the first step, would let a way that is drawn at height 0 pass through every hill on a floor.

mod column;
mod mesh;
mod placed;

pub(in crate::stage) use column::GroundSurface;
pub use mesh::GROUND_TRIANGLES;
pub(in crate::stage) use mesh::GroundMesh;
pub(in crate::stage) use placed::{PlacedGround, SceneGround};
