//! The question when a model of a scene has another file than the one for which its edits were made.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{DocumentMessage, OutdatedEdits, OutdatedEditsChoice};

/// The edits of a model that a project keeps were made for another file.
#[derive(Clone, Debug, PartialEq)]
pub struct OutdatedQuestion {
    /// The edits.
    pub edits: OutdatedEdits,
}

impl QuestionKind for OutdatedQuestion {
    fn name(&self) -> &'static str {
        "asked what becomes of edits of a changed model"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(520.0);
        ask.title(&format!("Apply the edits of the project to {}?", self.edits.title));
        ask.says("The file changed since these edits were made, so they are not applied now.");
        ask.adds("If they were saved into the file, it has them already: remove them, or the motion gets them twice. If another program wrote a new version of the file, apply them.");
        let cancel = ("Cancel", "Decide later; the scene plays the file as it is", Tone::First, None);
        let apply = (
            "Apply",
            "Apply the edits to the file as it is now",
            Tone::Plain,
            Some(OutdatedEditsChoice::Apply),
        );
        let remove = (
            "Remove",
            "Let the project keep no edits of this model; Undo in the scene brings them back",
            Tone::Loses,
            Some(OutdatedEditsChoice::Remove),
        );
        let request = match ask.buttons(&[cancel, apply, remove]) {
            Some(Some(choice)) => {
                let message = DocumentMessage::DecideOutdated(self.edits.clone(), choice);
                Request::Answer(FileAction::Send(message))
            }
            Some(None) => Request::Dismiss,
            None => return,
        };
        ask.requests.push(request);
    }
}
