//! The last split of actions, so that its undo selects them again.

use dragonfly_anim::stage::script::StageScript;
use std::sync::Arc;

/// Actions that are split, and the text before that.
#[derive(Clone, Debug)]
pub(in crate::panels) struct SplitActions {
    text: Arc<str>,
    actions: Vec<usize>,
}

impl SplitActions {
    /// Returns these actions of a text.
    pub(in crate::panels) fn new(text: Arc<str>, actions: Vec<usize>) -> Self {
        Self { text, actions }
    }
}

/// The last split.
#[derive(Clone, Debug)]
pub(super) struct LastSplit {
    split: SplitActions,
    /// The text with the halves.
    after: Arc<str>,
}

impl LastSplit {
    /// Returns the split that led to the text `after`.
    pub(super) fn new(split: SplitActions, after: Arc<str>) -> Self {
        Self { split, after }
    }

    /// Returns the actions that were split, if the script `new` is the one before the split and `old` the one after it.
    pub(super) fn undone(&self, old: &StageScript, new: &StageScript) -> Option<&[usize]> {
        let is = |script: &StageScript, text: &str| **script.tree().text() == *text;
        (is(new, &self.split.text) && is(old, &self.after)).then_some(&*self.split.actions)
    }
}
