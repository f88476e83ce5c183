//! What is hidden and locked in a scene. A change of it is a step of undo between those of the history, although the document does not have it.
//!
//! ```text
//! history   move ── rotate ── scale          each step of the history knows how many were done before it
//! hiding         └ hide    └ lock, show      undone before the step of the history that they follow
//! ```

use super::renamed_things::RenamedThings;
use crate::panels::selection_trail::WalkDirection;
use std::collections::BTreeSet;

/// Maximum number of changes that can be undone.
const MOST: usize = 200;

/// The things of a scene that are hidden and locked.
#[derive(Clone, Copy, Debug)]
pub(in crate::panels) struct SceneMarks<'a> {
    /// The ids of the hidden things.
    pub(in crate::panels) hidden: &'a BTreeSet<Box<str>>,
    /// The ids of the locked things.
    pub(in crate::panels) locked: &'a BTreeSet<Box<str>>,
    /// Number of changes of them.
    pub(in crate::panels) version: u64,
}

/// The hidden and the locked things, by their ids, with the changes that can be undone and redone.
#[derive(Clone, Debug, Default)]
pub(super) struct HideAndLock {
    hidden: BTreeSet<Box<str>>,
    locked: BTreeSet<Box<str>>,
    /// Number of changes.
    version: u64,
    /// The newest one is the last.
    past: Vec<HideStep>,
    /// The one that was undone last is the last.
    future: Vec<HideStep>,
}

/// A change of what is hidden and locked: the state on its other side.
#[derive(Clone, Debug)]
struct HideStep {
    /// Number of applied steps of the history.
    done: usize,
    label: &'static str,
    hidden: BTreeSet<Box<str>>,
    locked: BTreeSet<Box<str>>,
}

impl HideAndLock {
    /// Returns the ids of the hidden things.
    pub(super) fn hidden(&self) -> &BTreeSet<Box<str>> {
        &self.hidden
    }

    /// Returns the ids of the locked things.
    pub(super) fn locked(&self) -> &BTreeSet<Box<str>> {
        &self.locked
    }

    /// Returns what is hidden and locked, as it is remembered for a file.
    pub(super) fn marks(&self) -> SceneMarks<'_> {
        SceneMarks { hidden: &self.hidden, locked: &self.locked, version: self.version }
    }

    /// Hides things or shows them, without a step.
    pub(super) fn hide(&mut self, things: Vec<Box<str>>, hide: bool) {
        self.version += 1;
        set(&mut self.hidden, things, hide);
    }

    /// Locks things or unlocks them, without a step.
    pub(super) fn lock(&mut self, things: Vec<Box<str>>, lock: bool) {
        self.version += 1;
        set(&mut self.locked, things, lock);
    }

    /// Makes a change a step after the first `done` ones of the history. One that changes nothing is none.
    pub(super) fn step(&mut self, done: usize, label: &'static str, change: impl FnOnce(&mut Self)) {
        let before = self.as_step(done, label);
        change(self);
        if (&before.hidden, &before.locked) == (&self.hidden, &self.locked) {
            return;
        }
        self.future.clear();
        self.past.push(before);
        if self.past.len() > MOST {
            self.past.remove(0);
        }
    }

    /// Returns the label of the change that is undone or redone next, before a step of the history is; `None` where there is none.
    pub(super) fn next(&self, done: usize, direction: WalkDirection) -> Option<&'static str> {
        let from = match direction {
            WalkDirection::Back => &self.past,
            WalkDirection::Forward => &self.future,
        };
        from.last().filter(|step| step.done == done).map(|step| step.label)
    }

    /// Undoes or redoes a change. Returns whether there was one.
    pub(super) fn walk(&mut self, done: usize, direction: WalkDirection) -> bool {
        let Some(label) = self.next(done, direction) else { return false };
        let now = self.as_step(done, label);
        let (from, to) = match direction {
            WalkDirection::Back => (&mut self.past, &mut self.future),
            WalkDirection::Forward => (&mut self.future, &mut self.past),
        };
        to.push(now);
        let Some(step) = from.pop() else { return false };
        (self.hidden, self.locked) = (step.hidden, step.locked);
        self.version += 1;
        true
    }

    /// Forgets the changes that followed the first `done` steps of the history: other steps follow them now.
    pub(super) fn forget_after(&mut self, done: usize) {
        self.past.retain(|step| step.done <= done);
        self.future.clear();
    }

    /// Replaces the ids of things that were renamed.
    pub(super) fn rename(&mut self, renamed: &RenamedThings) {
        renamed.rename_in(&mut self.hidden);
        renamed.rename_in(&mut self.locked);
    }

    fn as_step(&self, done: usize, label: &'static str) -> HideStep {
        HideStep { done, label, hidden: self.hidden.clone(), locked: self.locked.clone() }
    }
}

fn set(of: &mut BTreeSet<Box<str>>, things: Vec<Box<str>>, on: bool) {
    for thing in things {
        if on {
            of.insert(thing);
        } else {
            of.remove(&thing);
        }
    }
}
