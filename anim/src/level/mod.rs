//! Levels of detail (LOD): the same model with fewer triangles, for when it is far away (thesis §2.1.7.2, progressive
//! mesh).
//!
//! Triangles are removed by *edge collapse*: one end of an edge moves onto the other, and the triangles between vanish
//! (Hoppe 1996; costs after Garland and Heckbert 1997). A vertex only ever moves onto another existing one, so every
//! level shares the vertices of the original, including their influences, texture coordinates and morph targets, and is
//! nothing but another list of indices.
//!
//! * [`simplify`] computes the order of collapses of one primitive: a [`Progression`], from which the indices after any
//!   number of collapses follow (the progressive mesh).
//! * [`levels`] makes a chain of levels of a whole model, and measures each in the poses of its takes.
//! * [`choose_level`] chooses the level by its size on the screen.
//!
//! # What is preserved
//!
//! * Vertices at one position that always move together (same position, influences and morph differences) are one
//!   *place*; a difference in texture coordinates or color there is a seam. A collapse moves every side of a seam or
//!   does not happen, so a seam is only ever shortened along itself and texture coordinates are never torn.
//! * A border only collapses along itself. Where several primitives of a mesh meet, and wherever the surface is not a
//!   manifold (an edge of three triangles), vertices stay.
//! * No triangle turns over: its normal stays within 90° of the original's, and within about 78° per step.
//!
//! # Cost
//!
//! O(n log n) for n triangles: a vertex with more than 64 triangles around it is not moved, so a collapse examines a
//! bounded neighborhood. The same input gives the same levels.

mod chain;
mod choice;
mod collapse;
mod cost;
mod error;
mod progression;
mod surface;

pub use chain::{LevelSettings, Lod, levels};
pub use choice::{Screen, choose_level, error_in_pixels, radius_in_pixels};
pub use collapse::{SimplifySettings, simplify};
pub use error::skinned_error;
pub use progression::{Move, Progression};
