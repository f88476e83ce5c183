//! Models of a scene whose files changed since the edits that its project keeps were made: the user is asked once, when they were read.

use super::outdated_edits::OutdatedEdits;
use super::scene_models::SceneModels;
use super::scene_view::SceneModel;
use std::collections::BTreeSet;

/// The models of an open scene that the user was asked about.
#[derive(Debug, Default)]
pub(super) struct ChangedModels {
    /// The models that were read at least once since the scene was opened.
    known: BTreeSet<String>,
    /// Models whose edits were applied again, and that were not read since then.
    awaited: BTreeSet<String>,
}

/// News for the user about models that were read.
#[derive(Debug, Default)]
pub(super) struct ChangedModelNews {
    /// The edits that were made for other files, of models that were read for the first time.
    pub(super) outdated: Vec<OutdatedEdits>,
    /// Edits that were applied again and do not fit, a sentence for each model.
    pub(super) unfit: Vec<String>,
}

impl ChangedModels {
    /// Returns what is new, once no model is being read: a model that changes later is not asked about, but has a note.
    pub(super) fn news(&mut self, models: &SceneModels, outdated: &[OutdatedEdits]) -> ChangedModelNews {
        let mut news = ChangedModelNews::default();
        if models.shown().values().any(|model| matches!(model, SceneModel::Loading))
            || models.are_read_again()
        {
            return news;
        }
        for (name, _, file) in models.read() {
            if !self.known.contains(name) {
                news.outdated.extend(outdated.iter().find(|edits| edits.model == name).cloned());
                self.known.insert(name.to_owned());
            }
            if self.awaited.contains(name) {
                news.unfit.extend(file.unfit.clone());
            }
        }
        self.awaited.clear();
        news
    }

    /// Notes that the edits of models were applied again.
    pub(super) fn await_fit(&mut self, models: impl IntoIterator<Item = String>) {
        self.awaited.extend(models);
    }
}
