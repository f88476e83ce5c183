//! Keeping a value between two bounds that were computed.
//!
//! `clamp` of the standard library panics if the lower bound exceeds the upper one or is NaN. Computed bounds do that
//! sooner or later: a panel narrower than the text in it, a take without length. Code of the window uses [`between`]
//! wherever a bound is not a constant.

/// Returns the value closest to `value` from `low` to `high`. If `low` exceeds `high`, returns `low`: what does not fit is
/// cut off at its end. A bound that is NaN is no bound.
pub fn between<T: PartialOrd>(value: T, low: T, high: T) -> T {
    let value = if value > high { high } else { value };
    if value < low { low } else { value }
}
