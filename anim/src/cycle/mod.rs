//! Cycles: the keys of a channel repeated before and after, as real keys. glTF has no extrapolation.
//!
//! | mode | cycle number `i` | found in |
//! | --- | --- | --- |
//! | repeat | the values again | Blender's "Repeat Motion", Maya's "Cycle" |
//! | offset | moved so that it starts where the cycle before ends | Blender's "Repeat with Offset", Maya's "Cycle with Offset" |
//! | mirror | every other cycle backwards | Blender's "Repeat Mirrored", Maya's "Oscillate" |
//!
//! # Formulas
//!
//! With the first value `a` at `t0`, the last value `b` at `t1`, and the period `P = t1 - t0`, the key at `t` with value `v` is repeated at
//! `t + i P` (mirrored, for odd `i`: at `t0 + t1 + i P - t`, its tangents exchanged and negated) with the value
//!
//! ```text
//! repeat, mirror   v
//! offset           translations v + i (b - a), rotations (b a⁻¹)^i v, scales v (b / a)^i
//! ```
//!
//! Two cycles share the key between them: it is the last key of the earlier one. Where a repeated curve does not end as it starts, it
//! therefore leads from the end to the second key of the next cycle. Tangents of offset rotations turn with their values, and those of
//! scales are scaled.
//!
//! A cycle that ends at a limit ends with a key there, which has the value and the slope of the curve: the part of a Hermite curve before a
//! time is the Hermite curve with the value and the slope there.

mod extend;
mod slope;
mod value;

pub use extend::{CycleMode, CycleRange, Cycles, cycled};
pub use slope::value_and_slope;
pub use value::{CycleValue, ScaleValue};
