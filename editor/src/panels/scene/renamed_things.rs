//! The things of a script that another script has under other names.

use dragonfly_anim::stage::script::StageScript;
use std::collections::{BTreeMap, BTreeSet};

/// The old and the new names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RenamedThings(BTreeMap<Box<str>, Box<str>>);

impl RenamedThings {
    /// Finds the things at the same places of two casts whose names only one of them has.
    pub(super) fn between(old: &StageScript, new: &StageScript) -> Self {
        if old.things().len() != new.things().len() {
            return Self::default();
        }
        let pairs = old.things().zip(new.things()).filter(|(was, now)| was.row.name == now.row.name);
        let renamed = pairs.filter_map(|(was, now)| {
            let (was, now) = (was.value("id")?, now.value("id")?);
            let is_new = was != now && new.thing_called(was).is_none() && old.thing_called(now).is_none();
            is_new.then(|| (was.into(), now.into()))
        });
        Self(renamed.collect())
    }

    /// Returns the new name of a thing that was renamed.
    pub fn new_name(&self, old: &str) -> Option<&str> {
        self.0.get(old).map(|new| &**new)
    }

    /// Replaces old names by the new ones.
    pub(super) fn rename_in(&self, names: &mut BTreeSet<Box<str>>) {
        for (old, new) in &self.0 {
            if names.remove(old) {
                names.insert(new.clone());
            }
        }
    }
}
