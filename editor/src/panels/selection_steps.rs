//! The selections of bones and keys around each step of the history: undo restores the one before the step, and redo the
//! one after it.

use super::keys::KeySelection;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::Change;
use dragonfly_document::adapter::TakeId;
use dragonfly_document::history::Gesture;
use std::collections::VecDeque;

/// The selected bones and keys at one moment.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SelectionState {
    /// The selected bones in the order of selection.
    pub(super) bones: Vec<BoneIndex>,
    /// The selected keys.
    pub(super) keys: KeySelection,
    /// The take that was shown, to which the keys belong.
    pub(super) take: Option<TakeId>,
}

impl SelectionState {
    /// Returns the same selection in another skeleton.
    fn shifted(&self, shift: BoneShift) -> Self {
        Self { bones: shift.bones(&self.bones), keys: self.keys.renumbered(shift), take: self.take }
    }
}

/// The selections around all steps of the history that were made since the model was opened.
#[derive(Debug, Default)]
pub(super) struct SelectionSteps {
    steps: Vec<SelectionStep>,
    /// Number of applied steps in the last view.
    done: usize,
    /// Changes that no view has answered yet, with the selection when they were sent.
    sent: VecDeque<SentChange>,
    /// The gesture of the last edit.
    gesture: Option<Gesture>,
    /// Selections of undone steps that the gesture removed; they come back if it is cancelled.
    removed: Vec<SelectionStep>,
}

/// The selections around one step; `None` where they are not known.
#[derive(Clone, Debug, Default)]
struct SelectionStep {
    before: Option<SelectionState>,
    after: Option<SelectionState>,
}

#[derive(Debug)]
struct SentChange {
    number: u64,
    /// Whether it makes a step; otherwise it undoes or redoes steps.
    makes_step: bool,
    selection: SelectionState,
}

impl SelectionSteps {
    /// Forgets everything: a model was opened, with this number of applied steps.
    pub(super) fn open(&mut self, done: usize) {
        *self = Self { done, ..Self::default() };
    }

    /// Returns whether the selection before a change is to be noted: all edits of a gesture are one step.
    pub(super) fn notes(&self, change: &Change) -> bool {
        match change {
            Change::Edit(_, gesture) => gesture.is_none() || self.gesture != *gesture,
            Change::Undo | Change::Redo | Change::GoTo(_) => true,
            Change::Release(_) | Change::Cancel(_) => false,
        }
    }

    /// Notes the selection at the time at which a change is sent under a number.
    pub(super) fn send(&mut self, number: u64, change: &Change, selection: SelectionState) {
        let makes_step = matches!(change, Change::Edit(..));
        self.gesture = if let Change::Edit(_, gesture) = change { *gesture } else { None };
        self.removed = Vec::new();
        self.sent.push_back(SentChange { number, makes_step, selection });
    }

    /// Follows the bones to another skeleton, for the changes that no view has answered yet. Those around the steps are of the skeletons
    /// that the steps had.
    pub(super) fn shift_sent(&mut self, shift: BoneShift, answered: u64) {
        for sent in self.sent.iter_mut().filter(|sent| sent.number > answered) {
            sent.selection = sent.selection.shifted(shift);
        }
    }

    /// Notes that a gesture was cancelled.
    pub(super) fn cancel(&mut self, gesture: Gesture) {
        if self.gesture.take_if(|own| *own == gesture).is_none() {
            return;
        }
        if self.sent.back().is_some_and(|sent| sent.makes_step) {
            self.sent.pop_back();
        } else {
            // The step of the gesture is the last one.
            self.steps.truncate(self.done.saturating_sub(1));
            self.steps.append(&mut self.removed);
        }
    }

    /// Notes that a view has answered all changes up to a number, with this number of applied steps. Returns the
    /// selection to restore, if the view shows the result of an undo or redo.
    pub(super) fn receive(&mut self, answered: u64, done: usize) -> Option<SelectionState> {
        let count = self.sent.iter().take_while(|sent| sent.number <= answered).count();
        let sent: Vec<SentChange> = self.sent.drain(..count).collect();
        let before = std::mem::replace(&mut self.done, done);
        let made = sent.iter().filter(|sent| sent.makes_step).count();
        if made > 0 {
            self.made(before, done, sent);
            return None;
        }
        let walked_from = sent.into_iter().next()?.selection;
        self.steps.resize(self.steps.len().max(done).max(before), SelectionStep::default());
        if done < before {
            self.steps[before - 1].after = Some(walked_from);
            return self.steps[done].before.clone();
        }
        let last = done.checked_sub(1).filter(|_| done > before)?;
        let next = || self.steps.get(done).and_then(|step| step.before.clone());
        self.steps[last].after.clone().or_else(next)
    }

    /// Notes the steps that were made since there were `before` steps. Where some changes made no step, it is not known
    /// which.
    fn made(&mut self, before: usize, done: usize, sent: Vec<SentChange>) {
        if done <= before {
            return;
        }
        self.steps.resize(self.steps.len().max(before), SelectionStep::default());
        let removed = self.steps.split_off(before);
        if self.gesture.is_some() {
            self.removed = removed;
        }
        if sent.len() == done - before {
            let states =
                sent.into_iter().map(|sent| SelectionStep { before: Some(sent.selection), after: None });
            self.steps.extend(states);
        }
        self.steps.resize(done, SelectionStep::default());
    }
}
