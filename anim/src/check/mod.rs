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
mod path;
mod rule;

pub use path::{ModelPath, PathKind, PathStep};
pub use rule::RULES;

use crate::data::{ModelData, Skeleton, Take};
use std::fmt;

/// Severity of a finding. Sorts with the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// An invariant of the data types is broken.
    Error,
    /// Probably unintended.
    Warning,
    /// Worth knowing.
    Note,
}

/// The function of a rule, by what it examines.
#[derive(Clone, Copy)]
pub(crate) enum RuleFunction {
    /// Examines the model without its takes.
    Model(fn(&ModelData, &mut Findings)),
    /// Examines one take and the skeleton it moves.
    Take(fn(&TakeContext<'_>, &mut Findings)),
}

/// One rule.
#[derive(Clone, Copy)]
pub struct Rule {
    /// Short and in capitals: `"KEY_TIMES_FALL"`.
    pub id: &'static str,
    /// Severity of its findings.
    pub severity: Severity,
    /// The problem that the rule finds, in one sentence.
    pub meaning: &'static str,
    function: RuleFunction,
}

impl Rule {
    const fn model(
        id: &'static str,
        severity: Severity,
        meaning: &'static str,
        function: fn(&ModelData, &mut Findings),
    ) -> Self {
        Self { id, severity, meaning, function: RuleFunction::Model(function) }
    }

    const fn take(
        id: &'static str,
        severity: Severity,
        meaning: &'static str,
        function: fn(&TakeContext<'_>, &mut Findings),
    ) -> Self {
        Self { id, severity, meaning, function: RuleFunction::Take(function) }
    }
}

/// A violation of a rule. Displayed as `severity: path: text`.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// [`Rule::id`].
    pub rule: &'static str,
    /// [`Rule::severity`].
    pub severity: Severity,
    /// The violating element.
    pub path: ModelPath,
    /// Description of the problem, with the numbers.
    pub text: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        write!(f, "{severity}: {}: {}", self.path, self.text)
    }
}

/// Number of findings of one rule that a [`check`] lists one by one; the rest is only counted.
pub const MAX_PER_RULE: usize = 100;

/// Collects the findings of one rule.
pub(crate) struct Findings {
    rule: &'static Rule,
    list: Vec<Finding>,
    omitted: usize,
}

impl Findings {
    /// Adds a finding; `describe` is only called while the list is not full.
    pub(crate) fn add(&mut self, describe: impl FnOnce() -> (ModelPath, String)) {
        if self.list.len() >= MAX_PER_RULE {
            self.omitted += 1;
            return;
        }
        let (path, text) = describe();
        self.list.push(Finding { rule: self.rule.id, severity: self.rule.severity, path, text });
    }
}

/// A take with its context.
pub(crate) struct TakeContext<'a> {
    pub(crate) take: &'a Take,
    pub(crate) skeleton: &'a Skeleton,
    /// Number of the take in its model.
    pub(crate) number: usize,
    /// The model; `None` where the take is checked by itself.
    pub(crate) model: Option<&'a ModelData>,
}

impl TakeContext<'_> {
    /// Returns the path of the take.
    pub(crate) fn path(&self) -> ModelPath {
        ModelPath::of(PathKind::Take, self.number, &self.take.name)
    }

    /// Returns the path of a bone of the skeleton, within the take.
    pub(crate) fn bone(&self, bone: usize) -> ModelPath {
        let name = self.skeleton.bones.get(bone).map_or("", |bone| bone.name.as_str());
        self.path().then(PathKind::Bone, bone, name)
    }
}

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
