//! The check of a take for defects.

use crate::adapter::stored_contacts;
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::lint::{LintFinding, LintThresholds, lint_take};
use std::sync::Arc;

/// A take to be checked.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeCheck {
    /// The take.
    pub take: Arc<Take>,
    /// The skeleton of the model.
    pub skeleton: Arc<Skeleton>,
    /// Frames per second.
    pub rate: f32,
    /// Meters in one unit of length of the model.
    pub meters_per_unit: f32,
}

/// The defects of a take.
#[derive(Clone, Debug)]
pub struct CheckedTake {
    /// The take.
    pub take: Arc<Take>,
    /// The defects, those of one rule together.
    pub findings: Vec<LintFinding>,
}

impl TakeCheck {
    /// Returns the defects with the usual thresholds. The contacts stored with the take are used for foot slide.
    ///
    /// # Errors
    ///
    /// The reason why the take cannot be checked.
    pub fn run(&self) -> Result<CheckedTake, String> {
        let given = stored_contacts(&self.take.extras, &self.skeleton);
        let mut limits = LintThresholds::default();
        limits.given = given;
        limits.contacts.meters_per_unit = self.meters_per_unit;
        let findings = lint_take(&self.take, &self.skeleton, self.rate, &limits);
        let take = Arc::clone(&self.take);
        findings.map(|findings| CheckedTake { take, findings }).map_err(|error| error.to_string())
    }
}
