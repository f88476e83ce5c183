//! The open document: a model as it was read, its edited takes, its file, its journal.

use super::adapter::{EditError, TextFiles};
use super::edit::Edit;
use super::editable::Editable;
use super::history::{Edited, Gesture};
use super::job::JobNews;
use super::journal_writer::JournalWriter;
use super::offer::recovered;
use super::open_scene::OpenScene;
use super::recorded::{EditsOrigin, Recorded, Snapshot};
use super::replay::Replayed;
use super::{FileView, HistoryView, LoadedModel, OpenedModel, Source, View};
use dragonfly_anim::data::Take;
use dragonfly_runtime::Address;
use dragonfly_store::{Autosave, FileStamp, Journal};
use std::sync::Arc;
use std::time::Instant;

/// A change of the open document.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Apply an edit. Each edit of a gesture replaces the one before.
    Edit(Edit, Option<Gesture>),
    /// End a gesture: a button was released, a value entered. Its step is flushed to the disk at once. Any other change ends it too, and so
    /// does a second without changes.
    Release(Gesture),
    /// Cancel a gesture, as if it had never started.
    Cancel(Gesture),
    /// Undo the last step.
    Undo,
    /// Redo the next step.
    Redo,
    /// Undo or redo until exactly this many steps are applied.
    GoTo(usize),
}

/// The open document.
pub(super) struct Open {
    /// The model as it was read.
    opened: Arc<LoadedModel>,
    /// The texts as they were read; none for a model.
    texts: TextFiles,
    /// The scene of a script or project; `None` for a model.
    pub(super) scene: Option<OpenScene>,
    /// The model with the skeleton as it is now.
    pub(super) loaded: Arc<LoadedModel>,
    pub(super) edited: Edited,
    /// The published history; replaced only when steps change.
    history: Arc<HistoryView>,
    /// The file to save, or the reason why it cannot be saved.
    pub(super) editable: Result<Editable, String>,
    /// The path to which it is saved.
    pub(super) file: Arc<FileView>,
    /// The takes with which the history starts; those of the file where `None`.
    pub(super) base: Option<Arc<[Arc<Take>]>>,
    /// The header of its journal.
    pub(super) about: EditsOrigin,
    pub(super) journal_writer: JournalWriter,
    /// Whether the user discarded the unsaved work.
    pub(super) unwanted: bool,
    /// Whether the whole file was replaced, after the user had decided so.
    pub(super) is_rewritten: bool,
    /// Content of the model that the last save of the file did not store, one sentence each.
    pub(super) lost: Vec<String>,
}

impl Open {
    pub(super) fn new(opened: OpenedModel, autosave: Option<Autosave>) -> Self {
        let adapter = opened.adapter();
        let OpenedModel { loaded, editable, texts } = opened;
        let ending = editable.as_ref().map_or_else(|_| String::new(), Editable::ending);
        let file = FileView { title: loaded.title.clone(), path: loaded.path.clone(), ending };
        let source = loaded.path.is_none().then_some(Source::BuiltIn);
        let conventions = loaded.conversion.chosen();
        let loaded = Arc::new(loaded);
        let mut open = Self {
            edited: Edited::new(adapter),
            scene: loaded.path.as_deref().filter(|_| !texts.is_empty()).map(OpenScene::of),
            texts,
            opened: Arc::clone(&loaded),
            loaded,
            history: Arc::default(),
            editable,
            file: Arc::new(file),
            base: None,
            about: EditsOrigin::new(source.as_ref(), conventions),
            journal_writer: JournalWriter::new(autosave),
            unwanted: false,
            is_rewritten: false,
            lost: Vec::new(),
        };
        open.look();
        open
    }

    /// Returns the source from which the model was read.
    pub(super) fn source(&self) -> Source {
        let chosen = self.opened.conversion.chosen();
        self.opened.path.clone().map_or(Source::BuiltIn, |path| Source::of(path, chosen))
    }

    /// Returns the model as it was read.
    pub(super) fn opened(&self) -> &Arc<LoadedModel> {
        &self.opened
    }

    /// Returns the texts as they were read; none for a model.
    pub(super) fn texts_as_read(&self) -> &TextFiles {
        &self.texts
    }

    /// Plans the scene again where its text or its models changed, and starts to read models that it names.
    pub(super) fn update_scene(&mut self, document: &Address<JobNews>) {
        if let Some(scene) = &mut self.scene {
            scene.update(self.edited.adapter().texts(), document);
        }
    }

    /// Starts with the edits of another version of the model.
    pub(super) fn start_with(&mut self, edited: Edited) {
        self.edited = edited;
        self.look();
    }

    /// Continues with the history of a journal.
    pub(super) fn go_on(&mut self, replayed: Replayed) {
        if let (Ok(editable), Some(places)) = (&mut self.editable, replayed.places()) {
            editable.set_places(places);
        }
        self.edited = replayed.edited;
        self.base = replayed.base;
        // A document without a file has nothing saved.
        if self.file.path.is_none() && self.loaded.path.is_some() {
            self.edited.set_saved(None);
        }
        self.look();
    }

    /// Detaches the document from its file: the next save asks for a path.
    pub(super) fn leave_file(&mut self) {
        let source = self.source();
        self.about = EditsOrigin::new(Some(&source), source.conventions());
        let (title, ending) = (recovered(&self.loaded.title), self.file.ending.clone());
        self.file = Arc::new(FileView { title, path: None, ending });
        if let Ok(editable) = &mut self.editable {
            editable.forget_file();
        }
    }

    /// Returns the state of the file when it was last read or saved.
    pub(super) fn stamp(&self) -> Option<FileStamp> {
        self.editable.as_ref().ok().and_then(|editable| editable.stamp().copied())
    }

    /// Applies the change and records it in the journal. Returns whether the document changed.
    pub(super) fn change(&mut self, change: Change, now: Instant) -> Result<bool, EditError> {
        let done = match change {
            Change::Edit(edit, gesture) => {
                self.edited.ask(edit, gesture)?;
                let due = self.edited.steps().0.back().is_some_and(|step| {
                    let edit = std::borrow::Cow::Borrowed(&step.edit);
                    self.journal_writer.record(&self.about, &Recorded::Edit { edit, gesture }, now)
                });
                if due {
                    self.snapshot(false, now);
                }
                true
            }
            Change::Release(gesture) => {
                self.journal_writer.release(gesture, now);
                return Ok(false);
            }
            Change::Cancel(gesture) => {
                let done = self.edited.cancel(gesture);
                if done {
                    self.record(&Recorded::Cancel { gesture }, now);
                }
                done
            }
            Change::Undo => self.walk(Edited::undo, now),
            Change::Redo => self.walk(Edited::redo, now),
            Change::GoTo(steps) => self.walk(|edited| edited.go_to(steps), now),
        };
        debug_assert_eq!(self.edited.adapter().check(), Ok(()));
        if done {
            self.unwanted = false;
        }
        self.look();
        Ok(done)
    }

    /// Undoes or redoes steps and records it. Returns whether anything changed.
    fn walk(&mut self, walk: impl FnOnce(&mut Edited) -> bool, now: Instant) -> bool {
        let done = walk(&mut self.edited);
        if done {
            let steps = self.edited.steps().1;
            self.record(&Recorded::GoTo { steps }, now);
        }
        done
    }

    fn record(&mut self, recorded: &Recorded<'_>, now: Instant) {
        if self.journal_writer.record(&self.about, recorded, now) {
            self.snapshot(false, now);
        }
    }

    /// Undoes or redoes to the saved state, or to the one that a project keeps. Returns `false` where neither leads there.
    pub(super) fn revert(&mut self, now: Instant) -> bool {
        let Some(saved) = self.edited.settled() else { return false };
        self.walk(|edited| edited.go_to(saved), now);
        self.look();
        true
    }

    /// Flushes the journal and writes a snapshot where they are due.
    pub(super) fn keep(&mut self, now: Instant) {
        self.journal_writer.sync(now);
        // A snapshot without a known saved state would make the next save larger, so it waits for that save.
        let known = self.base.is_none() || self.edited.saved().is_some();
        if self.journal_writer.wants_snapshot(now) && (known || self.journal_writer.has_gap()) {
            self.snapshot(false, now);
        }
    }

    /// Replaces the contents of the journal by a snapshot. It includes the takes with which the history starts if the file no longer has
    /// them, or if `with_base`.
    pub(super) fn snapshot(&mut self, with_base: bool, now: Instant) {
        self.journal_writer.begin_overdue(now);
        if self.journal_writer.path().is_none() {
            return;
        }
        let base = (with_base || self.base.is_some()).then(|| self.base());
        match Snapshot::bytes(self.about.clone(), &self.edited, base.as_deref()) {
            Ok(bytes) => self.journal_writer.snapshot(&bytes, self.edited.is_saved(), now),
            Err(error) => tracing::error!("the history cannot be written as JSON: {error}"),
        }
    }

    /// Writes all steps to a journal that was created for them.
    pub(super) fn begin_journal_with_steps(&mut self, journal: Journal, now: Instant) {
        match Snapshot::bytes(self.about.clone(), &self.edited, None) {
            Ok(bytes) => self.journal_writer.begin_with(journal, &bytes, self.edited.is_saved(), now),
            Err(error) => tracing::error!("the history cannot be written as JSON: {error}"),
        }
    }

    /// Returns whether closing it would lose work that the user did not discard.
    pub(super) fn has_unsaved_work(&self) -> bool {
        self.edited.has_unsaved() && !self.unwanted
    }

    /// Moves the journal to the trash folder: another one has its work.
    pub(super) fn discard_journal(&mut self, autosave: &Autosave) -> Result<(), String> {
        let Some(journal) = self.journal_writer.take() else { return Ok(()) };
        let done = if journal.is_empty() { journal.close() } else { autosave.discard_own(journal).map(drop) };
        done.map_err(|error| error.to_string())
    }

    /// Returns the takes with which the history starts, unless its oldest steps were removed.
    pub(super) fn base(&self) -> Arc<[Arc<Take>]> {
        self.base.clone().unwrap_or_else(|| self.opened.model.animation.takes.clone().into())
    }

    /// Closes the journal. Unsaved work stays in it, or goes to the trash folder if the user discarded it.
    pub(super) fn close(&mut self, autosave: Option<&Autosave>) -> Result<(), String> {
        let saved = self.edited.is_saved();
        let stamp = self.stamp();
        let (Some(mut journal), Some(autosave)) = (self.journal_writer.take(), autosave) else {
            return Ok(());
        };
        // A project has the steps, and the file of the model has not.
        let is_kept = !saved && self.edited.is_kept();
        let done = if is_kept || (self.unwanted && !saved) || (saved && self.file.path.is_none()) {
            if journal.is_empty() { journal.close() } else { autosave.discard_own(journal).map(drop) }
        } else {
            // In the saved state there is no work to restore, only history.
            let marked = match stamp.filter(|_| saved && journal.unsaved() > 0) {
                Some(stamp) => journal.saved(&stamp),
                None => Ok(()),
            };
            marked.and_then(|()| journal.close())
        };
        done.map_err(|error| error.to_string())
    }

    pub(super) fn view(&self, generation: u64) -> View {
        let history = Arc::clone(&self.history);
        let file = Arc::clone(&self.file);
        let view = View::of(generation, Arc::clone(&self.loaded), self.edited.adapter(), history, file);
        let opened = Arc::clone(&self.opened);
        let scene = self.scene.as_ref().map(OpenScene::view);
        View { opened, scene, is_unrecorded: self.journal_writer.has_gap(), ..view }
    }

    /// Updates the published history and, where an edit changed the skeleton, the published model. During a gesture its step stays the
    /// same, and nothing is allocated.
    pub(super) fn look(&mut self) {
        let skeleton = self.edited.adapter().skeleton();
        if !Arc::ptr_eq(skeleton, &self.loaded.model.animation.skeleton) {
            self.loaded = LoadedModel::with_skeleton(&self.opened, skeleton);
        }
        let (steps, done) = self.edited.steps();
        let last = steps.back().map(|step| (step.edit.label(), &step.about));
        let now = (steps.len(), done, self.edited.settled(), last);
        let shown = &self.history;
        let last = shown.steps.last().copied().zip(shown.about.last());
        if now != (shown.steps.len(), shown.done, shown.saved_at, last)
            || self.edited.has_unsaved() == shown.saved
        {
            self.history = Arc::new(HistoryView::of(&self.edited));
        }
    }
}
