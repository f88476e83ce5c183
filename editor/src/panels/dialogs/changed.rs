//! The question when another program changed or removed the file that is open, or one that belongs to it.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{DocumentMessage, SaveOrder};
use dragonfly_store::FileState;
use std::path::{Path, PathBuf};

#[derive(Clone, Copy)]
enum ChangedChoice {
    Overwrite,
    SaveAs,
    Apply,
    Reload,
    Cancel,
}

/// Another program changed or removed the file that is open, or one that belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedQuestion {
    /// State of the file.
    pub file: FileState,
    /// The file that changed, for example a script of a project; `None` for the one that is open.
    pub path: Option<PathBuf>,
    /// The save that this blocks.
    pub order: Option<SaveOrder>,
}

impl QuestionKind for ChangedQuestion {
    fn name(&self) -> &'static str {
        "asked what becomes of a changed file"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        let Some(view) = ask.view else { return };
        let (title, saved) = (view.file.title.clone(), view.history.saved);
        ask.ui.set_width(if saved { 480.0 } else { 600.0 });
        let order = self.order.as_ref();
        let gone = self.file == FileState::Missing;
        let then = order.and_then(|order| order.then.clone());
        let beside = self.path.as_deref().map(file_name).filter(|name| *name != title);
        let name = beside.as_ref().unwrap_or(&title);
        ask.title(&if gone { format!("{name} is gone") } else { format!("{name} was changed on disk") });
        ask.says(if gone {
            "Another program moved or deleted the file. The open document is still complete."
        } else if order.is_some() {
            "Another program changed the file after it was opened, so it was not overwritten."
        } else {
            "Another program changed the file after it was opened."
        });
        if beside.is_some() {
            ask.adds(format!("It belongs to {title}, whose files are reloaded or overwritten together."));
        }
        if !saved && !gone {
            ask.adds("Your changes are not saved. They can be applied to the new version: bones and takes are found by name, and what does not fit is listed. Reloading discards them; a copy stays in the bin of the autosave folder for a while.");
        }
        let reload =
            ("Reload", "Open the file as it is on disk now", if saved { Tone::First } else { Tone::Loses });
        let overwrite = (
            "Overwrite",
            "Replace the file with the open document; the other version is kept in the autosave folder",
        );
        let save_as = ("Save as…", "Keep both versions", Tone::Plain, ChangedChoice::SaveAs);
        let cancel = ("Cancel", "Change nothing for now", Tone::Plain, ChangedChoice::Cancel);
        let pressed = if gone {
            let write = ("Save again", "Write the file where it was", Tone::First, ChangedChoice::Overwrite);
            ask.buttons(&[write, save_as, cancel])
        } else if saved && order.is_none() {
            let reload = (reload.0, reload.1, reload.2, ChangedChoice::Reload);
            ask.buttons(&[
                reload,
                cancel,
                save_as,
                (overwrite.0, overwrite.1, Tone::Loses, ChangedChoice::Overwrite),
            ])
        } else if !saved {
            let apply = (
                "Load and apply my changes",
                "Open the file as it is on disk now, with your unsaved changes",
                Tone::First,
                ChangedChoice::Apply,
            );
            ask.buttons(&[
                apply,
                save_as,
                cancel,
                (overwrite.0, overwrite.1, Tone::Loses, ChangedChoice::Overwrite),
                (reload.0, reload.1, Tone::Loses, ChangedChoice::Reload),
            ])
        } else {
            let reload = (reload.0, reload.1, Tone::Loses, ChangedChoice::Reload);
            let save_as = (save_as.0, save_as.1, Tone::First, ChangedChoice::SaveAs);
            ask.buttons(&[
                save_as,
                cancel,
                (overwrite.0, overwrite.1, Tone::Loses, ChangedChoice::Overwrite),
                reload,
            ])
        };
        let request = match pressed {
            Some(ChangedChoice::Overwrite) => {
                Request::Answer(FileAction::Send(DocumentMessage::Save(SaveOrder {
                    anyway: true,
                    ..SaveOrder::own(then)
                })))
            }
            Some(ChangedChoice::SaveAs) => Request::Answer(FileAction::Where { copy: false, then }),
            Some(ChangedChoice::Apply) => Request::Answer(FileAction::Send(DocumentMessage::Reload)),
            Some(ChangedChoice::Reload) => Request::Answer(FileAction::Reload),
            Some(ChangedChoice::Cancel) => Request::Dismiss,
            None => return,
        };
        ask.requests.push(request);
    }
}

/// Returns the name of a file without its folder.
fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
