//! Local preview of an edit until the document answers: the same edit, applied to a copy of the takes.
//!
//! Every change that is sent to the document gets a number. An edit whose result is shown at once is also carried out here,
//! by the same code, on a copy that shares everything large with the document's view. The panels show that copy until a view
//! arrives that [answers](View::answered) the number: then the edit is in that view, or it was refused, and the copy is
//! dropped. Nothing is guessed, and nothing expires.

use dragonfly_document::edit::Edit;
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_document::{Change, View};
use std::sync::Arc;

/// Numbers of changes, and the takes as they are shown before the document answers.
#[derive(Clone, Debug, Default)]
pub struct Echo {
    /// Number of the last change that was sent.
    sent: u64,
    /// Number of the last change that a view answered.
    answered: u64,
    local: Option<LocalEdits>,
}

/// Edits that are shown and not answered yet.
#[derive(Clone, Debug)]
struct LocalEdits {
    /// Number of the newest of them.
    number: u64,
    /// The last view of the document.
    document: View,
    edited: Edited,
}

impl Echo {
    /// Whether a view has answered the change with this number.
    pub fn has_answered(&self, number: u64) -> bool {
        number <= self.answered
    }

    /// Numbers a change that is sent to the document, and carries it out in `shown` as well where that is quick.
    pub fn send(&mut self, change: &Change, shown: &mut Option<View>) -> u64 {
        self.sent += 1;
        match change {
            Change::Edit(edit, gesture) if edit.is_quick() => self.carry_out(edit, *gesture, shown),
            Change::Cancel(gesture) => {
                if let Some(local) = &mut self.local
                    && local.edited.cancel(*gesture)
                {
                    local.number = self.sent;
                    *shown = Some(local.view());
                }
            }
            // The next view shows what comes of these.
            Change::Undo | Change::Redo | Change::GoTo(_) => self.local = None,
            Change::Edit(..) | Change::Release(_) => {}
        }
        self.sent
    }

    fn carry_out(&mut self, edit: &Edit, gesture: Option<Gesture>, shown: &mut Option<View>) {
        let local = match (self.local.take(), &*shown) {
            (Some(local), _) => Some(local),
            (None, Some(view)) => {
                Some(LocalEdits { number: self.sent, edited: view.edited(), document: view.clone() })
            }
            (None, None) => None,
        };
        let Some(mut local) = local else { return };
        // The document refuses it as well, and its answer gives the reason.
        if local.edited.ask(edit.clone(), gesture).is_ok() {
            local.number = self.sent;
            *shown = Some(local.view());
        }
        if local.edited.steps().1 > 0 {
            self.local = Some(local);
        }
    }

    /// Takes a view of the document. Returns what to show from now on: the view, with the edits that it does not contain yet;
    /// in `shown` the view of the document that was there before takes the place of an echo.
    pub fn receive(&mut self, view: View, shown: &mut Option<View>) -> View {
        self.answered = self.answered.max(view.answered);
        let Some(mut local) = self.local.take() else { return view };
        *shown = Some(local.document);
        let same_model = shown.as_ref().is_some_and(|old| Arc::ptr_eq(&old.loaded, &view.loaded));
        if !same_model || local.number <= self.answered {
            return view;
        }
        local.document = view;
        let echo = local.view();
        self.local = Some(local);
        echo
    }

    /// The document was lost, and with it everything that was not answered.
    pub fn forget(&mut self) {
        self.answered = self.sent;
        self.local = None;
    }
}

impl LocalEdits {
    fn view(&self) -> View {
        self.document.echo(self.number, &self.edited)
    }
}
