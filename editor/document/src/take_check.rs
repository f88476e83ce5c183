//! The check of a take for defects, in a job: a long take has many poses.

use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use crate::adapter::stored_contacts;
use crate::text::sentence;
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::lint::{LintFinding, LintThresholds, lint_take};
use dragonfly_runtime::Job;
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
        let findings = lint_take(&self.take, &self.skeleton, self.rate, &limits);
        let take = Arc::clone(&self.take);
        findings.map(|findings| CheckedTake { take, findings }).map_err(|error| error.to_string())
    }
}

impl Document {
    /// Checks a take in a job. The reply is [`DocumentReply::Checked`].
    pub(super) fn check_take(&mut self, check: TakeCheck) {
        let begun = Job::start(
            &self.own,
            "check",
            move |_| JobNews::Checked(check.run()),
            |panic| JobNews::Checked(Err(format!("the take could not be checked: {panic}"))),
        );
        match begun {
            Ok(job) => self.checking = Some(job),
            Err(error) => self.reply(DocumentReply::Warning(error.to_string())),
        }
    }

    /// Handles the result of the check.
    pub(super) fn checked(&mut self, result: Result<CheckedTake, String>) {
        self.reply(match result {
            Ok(checked) => DocumentReply::Checked(checked),
            Err(reason) => DocumentReply::Refused(sentence(&reason)),
        });
    }
}
