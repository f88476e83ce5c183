//! Rotation keys: the shortest way from key to key, and full turns between two keys.
//!
//! | to | function | found in |
//! | --- | --- | --- |
//! | let neighboring quaternions have signs that agree | [`shortest_way`] | glTF 2.0 §3.11 (implementation note), Maya's and Blender's Euler filter, `scipy.spatial.transform.Slerp` |
//! | turn by 180° or more from one key to the next | [`full_turns`] | Unreal's and Unity's Euler curves; quaternion keys cannot hold it |
//!
//! # Formulas
//!
//! * `q` and `-q` are one rotation. [`shortest_way`] replaces each `q[i]` by the one of `±q[i]` with `q[i-1] · q[i] >= 0`, and its tangents
//!   with it. Linear interpolation stays as it is, because it takes the short way whatever the signs; a cubic spline between opposite
//!   signs passes near zero and flips, and no longer does.
//! * From `a` to `b`, `a⁻¹ b = exp(u θ / 2)` with a unit vector `u` and `0 <= θ <= π`: the short way. [`full_turns`] turns by
//!   `φ = θ + 2 π n` about `u` instead, with keys `a exp(u φ t / 2)` in between, no more than 90° apart (45° for splines, whose curve
//!   between two keys leaves the sphere: the angle is then exact within 0.05°). The tangents of a spline are those of constant speed,
//!   `q u ω / 2` with `ω = φ / seconds`. If `a` and `b` are nearly the same rotation, `u` is the given axis.
//!
//! Everything is computed in double precision with the functions of `libm`.

mod full;
mod shortest;

pub use full::full_turns;
pub use shortest::shortest_way;
