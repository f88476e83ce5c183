//! The check of a take for defects.

use super::take_thresholds::TakeThresholds;
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::lint::LintFinding;
use dragonfly_runtime::Job;
use std::path::Path;
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
    /// A sentence about thresholds that the model has no use for.
    pub warning: Option<String>,
}

/// The state of the checks of takes.
#[derive(Default)]
pub(super) struct TakeChecking {
    /// The job of the newest check; dropping it cancels it.
    pub(super) job: Option<Job>,
    /// The warning of the last check. Each state of a take is checked, and the user is warned once.
    pub(super) warning: Option<String>,
}

impl TakeCheck {
    /// Returns the defects, with the thresholds in the file next to `model`, or the usual ones; a model without a file (`None`) has the usual ones.
    ///
    /// # Errors
    ///
    /// The reason why the take cannot be checked, or what is wrong with the thresholds.
    pub fn run(&self, model: Option<&Path>) -> Result<CheckedTake, String> {
        let thresholds = model.map_or_else(|| Ok(TakeThresholds::default()), TakeThresholds::of_model)?;
        let warning = thresholds.unknown_joints(&self.skeleton).zip(model).map(|(text, model)| {
            let path = TakeThresholds::beside(model);
            format!("{}: {text}", path.display())
        });
        let findings =
            thresholds.with_unit(self.meters_per_unit).check(&self.take, &self.skeleton, self.rate)?;
        Ok(CheckedTake { take: Arc::clone(&self.take), findings, warning })
    }
}
