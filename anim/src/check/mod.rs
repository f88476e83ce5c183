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
//! A new rule is a file in `rule/` and a line in [`RULES`], which is in `rule/mod.rs`.
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
mod measure;
mod path;
mod rule;

pub(crate) use context::TakeContext;
pub use finding::{Finding, MAX_PER_RULE, Rule, Severity};
pub(crate) use finding::{Findings, RuleFunction};
pub use path::{ModelPath, PathKind, PathStep};
pub use rule::RULES;

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
