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
    /// The files of models whose edits were applied again and do not fit, and a sentence for each. No sentence occurs twice.
    pub(super) unfit: Vec<(String, String)>,
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
        for (name, source, file) in models.read() {
            if !self.known.contains(name) {
                news.outdated.extend(outdated.iter().find(|edits| edits.model == name).cloned());
                self.known.insert(name.to_owned());
            }
            if self.awaited.contains(name) {
                let is_new = |text: &&String| news.unfit.iter().all(|(_, other)| other != *text);
                // A script may mean one model by its id and by its file.
                let unfit = file.unfit.as_ref().filter(is_new);
                news.unfit.extend(unfit.map(|text| (source.file.clone(), text.clone())));
            }
        }
        self.awaited.clear();
        news
    }

    /// Notes that the edits of models were applied again, and that the user is warned about those that do not fit.
    pub(super) fn await_fit(&mut self, models: impl IntoIterator<Item = String>) {
        self.awaited.extend(models);
    }
}

impl ChangedModelNews {
    /// Returns one sentence about all edits that do not fit, which names every model at its start; `None` where all fit.
    pub(super) fn unfit_sentence(&self) -> Option<String> {
        let (names, reasons): (Vec<&str>, Vec<&str>) =
            self.unfit.iter().map(|(file, reason)| (file.as_str(), reason.as_str())).unzip();
        match reasons.as_slice() {
            [] => None,
            [reason] => Some((*reason).to_owned()),
            _ => Some(format!("edits of {} do not fit them: {}", names.join(", "), reasons.join("; "))),
        }
    }
}
