//! In-between tools: functions that change the values of chosen keys, and filters of curves.
//!
//! | to | function | found in |
//! | --- | --- | --- |
//! | move keys between or beyond their neighbors | [`blend_keys`] | Blender's breakdown, push, relax and ease; animBot |
//! | smooth a curve | [`gaussian`] | `scipy.ndimage.gaussian_filter1d`; Blender's "Smooth (Gaussian)" |
//! | remove fast movements above a frequency | [`butterworth`] | `scipy.signal.butter` and `filtfilt`; Maya, Blender |
//! | remove single wrong values | [`remove_peaks`] | `scipy.signal.medfilt`; the Hampel filter |
//! | add a reproducible tremble | [`noise_at`] | Blender's noise modifier |
//! | filter keys at uneven times | [`filter_keys`] | |
//!
//! # Rules
//!
//! * The functions know numbers only, as [`KeyValue`]: single numbers, vectors and rotations. They compute in double precision with
//!   the functions of `libm`, so a result is the same on every system.
//! * Rotations stay on the sphere of unit quaternions. A blend moves along the great circle from one rotation to the other, the short
//!   way round ([`KeyValue::mix`]). A filter first gives each quaternion the sign nearer to the one before, filters the four numbers,
//!   and normalizes: the mean of the sphere's chords. For rotations within an angle θ of each other it differs from the mean along
//!   the arcs by less than θ³/24, and a turn at constant speed stays as it is, however far it turns.
//! * A curve continues beyond its ends as its reflection about the end ([`extended`]), so filters do not pull the first and the
//!   last value inwards, and a Gaussian keeps a straight line.

mod blend;
mod butterworth;
mod extend;
mod filter;
mod gaussian;
mod noise;
mod peaks;
mod value;

pub use blend::{BlendTarget, blend_keys};
pub use butterworth::{Butterworth, butterworth};
pub use extend::extended;
pub use filter::{KeyFilter, UniformTimes, filter_keys};
pub use gaussian::{gaussian, gaussian_radius};
pub use noise::noise_at;
pub use peaks::remove_peaks;
pub use value::KeyValue;
