//! One rule a file: a function that looks at a model or a take and adds what it finds.
//!
//! A rule compares so that NaN breaks no other rule than the one about NaN, and keeps to its own subject: what has a
//! rule of its own is not reported twice.

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

use super::column::columns;
use super::{Kind, Place, TakeOf};
use glam::Vec3;

/// How far from 1 the length of a unit vector or quaternion may be: what half floats lose is less.
const UNIT_TOLERANCE: f32 = 2e-3;

/// Has one axis no extent beside the longest, or are all a million times smaller than they should be?
fn is_flat(scale: Vec3) -> bool {
    let scale = scale.abs();
    scale.is_finite() && (scale.min_element() <= 1e-5 * scale.max_element() || scale.max_element() < 1e-6)
}

/// Does it turn left into right: an odd number of negative factors?
fn is_mirrored(scale: Vec3) -> bool {
    scale.x * scale.y * scale.z < 0.0
}

/// Every two neighbouring key times of every channel and morph track; `each` gets the place of the later one.
fn neighbours(of: &TakeOf<'_>, mut each: impl FnMut(&dyn Fn() -> Place, f32, f32)) {
    for column in columns(of) {
        for (key, pair) in column.times.windows(2).enumerate() {
            each(&|| column.place(of).then(Kind::Key, key + 1, ""), pair[0], pair[1]);
        }
    }
    for (number, morph) in of.take.morphs.iter().enumerate() {
        for (key, pair) in morph.times.windows(2).enumerate() {
            let place = || of.place().then(Kind::MorphTrack, number, "").then(Kind::Key, key + 1, "");
            each(&place, pair[0], pair[1]);
        }
    }
}
