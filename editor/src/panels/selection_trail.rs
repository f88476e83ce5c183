//! The selections between the steps of the history, for undo that also goes back through selections.

use super::selection_steps::SelectionState;
use std::collections::BTreeMap;

/// Maximum number of selections that are kept at one position of the history, and of positions with selections.
const MOST: usize = 200;

/// The selections that were made at each position of the history.
#[derive(Debug, Default)]
pub struct SelectionTrail {
    /// The selections by the number of applied steps.
    at: BTreeMap<usize, PastAndFuture>,
    /// The selection of the last frame, and its position.
    last: Option<(usize, SelectionState)>,
}

/// Selections before the present one, and undone ones after it; the nearest is the last of each.
#[derive(Debug, Default)]
struct PastAndFuture {
    past: Vec<SelectionState>,
    future: Vec<SelectionState>,
}

/// Direction of a walk through selections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WalkDirection {
    /// To earlier selections.
    Back,
    /// To selections that were undone.
    Forward,
}

impl SelectionTrail {
    /// Forgets all selections.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Returns the selection of the last frame; `None` before the first one.
    pub(super) fn last(&self) -> Option<&SelectionState> {
        self.last.as_ref().map(|(_, selection)| selection)
    }

    /// Notes a selection that differs from the last one. One that came with a step of the history belongs to that step.
    pub(super) fn note(&mut self, done: usize, selection: SelectionState) {
        if let Some((position, before)) = self.last.replace((done, selection))
            && position == done
        {
            let here = self.at.entry(done).or_default();
            here.future.clear();
            here.past.push(before);
            if here.past.len() > MOST {
                here.past.remove(0);
            }
        }
        if self.at.len() > MOST {
            self.at.pop_first();
        }
    }

    /// Notes the number of applied steps while the selection stays.
    pub(super) fn move_to(&mut self, done: usize) {
        if let Some((position, _)) = &mut self.last {
            *position = done;
        }
    }

    /// Forgets the selections that followed the first `done` steps: other steps follow them now.
    pub(super) fn forget_after(&mut self, done: usize) {
        self.at.split_off(&(done + 1));
        if let Some(here) = self.at.get_mut(&done) {
            here.future.clear();
        }
    }

    /// Returns whether there is a selection in that direction at a position of the history.
    pub(super) fn leads(&self, done: usize, direction: WalkDirection) -> bool {
        self.at.get(&done).is_some_and(|here| match direction {
            WalkDirection::Back => !here.past.is_empty(),
            WalkDirection::Forward => !here.future.is_empty(),
        })
    }

    /// Goes to the next selection in a direction and returns it; `None` where there is none.
    pub(super) fn walk(&mut self, done: usize, direction: WalkDirection) -> Option<SelectionState> {
        let here = self.at.get_mut(&done)?;
        let (from, to) = match direction {
            WalkDirection::Back => (&mut here.past, &mut here.future),
            WalkDirection::Forward => (&mut here.future, &mut here.past),
        };
        let next = from.pop()?;
        to.extend(self.last.replace((done, next.clone())).map(|(_, before)| before));
        Some(next)
    }
}
