//! Tangents of cubic splines, from the keys before and after.
//!
//! With `h` seconds and `d` units per second from one key to the next, before (`0`) and after (`1`) a key:
//!
//! | kind | slope at the key | source |
//! |---|---|---|
//! | auto | `(d0 h1 + d1 h0) / (h0 + h1)` | the parabola through the three keys, as `numpy.gradient` |
//! | clamped | `0` if `d0` and `d1` differ in sign, else `3 (h0 + h1) / ((2 h1 + h0) / d0 + (h1 + 2 h0) / d1)` | Fritsch and Butland 1984, as `scipy.interpolate.PchipInterpolator` |
//! | flat | `0` | |
//! | linear | `d0` before the key, `d1` after it | |
//! | unified | the mean of both slopes that the key has | |
//!
//! A clamped curve never leaves the range of values between two keys. At the first and the last key, auto is the slope to the
//! only neighbor, and clamped is flat, as Blender's auto-clamped handles. Rotations are four numbers, each a curve of its own:
//! give the neighbors the sign that is nearer to the key.

/// The way in which tangents are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentKind {
    /// Smooth: the curve passes through the key with the slope of its neighbors.
    Auto,
    /// Smooth, but never beyond the values of the neighbors.
    Clamped,
    /// No slope.
    Flat,
    /// Straight to the neighbors; the curve has a corner at the key.
    Linear,
    /// The same slope before and after the key: the mean of those that it has.
    Unified,
}

/// A key beside another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighborKey {
    /// Distance from the other key in seconds, more than zero.
    pub seconds: f32,
    /// Value; vectors have 0 as fourth number.
    pub value: [f32; 4],
}

/// Returns the tangents of a key in units per second: in-tangent, out-tangent.
///
/// `now` are those that it has. A key without neighbors, or with neighbors at distances that are not positive, is flat.
pub fn tangents(
    kind: TangentKind,
    before: Option<NeighborKey>,
    value: [f32; 4],
    after: Option<NeighborKey>,
    now: [[f32; 4]; 2],
) -> [[f32; 4]; 2] {
    let usable = |key: &NeighborKey| key.seconds > 0.0;
    let (before, after) = (before.filter(usable), after.filter(usable));
    let slope = |from: [f32; 4], to: [f32; 4], seconds: f32| {
        std::array::from_fn::<f32, 4, _>(|at| (to[at] - from[at]) / seconds)
    };
    let arrive = before.map(|key| (key.seconds, slope(key.value, value, key.seconds)));
    let leave = after.map(|key| (key.seconds, slope(value, key.value, key.seconds)));
    match kind {
        TangentKind::Flat => [[0.0; 4]; 2],
        TangentKind::Unified => [std::array::from_fn(|at| 0.5 * (now[0][at] + now[1][at])); 2],
        TangentKind::Linear => {
            let only = arrive.or(leave).map_or([0.0; 4], |(_, slope)| slope);
            [arrive.map_or(only, |(_, slope)| slope), leave.map_or(only, |(_, slope)| slope)]
        }
        TangentKind::Auto => match (arrive, leave) {
            (Some((h0, d0)), Some((h1, d1))) => {
                [std::array::from_fn(|at| (d0[at] * h1 + d1[at] * h0) / (h0 + h1)); 2]
            }
            (Some((_, only)), None) | (None, Some((_, only))) => [only; 2],
            (None, None) => [[0.0; 4]; 2],
        },
        TangentKind::Clamped => match (arrive, leave) {
            (Some((h0, d0)), Some((h1, d1))) => {
                [std::array::from_fn(|at| within([h0, h1], [d0[at], d1[at]])); 2]
            }
            (Some(_), None) | (None, Some(_)) | (None, None) => [[0.0; 4]; 2],
        },
    }
}

/// Returns the slope at a key at which the curve stays between the values of its neighbors.
fn within([h0, h1]: [f32; 2], [d0, d1]: [f32; 2]) -> f32 {
    // NaN fails the comparisons.
    if (d0 > 0.0 && d1 > 0.0) || (d0 < 0.0 && d1 < 0.0) {
        3.0 * (h0 + h1) / ((2.0 * h1 + h0) / d0 + (h1 + 2.0 * h0) / d1)
    } else {
        0.0
    }
}
