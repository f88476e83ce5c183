//! Opening a model in place of the open one: the job that loads it, its progress, its end.

use super::job::start_loading;
use super::loading_model::LoadingModel;
use super::message::DocumentReply;
use super::open::Open;
use super::owner::Document;
use super::running_save::Deferred;
use super::scan::Decision;
use super::{LoadError, Offer, OpenedModel, Progress, Source};
use std::sync::Arc;

impl Document {
    /// Starts to load a model in the background; `offer` is the unsaved work that it is opened for.
    pub(super) fn open(&mut self, source: Source, offer: Option<(Offer, Decision)>) {
        let ticket = self.next_ticket();
        self.job = None;
        let started = match self.faults.refuses_read() {
            true => Err(std::io::Error::other("injected fault")),
            false => start_loading(&self.own, ticket, source.clone(), self.load),
        };
        match started {
            Ok(job) => {
                let (gets_edits, of_scene) = (false, None);
                self.job = Some(LoadingModel { _job: job, ticket, source, offer, gets_edits, of_scene });
            }
            Err(error) => {
                self.stay();
                self.reply(DocumentReply::Failed { source, reason: error.to_string() });
                self.offer_late();
            }
        }
    }

    pub(super) fn cancel(&mut self) {
        let importing = self.cancel_import();
        self.cancel_copies();
        if self.job.take().is_some() || importing {
            self.stay();
            self.reply(DocumentReply::Cancelled);
        }
    }

    /// Reports the progress of the loading job with this ticket.
    pub(super) fn show_progress(&self, ticket: u64, progress: Progress) {
        if let Some(running) = self.job.as_ref().filter(|running| running.ticket == ticket) {
            self.reply(DocumentReply::Loading { title: running.source.title(), progress });
        }
    }

    /// Opens what the loading job with this ticket has loaded, or reports why it failed.
    pub(super) fn finish_loading(&mut self, ticket: u64, loaded: Result<Box<OpenedModel>, LoadError>) {
        if self.save.is_some() {
            return self.deferred.push_back(Deferred::Loaded(ticket, loaded));
        }
        let Some(mut running) = self.job.take_if(|running| running.ticket == ticket) else { return };
        match (loaded, running.of_scene.take()) {
            (Ok(opened), Some(model)) => {
                self.enter_model(*opened, model);
                self.offer_late();
            }
            (loaded, _) => self.finish_opening(loaded, running),
        }
    }

    /// Opens a model in place of the open one, or reports why it could not be read.
    fn finish_opening(&mut self, loaded: Result<Box<OpenedModel>, LoadError>, running: LoadingModel) {
        match loaded {
            Ok(opened) if running.gets_edits => self.rebase(*opened, &running.source),
            Ok(opened) => {
                self.close();
                let open = Open::new(*opened, self.autosave.clone());
                let loaded = Arc::clone(&open.loaded);
                self.open = Some(open);
                self.reply(DocumentReply::Opened(loaded));
                match running.offer {
                    Some((offer, decision)) => self.restore(&offer, decision),
                    None => self.begin_journal(),
                }
                self.report_trouble();
                self.changed();
                self.offer_late();
            }
            Err(LoadError::Cancelled) => {
                self.stay();
                self.reply(DocumentReply::Cancelled);
            }
            Err(error) => {
                self.stay();
                let reason = error.to_string();
                self.reply(DocumentReply::Failed { source: running.source, reason });
                self.offer_late();
            }
        }
    }

    /// Closes the open document, before another one is opened or the program ends.
    fn close(&mut self) {
        (self.waiting, self.noticed) = (None, None);
        if let Some(scene) = self.scene.take() {
            self.close_document(scene.into_open());
        }
        if let Some(open) = self.open.take() {
            self.close_document(open);
        }
    }

    pub(super) fn close_document(&mut self, mut open: Open) {
        if open.has_unsaved_work() && self.autosave.is_some() {
            let text = format!(
                "The unsaved work of {} can be restored when the file is opened again",
                open.file.title
            );
            self.reply(DocumentReply::Notice(text));
        }
        if let Err(reason) = open.close(self.autosave.as_ref()) {
            self.reply(DocumentReply::Warning(reason));
        }
    }
}
