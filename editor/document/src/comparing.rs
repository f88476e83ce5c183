//! The job that reads another file, whose takes are compared with those of the open model.

use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use super::{LoadedModel, Loader, Source};
use crate::text::sentence;
use dragonfly_runtime::Job;
use std::sync::Arc;

impl Document {
    /// Reads a file as opening does. The reply is [`DocumentReply::ComparedRead`].
    pub(super) fn read_compared(&mut self, source: Source, load: Loader) {
        let begun = Job::start(
            &self.own,
            "compared file",
            move |job| {
                let loaded = load(&source, &mut |_| {}, job.cancel_flag());
                let loaded = loaded.map(|opened| Arc::new(opened.loaded));
                JobNews::Compared(loaded.map_err(|error| error.to_string()))
            },
            |panic| JobNews::Compared(Err(format!("the importer failed: {panic}"))),
        );
        match begun {
            Ok(job) => self.comparing = Some(job),
            Err(error) => self.reply(DocumentReply::Warning(error.to_string())),
        }
    }

    /// Handles the file that was read.
    pub(super) fn compared_read(&mut self, result: Result<Arc<LoadedModel>, String>) {
        self.reply(match result {
            Ok(loaded) => DocumentReply::ComparedRead(loaded),
            Err(reason) => DocumentReply::Warning(sentence(&format!("nothing is compared: {reason}"))),
        });
    }
}
