//! What is open: a model as it was read, and its takes as they were edited.

use super::adapter::{EditError, ModelAdapter};
use super::edit::Edit;
use super::history::{Edited, Gesture};
use super::{HistoryView, LoadedModel, View};
use std::sync::Arc;

/// What can be done to an open document.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// An edit; of a gesture, its newest form.
    Edit(Edit, Option<Gesture>),
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
    edited: Edited,
    /// As it was shown last; made anew only when a step comes or goes.
    history: Arc<HistoryView>,
}

impl Open {
    pub(super) fn new(loaded: Arc<LoadedModel>) -> Self {
        let edited = Edited::new(ModelAdapter::new(&loaded.model.animation));
        let mut open = Self { loaded, edited, history: Arc::default() };
        open.look();
        open
    }

    /// Does it; was there anything to do?
    pub(super) fn change(&mut self, change: Change) -> Result<bool, EditError> {
        let done = match change {
            Change::Edit(edit, gesture) => self.edited.apply(edit, gesture).map(|()| true)?,
            Change::Cancel(gesture) => self.edited.cancel(gesture),
            Change::Undo => self.edited.undo(),
            Change::Redo => self.edited.redo(),
            Change::GoTo(steps) => self.edited.go_to(steps),
        };
        debug_assert_eq!(self.edited.adapter().check(), Ok(()));
        self.look();
        Ok(done)
    }

    pub(super) fn view(&self, generation: u64) -> View {
        let history = Arc::clone(&self.history);
        View::of(generation, Arc::clone(&self.loaded), self.edited.adapter(), history)
    }

    /// While a gesture lasts its step stays the same for who reads the list, and nothing is made.
    fn look(&mut self) {
        let (steps, done) = self.edited.steps();
        let last = steps.back().map(|step| (step.edit.label(), &step.about));
        let now = (steps.len(), done, self.edited.saved(), last);
        let shown = &self.history;
        let last = shown.steps.last().copied().zip(shown.about.last());
        if now != (shown.steps.len(), shown.done, shown.saved_at, last) || self.edited.is_saved() != shown.saved {
            self.history = Arc::new(HistoryView::of(&self.edited));
        }
    }
}
