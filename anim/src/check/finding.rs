//! A rule, and what it finds.

use super::context::TakeContext;
use super::path::ModelPath;
use crate::data::ModelData;
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
    pub(super) function: RuleFunction,
}

impl Rule {
    pub(super) const fn model(
        id: &'static str,
        severity: Severity,
        meaning: &'static str,
        function: fn(&ModelData, &mut Findings),
    ) -> Self {
        Self { id, severity, meaning, function: RuleFunction::Model(function) }
    }

    pub(super) const fn take(
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

/// Number of findings of one rule that a [`check`](super::check()) lists one by one; the rest is only counted.
pub const MAX_PER_RULE: usize = 100;

/// Collects the findings of one rule.
pub(crate) struct Findings {
    pub(super) rule: &'static Rule,
    pub(super) list: Vec<Finding>,
    pub(super) omitted: usize,
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
