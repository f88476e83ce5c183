//! One animated property over time, as columns: times and values.

use std::sync::Arc;

/// How a value between two keys is computed (thesis §2.1.5.2; glTF 2.0 §3.11 for the cubic spline).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Interpolation {
    /// The last key at or before the time ("last, preceding key-frame").
    Step,
    /// The two keys around the time, interpolated: lerp for vectors, slerp the short way for rotations.
    #[default]
    Linear,
    /// Hermite spline; each key has an in-tangent, a value and an out-tangent, tangents in units per second.
    CubicSpline,
    /// The key nearest in time ("closest key-frame"); exactly half way, the later one.
    Closest,
}

/// Keys of one property of one bone: `times.len()` keys, seconds, strictly ascending.
///
/// `values` has one value per key, or three for [`Interpolation::CubicSpline`]: in-tangent, value, out-tangent. An
/// empty channel means "not animated": the bone keeps its rest value.
#[derive(Clone, Debug, PartialEq)]
#[doc(alias("curve", "F-curve"))]
pub struct Channel<T> {
    /// Seconds, strictly ascending.
    pub times: Arc<[f32]>,
    /// One value per key, or three per key for a cubic spline.
    pub values: Arc<[T]>,
    /// How values between keys are computed.
    pub interpolation: Interpolation,
}

impl<T> Default for Channel<T> {
    fn default() -> Self {
        Self { times: Arc::default(), values: Arc::default(), interpolation: Interpolation::Linear }
    }
}

impl<T: Copy> Channel<T> {
    /// Creates a channel from its columns; the caller has checked their lengths.
    pub fn new(
        times: impl Into<Arc<[f32]>>,
        values: impl Into<Arc<[T]>>,
        interpolation: Interpolation,
    ) -> Self {
        let channel = Self { times: times.into(), values: values.into(), interpolation };
        debug_assert_eq!(channel.times.len() * channel.values_per_key(), channel.values.len());
        channel
    }

    /// Returns whether there is no key.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Returns the number of keys.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Returns 3 for a cubic spline, 1 otherwise.
    pub fn values_per_key(&self) -> usize {
        if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }

    /// Returns the value of key `key` itself, without tangents; `None` past the end.
    pub fn value(&self, key: usize) -> Option<T> {
        match self.interpolation {
            Interpolation::CubicSpline => self.values.get(key.checked_mul(3)? + 1).copied(),
            _ => self.values.get(key).copied(),
        }
    }

    /// Returns the times of the first and of the last key; `None` when there is none.
    pub fn range(&self) -> Option<(f32, f32)> {
        Some((*self.times.first()?, *self.times.last()?))
    }
}
