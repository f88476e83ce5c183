//! Unsaved work of an earlier session: offered, and restored.

use super::Source;
use super::message::DocumentReply;
use super::offer::Offer;
use super::owner::Document;
use super::replay::replay;
use super::scan::{Decision, RecoveryScan};
use dragonfly_store::{Claim, Journal, JournalError, Opening, Recoverable, Resumed};
use std::path::PathBuf;
use std::time::Instant;

impl Document {
    /// Offers the unsaved work that was found, except work that is offered together with its model.
    pub(super) fn offer(&mut self, scan: RecoveryScan) {
        if self.job.is_some() {
            self.scan = Some(scan);
            return;
        }
        scan.unreadable.into_iter().for_each(|text| self.reply(DocumentReply::Warning(text)));
        let waiting = self.waiting.as_ref().map(|waiting| &waiting.journal);
        let own = self.open.as_ref().and_then(|open| open.journal_writer.path());
        let scene = self.scene.as_ref().and_then(|scene| scene.journal());
        let taken = |offer: &Offer| {
            let journal = &offer.found.journal;
            Some(journal) == waiting || Some(&**journal) == own || Some(&**journal) == scene
        };
        let offers: Vec<_> = scan.offers.into_iter().filter(|offer| !taken(offer)).collect();
        let searched = std::mem::take(&mut self.searched);
        if !offers.is_empty() {
            self.reply(DocumentReply::Offers(offers));
        } else if searched {
            self.reply(DocumentReply::NothingToOffer);
        }
    }

    /// Offers unsaved work that was found while the first model was loading.
    pub(super) fn offer_late(&mut self) {
        if let Some(scan) = self.scan.take() {
            self.offer(scan);
        }
    }

    /// Starts the journal of the document that was just opened, or continues the existing one.
    pub(super) fn begin_journal(&mut self) {
        let (Some(open), Some(autosave)) = (&mut self.open, self.autosave.clone()) else { return };
        let Some(path) = open.loaded.path.clone() else {
            return open.journal_writer.begin_later(None, None);
        };
        let stamp = open.stamp();
        match autosave.begin(Some(&path), stamp.as_ref()) {
            Ok(Opening::New(journal)) => {
                open.journal_writer.set(*journal);
            }
            Ok(Opening::Found(found)) => self.meet(*found),
            Err(JournalError::Held { owner, .. }) => {
                let whom = owner.map_or_else(String::new, |owner| format!(" ({owner})"));
                let text = format!(
                    "{} is open in another window too{whom}; a save asks before it overwrites changes made there",
                    open.file.title
                );
                self.begin_beside();
                self.reply(DocumentReply::Warning(text));
            }
            Err(error) => open.journal_writer.not_begun(Some(path), stamp, &error),
        }
    }

    /// Starts another journal, in addition to the existing one.
    pub(super) fn begin_beside(&mut self) {
        let (Some(open), Some(autosave)) = (&mut self.open, &self.autosave) else { return };
        let stamp = open.stamp();
        match autosave.begin_another(open.file.path.as_deref(), stamp.as_ref()) {
            Ok(journal) => {
                open.journal_writer.set(journal);
            }
            Err(error) => open.journal_writer.not_begun(open.file.path.clone(), stamp, &error),
        }
    }

    /// Handles the existing journal of the document that was just opened.
    fn meet(&mut self, found: Recoverable) {
        let Some(autosave) = &self.autosave else { return };
        let offer = match Offer::of(autosave, &found) {
            Ok(offer) => offer,
            Err(reason) => {
                self.reply(DocumentReply::Warning(reason));
                return self.begin_beside();
            }
        };
        if offer.steps > 0 {
            self.waiting = Some(found);
            return self.reply(DocumentReply::Offers(vec![offer]));
        }
        // The journal has history and no unsaved work.
        match autosave.resume(&found, Claim::IfFree) {
            Ok(resumed) => self.go_on(resumed, &found, false),
            Err(_) => self.begin_beside(),
        }
    }

    /// Applies the decision of the user about unsaved work.
    pub(super) fn decide(&mut self, offer: Offer, decision: Decision) {
        let own = self.waiting.take_if(|waiting| waiting.journal == offer.found.journal).is_some();
        match decision {
            Decision::Discard => {
                if let Some(Err(error)) =
                    self.autosave.as_ref().map(|autosave| autosave.discard(&offer.found))
                {
                    self.reply(DocumentReply::Warning(error.to_string()));
                }
                if own {
                    self.begin_journal();
                }
            }
            Decision::Later if own => self.begin_beside(),
            Decision::Later => {}
            Decision::Keep | Decision::Beside if own => {
                self.restore(&offer, decision);
                self.changed();
            }
            Decision::Keep | Decision::Beside => match offer.source.clone() {
                Some(source) => self.open(source, Some((offer, decision))),
                None => self.reply(DocumentReply::Warning(format!(
                    "{}: the model of this unsaved work is unknown",
                    offer.title
                ))),
            },
        }
        self.report_trouble();
    }

    /// Restores work in the file that the user chose, if it has the contents to which the work belongs.
    pub(super) fn found_at(&mut self, offer: Offer, path: PathBuf) {
        match offer.is_of(&path) {
            Ok(true) => {
                let chosen = offer.source.as_ref().map(Source::conventions).unwrap_or_default();
                let source = Source::of(path, chosen);
                let offer = Offer { source: Some(source.clone()), ..offer };
                self.open(source, Some((offer, Decision::Keep)));
            }
            Ok(false) => self.reply(DocumentReply::OtherFile(Box::new(offer), path)),
            Err(reason) => {
                self.reply(DocumentReply::Warning(reason));
                // The path may be mistyped, so the work is offered again.
                self.reply(DocumentReply::Offers(vec![offer]));
            }
        }
    }

    /// Restores work in the model that was opened for it.
    pub(super) fn restore(&mut self, offer: &Offer, decision: Decision) {
        let (Some(open), Some(autosave)) = (&mut self.open, self.autosave.clone()) else { return };
        let beside = decision == Decision::Beside || offer.found.document.is_none();
        let resumed = if decision == Decision::Beside {
            autosave.copy(&offer.found, None)
        } else if let Some(path) = offer.moved_to() {
            // A journal of the file at its present path; the old one is no longer needed.
            autosave.copy(&offer.found, Some(path)).inspect(|_| {
                if let Err(error) = autosave.discard(&offer.found) {
                    tracing::warn!("{error}");
                }
            })
        } else {
            autosave.resume(&offer.found, Claim::Anyway)
        };
        if beside {
            open.leave_file();
        }
        match resumed {
            Ok(resumed) => self.go_on(resumed, &offer.found, true),
            Err(error) => {
                self.reply(DocumentReply::Warning(format!(
                    "The unsaved work could not be restored: {error}"
                )));
                self.begin_beside();
            }
        }
    }

    /// Continues with a journal, as far as its edits can be applied again.
    fn go_on(&mut self, resumed: Resumed, found: &Recoverable, wanted: bool) {
        let Some(open) = &mut self.open else { return };
        let Resumed { journal, entries, cut } = resumed;
        let model = &open.opened().model;
        let replayed = replay(model, open.texts_as_read(), &entries);
        let fits = replayed.is_of(model, open.texts_as_read())
            && found.file == dragonfly_store::DocumentFileState::Same;
        if !wanted && (replayed.stopped.is_some() || !fits || !replayed.edited.is_saved()) {
            let text = format!(
                "The history of {} belongs to other contents of the file; a new history was started",
                open.file.title
            );
            self.put_away(journal, "");
            self.begin_new_journal();
            return self.reply(DocumentReply::Notice(text));
        }
        let steps = replayed.edited.unsaved_steps();
        let stopped = replayed.stopped.clone();
        open.go_on(replayed);
        if wanted {
            let what = if steps == 1 { "1 step".to_owned() } else { format!("{steps} steps") };
            let title = open.file.title.clone();
            self.reply(DocumentReply::Notice(format!("Restored the unsaved work of {title}: {what}")));
        }
        match stopped {
            None => self.go_on_in(journal),
            Some(reason) => {
                let kept = self.put_away(journal, "the journal is kept in ");
                let text = format!("Not all of the unsaved work could be restored: {reason}; {kept}");
                self.begin_beside();
                self.reply(DocumentReply::Warning(text));
                self.snapshot_now();
            }
        }
        if cut > 0 {
            tracing::warn!("{cut} bytes at the end of {} could not be read", found.journal.display());
        }
    }

    fn go_on_in(&mut self, journal: Journal) {
        let Some(open) = &mut self.open else { return };
        let beside = open.file.path.is_none();
        open.journal_writer.set(journal);
        // A separate document depends on the file only for the model.
        if beside {
            self.snapshot_now();
        }
    }

    fn snapshot_now(&mut self) {
        if let Some(open) = &mut self.open {
            let own = open.file.path.is_none() && open.loaded.path.is_some();
            if own && open.base.is_none() {
                open.base = Some(open.base());
            }
            open.snapshot(own, Instant::now());
        }
    }

    fn begin_new_journal(&mut self) {
        let (Some(open), Some(autosave)) = (&mut self.open, &self.autosave) else { return };
        let stamp = open.stamp();
        match autosave.begin(open.file.path.as_deref(), stamp.as_ref()) {
            Ok(Opening::New(journal)) => {
                open.journal_writer.set(*journal);
            }
            _ => self.begin_beside(),
        }
    }

    /// Moves a journal to the trash folder. Returns a message with its path.
    fn put_away(&self, journal: Journal, says: &str) -> String {
        match self.autosave.as_ref().map(|autosave| autosave.discard_own(journal)) {
            Some(Ok(path)) => format!("{says}{}", path.display()),
            Some(Err(error)) => error.to_string(),
            None => String::new(),
        }
    }
}
