//! One rule per file: a function that examines a model or a take and adds its findings.
//!
//! A rule compares so that NaN violates no rule but the one about NaN, and reports only its own subject: a problem that
//! another rule covers is not reported twice.

pub(super) mod bone_name_twice;
pub(super) mod bone_stretched;
pub(super) mod bone_unused;
pub(super) mod column_length;
pub(super) mod index;
pub(super) mod joint_missing;
pub(super) mod key_count;
pub(super) mod key_mirrored;
pub(super) mod key_not_finite;
pub(super) mod key_not_unit;
pub(super) mod key_scale_zero;
pub(super) mod key_time_negative;
pub(super) mod key_time_twice;
pub(super) mod key_times_fall;
pub(super) mod morph_track;
pub(super) mod normal_not_unit;
pub(super) mod not_finite;
pub(super) mod offset_singular;
pub(super) mod parent_order;
pub(super) mod rest_mirrored;
pub(super) mod rest_not_uniform;
pub(super) mod rest_not_unit;
pub(super) mod rest_scale_zero;
pub(super) mod rotation_flip;
pub(super) mod rotation_jump;
pub(super) mod take_range;
pub(super) mod take_without_length;
pub(super) mod track_of_no_bone;
pub(super) mod track_order;
pub(super) mod track_twice;
pub(super) mod triangle_degenerate;
pub(super) mod weight_negative;
pub(super) mod weight_sum;

use super::channels::channels;
use super::{ModelPath, PathKind, TakeContext};
use glam::Vec3;

/// Tolerance of the length of a unit vector or quaternion; half floats lose less.
const UNIT_TOLERANCE: f32 = 2e-3;

/// Returns whether `scale` flattens: one factor is negligible relative to the largest, or all are below a millionth.
fn is_flat(scale: Vec3) -> bool {
    let scale = scale.abs();
    scale.is_finite() && (scale.min_element() <= 1e-5 * scale.max_element() || scale.max_element() < 1e-6)
}

/// Returns whether `scale` mirrors: an odd number of factors is negative.
fn is_mirrored(scale: Vec3) -> bool {
    scale.x * scale.y * scale.z < 0.0
}

/// Calls `each` with every two neighboring key times of every channel and morph track, and the path of the later one.
fn neighbors(of: &TakeContext<'_>, mut each: impl FnMut(&dyn Fn() -> ModelPath, f32, f32)) {
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
