//! Measurements that several rules share: unit length, flat and mirroring scales, neighboring key times.

use super::channels::channels;
use super::{ModelPath, PathKind, TakeContext};
use glam::Vec3;

/// Tolerance of the length of a unit vector or quaternion; half floats lose less.
pub(super) const UNIT_TOLERANCE: f32 = 2e-3;

/// Returns whether `scale` flattens: one factor is negligible relative to the largest, or all are below a millionth.
pub(super) fn is_flat(scale: Vec3) -> bool {
    let scale = scale.abs();
    scale.is_finite() && (scale.min_element() <= 1e-5 * scale.max_element() || scale.max_element() < 1e-6)
}

/// Returns whether `scale` mirrors: an odd number of factors is negative.
pub(super) fn is_mirrored(scale: Vec3) -> bool {
    scale.x * scale.y * scale.z < 0.0
}

/// Calls `each` with every two neighboring key times of every channel and morph track, and the path of the later one.
pub(super) fn neighbors(of: &TakeContext<'_>, mut each: impl FnMut(&dyn Fn() -> ModelPath, f32, f32)) {
    for channel in channels(of) {
        for (key, pair) in channel.times.windows(2).enumerate() {
            each(&|| channel.path(of).then(PathKind::Key, key + 1, ""), pair[0], pair[1]);
        }
    }
    for (number, morph) in of.take.morphs.iter().enumerate() {
        for (key, pair) in morph.times.windows(2).enumerate() {
            let path = || of.path().then(PathKind::MorphTrack, number, "").then(PathKind::Key, key + 1, "");
            each(&path, pair[0], pair[1]);
        }
    }
}
