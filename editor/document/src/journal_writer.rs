//! Writes the journal of the open document: an edit is handed to the system before it counts as applied.
//!
//! A journal that fails, or that cannot be created, does not stop the work. The user is warned once, and the journal is retried with
//! the next edit and after a while, with a snapshot of everything: the edits since the failure would be missing otherwise.

use super::history::Gesture;
use super::recorded::{EditsOrigin, Recorded};
use dragonfly_store::{
    Autosave, FileContents, FileStamp, Journal, JournalError, Successor, SuccessorJournal,
};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Delay before a failed journal is retried.
const RETRY_AFTER: Duration = Duration::from_secs(2);

/// Time without edits after which a gesture counts as ended, where its end was not reported.
const GESTURE_TIMEOUT: Duration = Duration::from_secs(1);

/// Size in bytes below which a journal is not compacted.
const COMPACT_ABOVE: u64 = 1 << 20;
/// Growth since the last compaction at which a journal is compacted.
const COMPACT_GROWTH: u64 = 4;

/// Writes the journal of the open document, if it has one.
#[derive(Debug, Default)]
pub(super) struct JournalWriter {
    autosave: Option<Autosave>,
    journal: Option<Journal>,
    /// The document whose journal is created with the first edit, or as soon as that is possible.
    wanted: Option<(Option<PathBuf>, Option<FileStamp>)>,
    /// Whether the journal could not be created so far.
    is_overdue: bool,
    /// Whether the document has steps already that the journal is to begin with.
    has_steps: bool,
    /// Whether this journal has the entry that names this program.
    begun: bool,
    /// Time of the last failure, while edits are missing in the journal.
    gap: Option<Instant>,
    /// Size in bytes after the last compaction.
    compact: u64,
    gesture: Option<(Gesture, Instant)>,
    line: Vec<u8>,
    /// The save that is running.
    save: Option<RecordedSave>,
    /// Warnings that the user has not seen yet.
    trouble: Vec<String>,
}

/// A save that is running, as far as the journal is concerned.
#[derive(Debug, Default)]
struct RecordedSave {
    /// The entries since it began; the first one names this program and the model.
    newer: Vec<Vec<u8>>,
    /// Whether the journal has the record that it is running.
    is_recorded: bool,
}

impl JournalWriter {
    /// A writer without a journal.
    pub(super) fn new(autosave: Option<Autosave>) -> Self {
        Self { autosave, ..Self::default() }
    }

    /// Creates the journal with the first edit.
    pub(super) fn begin_later(&mut self, document: Option<PathBuf>, stamp: Option<FileStamp>) {
        self.wanted = Some((document, stamp));
    }

    /// Creates the journal with the first edit, and with the steps that the document has already: another file has them.
    pub(super) fn begin_later_with_steps(&mut self, document: Option<PathBuf>, stamp: Option<FileStamp>) {
        self.begin_later(document, stamp);
        self.has_steps = true;
    }

    /// Continues with this journal, and returns the one before.
    pub(super) fn set(&mut self, journal: Journal) -> Option<Journal> {
        self.compact = journal.size();
        (self.begun, self.gap, self.wanted, self.is_overdue) = (false, None, None, false);
        self.journal.replace(journal)
    }

    /// Continues with this journal, which begins with a snapshot; `saved` if the file has the same state.
    pub(super) fn begin_with(&mut self, journal: Journal, snapshot: &[u8], saved: bool, now: Instant) {
        self.set(journal);
        let Some(journal) = &mut self.journal else { return };
        match journal.compact_as(snapshot, saved) {
            Ok(()) => self.compact = journal.size(),
            Err(error) => self.failed(&error, now),
        }
    }

    /// Begins a save: later entries are not in the file. Returns the successor of the journal, which a job fills
    /// with a snapshot; `None` where nothing is recorded, or edits are missing.
    pub(super) fn begin_save(&mut self, now: Instant) -> Option<Successor> {
        self.end_of_gesture(now);
        // The next entry separates the gestures before the save from those after it.
        self.begun = false;
        self.save = Some(RecordedSave::default());
        self.complete().map(|journal| journal.successor())
    }

    /// Switches to the journal that was written for the save, and records that the file is about to be written with these contents;
    /// `None` where the save writes only other files.
    pub(super) fn record_saving(
        &mut self,
        new: Option<Result<SuccessorJournal, JournalError>>,
        file: Option<FileContents>,
        now: Instant,
    ) {
        if self.gap.is_none()
            && let Some(new) = new
        {
            let done = new.and_then(|new| self.continue_in(new));
            self.compacted(done, now);
        }
        let mut save = self.save.take().unwrap_or_default();
        if let Some(journal) = self.complete() {
            let done = journal.saving_without(save.newer.len() as u64, file);
            save.is_recorded = done.is_ok();
            self.report_unrecorded_save(done);
        }
        self.save = Some(save);
    }

    /// Ends a save; `stamp` is that of the file if it was written and is the file of this journal.
    pub(super) fn end_save(&mut self, stamp: Option<&FileStamp>) {
        let save = self.save.take();
        if let (Some(stamp), true) = (stamp, save.is_some_and(|save| save.is_recorded)) {
            let done = self.complete().map_or(Ok(()), |journal| journal.saved(stamp));
            self.report_unrecorded_save(done);
        }
    }

    /// Ends a save under another name, and switches to `journal`, which was written for it. Returns the journal before.
    pub(super) fn move_to(
        &mut self,
        (document, stamp): (Option<PathBuf>, Option<FileStamp>),
        journal: Result<Journal, JournalError>,
        about: &EditsOrigin,
        now: Instant,
    ) -> Option<Journal> {
        let newer = self.save.take().unwrap_or_default().newer;
        let old = match journal {
            Ok(journal) => self.set(journal),
            Err(error) => {
                self.not_begun(document, stamp, &error);
                return None;
            }
        };
        if !newer.is_empty() {
            let done = self.begun(about, now).and_then(|()| {
                let Some(journal) = &mut self.journal else { return Ok(()) };
                newer.iter().skip(1).try_for_each(|entry| journal.append(entry, now))
            });
            if let Err(error) = done {
                self.failed(&error, now);
            }
        }
        old
    }

    /// Returns the journal; `None` while edits are missing in it.
    fn complete(&mut self) -> Option<&mut Journal> {
        self.journal.as_mut().filter(|_| self.gap.is_none())
    }

    /// Appends the entries since the save began to `new` and switches to it.
    fn continue_in(&mut self, mut new: SuccessorJournal) -> Result<(), JournalError> {
        let (Some(journal), Some(save)) = (&mut self.journal, &self.save) else { return Ok(()) };
        save.newer.iter().try_for_each(|entry| new.append(entry))?;
        journal.continue_in(new)?;
        self.begun = !save.newer.is_empty();
        Ok(())
    }

    fn report_unrecorded_save(&mut self, done: Result<(), JournalError>) {
        if let Err(error) = done {
            self.trouble.push(format!("The journal could not record that the document was saved: {error}"));
        }
    }

    /// Returns the path of the journal.
    pub(super) fn path(&self) -> Option<&Path> {
        self.journal.as_ref().map(Journal::path)
    }

    /// Returns the journal and writes no more.
    pub(super) fn take(&mut self) -> Option<Journal> {
        self.journal.take()
    }

    /// Returns the warnings since the last call.
    pub(super) fn trouble(&mut self) -> Vec<String> {
        std::mem::take(&mut self.trouble)
    }

    /// Appends an entry. When this returns, the system has it, or there is a warning that it has not.
    ///
    /// Returns whether a snapshot is due at once: the journal was created, and lacks earlier steps.
    #[must_use]
    pub(super) fn record(&mut self, about: &EditsOrigin, recorded: &Recorded<'_>, now: Instant) -> bool {
        let gesture = match recorded {
            Recorded::Edit { gesture, .. } => *gesture,
            _ => None,
        };
        // The creation is tried once in a gesture, not with each movement of the mouse.
        let goes_on = gesture.is_some() && self.gesture.map(|(own, _)| own) == gesture;
        // Nor during a save, which would need another snapshot then: it has tried when it began.
        let waits = self.is_overdue && (goes_on || self.save.is_some());
        if !waits && self.begin(now) {
            return true;
        }
        if self.journal.is_none() {
            self.gesture = gesture.map(|gesture| (gesture, now));
        }
        if self.journal.is_none() || self.gap.is_some() {
            return false;
        }
        let done = self.begun(about, now).and_then(|()| self.append(recorded, now));
        if let Err(error) = done {
            self.failed(&error, now);
            return false;
        }
        match gesture {
            Some(gesture) => {
                if self.gesture.is_some_and(|(other, _)| other != gesture) {
                    self.end_of_gesture(now);
                }
                self.gesture = Some((gesture, now));
            }
            None => self.end_of_gesture(now),
        }
        false
    }

    /// Ends a gesture: its edit is due to be flushed to the disk.
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

    /// Creates the journal that is wanted, if there is one. Returns whether it lacks earlier steps.
    fn begin(&mut self, now: Instant) -> bool {
        let (Some(autosave), Some((document, stamp))) = (&self.autosave, self.wanted.take()) else {
            return false;
        };
        match autosave.begin_another(document.as_deref(), stamp.as_ref()) {
            Ok(journal) => {
                let lacks_steps = self.is_overdue || self.has_steps;
                self.set(journal);
                // Until the snapshot is written, edits are missing.
                self.gap = lacks_steps.then_some(now);
                lacks_steps
            }
            Err(error) => {
                self.not_begun(document, stamp, &error);
                self.gap = Some(now);
                false
            }
        }
    }

    /// Returns whether there is no journal, and the one that is wanted is to begin with a snapshot.
    pub(super) fn lacks_steps(&self) -> bool {
        self.journal.is_none() && self.wanted.is_some() && (self.is_overdue || self.has_steps)
    }

    /// Creates the wanted journal before a snapshot that it is to begin with, also after an attempt that failed.
    pub(super) fn begin_overdue(&mut self, now: Instant) {
        if self.lacks_steps() {
            self.begin(now);
        }
    }

    /// Sets the file of a journal that is still to be created.
    pub(super) fn file_is(&mut self, document: Option<PathBuf>, stamp: Option<FileStamp>) {
        if let Some(wanted) = &mut self.wanted {
            *wanted = (document, stamp);
        }
    }

    fn begun(&mut self, about: &EditsOrigin, now: Instant) -> Result<(), JournalError> {
        if !self.begun {
            self.append(&Recorded::Begin(about.clone()), now)?;
            self.begun = true;
        }
        Ok(())
    }

    fn append(&mut self, recorded: &Recorded<'_>, now: Instant) -> Result<(), JournalError> {
        let Some(journal) = &mut self.journal else { return Ok(()) };
        self.line.clear();
        // No edit that was applied can fail here: numbers are finite, keys are text.
        if let Err(error) = serde_json::to_writer(&mut self.line, recorded) {
            tracing::error!("an edit cannot be written as JSON: {error}");
        }
        journal.append(&self.line, now)?;
        if let Some(save) = &mut self.save {
            save.newer.push(self.line.clone());
        }
        Ok(())
    }

    /// Warns that the journal of this document could not be created. It is tried again later.
    pub(super) fn not_begun(
        &mut self,
        document: Option<PathBuf>,
        stamp: Option<FileStamp>,
        error: &JournalError,
    ) {
        self.wanted = Some((document, stamp));
        if !std::mem::replace(&mut self.is_overdue, true) {
            self.trouble.push(format!("Unsaved work is not recorded, so a crash would lose it: {error}"));
        }
    }

    fn failed(&mut self, error: &JournalError, now: Instant) {
        if self.gap.is_none() {
            self.trouble.push(format!("Unsaved work is not being recorded: {error}; save to be safe"));
        }
        self.gap = Some(now);
    }

    /// Flushes entries that are due to the disk.
    pub(super) fn sync(&mut self, now: Instant) {
        if self.is_overdue && self.gap.is_none() {
            self.gap = Some(now);
        }
        if self.gesture.is_some_and(|(_, last)| now.saturating_duration_since(last) >= GESTURE_TIMEOUT) {
            self.end_of_gesture(now);
        }
        if self.gap.is_none()
            && let Some(journal) = &mut self.journal
            && let Err(error) = journal.sync_if_due(now)
        {
            self.failed(&error, now);
        }
    }

    /// Returns whether a snapshot is due: because edits are missing, or because it would be much smaller than the journal.
    pub(super) fn wants_snapshot(&self, now: Instant) -> bool {
        // A save that is running writes a snapshot, too.
        if self.save.is_some() {
            return false;
        }
        match (self.gap, &self.journal) {
            (Some(last), _) => now.saturating_duration_since(last) >= RETRY_AFTER,
            (None, None) => false,
            (None, Some(journal)) => {
                self.gesture.is_none()
                    && journal.size() > COMPACT_ABOVE.max(self.compact.saturating_mul(COMPACT_GROWTH))
            }
        }
    }

    /// Returns whether edits are missing in the journal, or there is none although there should be one.
    pub(super) fn has_gap(&self) -> bool {
        self.gap.is_some() || self.is_overdue
    }

    /// Replaces the contents of the journal by a snapshot; `saved` if the file has the same state.
    pub(super) fn snapshot(&mut self, bytes: &[u8], saved: bool, now: Instant) {
        let Some(journal) = &mut self.journal else { return };
        let done = journal.compact_as(bytes, saved);
        self.begun &= done.is_err();
        self.compacted(done, now);
    }

    /// Handles the outcome of a snapshot.
    fn compacted(&mut self, done: Result<(), JournalError>, now: Instant) {
        let Some(journal) = &mut self.journal else { return };
        match done {
            Ok(()) => {
                self.compact = journal.size();
                let is_first = std::mem::take(&mut self.has_steps);
                if self.gap.take().is_some() && !is_first {
                    self.trouble.push("Unsaved work is recorded again".to_owned());
                }
            }
            // The old journal continues, if it is intact.
            Err(error) if self.gap.is_some() || journal.broken().is_some() => self.failed(&error, now),
            Err(error) => {
                self.compact = journal.size();
                tracing::warn!("{error}");
            }
        }
    }

    /// Returns the time at which there is something to do without a message.
    pub(super) fn next_due(&self) -> Option<Instant> {
        let again = self.gap.filter(|_| self.save.is_none()).map(|last| last + RETRY_AFTER);
        let due = self.journal.as_ref().filter(|_| self.gap.is_none()).and_then(Journal::next_due);
        let quiet = self.gesture.map(|(_, last)| last + GESTURE_TIMEOUT);
        [again, due, quiet].into_iter().flatten().min()
    }
}
