//! What is open: a model as it was read, its takes as they were edited, its file, its journal.

use super::adapter::{EditError, ModelAdapter};
use super::edit::Edit;
use super::editable::Editable;
use super::history::{Edited, Gesture};
use super::keeper::Keeper;
use super::offer::recovered;
use super::recorded::{About, Recorded, Snapshot};
use super::replay::Replayed;
use super::{FileView, HistoryView, LoadedModel, Opened, Source, View, base};
use dragonfly_anim::data::Take;
use dragonfly_store::{Autosave, FileStamp};
use std::sync::Arc;
use std::time::Instant;

/// What can be done to an open document.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// An edit; of a gesture, its newest form.
    Edit(Edit, Option<Gesture>),
    /// The gesture is over: a button was released, a value entered. Its step is brought to the disk at once. Who forgets
    /// to say so loses nothing: any other change ends it too, and so does a second without one.
    Release(Gesture),
    /// The gesture as if it had never begun.
    Cancel(Gesture),
    /// The last step undone.
    Undo,
    /// The next step done again.
    Redo,
    /// As many steps done as this.
    GoTo(usize),
}

/// What is open, as its owner sees it.
pub(super) struct Open {
    pub(super) loaded: Arc<LoadedModel>,
    pub(super) edited: Edited,
    /// As it was shown last; made anew only when a step comes or goes.
    history: Arc<HistoryView>,
    /// What saves it; why nothing does, where nothing does.
    pub(super) editable: Result<Editable, String>,
    /// Where it is saved.
    pub(super) file: Arc<FileView>,
    /// The takes with which the history begins; those of the file where `None`.
    pub(super) base: Option<Arc<[Arc<Take>]>>,
    /// For the journal.
    pub(super) about: About,
    pub(super) keeper: Keeper,
    /// The person does not want what is not saved.
    pub(super) unwanted: bool,
}

impl Open {
    pub(super) fn new(opened: Opened, autosave: Option<Autosave>) -> Self {
        let Opened { loaded, editable } = opened;
        let file = FileView { title: loaded.title.clone(), path: loaded.path.clone() };
        let source = loaded.path.is_none().then_some(Source::BuiltIn);
        let mut open = Self {
            edited: Edited::new(ModelAdapter::new(&loaded.model.animation)),
            loaded: Arc::new(loaded),
            history: Arc::default(),
            editable,
            file: Arc::new(file),
            base: None,
            about: About::new(source.as_ref()),
            keeper: Keeper::new(autosave),
            unwanted: false,
        };
        open.look();
        open
    }

    /// Goes on with what a journal told.
    pub(super) fn go_on(&mut self, replayed: Replayed) {
        if let (Ok(editable), Some(places)) = (&mut self.editable, replayed.places()) {
            editable.set_places(places);
        }
        self.edited = replayed.edited;
        self.base = replayed.base;
        // Of a document of its own nothing is in a file.
        if self.file.path.is_none() && self.loaded.path.is_some() {
            self.edited.set_saved(None);
        }
        self.look();
    }

    /// It is no file's document any more: the next save asks where.
    pub(super) fn leave_file(&mut self) {
        let source = self.loaded.path.clone().map_or(Source::BuiltIn, Source::File);
        self.about = About::new(Some(&source));
        self.file = Arc::new(FileView { title: recovered(&self.loaded.title), path: None });
        if let Ok(editable) = &mut self.editable {
            editable.forget_file();
        }
    }

    /// What the file was when it was read or saved last.
    pub(super) fn stamp(&self) -> Option<FileStamp> {
        self.editable.as_ref().ok().and_then(|editable| editable.stamp().copied())
    }

    /// Does it, and has it recorded; was there anything to do?
    pub(super) fn change(&mut self, change: Change, now: Instant) -> Result<bool, EditError> {
        let done = match change {
            Change::Edit(edit, gesture) => {
                self.edited.ask(edit, gesture)?;
                if let Some(step) = self.edited.steps().0.back() {
                    let edit = std::borrow::Cow::Borrowed(&step.edit);
                    self.keeper.record(&self.about, &Recorded::Edit { edit, gesture }, now);
                }
                true
            }
            Change::Release(gesture) => {
                self.keeper.release(gesture, now);
                return Ok(false);
            }
            Change::Cancel(gesture) => {
                let done = self.edited.cancel(gesture);
                if done {
                    self.keeper.record(&self.about, &Recorded::Cancel { gesture }, now);
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

    /// Goes through the history.
    fn walk(&mut self, walk: impl FnOnce(&mut Edited) -> bool, now: Instant) -> bool {
        let done = walk(&mut self.edited);
        if done {
            let steps = self.edited.steps().1;
            self.keeper.record(&self.about, &Recorded::GoTo { steps }, now);
        }
        done
    }

    /// Goes back, or forth, to what was saved; `false` when no undo and no redo leads there.
    pub(super) fn revert(&mut self, now: Instant) -> bool {
        let Some(saved) = self.edited.saved() else { return false };
        self.walk(|edited| edited.go_to(saved), now);
        self.look();
        true
    }

    /// Does what is due on the disk.
    pub(super) fn keep(&mut self, now: Instant) {
        self.keeper.sync(now);
        // Without a known place of the last save a snapshot would make the next save larger; it waits for that one.
        let known = self.base.is_none() || self.edited.saved().is_some();
        if self.keeper.wants_snapshot(now) && (known || self.keeper.has_gap()) {
            self.snapshot(false, now);
        }
    }

    /// Begins the journal anew with everything; with the takes that the history began with, if they are not those of the
    /// file any more, or will not be (`saves`).
    pub(super) fn snapshot(&mut self, saves: bool, now: Instant) {
        let base = (saves || self.base.is_some() || self.edited.is_cut()).then(|| self.beginning());
        match Snapshot::bytes(self.about.clone(), &self.edited, base.as_deref()) {
            Ok(bytes) => self.keeper.snapshot(&bytes, self.edited.is_saved(), now),
            Err(error) => tracing::error!("the history has no JSON: {error}"),
        }
    }

    /// The takes with which the history begins, as bytes.
    fn beginning(&self) -> Vec<u8> {
        if self.edited.is_cut() {
            let mut first = self.edited.clone();
            first.go_to(0);
            let takes: Vec<_> = first.adapter().results().cloned().collect();
            return base::write(&takes);
        }
        base::write(self.base.as_deref().unwrap_or(&self.loaded.model.animation.takes))
    }

    /// Lets go of the journal. What is not saved stays in it, unless it is unwanted: then it goes into the bin.
    pub(super) fn close(&mut self, autosave: Option<&Autosave>) -> Result<(), String> {
        let saved = self.edited.is_saved();
        let stamp = self.stamp();
        let (Some(mut journal), Some(autosave)) = (self.keeper.take(), autosave) else { return Ok(()) };
        let done = if (self.unwanted && !saved) || (saved && self.file.path.is_none()) {
            if journal.is_empty() { journal.close() } else { autosave.put_away(journal).map(drop) }
        } else {
            // Back at what was saved there is nothing to be had back, only history.
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
        View::of(generation, Arc::clone(&self.loaded), self.edited.adapter(), history, Arc::clone(&self.file))
    }

    /// While a gesture lasts its step stays the same for who reads the list, and nothing is made.
    pub(super) fn look(&mut self) {
        let (steps, done) = self.edited.steps();
        let last = steps.back().map(|step| (step.edit.label(), &step.about));
        let now = (steps.len(), done, self.edited.saved(), last);
        let shown = &self.history;
        let last = shown.steps.last().copied().zip(shown.about.last());
        if now != (shown.steps.len(), shown.done, shown.saved_at, last)
            || self.edited.is_saved() != shown.saved
        {
            self.history = Arc::new(HistoryView::of(&self.edited));
        }
    }
}
