//! The job that imports the takes of files onto the open model, as one edit.

use super::Change;
use super::clip_news::{ClipNews, imported};
use super::clip_order::ClipOrder;
use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use crate::edit::{AddTakes, Edit};
use crate::text::sentence;
use dragonfly_runtime::{Job, JobContext};
use std::sync::Arc;
use std::time::Instant;

impl Document {
    /// Imports the takes of files onto the open model, in a job.
    pub(super) fn import_takes(&mut self, order: ClipOrder) {
        let Some(open) = &self.open else {
            return self.reply(DocumentReply::Refused("Open a model first".to_owned()));
        };
        let (adapter, load) = (open.edited.adapter().clone(), self.load);
        let target = Arc::clone(&open.loaded.model);
        let count = order.files.len();
        let work = move |job: &JobContext<JobNews>| {
            let mut progress = |read: usize| {
                job.report(read as f32 / count.max(1) as f32, |_| {
                    JobNews::Clips(ClipNews::Progress(read, count))
                });
            };
            let done = imported(&order, &adapter, &target, load, job.cancel_flag(), &mut progress);
            JobNews::Clips(match job.is_cancelled() {
                true => ClipNews::Failed("the import was cancelled".to_owned()),
                false => ClipNews::Done(done),
            })
        };
        let failed = |panic: &str| JobNews::Clips(ClipNews::Failed(format!("the importer failed: {panic}")));
        match Job::start(&self.own, "import takes", work, failed) {
            Ok(job) => self.clip_import = Some(job),
            Err(error) => self.reply(DocumentReply::Warning(error.to_string())),
        }
    }

    /// Cancels the import of takes. Returns whether one was running.
    pub(super) fn cancel_import(&mut self) -> bool {
        self.clip_import.take().is_some()
    }

    /// Handles news of the job. News of a cancelled one are ignored.
    pub(super) fn clip_news(&mut self, news: ClipNews, now: Instant) {
        if self.clip_import.is_none() {
            return;
        }
        match news {
            ClipNews::Progress(read, all) => {
                self.reply(DocumentReply::Notice(format!("Importing takes: {read} of {all} files")));
            }
            ClipNews::Failed(reason) => {
                self.clip_import = None;
                self.reply(DocumentReply::Refused(sentence(&reason)));
            }
            ClipNews::Done(done) => {
                self.clip_import = None;
                let summary = done.summary();
                if !done.takes.is_empty() {
                    let edit = Edit::AddTakes(AddTakes { takes: done.takes });
                    self.change(Change::Edit(edit, None), None, now);
                    // The view goes first: the status line shows the last message.
                    self.publish();
                }
                match &*done.failed {
                    [] => self.reply(DocumentReply::Notice(summary)),
                    [reason] => self.reply(DocumentReply::Warning(reason.clone())),
                    [first, more @ ..] => {
                        let text = format!("{first}; and {} more files were not imported", more.len());
                        self.reply(DocumentReply::Warning(text));
                    }
                }
            }
        }
    }
}
