//! Validation: a list of everything wrong with a model or a take, with paths.
//!
//! Nothing is repaired or rejected: [`check`] reports each problem with its path and severity. It never panics,
//! whatever the model contains, and takes time in proportion to the model's size.
//!
//! | severity | meaning |
//! |---|---|
//! | [`Severity::Error`] | an invariant of the data types is broken: the display uses a fallback, or is wrong |
//! | [`Severity::Warning`] | allowed, but probably unintended, and visible |
//! | [`Severity::Note`] | allowed and often intended; worth knowing when something looks odd |
//!
//! A new rule is a file in `rule/` and a line in [`RULES`].
//!
//! ```
//! # let model = dragonfly_anim::data::ModelData::default();
//! for finding in dragonfly_anim::check::check(&model) {
//!     println!("{finding}");
//! }
//! ```

mod channels;
mod context;
mod finding;
mod path;
mod rule;

pub(crate) use context::TakeContext;
pub use finding::{Finding, MAX_PER_RULE, Rule, Severity};
pub(crate) use finding::{Findings, RuleFunction};
pub use path::{ModelPath, PathKind, PathStep};

use crate::data::{ModelData, Skeleton, Take};

/// Returns everything wrong with `model`, the worst first, then in the order of [`RULES`].
pub fn check(model: &ModelData) -> Vec<Finding> {
    let takes = model.animation.takes.iter().enumerate().map(|(number, take)| TakeContext {
        take,
        skeleton: &model.animation.skeleton,
        number,
        model: Some(model),
    });
    let takes: Vec<TakeContext<'_>> = takes.collect();
    run(|function, findings| match function {
        RuleFunction::Model(function) => function(model, findings),
        RuleFunction::Take(function) => takes.iter().for_each(|take| function(take, findings)),
    })
}

/// Returns everything wrong with `take` as one that moves `skeleton`; in paths it is take number 0.
pub fn check_take(take: &Take, skeleton: &Skeleton) -> Vec<Finding> {
    let of = TakeContext { take, skeleton, number: 0, model: None };
    run(|function, findings| match function {
        RuleFunction::Model(_) => {}
        RuleFunction::Take(function) => function(&of, findings),
    })
}

fn run(mut call: impl FnMut(RuleFunction, &mut Findings)) -> Vec<Finding> {
    let mut all = Vec::new();
    for rule in RULES {
        let mut findings = Findings { rule, list: Vec::new(), omitted: 0 };
        call(rule.function, &mut findings);
        all.append(&mut findings.list);
        if findings.omitted > 0 {
            let text = format!("and {} more of these", findings.omitted);
            all.push(Finding { rule: rule.id, severity: rule.severity, path: ModelPath::default(), text });
        }
    }
    all.sort_by_key(|finding| finding.severity);
    all
}

use Severity::{Error, Note, Warning};

/// All rules, in the order in which findings of equal severity are listed.
pub static RULES: &[Rule] = &[
    Rule::model("NOT_FINITE", Error, "A number of the model is NaN or infinite.", rule::not_finite::check),
    Rule::model("COLUMN_LENGTH", Error, "A list has the wrong length.", rule::column_length::check),
    Rule::model("INDEX", Error, "An index is out of range.", rule::index::check),
    Rule::model("PARENT_ORDER", Error, "A parent does not come before its child.", rule::parent_order::check),
    Rule::model(
        "JOINT_MISSING",
        Error,
        "An influence refers to a joint that the skin does not have.",
        rule::joint_missing::check,
    ),
    Rule::model(
        "WEIGHT_NEGATIVE",
        Error,
        "The weight of an influence is negative.",
        rule::weight_negative::check,
    ),
    Rule::model("WEIGHT_SUM", Error, "The weights of a vertex do not sum to 1.", rule::weight_sum::check),
    Rule::model(
        "REST_NOT_UNIT",
        Error,
        "The rotation of a rest pose is not of unit length.",
        rule::rest_not_unit::check,
    ),
    Rule::model(
        "OFFSET_SINGULAR",
        Error,
        "An offset matrix cannot be inverted.",
        rule::offset_singular::check,
    ),
    Rule::model("NORMAL_NOT_UNIT", Warning, "A normal is not of unit length.", rule::normal_not_unit::check),
    Rule::model(
        "REST_SCALE_ZERO",
        Warning,
        "The rest scale of a bone is zero along an axis.",
        rule::rest_scale_zero::check,
    ),
    Rule::model("BONE_NAME_TWICE", Warning, "Two bones have the same name.", rule::bone_name_twice::check),
    Rule::model("REST_MIRRORED", Note, "The rest pose of a bone is mirrored.", rule::rest_mirrored::check),
    Rule::model(
        "REST_NOT_UNIFORM",
        Note,
        "A bone's rest scale differs along its axes.",
        rule::rest_not_uniform::check,
    ),
    Rule::model("BONE_UNUSED", Note, "A bone and its descendants move nothing.", rule::bone_unused::check),
    Rule::model("TRIANGLE_DEGENERATE", Note, "A triangle has no area.", rule::triangle_degenerate::check),
    Rule::take(
        "TRACK_OF_NO_BONE",
        Error,
        "The bone of a track does not exist.",
        rule::track_of_no_bone::check,
    ),
    Rule::take(
        "TRACK_TWICE",
        Error,
        "Two tracks of a take belong to the same bone.",
        rule::track_twice::check,
    ),
    Rule::take(
        "TRACK_ORDER",
        Error,
        "The tracks of a take are not one per bone in bone order.",
        rule::track_order::check,
    ),
    Rule::take(
        "KEY_COUNT",
        Error,
        "The number of values of a channel does not match its key times.",
        rule::key_count::check,
    ),
    Rule::take(
        "KEY_NOT_FINITE",
        Error,
        "A key's time, value or tangent is NaN or infinite.",
        rule::key_not_finite::check,
    ),
    Rule::take(
        "KEY_TIMES_FALL",
        Error,
        "The key times of a channel do not ascend.",
        rule::key_times_fall::check,
    ),
    Rule::take(
        "KEY_TIME_TWICE",
        Error,
        "Two keys of a channel have the same time.",
        rule::key_time_twice::check,
    ),
    Rule::take(
        "KEY_NOT_UNIT",
        Error,
        "The rotation of a key is not of unit length.",
        rule::key_not_unit::check,
    ),
    Rule::take("MORPH_TRACK", Error, "A morph track does not fit its instance.", rule::morph_track::check),
    Rule::take(
        "TAKE_RANGE",
        Error,
        "Start and length of a take do not match its keys.",
        rule::take_range::check,
    ),
    Rule::take(
        "KEY_SCALE_ZERO",
        Warning,
        "A key scales a bone to zero along an axis.",
        rule::key_scale_zero::check,
    ),
    Rule::take(
        "KEY_MIRRORED",
        Warning,
        "A key is mirrored and the rest pose is not, or the reverse.",
        rule::key_mirrored::check,
    ),
    Rule::take(
        "ROTATION_FLIP",
        Warning,
        "Neighboring rotation keys are in opposite hemispheres.",
        rule::rotation_flip::check,
    ),
    Rule::take(
        "ROTATION_JUMP",
        Warning,
        "A rotation turns by more than half a turn per frame.",
        rule::rotation_jump::check,
    ),
    Rule::take("KEY_TIME_NEGATIVE", Note, "A key comes before time 0.", rule::key_time_negative::check),
    Rule::take(
        "BONE_STRETCHED",
        Note,
        "A translation track changes the length of a bone.",
        rule::bone_stretched::check,
    ),
    Rule::take(
        "TAKE_WITHOUT_LENGTH",
        Note,
        "A take has a single pose, or no keys.",
        rule::take_without_length::check,
    ),
];
