//! The job that exports the open model.

use super::export::{ExportOrder, ExportQuestions, ExportReport, export_files};
use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_runtime::{Job, JobContext};
use std::sync::Arc;

impl Document {
    /// Exports the open model as it is now, in a job; or finds out what the export would lose.
    pub(super) fn export(&mut self, order: ExportOrder) {
        if let Some(order) = self.export_questions.begin(order) {
            self.start_export(order);
        }
    }

    fn start_export(&mut self, order: ExportOrder) {
        let Some(open) = &self.open else {
            self.export_questions = ExportQuestions::default();
            return self.reply(DocumentReply::Refused("Open a model first".to_owned()));
        };
        let adapter = open.edited.adapter().clone();
        let loaded = Arc::clone(&open.loaded);
        let failed = order.clone();
        let work = move |_: &JobContext<JobNews>| {
            let animation =
                AnimationData { skeleton: Arc::clone(adapter.skeleton()), takes: adapter.saved_takes() };
            let model = ModelData { animation, ..(*loaded.model).clone() };
            let done = export_files(&model, &order);
            JobNews::Exported(Box::new((order, done)))
        };
        let panicked = move |panic: &str| {
            JobNews::Exported(Box::new((failed, Err(format!("the export failed: {panic}")))))
        };
        match Job::start(&self.own, "export", work, panicked) {
            // Dropping a job would cancel it; files are written to their end.
            Ok(job) => job.detach(),
            Err(error) => {
                self.export_questions = ExportQuestions::default();
                self.reply(DocumentReply::Warning(error.to_string()));
            }
        }
    }

    /// Handles the end of the job.
    pub(super) fn exported(&mut self, (order, done): (ExportOrder, Result<ExportReport, String>)) {
        let is_question = !order.is_written;
        self.reply(DocumentReply::Exported(order, done));
        if is_question && let Some(next) = self.export_questions.next() {
            self.start_export(next);
        }
    }
}
