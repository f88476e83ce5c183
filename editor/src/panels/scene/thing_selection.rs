//! The selected things of a scene.

use super::renamed_things::RenamedThings;
use dragonfly_document::bones::Choice;
use std::collections::HashSet;

/// Ids of things in the order of selection, the active one last, each once.
#[derive(Clone, Debug, Default)]
pub(super) struct ThingSelection {
    list: Vec<Box<str>>,
    set: HashSet<Box<str>>,
}

impl ThingSelection {
    /// Returns the ids, the active one last.
    pub(super) fn list(&self) -> &[Box<str>] {
        &self.list
    }

    /// Returns whether a thing is selected.
    pub(super) fn contains(&self, thing: &str) -> bool {
        self.set.contains(thing)
    }

    /// Selects these things instead.
    pub(super) fn replace(&mut self, things: Vec<Box<str>>) {
        self.set.clear();
        self.list = things;
        self.list.retain(|id| self.set.insert(id.clone()));
    }

    /// Replaces the selection, adds these things as the last ones, or toggles them.
    pub(super) fn choose(&mut self, things: &[Box<str>], choice: Choice) {
        if choice == Choice::Replace {
            return self.replace(things.to_vec());
        }
        let chosen: HashSet<&str> = things.iter().map(|id| &**id).collect();
        let before = std::mem::take(&mut self.set);
        self.list.retain(|id| !chosen.contains(&**id));
        let added = things.iter().filter(|id| choice == Choice::Add || !before.contains(*id));
        let all = self.list.drain(..).chain(added.cloned()).collect();
        self.replace(all);
    }

    /// Keeps things selected that have other names.
    pub(super) fn rename(&mut self, renamed: &RenamedThings) {
        if self.list.iter().any(|id| renamed.new_name(id).is_some()) {
            let named = self.list.iter().map(|id| renamed.new_name(id).map_or_else(|| id.clone(), Box::from));
            self.replace(named.collect());
        }
    }

    /// Deselects the things for which `is_kept` returns false.
    pub(super) fn retain(&mut self, is_kept: impl Fn(&str) -> bool) {
        self.list.retain(|id| is_kept(id));
        self.set.retain(|id| is_kept(id));
    }
}
