//! Unsaved work of an earlier time: found, offered, brought back.

use super::Source;
use super::message::DocumentReply;
use super::offer::Offer;
use super::owner::Document;
use super::replay::replay;
use dragonfly_store::{
    Autosave, Bounds, Claim, Journal, JournalError, Opening, Reading, Recoverable, Resumed,
};
use std::path::PathBuf;
use std::time::Instant;

/// What becomes of unsaved work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// It goes on, with its history.
    Keep,
    /// It is opened as a document of its own, which has no file yet; where it is stays as it is.
    Beside,
    /// Into the bin.
    Discard,
    /// It is left where it is, and offered another time.
    Later,
}

/// Unsaved work of what is open, of which nothing is decided yet.
pub(super) struct Waiting(Recoverable);

/// Journals with nothing but history that are kept.
const HISTORIES: Bounds = Bounds { least: 20, most: 200, bytes: 1 << 30 };

/// What was found in the autosave folder.
#[derive(Debug, Default)]
pub(super) struct Scan {
    offers: Vec<Offer>,
    /// Journals that cannot be read, and why.
    unreadable: Vec<String>,
}

impl Scan {
    /// Looks at everything; what only takes room is put away.
    pub(super) fn of(autosave: &Autosave) -> Self {
        let mut scan = Self::default();
        if let Err(error) = autosave.tidy(HISTORIES) {
            tracing::warn!("{error}");
        }
        let found = match autosave.recoverable() {
            Ok(found) => found,
            Err(error) => {
                scan.unreadable.push(error.to_string());
                return scan;
            }
        };
        for found in found {
            match &found.reading {
                Reading::Newer(version) => scan.unreadable.push(format!(
                    "{}: a newer version of this program recorded unsaved work here (format {version}); it was left as it is",
                    found.journal.display()
                )),
                Reading::Damaged(reason) => scan.unreadable.push(format!(
                    "{}: no unsaved work can be read here: {reason}; it was left as it is",
                    found.journal.display()
                )),
                Reading::Whole | Reading::Cut(_) if found.is_offered() => match Offer::of(autosave, &found) {
                    Ok(offer) if offer.steps > 0 => scan.offers.push(offer),
                    Ok(_) => {}
                    Err(reason) => scan.unreadable.push(reason),
                },
                Reading::Whole | Reading::Cut(_) => {}
            }
        }
        scan
    }
}

impl Document {
    /// Offers what was found, but for what is offered with the model that it belongs to.
    pub(super) fn offer(&mut self, scan: Scan) {
        if self.job.is_some() {
            self.scan = Some(scan);
            return;
        }
        scan.unreadable.into_iter().for_each(|text| self.reply(DocumentReply::Warned(text)));
        let waiting = self.waiting.as_ref().map(|waiting| &waiting.0.journal);
        let own = self.open.as_ref().and_then(|open| open.keeper.path());
        let taken =
            |offer: &Offer| Some(&offer.found.journal) == waiting || Some(&*offer.found.journal) == own;
        let offers: Vec<_> = scan.offers.into_iter().filter(|offer| !taken(offer)).collect();
        let searched = std::mem::take(&mut self.searched);
        if !offers.is_empty() {
            self.reply(DocumentReply::Offers(offers));
        } else if searched {
            self.reply(DocumentReply::NothingToOffer);
        }
    }

    /// Offers what was found while the first model was on its way.
    pub(super) fn offer_late(&mut self) {
        if let Some(scan) = self.scan.take() {
            self.offer(scan);
        }
    }

    /// Begins the journal of what was just opened; or goes on with it, where there is one.
    pub(super) fn begin_journal(&mut self) {
        let (Some(open), Some(autosave)) = (&mut self.open, self.autosave.clone()) else { return };
        let Some(path) = open.loaded.path.clone() else {
            return open.keeper.begin_later(None, None);
        };
        let stamp = open.stamp();
        match autosave.begin(Some(&path), stamp.as_ref()) {
            Ok(Opening::New(journal)) => {
                open.keeper.set(*journal);
            }
            Ok(Opening::Found(found)) => self.meet(*found),
            Err(JournalError::Held { owner, .. }) => {
                let whom = owner.map_or_else(String::new, |owner| format!(" ({owner})"));
                let text = format!(
                    "{} is open in another window as well{whom}: whoever saves last is warned before anything is overwritten",
                    open.file.title
                );
                self.begin_beside();
                self.reply(DocumentReply::Warned(text));
            }
            Err(error) => open.keeper.never(&error),
        }
    }

    /// A journal beside those that are there.
    fn begin_beside(&mut self) {
        let (Some(open), Some(autosave)) = (&mut self.open, &self.autosave) else { return };
        let stamp = open.stamp();
        match autosave.begin_beside(open.file.path.as_deref(), stamp.as_ref()) {
            Ok(journal) => {
                open.keeper.set(journal);
            }
            Err(error) => open.keeper.never(&error),
        }
    }

    /// There is a journal of what was just opened.
    fn meet(&mut self, found: Recoverable) {
        let Some(autosave) = &self.autosave else { return };
        let offer = match Offer::of(autosave, &found) {
            Ok(offer) => offer,
            Err(reason) => {
                self.reply(DocumentReply::Warned(reason));
                return self.begin_beside();
            }
        };
        if offer.steps > 0 {
            self.waiting = Some(Waiting(found));
            return self.reply(DocumentReply::Offers(vec![offer]));
        }
        // Nothing but history.
        match autosave.keep(&found, Claim::IfFree) {
            Ok(resumed) => self.go_on(resumed, &found, false),
            Err(_) => self.begin_beside(),
        }
    }

    /// Does what a person decided.
    pub(super) fn decide(&mut self, offer: Offer, decision: Decision) {
        let own = self.waiting.take_if(|waiting| waiting.0.journal == offer.found.journal).is_some();
        match decision {
            Decision::Discard => {
                if let Some(Err(error)) =
                    self.autosave.as_ref().map(|autosave| autosave.discard(&offer.found))
                {
                    self.reply(DocumentReply::Warned(error.to_string()));
                }
                if own {
                    self.begin_journal();
                }
            }
            Decision::Later if own => self.begin_beside(),
            Decision::Later => {}
            Decision::Keep | Decision::Beside if own => {
                self.bring_back(&offer, decision);
                self.changed();
            }
            Decision::Keep | Decision::Beside => match offer.source.clone() {
                Some(source) => self.open(source, Some((offer, decision))),
                None => self.reply(DocumentReply::Warned(format!("{}: its model is not known", offer.title))),
            },
        }
        self.tell_trouble();
    }

    /// The file is here now, a person says: goes on there if it holds what it held then.
    pub(super) fn found_at(&mut self, offer: Offer, path: PathBuf) {
        match offer.is_of(&path) {
            Ok(true) => {
                let offer = Offer { source: Some(Source::File(path.clone())), ..offer };
                self.open(Source::File(path), Some((offer, Decision::Keep)));
            }
            Ok(false) => self.reply(DocumentReply::OtherFile(Box::new(offer), path)),
            Err(reason) => {
                self.reply(DocumentReply::Warned(reason));
                // A path with a letter too many is no answer.
                self.reply(DocumentReply::Offers(vec![offer]));
            }
        }
    }

    /// Brings work back into the model that was opened for it.
    pub(super) fn bring_back(&mut self, offer: &Offer, decision: Decision) {
        let (Some(open), Some(autosave)) = (&mut self.open, self.autosave.clone()) else { return };
        let beside = decision == Decision::Beside || offer.found.document.is_none();
        let resumed = if decision == Decision::Beside {
            autosave.beside(&offer.found, None)
        } else if let Some(path) = offer.moved_to() {
            // A journal of the file where it is now; the other one is done with.
            autosave.beside(&offer.found, Some(path)).inspect(|_| {
                if let Err(error) = autosave.discard(&offer.found) {
                    tracing::warn!("{error}");
                }
            })
        } else {
            autosave.keep(&offer.found, Claim::Anyway)
        };
        if beside {
            open.leave_file();
        }
        match resumed {
            Ok(resumed) => self.go_on(resumed, &offer.found, true),
            Err(error) => {
                self.reply(DocumentReply::Warned(format!(
                    "The unsaved work could not be brought back: {error}"
                )));
                self.begin_beside();
            }
        }
    }

    /// Goes on with a journal, as far as what it holds can be done again.
    fn go_on(&mut self, resumed: Resumed, found: &Recoverable, wanted: bool) {
        let Some(open) = &mut self.open else { return };
        let Resumed { journal, entries, cut } = resumed;
        let replayed = replay(&open.loaded.model, &entries);
        let fits = replayed.is_of(&open.loaded.model) && found.file == dragonfly_store::Fate::Same;
        if !wanted && (replayed.stopped.is_some() || !fits || !replayed.edited.is_saved()) {
            let text = format!(
                "The history of {} is of another state of the file, so it begins anew",
                open.file.title
            );
            self.put_away(journal, "");
            self.begin_journal_anew();
            return self.reply(DocumentReply::Told(text));
        }
        let steps = replayed.edited.unsaved_steps();
        let stopped = replayed.stopped.clone();
        open.go_on(replayed);
        if wanted {
            let what = if steps == 1 { "1 step".to_owned() } else { format!("{steps} steps") };
            let title = open.file.title.clone();
            self.reply(DocumentReply::Told(format!("Brought back the unsaved work of {title}: {what}")));
        }
        match stopped {
            None => self.go_on_in(journal),
            Some(reason) => {
                let kept = self.put_away(journal, "the journal is kept in ");
                let text = format!("Not all of the unsaved work could be done again: {reason}; {kept}");
                self.begin_beside();
                self.reply(DocumentReply::Warned(text));
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
        open.keeper.set(journal);
        // A document of its own needs nothing of the file any more but the model.
        if beside {
            self.snapshot_now();
        }
    }

    fn snapshot_now(&mut self) {
        if let Some(open) = &mut self.open {
            let own = open.file.path.is_none() && open.loaded.path.is_some();
            if own && open.base.is_none() {
                open.base = Some(open.loaded.model.animation.takes.clone().into());
            }
            open.snapshot(own, Instant::now());
        }
    }

    fn begin_journal_anew(&mut self) {
        let (Some(open), Some(autosave)) = (&mut self.open, &self.autosave) else { return };
        let stamp = open.stamp();
        match autosave.begin(open.file.path.as_deref(), stamp.as_ref()) {
            Ok(Opening::New(journal)) => {
                open.keeper.set(*journal);
            }
            _ => self.begin_beside(),
        }
    }

    /// Puts a journal into the bin, and says where it is.
    fn put_away(&self, journal: Journal, says: &str) -> String {
        match self.autosave.as_ref().map(|autosave| autosave.put_away(journal)) {
            Some(Ok(path)) => format!("{says}{}", path.display()),
            Some(Err(error)) => error.to_string(),
            None => String::new(),
        }
    }
}

/// For tests of what is found.
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_folder_has_nothing_to_offer() {
        let folder = std::env::temp_dir().join(format!("dragonfly-nothing-{}", std::process::id()));
        let autosave = Autosave::new(std::sync::Arc::new(dragonfly_store::RealFiles), Some(folder)).unwrap();
        let scan = Scan::of(&autosave);
        assert!(scan.offers.is_empty() && scan.unreadable.is_empty(), "{scan:?}");
    }
}
