//! Unsaved work of an earlier session, described for the user.

use super::Source;
use super::history::Gesture;
use super::recorded::{EditsOrigin, Recorded, Snapshot};
use dragonfly_store::{
    Autosave, DocumentFileState, FileStamp, JournalEntry, OwnerStatus, Readability, RealFiles, Recoverable,
};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Number of steps whose labels are shown.
const SHOWN: usize = 5;

/// Unsaved work of an earlier session that can be restored.
#[derive(Clone, Debug, PartialEq)]
pub struct Offer {
    /// Name of the file without folder, or a substitute.
    pub title: String,
    /// The model to open for it; `None` where that is unknown.
    pub source: Option<Source>,
    /// Number of unsaved steps.
    pub steps: usize,
    /// Labels of the newest steps, the newest first. Steps that were saved and then undone are marked as undone.
    pub labels: Vec<String>,
    /// The journal that contains it.
    pub found: Recoverable,
}

impl Offer {
    /// Reads a journal.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn of(autosave: &Autosave, found: &Recoverable) -> Result<Self, String> {
        let entries = autosave.entries(found).map_err(|error| error.to_string())?;
        Ok(Self::from_entries(found, &entries))
    }

    pub(super) fn from_entries(found: &Recoverable, entries: &[JournalEntry]) -> Self {
        let mut outline = HistoryOutline::default();
        entries.iter().for_each(|entry| outline.add(entry));
        let chosen = outline.about.as_ref().map(EditsOrigin::conventions).unwrap_or_default();
        let source = match &found.document {
            Some(path) => Some(Source::of(path.clone(), chosen)),
            None => outline.about.as_ref().and_then(EditsOrigin::source),
        };
        let title = match (&found.document, &source) {
            (None, Some(source)) => recovered(&source.title()),
            (_, Some(source)) => source.title(),
            _ => {
                found.journal.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
            }
        };
        let (steps, labels) = outline.unsaved();
        Self { title, source, steps, labels, found: found.clone() }
    }

    /// Returns the time since its last entry; `None` where the clock was set back.
    pub fn age(&self) -> Option<Duration> {
        let when = UNIX_EPOCH + Duration::from_nanos(u64::try_from(self.found.when).ok()?);
        SystemTime::now().duration_since(when).ok()
    }

    /// Returns what the user should know before deciding, one sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        match &self.found.file {
            DocumentFileState::Changed => warnings.push(
                "Another program changed the file since then. The work is applied to its present contents."
                    .to_owned(),
            ),
            DocumentFileState::Missing => warnings
                .push("The file is missing. If it was moved or renamed, choose its present path.".to_owned()),
            DocumentFileState::Unknown(reason) => {
                warnings.push(format!("The file cannot be checked: {reason}."))
            }
            DocumentFileState::Same | DocumentFileState::Unsaved => {}
        }
        if let Readability::Cut(bytes) = self.found.reading {
            warnings.push(format!(
                "The last {bytes} bytes of the journal are damaged. Everything before them is intact."
            ));
        }
        if let (OwnerStatus::OnOtherHost, Some(owner)) = (self.found.owner_status, &self.found.owner) {
            warnings.push(format!("It may still be in use by {owner} on another computer."));
        }
        warnings
    }

    /// Returns whether the file is missing, so that the user must choose its present path.
    pub fn is_missing(&self) -> bool {
        self.found.document.is_some() && self.found.file == DocumentFileState::Missing
    }

    /// Returns whether the file at `path` has the contents to which the work belongs.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub(super) fn is_of(&self, path: &Path) -> Result<bool, String> {
        let stamp =
            FileStamp::take(&RealFiles, path).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(self.found.held(&stamp))
    }

    /// Returns the present path of the file, if it was moved.
    pub(super) fn moved_to(&self) -> Option<&Path> {
        match (self.source.as_ref().and_then(Source::path), &self.found.document) {
            (Some(path), Some(document)) if path != document => Some(path),
            _ => None,
        }
    }

    /// Returns whether the work can be restored now.
    pub fn can_be_kept(&self) -> bool {
        self.source.is_some() && self.found.file != DocumentFileState::Missing
    }
}

/// Returns the title of restored work that has no file.
pub(super) fn recovered(title: &str) -> String {
    format!("{title} (recovered)")
}

/// A history without its data: enough to count and name its steps.
#[derive(Debug, Default)]
struct HistoryOutline {
    about: Option<EditsOrigin>,
    steps: Vec<(&'static str, Option<Gesture>)>,
    done: usize,
    saved: Option<usize>,
    was_saved: bool,
}

impl HistoryOutline {
    fn add(&mut self, entry: &JournalEntry) {
        match entry {
            JournalEntry::Saved => (self.saved, self.was_saved) = (Some(self.done), true),
            JournalEntry::Snapshot(bytes) => {
                let Some((snapshot, _)) = Snapshot::read(bytes) else { return };
                self.about = Some(snapshot.about);
                self.steps = snapshot.steps.iter().map(|edit| (edit.label(), None)).collect();
                self.done = snapshot.done.min(self.steps.len());
                (self.saved, self.was_saved) = (snapshot.saved, snapshot.saved != Some(0));
            }
            JournalEntry::Edit(bytes) => {
                // An entry that cannot be read is reported when the work is restored.
                if let Ok(recorded) = serde_json::from_slice(bytes) {
                    self.record(recorded);
                }
            }
        }
    }

    fn record(&mut self, recorded: Recorded<'_>) {
        match recorded {
            Recorded::Begin(about) => {
                self.about = Some(about);
                self.steps.iter_mut().for_each(|(_, gesture)| *gesture = None);
            }
            Recorded::Edit { edit, gesture } => {
                let goes_on = gesture.is_some()
                    && self.done == self.steps.len()
                    && self.steps.last().is_some_and(|(_, other)| *other == gesture);
                self.steps.truncate(self.done - usize::from(goes_on));
                if self.saved.unwrap_or(0) > self.steps.len() {
                    (self.saved, self.was_saved) = (None, true);
                }
                self.steps.push((edit.label(), gesture));
                self.done = self.steps.len();
            }
            Recorded::Cancel { gesture } => {
                if self.done == self.steps.len()
                    && self.steps.last().is_some_and(|(_, other)| *other == Some(gesture))
                {
                    self.steps.pop();
                    self.done = self.steps.len();
                }
            }
            Recorded::GoTo { steps } => self.done = steps.min(self.steps.len()),
        }
    }

    /// Returns the number of steps between the saved state and the last one, and their labels.
    fn unsaved(&self) -> (usize, Vec<String>) {
        let saved = match self.saved {
            Some(saved) => saved.min(self.steps.len()),
            None if self.was_saved => return (self.done.max(1), self.last(0)),
            None => 0,
        };
        let labels = if self.done < saved {
            // The step that was undone last is the first of them.
            let undone = self.steps[self.done..saved].iter().take(SHOWN);
            undone.map(|(label, _)| format!("{label} (undone)")).collect()
        } else {
            self.last(saved)
        };
        (self.done.abs_diff(saved), labels)
    }

    /// Returns the labels of the applied steps from index `from` on, the newest first.
    fn last(&self, from: usize) -> Vec<String> {
        self.steps[from..self.done].iter().rev().take(SHOWN).map(|(label, _)| (*label).to_owned()).collect()
    }
}
