//! The selected actions of a scene.

use super::follow::follow_action;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::bones::Choice;

/// Actions in the order of selection, the active one last, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct ActionSelection(Vec<usize>);

impl ActionSelection {
    /// Returns the actions, the active one last.
    pub(super) fn list(&self) -> &[usize] {
        &self.0
    }

    /// Replaces the selection, adds these actions as the last ones, or toggles them.
    pub(super) fn choose(&mut self, actions: &[usize], choice: Choice) {
        let before = std::mem::take(&mut self.0);
        let is_added = |action: &&usize| choice != Choice::Toggle || !before.contains(action);
        if choice != Choice::Replace {
            self.0.extend(before.iter().filter(|action| !actions.contains(action)));
        }
        for &action in actions.iter().filter(is_added) {
            if !self.0.contains(&action) {
                self.0.push(action);
            }
        }
    }

    /// Selects the same actions of a newer script.
    pub(super) fn follow(&mut self, old: &StageScript, new: &StageScript) {
        let followed =
            self.0.iter().filter_map(|&action| follow_action(old, action, new)).collect::<Vec<_>>();
        self.choose(&followed, Choice::Replace);
    }
}
