//! The selected actions of a scene.

use super::follow::follow_actions;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::bones::Choice;
use std::collections::HashSet;

/// Actions in the order of selection, the active one last, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct ActionSelection {
    list: Vec<usize>,
    set: HashSet<usize>,
}

impl ActionSelection {
    /// Returns the actions, the active one last.
    pub(super) fn list(&self) -> &[usize] {
        &self.list
    }

    /// Returns whether an action is selected.
    pub(super) fn contains(&self, action: usize) -> bool {
        self.set.contains(&action)
    }

    /// Replaces the selection, adds these actions as the last ones, or toggles them.
    pub(super) fn choose(&mut self, actions: &[usize], choice: Choice) {
        let before = std::mem::take(self);
        let chosen: HashSet<usize> = actions.iter().copied().collect();
        let kept = before.list.iter().copied().filter(|action| !chosen.contains(action));
        let kept = kept.filter(|_| choice != Choice::Replace);
        let is_added = |action: &usize| choice != Choice::Toggle || !before.set.contains(action);
        for action in kept.chain(actions.iter().copied().filter(is_added)) {
            if self.set.insert(action) {
                self.list.push(action);
            }
        }
    }

    /// Selects the same actions of a newer script.
    pub(super) fn follow(&mut self, old: &StageScript, new: &StageScript) {
        let followed = follow_actions(old, new, &self.list);
        if followed != self.list {
            self.choose(&followed, Choice::Replace);
        }
    }
}
