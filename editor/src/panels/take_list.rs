//! State of the list of takes: which name is being typed, and which new take is to be shown.

use dragonfly_document::adapter::{TakeId, TakeVersions};
use std::sync::Arc;

/// Pending actions of the list of takes.
#[derive(Clone, Debug, Default)]
pub struct TakeListState {
    renaming: Option<TakeId>,
    times_asked: u64,
    show_new: bool,
}

impl TakeListState {
    /// Returns the take whose name is being typed.
    pub fn renaming(&self) -> Option<TakeId> {
        self.renaming
    }

    /// Starts to rename a take, or ends it.
    pub(super) fn rename(&mut self, take: Option<TakeId>) {
        self.renaming = take;
    }

    /// Returns a number that grows each time that start and length are to be typed.
    pub fn times_asked(&self) -> u64 {
        self.times_asked
    }

    /// Puts the cursor into the fields for start and length.
    pub(super) fn ask_times(&mut self) {
        self.times_asked += 1;
    }

    /// Shows the next take that is created.
    pub(super) fn show_next_new(&mut self) {
        self.show_new = true;
    }

    /// Compares the list with the one before. Returns the index of a new take that is to be shown.
    pub(super) fn update(
        &mut self,
        before: &[Arc<TakeVersions>],
        now: &[Arc<TakeVersions>],
    ) -> Option<usize> {
        self.renaming.take_if(|id| !now.iter().any(|slot| slot.id == *id));
        let is_new = |slot: &Arc<TakeVersions>| !before.iter().any(|old| old.id == slot.id);
        let new = now.iter().position(is_new).filter(|_| self.show_new)?;
        self.show_new = false;
        Some(new)
    }
}
