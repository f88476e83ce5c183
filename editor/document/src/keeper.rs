//! Keeps the journal of what is open: what was done is in the hands of the system before it counts as done.
//!
//! A journal that fails does not stop the work. It is said once, and tried again: not from where it failed, since what
//! came meanwhile would be missing, but with a snapshot of everything.

use super::history::Gesture;
use super::recorded::{About, Recorded};
use dragonfly_store::{Autosave, FileStamp, Journal, JournalError};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// After a failure, the journal is tried again no sooner than this.
const AGAIN: Duration = Duration::from_secs(2);

/// A gesture whose end nobody told is over when nothing came for so long.
const QUIET: Duration = Duration::from_secs(1);

/// A journal is not begun anew before it has so many bytes, nor before it is so many times as large as it was then.
const LARGE: u64 = 1 << 20;
const GROWN: u64 = 4;

/// The journal of what is open, if there is one.
#[derive(Debug, Default)]
pub(super) struct Keeper {
    autosave: Option<Autosave>,
    journal: Option<Journal>,
    /// The document that a journal is to be begun for when there is something to record.
    wanted: Option<(Option<PathBuf>, Option<FileStamp>)>,
    /// Was it said in this journal that this program records?
    begun: bool,
    /// Is something missing in it? Since when, as it was tried last.
    gap: Option<Instant>,
    /// Bytes when it was begun anew.
    compact: u64,
    gesture: Option<(Gesture, Instant)>,
    line: Vec<u8>,
    /// What a person must be told, once each.
    trouble: Vec<String>,
}

impl Keeper {
    /// Keeps nothing before it has a journal.
    pub(super) fn new(autosave: Option<Autosave>) -> Self {
        Self { autosave, ..Self::default() }
    }

    /// Begins a journal as soon as there is something to record.
    pub(super) fn begin_later(&mut self, document: Option<PathBuf>, stamp: Option<FileStamp>) {
        self.wanted = Some((document, stamp));
    }

    /// From now on it is this one.
    pub(super) fn set(&mut self, journal: Journal) -> Option<Journal> {
        self.compact = journal.size();
        (self.begun, self.gap, self.wanted) = (false, None, None);
        self.journal.replace(journal)
    }

    /// The journal, to save with it; none while something is missing in it.
    pub(super) fn journal(&mut self) -> Option<&mut Journal> {
        self.journal.as_mut().filter(|_| self.gap.is_none())
    }

    /// Where the journal is.
    pub(super) fn path(&self) -> Option<&Path> {
        self.journal.as_ref().map(Journal::path)
    }

    /// Gives the journal away.
    pub(super) fn take(&mut self) -> Option<Journal> {
        self.journal.take()
    }

    /// What is to be said, each once.
    pub(super) fn trouble(&mut self) -> Vec<String> {
        std::mem::take(&mut self.trouble)
    }

    /// Appends what was done. When this returns, the system has it, or somebody will be told that it has not.
    pub(super) fn record(&mut self, about: &About, recorded: &Recorded<'_>, now: Instant) {
        self.begin();
        if self.journal.is_none() || self.gap.is_some() {
            return;
        }
        let done = self.begun(about, now).and_then(|()| self.append(recorded, now));
        if let Err(error) = done {
            return self.failed(&error, now);
        }
        match recorded {
            Recorded::Edit { gesture: Some(gesture), .. } => {
                if self.gesture.is_some_and(|(other, _)| other != *gesture) {
                    self.end_of_gesture(now);
                }
                self.gesture = Some((*gesture, now));
            }
            _ => self.end_of_gesture(now),
        }
    }

    /// The button was released: what was appended is due on the disk.
    pub(super) fn release(&mut self, gesture: Gesture, now: Instant) {
        if self.gesture.is_some_and(|(own, _)| own == gesture) {
            self.end_of_gesture(now);
        }
    }

    fn end_of_gesture(&mut self, now: Instant) {
        self.gesture = None;
        if let Some(journal) = &mut self.journal {
            journal.end_of_gesture(now);
        }
    }

    fn begin(&mut self) {
        let (Some(autosave), Some((document, stamp))) = (&self.autosave, self.wanted.take()) else { return };
        match autosave.begin_beside(document.as_deref(), stamp.as_ref()) {
            Ok(journal) => {
                self.set(journal);
            }
            Err(error) => self.never(&error),
        }
    }

    fn begun(&mut self, about: &About, now: Instant) -> Result<(), JournalError> {
        if !self.begun {
            self.append(&Recorded::Begin(about.clone()), now)?;
            self.begun = true;
        }
        Ok(())
    }

    fn append(&mut self, recorded: &Recorded<'_>, now: Instant) -> Result<(), JournalError> {
        let Some(journal) = &mut self.journal else { return Ok(()) };
        self.line.clear();
        // Fails for nothing that could be done: numbers are finite, keys are text.
        if let Err(error) = serde_json::to_writer(&mut self.line, recorded) {
            tracing::error!("an edit has no JSON: {error}");
        }
        journal.append(&self.line, now)
    }

    /// There is no journal, and there will be none.
    pub(super) fn never(&mut self, error: &JournalError) {
        self.trouble.push(format!("Unsaved work is not recorded, so a crash would lose it: {error}"));
    }

    fn failed(&mut self, error: &JournalError, now: Instant) {
        if self.gap.is_none() {
            self.trouble.push(format!("Unsaved work is not recorded at present: {error}; save to be safe"));
        }
        self.gap = Some(now);
    }

    /// Brings to the disk what is due.
    pub(super) fn sync(&mut self, now: Instant) {
        if self.gesture.is_some_and(|(_, last)| now.saturating_duration_since(last) >= QUIET) {
            self.end_of_gesture(now);
        }
        if self.gap.is_none()
            && let Some(journal) = &mut self.journal
            && let Err(error) = journal.sync_if_due(now)
        {
            self.failed(&error, now);
        }
    }

    /// Is a snapshot wanted: because something is missing, or because it would be much shorter than what is there?
    pub(super) fn wants_snapshot(&self, now: Instant) -> bool {
        let Some(journal) = &self.journal else { return false };
        match self.gap {
            Some(last) => now.saturating_duration_since(last) >= AGAIN,
            None => self.gesture.is_none() && journal.size() > LARGE.max(self.compact.saturating_mul(GROWN)),
        }
    }

    /// Is something missing in the journal?
    pub(super) fn has_gap(&self) -> bool {
        self.gap.is_some()
    }

    /// Begins the journal anew with everything; is that what the file holds?
    pub(super) fn snapshot(&mut self, bytes: &[u8], saved: bool, now: Instant) {
        let Some(journal) = &mut self.journal else { return };
        match journal.compact_as(bytes, saved) {
            Ok(()) => {
                self.compact = journal.size();
                self.begun = false;
                if self.gap.take().is_some() {
                    self.trouble.push("Unsaved work is recorded again".to_owned());
                }
            }
            // The old one goes on, if it can.
            Err(error) if self.gap.is_some() || journal.broken().is_some() => self.failed(&error, now),
            Err(error) => {
                self.compact = journal.size();
                tracing::warn!("{error}");
            }
        }
    }

    /// When there is something to do without being told.
    pub(super) fn next_due(&self) -> Option<Instant> {
        let again = self.gap.filter(|_| self.journal.is_some()).map(|last| last + AGAIN);
        let due = self.journal.as_ref().filter(|_| self.gap.is_none()).and_then(Journal::next_due);
        let quiet = self.gesture.map(|(_, last)| last + QUIET);
        [again, due, quiet].into_iter().flatten().min()
    }
}
