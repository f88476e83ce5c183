//! What the document and the dialogs answer, shown in the window.

use super::file_dialog::Answer;
use super::interface::Interface;
use super::saving;
use crate::panels::Effect;
use crate::panels::state::Loading;
use crate::panels::status::{Level, Status};
use dragonfly_document::{Change, DocumentReply, Source};
use dragonfly_runtime::{Context, Receiver};
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

/// Takes what the document says.
pub(super) struct Replies {
    /// Where it is shown.
    pub interface: Rc<RefCell<Interface>>,
}

impl Receiver for Replies {
    type Message = DocumentReply;

    fn receive(&mut self, reply: DocumentReply, _main: &mut Context) {
        let mut interface = self.interface.borrow_mut();
        let Some(reply) = saving::heard(&mut interface, reply) else { return interface.redraw() };
        let state = &mut interface.state;
        use DocumentReply::{Loading as Goes, Refused, View};
        let ends = !matches!(reply, Goes { .. } | View(_) | Refused(_));
        let passed_over = if ends { std::mem::take(&mut state.passed_over) } else { 0 };
        match reply {
            DocumentReply::Loading { title, progress } => state.loading = Some(Loading { title, progress }),
            DocumentReply::Cancelled => {
                state.loading = None;
                state.status.say(Level::Info, "Stopped loading");
            }
            DocumentReply::Failed { source, reason } => {
                state.loading = None;
                if let Source::File(path) = source {
                    state.settings.recent.retain(|other| *other != path || path.exists());
                }
                say_passed_over(&mut state.status, passed_over);
                state.status.say(Level::Error, reason);
            }
            DocumentReply::Refused(reason) => {
                state.keys_refused();
                state.status.say(Level::Warning, reason);
            }
            DocumentReply::View(view) => {
                state.now = Instant::now();
                state.show(view);
                let Some(view) = &state.view else { return };
                let (file, saved) = (std::sync::Arc::clone(&view.file), view.history.saved);
                interface.set_title(&file.title, saved);
            }
            DocumentReply::Opened(loaded) => {
                state.loading = None;
                if let Some(path) = &loaded.path {
                    state.settings.remember(path);
                }
                for warning in &loaded.warnings {
                    state.status.say(Level::Warning, format!("{}: {warning}", loaded.title));
                }
                state.status.say(Level::Info, format!("Opened {}", loaded.title));
                say_passed_over(&mut state.status, passed_over);
                let edits = std::mem::take(&mut interface.edits).into_iter();
                let changes = edits.map(|edit| Effect::Change(Change::Edit(edit, None)));
                interface.effects.extend(changes);
            }
            // Handled by `saving::heard` above.
            DocumentReply::Saved(_)
            | DocumentReply::NotSaved(..)
            | DocumentReply::Plan(..)
            | DocumentReply::Unsaved(_)
            | DocumentReply::MayQuit
            | DocumentReply::FileChanged(_)
            | DocumentReply::Offers(_)
            | DocumentReply::OtherFile(..)
            | DocumentReply::NothingToOffer
            | DocumentReply::Notice(_)
            | DocumentReply::Warning(_)
            | DocumentReply::Lost => {}
        }
        interface.redraw();
    }
}

/// Says that so many files, given together with the one that is open now, stay closed.
fn say_passed_over(status: &mut Status, files: usize) {
    match files {
        0 => {}
        1 => status.say(Level::Warning, "One model is open at a time: the second file stays closed"),
        _ => {
            status.say(Level::Warning, format!("One model is open at a time: {files} more files stay closed"))
        }
    }
}

/// Takes what the person chose in a dialog.
pub(super) struct Answers(pub Rc<RefCell<Interface>>);

impl Receiver for Answers {
    type Message = Answer;

    fn receive(&mut self, answer: Answer, _main: &mut Context) {
        let mut interface = self.0.borrow_mut();
        saving::chosen(&mut interface, answer);
        interface.redraw();
    }
}
