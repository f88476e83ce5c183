//! The question before a file of another program is replaced as a whole.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use crate::panels::commands::Id;
use crate::panels::request::{FileAction, Request};
use dragonfly_document::{DocumentMessage, SaveOrder, formats};

/// Saving replaces the whole file by what the editor reads, so that the rest of the file is lost.
#[derive(Clone, Debug, PartialEq)]
pub struct RewriteQuestion {
    /// The order to save.
    pub order: SaveOrder,
}

/// The answer of the user.
#[derive(Clone, Copy)]
enum RewriteChoice {
    Cancel,
    Export,
    Rewrite,
}

impl QuestionKind for RewriteQuestion {
    fn name(&self) -> &'static str {
        "asked whether the whole file is to be replaced"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(460.0);
        ask.title("Replace the whole file?");
        let formats = formats();
        let format = ask.view.and_then(|view| formats.by_extension(&view.file.ending));
        let format = format.map_or("this format", |format| format.title);
        ask.says(format!(
            "Edits cannot be put into a file of {format}: the whole file is written from what the editor reads. Constraints, \
             controls, layers and the settings of other programs are not in it.",
        ));
        ask.adds(
            "The old file is kept in the autosave folder for a while. A glTF file (.glb) keeps everything in later saves.",
        );
        let rewrite =
            ("Write whole file", "Replaces the file by a new one", Tone::Loses, RewriteChoice::Rewrite);
        let export =
            ("Export .glb…", "Writes a glTF file and keeps this one", Tone::First, RewriteChoice::Export);
        let cancel = ("Cancel", "Saves nothing", Tone::Plain, RewriteChoice::Cancel);
        let request = match ask.buttons(&[export, cancel, rewrite]) {
            Some(RewriteChoice::Rewrite) => {
                let order = SaveOrder { rewrite: true, ..self.order.clone() };
                Request::Answer(FileAction::Send(DocumentMessage::Save(order)))
            }
            Some(RewriteChoice::Export) => {
                ask.requests.push(Request::Dismiss);
                Request::Command(Id::Export)
            }
            Some(RewriteChoice::Cancel) => Request::Dismiss,
            None => return,
        };
        ask.requests.push(request);
    }
}
