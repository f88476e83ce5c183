//! Actions about files: saving, leaving, recovering, and the system's dialogs for them.

use super::editor_runtime::Running;
use super::file_dialog::{self, Purpose};
use super::interface::Interface;
use crate::panels::dialogs::PlaceQuestion;
use crate::panels::prompts::Overlay;
use crate::panels::status::MessageSeverity;
use crate::panels::{Effect, FileAction, FileChoice, Request, chosen_file};
use dragonfly_document::{DocumentMessage, Offer, SaveOrder, Source, Then};
use std::path::Path;

impl Running {
    /// Carries an action out. Returns whether the program is to end.
    pub(super) fn file_action(&mut self, action: FileAction) -> bool {
        match action {
            FileAction::Send(message) => {
                if let DocumentMessage::FoundAt(offer, _) = &message {
                    self.parts.interface.borrow_mut().state.offer_is_answered(offer);
                }
                self.tell(message)
            }
            FileAction::Find(offer) => {
                self.ask_where_it_is(offer);
                true
            }
            FileAction::Where { copy, then } => {
                self.ask_where(copy, then);
                true
            }
            FileAction::Reload => {
                let source = self.open_file();
                source.is_none_or(|source| {
                    self.tell(DocumentMessage::DoNotSave)
                        && self.tell(DocumentMessage::Open { source, anyway: true })
                })
            }
            FileAction::Stay => {
                self.leaving = false;
                true
            }
            FileAction::Leave(then) => return self.leave(then),
            FileAction::DoNotSave(then) => {
                self.tell(DocumentMessage::DoNotSave);
                // A scene that waits may have unsaved work too.
                return self.leave(then);
            }
            FileAction::QuitNow => return true,
        };
        false
    }

    /// Returns the file of the document, with the import options with which it was read.
    fn open_file(&self) -> Option<Source> {
        let interface = self.parts.interface.borrow();
        let view = interface.state.read().view?;
        Some(Source::of(view.file.path.clone()?, view.loaded.conversion.chosen()))
    }

    /// Sends a message to the document. Returns whether there is a document.
    fn tell(&self, message: DocumentMessage) -> bool {
        self.document.as_ref().is_some_and(|document| document.send(message))
    }

    /// Opens a model or ends the program, unless the document has unsaved work. A second request to quit before the document has
    /// replied, or one that no document can reply to, ends the program at once: recorded work is offered at the next start.
    fn leave(&mut self, then: Then) -> bool {
        match then {
            Then::Open(source) => {
                self.tell(DocumentMessage::Open { source, anyway: false });
                false
            }
            Then::Quit => std::mem::replace(&mut self.leaving, true) || !self.tell(DocumentMessage::Quit),
        }
    }

    fn ask_where_it_is(&mut self, offer: Box<Offer>) {
        let mut interface = self.parts.interface.borrow_mut();
        if interface.asking {
            return interface.state.say(MessageSeverity::Info, "A file dialog is open already");
        }
        let folder = offer.found.document.as_deref().and_then(Path::parent).map(Path::to_owned);
        match file_dialog::ask(Purpose::Find(offer), folder, self.answers.clone()) {
            Ok(()) => interface.asking = true,
            Err(error) => {
                interface
                    .state
                    .say(MessageSeverity::Error, format!("The file dialog could not be opened: {error}"));
            }
        }
    }

    fn ask_where(&mut self, copy: bool, then: Option<Then>) {
        let mut interface = self.parts.interface.borrow_mut();
        if interface.asking {
            return interface.state.say(MessageSeverity::Info, "A file dialog is open already");
        }
        let Some(view) = interface.state.read().view else { return };
        let near = view.file.path.as_deref().or(view.loaded.path.as_deref());
        let folder = near.and_then(Path::parent).map(Path::to_owned);
        let ending = &view.file.ending;
        let name = match (&view.file.path, copy) {
            (Some(_), false) => view.file.title.clone(),
            _ => {
                let stem = Path::new(&view.loaded.title).file_stem().unwrap_or_default().to_string_lossy();
                format!("{stem}{}.{ending}", if copy { " copy" } else { "" })
            }
        };
        let purpose = Purpose::Save { copy, then, name };
        match file_dialog::ask(purpose, folder, self.answers.clone()) {
            Ok(()) => interface.asking = true,
            Err(error) => {
                interface
                    .state
                    .say(MessageSeverity::Error, format!("The file dialog could not be opened: {error}"));
            }
        }
    }
}

/// Handles the answer of a file dialog.
pub(super) fn chosen(interface: &mut Interface, answer: file_dialog::Answer) {
    interface.asking = false;
    let file_dialog::Answer { purpose, file, others, quick } = answer;
    let overlay = if purpose == Purpose::Compare { Overlay::ComparePath } else { Overlay::OpenPath };
    match (purpose, file) {
        (Purpose::Open, Some(path)) => {
            interface.effects.push(Effect::File(FileAction::Leave(Then::Open(Source::File(path)))))
        }
        (Purpose::Compare, Some(path)) => {
            let message = DocumentMessage::ReadCompared(Source::File(path));
            interface.effects.push(Effect::File(FileAction::Send(message)));
        }
        (Purpose::Save { copy, then, .. }, Some(path)) => {
            use dragonfly_document::SaveTo::{As, Copy};
            let to = if copy { Copy(path) } else { As(path) };
            // `anyway`: the dialog has already asked the user whether to replace an existing
            // file.
            let order = SaveOrder { to, anyway: true, ..SaveOrder::own(then) };
            interface.effects.push(Effect::File(FileAction::Send(DocumentMessage::Save(order))));
        }
        (Purpose::Find(offer), Some(path)) => {
            interface.effects.push(Effect::File(FileAction::Send(DocumentMessage::FoundAt(offer, path))));
        }
        (Purpose::Find(offer), None) if quick => {
            let text = "This desktop has no dialog for opening files; type the path instead";
            interface.state.say(MessageSeverity::Warning, text);
            interface.state.ask_where_it_is(offer, None);
        }
        (Purpose::Choose(choice), Some(path)) => {
            let request = chosen_file::request(choice, path, others);
            let effect = interface.state.execute(request);
            interface.effects.extend(effect);
        }
        (Purpose::Choose(choice), None) if quick => {
            interface.state.say(MessageSeverity::Warning, choice.no_dialog());
            if matches!(choice, FileChoice::MissingModel | FileChoice::MissingSound) {
                let effect = interface.state.execute(Request::TypeFoundFile);
                interface.effects.extend(effect);
            } else if !choice.has_field() {
                interface.state.show_overlay(Some(Overlay::FilePath(choice)));
            }
        }
        (Purpose::Choose(choice), None) if choice.filter().is_none() => {
            interface.state.say(MessageSeverity::Info, "No folder was chosen")
        }
        (Purpose::Open | Purpose::Compare, None) if quick => {
            let text = "This desktop has no dialog for opening files; type the path instead";
            interface.state.say(MessageSeverity::Warning, text);
            interface.state.show_overlay(Some(overlay));
        }
        (Purpose::Save { copy, then, .. }, None) if quick => {
            let text = "This desktop has no dialog for saving files; type the path instead";
            interface.state.say(MessageSeverity::Warning, text);
            interface.state.ask(PlaceQuestion { copy, then }.into());
        }
        // A dialog that failed slowly looks the same as one that the user closed.
        (Purpose::Open | Purpose::Compare | Purpose::Find(_) | Purpose::Choose(_), None) => {
            interface.state.say(MessageSeverity::Info, "No file was chosen")
        }
        (Purpose::Save { .. }, None) => interface.state.say(MessageSeverity::Info, "Nothing was saved"),
    }
}
