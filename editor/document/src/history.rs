//! Undo and redo of every edit, as a list of steps.

use super::about::about;
use super::adapter::{EditError, Inverse, ModelAdapter, TextFiles, ValueDrag};
use super::base_skeleton::BaseSkeleton;
use super::edit::Edit;
use super::step_amount::{PoseBefore, StepAmount};
use std::collections::VecDeque;
use std::mem::discriminant;
use std::ops::Range;
use std::sync::Arc;

/// Identifies one gesture, for example a drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Gesture(pub u64);

/// Maximum number of steps.
pub const MAX_STEPS: usize = 10_000;
/// Maximum size of all steps in bytes, about. The oldest steps are removed beyond it.
pub const MAX_BYTES: usize = 256 << 20;

/// One step of the history.
#[derive(Clone, Debug)]
pub struct HistoryStep {
    /// The edit; of a gesture, its last one.
    pub edit: Edit,
    /// The gesture that made it.
    pub gesture: Option<Gesture>,
    /// Number that no other step has; a gesture keeps it.
    pub number: u64,
    /// Names of bones and take, at the time of the edit.
    pub about: Arc<str>,
    /// The amount by which it moves a bone; `None` where it neither sets nor offsets poses.
    pub amount: Option<StepAmount>,
    /// The pose before the step, from which the amount is measured.
    before: Option<PoseBefore>,
    /// Undoes the step where it is applied, and redoes it where it is undone.
    inverse: Inverse,
    /// Size of the inverse in bytes, about, when the step was made.
    bytes: usize,
}

/// Undone steps that a gesture removed, and the saved states as they were then.
#[derive(Clone, Debug)]
struct RemovedSteps {
    steps: Vec<HistoryStep>,
    saved: Option<usize>,
    saving: Option<usize>,
    kept: Option<usize>,
}

/// The difference between the last save and the present state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UnsavedSteps {
    /// The applied steps that the save does not contain; directly before them, all steps are in it.
    pub(super) steps: Range<usize>,
    /// Whether the save contains steps that are undone, or were undone and replaced.
    pub(super) has_undone: bool,
}

/// A model's takes with their history.
#[derive(Clone, Debug)]
pub struct Edited {
    adapter: ModelAdapter,
    steps: VecDeque<HistoryStep>,
    /// Number of steps that are applied; those after are undone.
    done: usize,
    /// Number of the newest step.
    numbered: u64,
    /// Number of steps that were applied at the last save; `None` where neither undo nor redo leads there.
    saved: Option<usize>,
    /// The same for the save that is running.
    saving: Option<usize>,
    /// Number of steps that were applied when another file kept them, which the file of the model does not contain; `None` where there is
    /// none, or where neither undo nor redo leads there.
    kept: Option<usize>,
    /// Numbers of first steps that the last save and the running one contain too, while `saved` or `saving` is `None`.
    shared: [usize; 2],
    /// Size of all steps in bytes, about.
    bytes: usize,
    /// Whether the oldest steps were removed because there were too many.
    cut: bool,
    /// The undone steps that the gesture in progress removed; they come back if it is cancelled.
    removed: Option<RemovedSteps>,
    /// State of the drag, where the last step is a pose that is being dragged.
    drag: Option<ValueDrag>,
    /// The skeleton before the first step.
    base: BaseSkeleton,
    /// The texts before the first step.
    base_texts: TextFiles,
}

impl Edited {
    /// Creates an empty history.
    pub fn new(adapter: ModelAdapter) -> Self {
        let base = BaseSkeleton::of(adapter.skeleton());
        Self::started(adapter, base)
    }

    /// Creates an empty history that starts with a skeleton which edits may have changed before.
    pub(super) fn started(adapter: ModelAdapter, base: BaseSkeleton) -> Self {
        Self {
            base_texts: adapter.texts().clone(),
            adapter,
            steps: VecDeque::new(),
            done: 0,
            numbered: 0,
            saved: Some(0),
            saving: None,
            kept: None,
            shared: [0; 2],
            bytes: 0,
            cut: false,
            removed: None,
            drag: None,
            base,
        }
    }

    /// Returns the skeleton before the first step.
    pub(super) fn base_skeleton(&self) -> &BaseSkeleton {
        &self.base
    }

    /// Returns the texts before the first step.
    pub(super) fn base_texts(&self) -> &TextFiles {
        &self.base_texts
    }

    /// Returns the takes as they are now.
    pub fn adapter(&self) -> &ModelAdapter {
        &self.adapter
    }

    /// Returns all steps, the first one first, and how many of them are applied.
    pub fn steps(&self) -> (&VecDeque<HistoryStep>, usize) {
        (&self.steps, self.done)
    }

    /// Applies an edit of the user or of a program, as [`Self::apply`] does for edits of a journal, if it is allowed now.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be applied or is not allowed; nothing has changed then.
    pub fn ask(&mut self, edit: Edit, gesture: Option<Gesture>) -> Result<(), EditError> {
        self.adapter.allows(&edit)?;
        self.apply(edit, gesture)
    }

    /// Applies an edit as a step. All edits of one gesture are one step: each replaces the previous one, and
    /// applies to the document as it was when the gesture started.
    ///
    /// Undone steps are removed; those that a gesture removes come back if it is cancelled.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be applied; nothing has changed then, and a gesture keeps its previous edit.
    pub fn apply(&mut self, edit: Edit, gesture: Option<Gesture>) -> Result<(), EditError> {
        let goes_on = gesture.is_some()
            && self.done == self.steps.len()
            && self.steps.back().is_some_and(|step| step.gesture == gesture);
        if goes_on
            && let Some(drag) = &mut self.drag
            && let Some(done) = drag.amend(&mut self.adapter, &edit)
        {
            done?;
            if let Some(step) = self.steps.back_mut() {
                step.amount = StepAmount::of(&self.adapter, &edit, step.before);
                step.edit = edit;
            }
            // The saved state is not the present one any more.
            self.lose_saves(self.done.saturating_sub(1));
            return Ok(());
        }
        let mut adapter = self.adapter.clone();
        if goes_on && let Some(step) = self.steps.back() {
            adapter.revert(step.inverse.clone());
        }
        let same_kind = |step: &&HistoryStep| discriminant(&step.edit) == discriminant(&edit);
        let is_written = matches!(&edit, Edit::EditScript(edit) if edit.is_written());
        let before = self.steps.back().filter(|_| goes_on);
        let about = match before.filter(same_kind).filter(|_| !is_written) {
            // A gesture changes the same bones all the time, so its text stays.
            Some(step) => Arc::clone(&step.about),
            None => about(&adapter, &edit),
        };
        let number = before.map_or(self.numbered + 1, |step| step.number);
        let before = PoseBefore::of(&adapter, &edit);
        let inverse = adapter.apply(&edit)?;
        let amount = StepAmount::of(&adapter, &edit, before);
        self.adapter = adapter;
        self.numbered = self.numbered.max(number);
        if goes_on {
            self.forget_after(self.done - 1);
        } else {
            let (saved, saving, kept) = (self.saved, self.saving, self.kept);
            let steps = self.forget_after(self.done);
            self.removed = gesture.map(|_| RemovedSteps { steps, saved, saving, kept });
        }
        self.lose_saves(self.steps.len());
        self.drag = gesture.and_then(|_| ValueDrag::of(&self.adapter, &edit, &inverse));
        if let Edit::AddRootBone(edit) = &edit {
            self.base.note(&edit.name);
        }
        let bytes = inverse.bytes();
        self.bytes += bytes;
        self.steps.push_back(HistoryStep { edit, gesture, number, about, amount, before, inverse, bytes });
        self.done = self.steps.len();
        self.forget_oldest();
        Ok(())
    }

    /// Removes the step of a gesture, as if it had never started. Returns whether it was the last step.
    pub fn cancel(&mut self, gesture: Gesture) -> bool {
        let is_last = self.done == self.steps.len();
        let its_step = self.steps.back().is_some_and(|step| step.gesture == Some(gesture));
        if is_last && its_step {
            let removed = self.removed.take();
            self.undo();
            self.forget_after(self.done);
            if let Some(RemovedSteps { steps, saved, saving, kept }) = removed {
                self.bytes += steps.iter().map(|step| step.bytes).sum::<usize>();
                self.steps.extend(steps);
                (self.saved, self.saving, self.kept) = (saved, saving, kept);
            }
        }
        is_last && its_step
    }

    /// Undoes the last step. Returns whether there is one.
    pub fn undo(&mut self) -> bool {
        self.go_to(self.done.wrapping_sub(1))
    }

    /// Redoes the next step. Returns whether there is one.
    pub fn redo(&mut self) -> bool {
        self.go_to(self.done + 1)
    }

    /// Undoes or redoes until exactly `done` steps are applied. Returns whether there are that many.
    pub fn go_to(&mut self, done: usize) -> bool {
        if done > self.steps.len() {
            return false;
        }
        (self.drag, self.removed) = (None, None);
        while self.done != done {
            let at = if done < self.done { self.done - 1 } else { self.done };
            let step = &mut self.steps[at];
            step.inverse = self.adapter.revert(step.inverse.clone());
            self.done = if done < self.done { self.done - 1 } else { self.done + 1 };
        }
        true
    }

    /// Returns the labels of the steps that undo and redo would affect, for the menu.
    pub fn labels(&self) -> [Option<&'static str>; 2] {
        let label = |at: usize| self.steps.get(at).map(|step| step.edit.label());
        [label(self.done.wrapping_sub(1)), label(self.done)]
    }

    /// Marks the present state as saved.
    pub fn mark_saved(&mut self) {
        (self.removed, self.kept) = (None, None);
        self.saved = Some(self.done);
    }

    /// Marks the present state as kept: another file than that of the model has its steps, so that there is no unsaved work.
    pub(super) fn mark_kept(&mut self) {
        self.end_gesture();
        self.kept = Some(self.done);
    }

    /// Returns whether another file keeps the present state.
    pub(super) fn is_kept(&self) -> bool {
        self.kept == Some(self.done)
    }

    /// Returns the number of steps that were applied in the state without unsaved work: the kept one, or else the saved one; `None` where
    /// neither undo nor redo leads there.
    pub(super) fn settled(&self) -> Option<usize> {
        self.kept.or(self.saved)
    }

    /// Returns whether closing the document would lose work: it is neither saved nor kept.
    pub fn has_unsaved(&self) -> bool {
        !self.is_saved() && !self.is_kept()
    }

    /// Notes that the present state is being saved, and ends the last gesture, whose later edits are not saved.
    pub fn begin_save(&mut self) {
        self.end_gesture();
        self.saving = Some(self.done);
    }

    /// Ends the save that [`begin_save`](Self::begin_save) began: where it succeeded, the state of then counts as saved.
    pub fn end_save(&mut self, succeeded: bool) {
        let saving = self.saving.take();
        if succeeded {
            // The kept steps belong to another file than the one that was written.
            (self.saved, self.kept) = (saving, None);
            self.shared[0] = self.shared[1];
        }
        if let Some(removed) = &mut self.removed {
            let saving = removed.saving.take();
            if succeeded {
                (removed.saved, removed.kept) = (saving, None);
            }
        }
    }

    /// Forgets the saved states after the first `common` steps: neither undo nor redo leads there.
    fn lose_saves(&mut self, common: usize) {
        for (saved, shared) in [&mut self.saved, &mut self.saving].into_iter().zip(&mut self.shared) {
            *shared = saved.unwrap_or(*shared).min(common);
            *saved = saved.filter(|saved| *saved <= common);
        }
        self.kept = self.kept.filter(|kept| *kept <= common);
    }

    /// Returns the number of steps applied or undone since the model was saved or opened. Where neither undo nor redo
    /// leads back to that state, returns the number of all applied steps.
    pub fn unsaved_steps(&self) -> usize {
        self.saved.map_or(self.done, |saved| self.done.abs_diff(saved))
    }

    /// Returns whether a save would change nothing: the takes are as they were when last saved or opened, and no pose is
    /// pending that was not pending then. Pending poses that were set and discarded since count as nothing.
    pub fn is_saved(&self) -> bool {
        let Some(saved) = self.saved else { return false };
        saved == self.done || (self.adapter.pending_poses() == 0 && self.only_pending_changed_since(saved))
    }

    /// Returns whether all steps between the present state and another one change pending poses and nothing else.
    fn only_pending_changed_since(&self, other: usize) -> bool {
        let (from, to) = (self.done.min(other), self.done.max(other));
        let mut between = self.steps.range(from..to);
        between
            .all(|step| matches!(step.edit, Edit::SetPending(_) | Edit::PendShapes(_) | Edit::DropPending(_)))
    }

    /// Returns the applied steps that the last save does not contain.
    pub(super) fn unsaved(&self) -> UnsavedSteps {
        let shared = self.saved.unwrap_or(self.shared[0]).min(self.done);
        let has_undone = self.saved.is_none_or(|saved| saved > self.done);
        UnsavedSteps { steps: shared..self.done, has_undone }
    }

    /// Returns the number of steps that were applied at the last save; `None` where neither undo nor redo leads there.
    pub fn saved(&self) -> Option<usize> {
        self.saved
    }

    /// Sets the saved state of restored steps; none where there are fewer steps.
    pub fn set_saved(&mut self, saved: Option<usize>) {
        self.saved = saved.filter(|saved| *saved <= self.steps.len());
        (self.shared, self.kept) = ([0; 2], None);
    }

    /// Returns whether the oldest steps were removed because there were too many.
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// Ends the last gesture: later edits are separate steps.
    pub fn end_gesture(&mut self) {
        self.removed = None;
        if let Some(step) = self.steps.back_mut() {
            step.gesture = None;
        }
    }

    /// Removes the steps after the first `kept`. Returns them.
    fn forget_after(&mut self, kept: usize) -> Vec<HistoryStep> {
        let steps: Vec<_> = self.steps.drain(kept..).collect();
        self.bytes -= steps.iter().map(|step| step.bytes).sum::<usize>();
        steps
    }

    fn forget_oldest(&mut self) {
        // The newest step is kept, however large it is.
        while self.steps.len() > 1 && (self.steps.len() > MAX_STEPS || self.bytes > MAX_BYTES) {
            let Some(oldest) = self.steps.pop_front() else { return };
            if let Edit::AddRootBone(edit) = &oldest.edit {
                self.base.start_with(&edit.name);
            }
            if let Edit::EditScript(edit) = &oldest.edit {
                edit.apply_to(&mut self.base_texts);
            }
            self.bytes -= oldest.bytes;
            self.done -= 1;
            self.shared = self.shared.map(|shared| shared.saturating_sub(1));
            self.cut = true;
            let removed = self
                .removed
                .iter_mut()
                .flat_map(|removed| [&mut removed.saved, &mut removed.saving, &mut removed.kept]);
            for saved in [&mut self.saved, &mut self.saving, &mut self.kept].into_iter().chain(removed) {
                *saved = saved.and_then(|saved| saved.checked_sub(1));
            }
        }
    }
}
