//! The question when models of a scene have other files than those for which their edits were made, asked once for all of them.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use super::line_list::line_list;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{DocumentMessage, OutdatedEdits, OutdatedEditsChoice};

/// The files of models changed since the edits that the project keeps were made.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedModelsQuestion {
    /// The edits of each model.
    pub edits: Vec<OutdatedEdits>,
}

impl QuestionKind for ChangedModelsQuestion {
    fn name(&self) -> &'static str {
        "asked what becomes of edits of changed models"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(560.0);
        ask.title(&match self.edits.len() {
            1 => "1 model changed since its edits were made".to_owned(),
            models => format!("{models} models changed since their edits were made"),
        });
        ask.says("The scene plays the files as they are, without the edits that the project keeps.");
        let line = |edits: &OutdatedEdits| match edits.model == edits.title {
            true => edits.title.clone(),
            false => format!("{}: {}", edits.model, edits.title),
        };
        line_list(ask.ui, &self.edits.iter().map(line).collect::<Vec<_>>());
        ask.adds("If edits were saved into a file, it has them already: remove them, or the motion gets them twice. If another program wrote a new version of the file, apply them again.");
        let later =
            ("Later", "Change nothing; the menu of each thing has the same choice", Tone::First, None);
        let apply = (
            "Apply the edits again",
            "Apply the edits to the files as they are now",
            Tone::Plain,
            Some(OutdatedEditsChoice::Apply),
        );
        let remove = (
            "Remove the edits",
            "Let the project keep no edits of these models; Undo brings them back",
            Tone::Loses,
            Some(OutdatedEditsChoice::Remove),
        );
        let request = match ask.buttons(&[later, apply, remove]) {
            Some(Some(choice)) => {
                let message = DocumentMessage::DecideAllOutdated(self.edits.clone(), choice);
                Request::Answer(FileAction::Send(message))
            }
            Some(None) => Request::Dismiss,
            None => return,
        };
        ask.requests.push(request);
    }
}
