//! Carries out what has to do with files: saving, leaving, bringing back.

use super::file_dialog::{self, Purpose};
use super::interface::Interface;
use crate::panels::Effect;
use crate::panels::saving::{Deed, Question};
use crate::panels::state::Overlay;
use crate::panels::status::{Level, Status};
use dragonfly_anim::format::gltf::GLB;
use dragonfly_document::{DocumentMessage, DocumentReply, Offer, SaveOrder, Source, Then};
use std::path::Path;
use std::sync::Arc;

use super::editor_runtime::Running;

impl Running {
    /// Does a deed; `true` when the program is to end.
    pub(super) fn deed(&mut self, deed: Deed) -> bool {
        match deed {
            Deed::Save(order) => self.tell(DocumentMessage::Save(order)),
            Deed::Plan(order) => self.tell(DocumentMessage::Plan(order)),
            Deed::Revert => self.tell(DocumentMessage::Revert),
            Deed::Decide(offer, decision) => self.tell(DocumentMessage::Decide(offer, decision)),
            Deed::Find(offer) => {
                self.ask_where_it_is(offer);
                true
            }
            Deed::FoundAt(offer, path) => {
                self.parts.interface.borrow_mut().state.offer_is_answered(&offer);
                self.tell(DocumentMessage::FoundAt(offer, path))
            }
            Deed::Search => self.tell(DocumentMessage::Search),
            Deed::LookAtFile => self.tell(DocumentMessage::LookAtFile),
            Deed::Where { copy, then } => {
                self.ask_where(copy, then);
                true
            }
            Deed::Reload => {
                let path = self.state_path();
                path.is_none_or(|path| {
                    self.tell(DocumentMessage::DoNotSave)
                        && self.tell(DocumentMessage::Open { source: Source::File(path), anyway: true })
                })
            }
            Deed::Leave(then) => return self.leave(then),
            Deed::DoNotSave(then) => {
                self.tell(DocumentMessage::DoNotSave);
                match then {
                    Then::Quit => return true,
                    Then::Open(source) => self.tell(DocumentMessage::Open { source, anyway: true }),
                }
            }
            Deed::QuitNow => return true,
        };
        false
    }

    fn state_path(&self) -> Option<std::path::PathBuf> {
        let interface = self.parts.interface.borrow();
        interface.state.view.as_ref().and_then(|view| view.file.path.clone())
    }

    /// Tells the document; `false` when there is none.
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
            return interface.state.status.say(Level::Info, "A dialog for files is open already");
        }
        let folder = offer.found.document.as_deref().and_then(Path::parent).map(Path::to_owned);
        match file_dialog::ask(Purpose::Find(offer), folder, self.answers.clone()) {
            Ok(()) => interface.asking = true,
            Err(error) => {
                interface.state.status.say(Level::Error, format!("No dialog could be opened: {error}"));
            }
        }
    }

    fn ask_where(&mut self, copy: bool, then: Option<Then>) {
        let mut interface = self.parts.interface.borrow_mut();
        if interface.asking {
            return interface.state.status.say(Level::Info, "A dialog for files is open already");
        }
        let Some(view) = &interface.state.view else { return };
        let near = view.file.path.as_deref().or(view.loaded.path.as_deref());
        let folder = near.and_then(Path::parent).map(Path::to_owned);
        let ending = view.loaded.format.unwrap_or(GLB).extension();
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
                interface.state.status.say(Level::Error, format!("No dialog could be opened: {error}"));
            }
        }
    }
}

/// Takes what came of a dialog for files.
pub(super) fn chosen(interface: &mut Interface, answer: file_dialog::Answer) {
    interface.asking = false;
    let file_dialog::Answer { purpose, file, quick } = answer;
    match (purpose, file) {
        (Purpose::Open, Some(path)) => interface.effects.push(Effect::Open(Source::File(path))),
        (Purpose::Save { copy, then, .. }, Some(path)) => {
            use dragonfly_document::SaveTo::{As, Copy};
            let to = if copy { Copy(path) } else { As(path) };
            // The dialog asked before it gave the name of a file that is there.
            let order = SaveOrder { to, anyway: true, then };
            interface.effects.push(Effect::Deed(Deed::Save(order)));
        }
        (Purpose::Find(offer), Some(path)) => {
            interface.effects.push(Effect::Deed(Deed::FoundAt(offer, path)));
        }
        (Purpose::Find(offer), None) if quick => {
            let text = "This desktop has no dialog for opening files; type the path instead";
            interface.state.status.say(Level::Warning, text);
            interface.state.ask_where_it_is(offer, None);
        }
        (Purpose::Open, None) if quick => {
            let text = "This desktop has no dialog for opening files; type the path instead";
            interface.state.status.say(Level::Warning, text);
            interface.state.overlay = Some(Overlay::OpenPath);
        }
        (Purpose::Save { copy, then, .. }, None) if quick => {
            let text = "This desktop has no dialog for saving files; type the path instead";
            interface.state.status.say(Level::Warning, text);
            interface.state.ask(Question::Where { copy, then });
        }
        // Also where the dialog failed slowly, which looks the same from here.
        (Purpose::Open | Purpose::Find(_), None) => {
            interface.state.status.say(Level::Info, "No file was chosen")
        }
        (Purpose::Save { .. }, None) => interface.state.status.say(Level::Info, "Nothing was saved"),
    }
}

/// Shows what the document says of saving; gives back what is said of something else.
pub(super) fn heard(interface: &mut Interface, reply: DocumentReply) -> Option<DocumentReply> {
    let state = &mut interface.state;
    match reply {
        DocumentReply::Saved(saved) => {
            let name = saved.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if !saved.copy {
                state.settings.remember(&saved.path);
            }
            for notice in &saved.notices {
                state.status.say(Level::Warning, format!("{name}: {notice}"));
            }
            say_saved(&mut state.status, &name, &saved);
            if let Some(then) = saved.then {
                interface.effects.push(Effect::Deed(Deed::Leave(then)));
            }
        }
        DocumentReply::NotSaved(order, reason) => {
            let effect = state.not_saved(order, reason);
            interface.effects.extend(effect);
        }
        DocumentReply::Plan(Ok(text), order) => {
            let lines: Vec<String> = text.lines().map(str::to_owned).collect();
            state.ask(Question::Plan(Arc::from(lines), order));
        }
        DocumentReply::Plan(Err(reason), _) => {
            state.status.say(Level::Error, format!("It cannot be saved: {reason}"));
        }
        DocumentReply::Unsaved(then) => {
            state.ask(Question::Unsaved(then));
            interface.effects.push(Effect::Stays);
        }
        DocumentReply::MayQuit => interface.effects.push(Effect::Deed(Deed::QuitNow)),
        DocumentReply::FileChanged(file) => state.ask(Question::Changed(file, None)),
        DocumentReply::Offers(offers) => offer(state, offers),
        DocumentReply::OtherFile(offer, path) => state.ask_where_it_is(offer, Some(path)),
        DocumentReply::NothingToOffer => {
            state.status.say(Level::Info, "There is no unsaved work of an earlier time")
        }
        DocumentReply::Notice(text) => state.status.say(Level::Info, text),
        DocumentReply::Warning(text) => state.status.say(Level::Warning, text),
        DocumentReply::Lost => {
            state.lost = true;
            state.dragging.echo.forget();
            state.status.say(Level::Error, "A mistake in the program closed the document");
        }
        other @ (DocumentReply::View(_)
        | DocumentReply::Opened(_)
        | DocumentReply::Loading { .. }
        | DocumentReply::Cancelled
        | DocumentReply::Failed { .. }
        | DocumentReply::Refused(_)) => return Some(other),
    }
    None
}

/// Asks about unsaved work; what was asked already and not answered stays asked.
fn offer(state: &mut crate::panels::State, mut offers: Vec<dragonfly_document::Offer>) {
    if let Some(Question::Recover { offers: before, .. }) = state
        .questions
        .iter()
        .map(|(_, question)| question)
        .find(|question| matches!(question, Question::Recover { .. }))
    {
        let new = |other: &&dragonfly_document::Offer| {
            !offers.iter().any(|offer| offer.found.journal == other.found.journal)
        };
        let before: Vec<_> = before.iter().filter(new).cloned().collect();
        offers.extend(before);
    }
    let lost = std::mem::take(&mut state.lost);
    state.ask(Question::Recover { offers, lost });
}

fn say_saved(status: &mut Status, name: &str, saved: &dragonfly_document::SavedFile) {
    let what = if saved.copy { "Saved a copy as" } else { "Saved" };
    let beside = match saved.beside {
        0 => String::new(),
        1 => " and a file beside it".to_owned(),
        files => format!(" and {files} files beside it"),
    };
    status.say(Level::Info, format!("{what} {name}{beside}"));
}
