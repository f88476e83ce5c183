//! The job that checks a take for defects: a long take has many poses.

use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use super::take_check::{CheckedTake, TakeCheck};
use crate::text::sentence;
use dragonfly_runtime::Job;

impl Document {
    /// Checks a take in a job. The reply is [`DocumentReply::Checked`].
    pub(super) fn check_take(&mut self, check: TakeCheck) {
        let model = self.open.as_ref().and_then(|open| open.file.path.clone());
        let begun = Job::start(
            &self.own,
            "check",
            move |_| JobNews::Checked(check.run(model.as_deref())),
            |panic| JobNews::Checked(Err(format!("the take could not be checked: {panic}"))),
        );
        match begun {
            Ok(job) => self.checking.job = Some(job),
            Err(error) => self.reply(DocumentReply::Warning(error.to_string())),
        }
    }

    /// Handles the result of the check.
    pub(super) fn checked(&mut self, result: Result<CheckedTake, String>) {
        let checked = match result {
            Ok(checked) => checked,
            Err(reason) => return self.reply(DocumentReply::Refused(sentence(&reason))),
        };
        if self.checking.warning != checked.warning {
            self.checking.warning.clone_from(&checked.warning);
            checked.warning.iter().for_each(|text| self.reply(DocumentReply::Warning(text.clone())));
        }
        self.reply(DocumentReply::Checked(checked));
    }
}
