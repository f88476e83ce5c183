//! The open file, read again after another program changed it, with the unsaved edits of the document.

use super::message::DocumentReply;
use super::open::Open;
use super::owner::Document;
use super::rebase::{Rebased, rebased};
use super::{OpenedModel, Source};
use std::sync::Arc;
use std::time::Instant;

impl Document {
    /// Starts to read the open file again in the background, for its unsaved edits.
    pub(super) fn reload(&mut self) {
        let Some(path) = self.open.as_ref().and_then(|open| open.file.path.clone()) else {
            let reason = "The document was never saved, so there is no file to load again";
            return self.reply(DocumentReply::Refused(reason.to_owned()));
        };
        let chosen = self.open.as_ref().map(|open| open.source().conventions()).unwrap_or_default();
        self.open(Source::of(path, chosen), None);
        if let Some(job) = &mut self.job {
            job.gets_edits = true;
        }
    }

    /// Replaces the open document by a new version of its file, `source`, with the unsaved edits. The new journal has all of them before
    /// the old one goes to the trash folder. If another file is open by now, it stays.
    pub(super) fn rebase(&mut self, opened: OpenedModel, source: &Source) {
        let is_open = |open: &mut Open| open.file.path.as_deref() == source.path();
        let Some(mut old) = self.open.take_if(is_open) else {
            return self.reply(DocumentReply::Cancelled);
        };
        (self.waiting, self.noticed) = (None, None);
        let Rebased { edited, unfit } = rebased(&old.edited, opened.adapter());
        let mut open = Open::new(opened, self.autosave.clone());
        open.start_with(edited);
        if let Some(autosave) = &self.autosave {
            let (path, stamp) = (open.file.path.clone(), open.stamp());
            match autosave.begin_another(path.as_deref(), stamp.as_ref()) {
                Ok(journal) => open.begin_journal_with_steps(journal, Instant::now()),
                Err(error) => open.journal_writer.not_begun(path, stamp, &error),
            }
            let is_recorded = !open.journal_writer.has_gap();
            let ended = if is_recorded { old.discard_journal(autosave) } else { old.close(Some(autosave)) };
            if let Err(reason) = ended {
                self.reply(DocumentReply::Warning(reason));
            }
        }
        let loaded = Arc::clone(&open.loaded);
        self.open = Some(open);
        self.reply(DocumentReply::Opened(loaded));
        self.reply(DocumentReply::Rebased(unfit));
        self.report_trouble();
        self.changed();
        self.offer_late();
    }
}
