//! Undo and redo of everything, as a list in which one can go to any place.

use super::about::about;
use super::adapter::{Drag, EditError, Inverse, ModelAdapter};
use super::edit::Edit;
use std::collections::VecDeque;
use std::sync::Arc;

/// Tells one gesture (a drag, a slider held) from all others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Gesture(pub u64);

/// Steps that are kept at most.
pub const MAX_STEPS: usize = 10_000;
/// Bytes that all steps keep at most, about; beyond, the oldest go.
pub const MAX_BYTES: usize = 256 << 20;

/// One step of the history.
#[derive(Clone, Debug)]
pub struct Step {
    /// What was done; of a gesture, what it came to.
    pub edit: Edit,
    /// Which gesture made it.
    pub gesture: Option<Gesture>,
    /// What it was done to, as people call it: bone, take. Known when it was done; names may change later.
    pub about: Arc<str>,
    /// Leads back where the step is done, forth where it is undone.
    inverse: Inverse,
    /// Of the inverse, about; as it was made.
    bytes: usize,
}

/// A model's takes with everything that was done to them.
#[derive(Clone, Debug)]
pub struct Edited {
    adapter: ModelAdapter,
    steps: VecDeque<Step>,
    /// Steps that are done; those behind are undone.
    done: usize,
    /// How many steps were done when it was saved; `None` where no undo and no redo leads there any more.
    saved: Option<usize>,
    /// Of all steps, about.
    bytes: usize,
    /// Were steps forgotten because there were too many?
    cut: bool,
    /// Where the last step is a pose that may still be dragged.
    drag: Option<Drag>,
}

impl Edited {
    /// Takes to which nothing was done yet.
    pub fn new(adapter: ModelAdapter) -> Self {
        Self { adapter, steps: VecDeque::new(), done: 0, saved: Some(0), bytes: 0, cut: false, drag: None }
    }

    /// The takes as they are now.
    pub fn adapter(&self) -> &ModelAdapter {
        &self.adapter
    }

    /// All steps, the first one first, and how many of them are done.
    pub fn steps(&self) -> (&VecDeque<Step>, usize) {
        (&self.steps, self.done)
    }

    /// [`Self::apply`] where a person or a program asks for it now, and not a journal of what was done before.
    ///
    /// # Errors
    ///
    /// Why it cannot be done or asked for; nothing has changed then.
    pub fn ask(&mut self, edit: Edit, gesture: Option<Gesture>) -> Result<(), EditError> {
        self.adapter.allows(&edit)?;
        self.apply(edit, gesture)
    }

    /// Does an edit as a step of its own, or as the newest form of a gesture: all edits of one gesture are one step,
    /// and each is meant for the document as it was when the gesture began.
    ///
    /// What was undone is forgotten.
    ///
    /// # Errors
    ///
    /// Why it cannot be done; nothing has changed then, and a gesture stays as it was before.
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
                step.edit = edit;
            }
            // As it was saved it is not any more.
            self.saved = self.saved.filter(|&saved| saved < self.done);
            return Ok(());
        }
        let mut adapter = self.adapter.clone();
        if goes_on && let Some(step) = self.steps.back() {
            adapter.revert(step.inverse.clone());
        }
        let about = match self.steps.back().filter(|_| goes_on) {
            // A gesture is about one thing, and while it lasts nothing is named anew.
            Some(step) => Arc::clone(&step.about),
            None => about(&adapter, &edit),
        };
        let inverse = adapter.apply(&edit)?;
        self.adapter = adapter;
        self.forget_after(if goes_on { self.done - 1 } else { self.done });
        if self.saved.is_some_and(|saved| saved > self.steps.len()) {
            self.saved = None;
        }
        self.drag = gesture.and_then(|_| Drag::of(&self.adapter, &edit, &inverse));
        let bytes = inverse.bytes();
        self.bytes += bytes;
        self.steps.push_back(Step { edit, gesture, about, inverse, bytes });
        self.done = self.steps.len();
        self.forget_oldest();
        Ok(())
    }

    /// Takes a gesture back as if it had never begun; was it the last step?
    pub fn cancel(&mut self, gesture: Gesture) -> bool {
        let is_last = self.done == self.steps.len();
        let its_step = self.steps.back().is_some_and(|step| step.gesture == Some(gesture));
        if is_last && its_step {
            self.undo();
            self.forget_after(self.done);
        }
        is_last && its_step
    }

    /// Undoes the last step; is there one?
    pub fn undo(&mut self) -> bool {
        self.go_to(self.done.wrapping_sub(1))
    }

    /// Does the next step again; is there one?
    pub fn redo(&mut self) -> bool {
        self.go_to(self.done + 1)
    }

    /// Undoes or does again until `done` steps are done; are there as many?
    pub fn go_to(&mut self, done: usize) -> bool {
        if done > self.steps.len() {
            return false;
        }
        self.drag = None;
        while self.done != done {
            let at = if done < self.done { self.done - 1 } else { self.done };
            let step = &mut self.steps[at];
            step.inverse = self.adapter.revert(step.inverse.clone());
            self.done = if done < self.done { self.done - 1 } else { self.done + 1 };
        }
        true
    }

    /// What undo would take back, and what redo would bring back: for the menu.
    pub fn labels(&self) -> [Option<&'static str>; 2] {
        let label = |at: usize| self.steps.get(at).map(|step| step.edit.label());
        [label(self.done.wrapping_sub(1)), label(self.done)]
    }

    /// It is on the disk as it is now.
    pub fn mark_saved(&mut self) {
        self.saved = Some(self.done);
    }

    /// Steps done or undone since it was saved or opened; all that were done where no undo leads back there.
    pub fn unsaved_steps(&self) -> usize {
        self.saved.map_or(self.done, |saved| self.done.abs_diff(saved))
    }

    /// Is it as it was saved or opened?
    pub fn is_saved(&self) -> bool {
        self.saved == Some(self.done)
    }

    /// How many steps were done when it was saved; `None` where no undo and no redo leads there any more.
    pub fn saved(&self) -> Option<usize> {
        self.saved
    }

    /// Says where it was saved, of steps that were brought back; nowhere where there are not so many.
    pub fn set_saved(&mut self, saved: Option<usize>) {
        self.saved = saved.filter(|saved| *saved <= self.steps.len());
    }

    /// Were the first steps forgotten because there were too many?
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// What comes from now on belongs to no gesture before.
    pub fn end_gesture(&mut self) {
        if let Some(step) = self.steps.back_mut() {
            step.gesture = None;
        }
    }

    fn forget_after(&mut self, kept: usize) {
        self.bytes -= self.steps.drain(kept..).map(|step| step.bytes).sum::<usize>();
    }

    fn forget_oldest(&mut self) {
        // The newest step stays, however large it is.
        while self.steps.len() > 1 && (self.steps.len() > MAX_STEPS || self.bytes > MAX_BYTES) {
            self.bytes -= self.steps.pop_front().map_or(0, |step| step.bytes);
            self.done -= 1;
            self.cut = true;
            self.saved = self.saved.and_then(|saved| saved.checked_sub(1));
        }
    }
}
