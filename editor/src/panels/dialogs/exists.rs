//! The question when the typed name belongs to another file.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{DocumentMessage, SaveOrder, SaveTo};
use std::path::PathBuf;

/// The file that the order saves to exists already.
#[derive(Clone, Debug, PartialEq)]
pub struct ExistsQuestion {
    /// The file.
    pub path: PathBuf,
    /// The order to save.
    pub order: SaveOrder,
}

impl QuestionKind for ExistsQuestion {
    fn name(&self) -> &'static str {
        "asked whether a file is to be replaced"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(440.0);
        let Self { path, order } = self;
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        ask.title(&format!("Replace {name}?"));
        ask.says(
            "A file with this name already exists. Its content is kept in the autosave folder for a while.",
        );
        ask.adds(path.display().to_string());
        let replace = ("Replace", "Overwrite the existing file", Tone::Loses, true);
        let cancel = ("Cancel", "Keep the existing file", Tone::First, false);
        match ask.buttons(&[cancel, replace]) {
            Some(true) => {
                let mut order = order.clone();
                match order.to {
                    // A new text of a project: what the question is not about is still checked.
                    SaveTo::Own => order.replaces.push(path.clone()),
                    SaveTo::As(_) | SaveTo::Copy(_) => order.anyway = true,
                }
                ask.requests.push(Request::Answer(FileAction::Send(DocumentMessage::Save(order))));
            }
            Some(false) => ask.requests.push(Request::Dismiss),
            None => {}
        }
    }
}
