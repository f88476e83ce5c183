//! One rule per file: a function that examines a model or a take and adds its findings. A new rule is a file here and a line
//! in [`RULES`].
//!
//! A rule compares so that NaN violates no rule but the one about NaN, and reports only its own subject: a problem that
//! another rule covers is not reported twice.

mod bone_name_twice;
mod bone_stretched;
mod bone_unused;
mod column_length;
mod index;
mod joint_missing;
mod key_count;
mod key_mirrored;
mod key_not_finite;
mod key_not_unit;
mod key_scale_zero;
mod key_time_negative;
mod key_time_twice;
mod key_times_fall;
mod morph_track;
mod normal_not_unit;
mod not_finite;
mod offset_singular;
mod parent_order;
mod rest_mirrored;
mod rest_not_uniform;
mod rest_not_unit;
mod rest_scale_zero;
mod rotation_flip;
mod rotation_jump;
mod take_range;
mod take_without_length;
mod track_of_no_bone;
mod track_order;
mod track_twice;
mod triangle_degenerate;
mod weight_negative;
mod weight_sum;

use super::{Rule, Severity};

use Severity::{Error, Note, Warning};

/// All rules, in the order in which findings of equal severity are listed.
pub static RULES: &[Rule] = &[
    Rule::model("NOT_FINITE", Error, "A number of the model is NaN or infinite.", not_finite::check),
    Rule::model("COLUMN_LENGTH", Error, "A list has the wrong length.", column_length::check),
    Rule::model("INDEX", Error, "An index is out of range.", index::check),
    Rule::model("PARENT_ORDER", Error, "A parent does not come before its child.", parent_order::check),
    Rule::model(
        "JOINT_MISSING",
        Error,
        "An influence refers to a joint that the skin does not have.",
        joint_missing::check,
    ),
    Rule::model("WEIGHT_NEGATIVE", Error, "The weight of an influence is negative.", weight_negative::check),
    Rule::model("WEIGHT_SUM", Error, "The weights of a vertex do not sum to 1.", weight_sum::check),
    Rule::model(
        "REST_NOT_UNIT",
        Error,
        "The rotation of a rest pose is not of unit length.",
        rest_not_unit::check,
    ),
    Rule::model("OFFSET_SINGULAR", Error, "An offset matrix cannot be inverted.", offset_singular::check),
    Rule::model("NORMAL_NOT_UNIT", Warning, "A normal is not of unit length.", normal_not_unit::check),
    Rule::model(
        "REST_SCALE_ZERO",
        Warning,
        "The rest scale of a bone is zero along an axis.",
        rest_scale_zero::check,
    ),
    Rule::model("BONE_NAME_TWICE", Warning, "Two bones have the same name.", bone_name_twice::check),
    Rule::model("REST_MIRRORED", Note, "The rest pose of a bone is mirrored.", rest_mirrored::check),
    Rule::model(
        "REST_NOT_UNIFORM",
        Note,
        "A bone's rest scale differs along its axes.",
        rest_not_uniform::check,
    ),
    Rule::model("BONE_UNUSED", Note, "A bone and its descendants move nothing.", bone_unused::check),
    Rule::model("TRIANGLE_DEGENERATE", Note, "A triangle has no area.", triangle_degenerate::check),
    Rule::take("TRACK_OF_NO_BONE", Error, "The bone of a track does not exist.", track_of_no_bone::check),
    Rule::take("TRACK_TWICE", Error, "Two tracks of a take belong to the same bone.", track_twice::check),
    Rule::take(
        "TRACK_ORDER",
        Error,
        "The tracks of a take are not one per bone in bone order.",
        track_order::check,
    ),
    Rule::take(
        "KEY_COUNT",
        Error,
        "The number of values of a channel does not match its key times.",
        key_count::check,
    ),
    Rule::take(
        "KEY_NOT_FINITE",
        Error,
        "A key's time, value or tangent is NaN or infinite.",
        key_not_finite::check,
    ),
    Rule::take("KEY_TIMES_FALL", Error, "The key times of a channel do not ascend.", key_times_fall::check),
    Rule::take("KEY_TIME_TWICE", Error, "Two keys of a channel have the same time.", key_time_twice::check),
    Rule::take("KEY_NOT_UNIT", Error, "The rotation of a key is not of unit length.", key_not_unit::check),
    Rule::take("MORPH_TRACK", Error, "A morph track does not fit its instance.", morph_track::check),
    Rule::take("TAKE_RANGE", Error, "Start and length of a take do not match its keys.", take_range::check),
    Rule::take(
        "KEY_SCALE_ZERO",
        Warning,
        "A key scales a bone to zero along an axis.",
        key_scale_zero::check,
    ),
    Rule::take(
        "KEY_MIRRORED",
        Warning,
        "A key is mirrored and the rest pose is not, or the reverse.",
        key_mirrored::check,
    ),
    Rule::take(
        "ROTATION_FLIP",
        Warning,
        "Neighboring rotation keys are in opposite hemispheres.",
        rotation_flip::check,
    ),
    Rule::take(
        "ROTATION_JUMP",
        Warning,
        "A rotation turns by more than half a turn per frame.",
        rotation_jump::check,
    ),
    Rule::take("KEY_TIME_NEGATIVE", Note, "A key comes before time 0.", key_time_negative::check),
    Rule::take(
        "BONE_STRETCHED",
        Note,
        "A translation track changes the length of a bone.",
        bone_stretched::check,
    ),
    Rule::take(
        "TAKE_WITHOUT_LENGTH",
        Note,
        "A take has a single pose, or no keys.",
        take_without_length::check,
    ),
];
