//! Unsaved work that a person can have back, in words for them.

use super::Source;
use super::history::Gesture;
use super::recorded::{About, Recorded, Snapshot};
use dragonfly_store::{Autosave, Entry, Fate, FileStamp, Life, Reading, RealFiles, Recoverable};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Labels of steps that are shown.
const SHOWN: usize = 5;

/// Unsaved work of an earlier time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    /// The file's name without folder, or what stands for it.
    pub title: String,
    /// What must be opened to have the work back; `None` when that is not known.
    pub source: Option<Source>,
    /// Steps that are in no file.
    pub steps: usize,
    /// What they did, the newest first, not more than a few; of steps that were saved and then undone, that they were.
    pub labels: Vec<String>,
    /// The journal it is in.
    pub found: Recoverable,
}

impl Offer {
    /// What is in a journal.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn of(autosave: &Autosave, found: &Recoverable) -> Result<Self, String> {
        let entries = autosave.entries(found).map_err(|error| error.to_string())?;
        Ok(Self::told(found, &entries))
    }

    pub(super) fn told(found: &Recoverable, entries: &[Entry]) -> Self {
        let mut story = Story::default();
        entries.iter().for_each(|entry| story.hear(entry));
        let source = match &found.document {
            Some(path) => Some(Source::File(path.clone())),
            None => story.about.as_ref().and_then(About::source),
        };
        let title = match (&found.document, &source) {
            (None, Some(source)) => recovered(&source.title()),
            (_, Some(source)) => source.title(),
            _ => {
                found.journal.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
            }
        };
        let (steps, labels) = story.unsaved();
        Self { title, source, steps, labels, found: found.clone() }
    }

    /// How long ago something was done in it last; `None` when a clock went backwards.
    pub fn age(&self) -> Option<Duration> {
        let when = UNIX_EPOCH + Duration::from_nanos(u64::try_from(self.found.when).ok()?);
        SystemTime::now().duration_since(when).ok()
    }

    /// What a person must know before they decide, a sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        match &self.found.file {
            Fate::Changed => warnings.push(
                "The file was changed since by another program. The work is done again on what it holds now."
                    .to_owned(),
            ),
            Fate::Missing => warnings.push(
                "The file is not where it was. If it was moved or renamed, open it where it is now."
                    .to_owned(),
            ),
            Fate::Unknown(reason) => warnings.push(format!("The file cannot be looked at: {reason}.")),
            Fate::Same | Fate::Unsaved => {}
        }
        if let Reading::Cut(bytes) = self.found.reading {
            warnings.push(format!(
                "The last {bytes} bytes of the journal are damaged. All before them is whole."
            ));
        }
        if let (Life::Elsewhere, Some(owner)) = (self.found.life, &self.found.owner) {
            warnings.push(format!("It may still be in use by {owner}, which cannot be asked."));
        }
        warnings
    }

    /// Was the file moved, renamed or removed, so that somebody must say where it is?
    pub fn is_missing(&self) -> bool {
        self.found.document.is_some() && self.found.file == Fate::Missing
    }

    /// Is the file at `path` the one that the work was done on: does it hold the same?
    ///
    /// # Errors
    /// Why it cannot be read.
    pub(super) fn is_of(&self, path: &Path) -> Result<bool, String> {
        let stamp =
            FileStamp::take(&RealFiles, path).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(self.found.held(&stamp))
    }

    /// Where the file is now, if it is not where it was.
    pub(super) fn moved_to(&self) -> Option<&Path> {
        match (&self.source, &self.found.document) {
            (Some(Source::File(path)), Some(document)) if path != document => Some(path),
            _ => None,
        }
    }

    /// Can the work be had back now?
    pub fn can_be_kept(&self) -> bool {
        self.source.is_some() && self.found.file != Fate::Missing
    }
}

/// The title of what was opened beside the file that it came from, or never had one.
pub(super) fn recovered(title: &str) -> String {
    format!("{title} (recovered)")
}

/// The history without the takes: enough to count and name its steps.
#[derive(Debug, Default)]
struct Story {
    about: Option<About>,
    steps: Vec<(&'static str, Option<Gesture>)>,
    done: usize,
    saved: Option<usize>,
    was_saved: bool,
}

impl Story {
    fn hear(&mut self, entry: &Entry) {
        match entry {
            Entry::Saved => (self.saved, self.was_saved) = (Some(self.done), true),
            Entry::Snapshot(bytes) => {
                let Some((snapshot, _)) = Snapshot::read(bytes) else { return };
                self.about = Some(snapshot.about);
                self.steps = snapshot.steps.iter().map(|edit| (edit.label(), None)).collect();
                self.done = snapshot.done.min(self.steps.len());
                (self.saved, self.was_saved) = (snapshot.saved, snapshot.saved != Some(0));
            }
            Entry::Edit(bytes) => {
                // What is not understood is told when the work is kept.
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

    /// How many steps lie between what was saved and what was there last, and what they did.
    fn unsaved(&self) -> (usize, Vec<String>) {
        let saved = match self.saved {
            Some(saved) => saved.min(self.steps.len()),
            None if self.was_saved => return (self.done.max(1), self.last(0)),
            None => 0,
        };
        let labels = if self.done < saved {
            // The one that was undone last lies first.
            let undone = self.steps[self.done..saved].iter().take(SHOWN);
            undone.map(|(label, _)| format!("{label} (undone)")).collect()
        } else {
            self.last(saved)
        };
        (self.done.abs_diff(saved), labels)
    }

    /// What was done from a step on, the newest first.
    fn last(&self, from: usize) -> Vec<String> {
        self.steps[from..self.done].iter().rev().take(SHOWN).map(|(label, _)| (*label).to_owned()).collect()
    }
}
