//! The question when the user is about to leave unsaved changes.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::{DocumentMessage, SaveOrder, Then};

#[derive(Clone, Copy)]
enum UnsavedChoice {
    Save,
    DoNotSave,
    Cancel,
}

/// Asks whether to save or discard unsaved changes.
#[derive(Clone, Debug, PartialEq)]
pub struct UnsavedQuestion {
    /// The action that would discard them.
    pub then: Then,
}

impl QuestionKind for UnsavedQuestion {
    fn name(&self) -> &'static str {
        "asked what becomes of unsaved work"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        let then = &self.then;
        ask.ui.set_width(440.0);
        let title = ask.view.map_or(String::new(), |view| view.file.title.clone());
        ask.title(&format!("Save {title}?"));
        ask.says(match then {
            Then::Quit => "It has unsaved changes, and the program is about to close.".to_owned(),
            Then::Open(source) => {
                format!("It has unsaved changes, and {} is about to be opened.", source.title())
            }
        });
        if let Some(scene) = ask.view.and_then(|view| view.waiting_scene.as_ref()) {
            ask.adds(match scene.saved {
                true => format!("It is edited in {}, which is saved.", scene.title),
                false => format!(
                    "It is edited in {}, which has unsaved changes, too. The next question is about them.",
                    scene.title
                ),
            });
        }
        if ask.view.is_some_and(|view| view.history.has_unsaved_step(ScriptLabel::EditModel.text())) {
            ask.adds("Edits of models are among them. The project keeps them; the files of the models stay as they are.");
        }
        if let Some(last) = ask.view.and_then(|view| view.history.last_unsaved()) {
            ask.adds(last);
        }
        // The file gets the text as it is; nothing of it is lost.
        let error = ask.view.and_then(|view| view.scene.as_ref()?.first_error());
        if let Some(error) = error {
            ask.warns(format!("It has an error and is saved as it is: {error}"));
        }
        let save = ("Save", "Save, then continue", Tone::First, UnsavedChoice::Save);
        let cancel = ("Cancel", "Return to the document", Tone::Plain, UnsavedChoice::Cancel);
        let lose = (
            "Don't save",
            "Continue without saving; the changes stay in the bin of the autosave folder for a while",
            Tone::Loses,
            UnsavedChoice::DoNotSave,
        );
        let request = match ask.buttons(&[save, cancel, lose]) {
            Some(UnsavedChoice::Save) => {
                Request::Answer(FileAction::Send(DocumentMessage::Save(SaveOrder::own(Some(then.clone())))))
            }
            Some(UnsavedChoice::DoNotSave) => Request::Answer(FileAction::DoNotSave(then.clone())),
            Some(UnsavedChoice::Cancel) => Request::Dismiss,
            None => return,
        };
        ask.requests.push(request);
    }
}
