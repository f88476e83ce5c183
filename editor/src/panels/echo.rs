//! Local preview of an edit until the document answers: the same edit, applied to a copy of the takes.
//!
//! Every change that is sent to the document gets a number. An edit that is quick is also carried out here, by the same code,
//! on a copy that shares everything large with the document's view. The panels show that copy until a view arrives that
//! [answers](View::answered) the number: then the edit is in that view, or it was refused, and the copy is dropped. Nothing is
//! guessed, and nothing expires.
//!
//! An edit that takes longer is shown when the document has answered it. Later edits wait for that answer as well, because
//! they apply to a state that does not exist here. The edits of a drag replace each other, so the copy from its start is kept
//! until it ends.

use dragonfly_document::edit::Edit;
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_document::{Change, View};
use std::sync::Arc;

/// Assigns numbers to changes, and keeps the takes as they are shown before the document answers.
#[derive(Clone, Debug, Default)]
pub struct Echo {
    /// Number of the last change that was sent.
    sent: u64,
    /// Number of the last change that a view answered.
    answered: u64,
    /// Number of the last change that was not carried out here, and the drag that it belongs to.
    skipped: Option<(u64, Option<Gesture>)>,
    local: Option<LocalEdits>,
}

/// A copy of the takes, with the edits that are shown and not answered yet.
#[derive(Clone, Debug)]
struct LocalEdits {
    /// Number of the newest of these edits.
    number: u64,
    /// The drag of the last edit. Until it ends, the copy is kept after the answer.
    gesture: Option<Gesture>,
    /// The last view of the document.
    document: View,
    edited: Edited,
}

/// Largest [cost](Edit::cost) of an edit that is carried out here: it takes less than 4 ms, a quarter of a frame at 60 frames per
/// second. The table of all keys of a rig in `benches/editor/README.md` shows the times of smaller and of larger edits.
const LARGEST: usize = 25_000;

impl Echo {
    /// Returns whether a view has answered the change with this number.
    pub fn has_answered(&self, number: u64) -> bool {
        number <= self.answered
    }

    /// Returns whether the change with this number is shown: a view answered it, or it was carried out here.
    pub fn shows(&self, number: u64) -> bool {
        self.has_answered(number) || self.local.as_ref().is_some_and(|local| number <= local.number)
    }

    /// Returns whether an edit of the takes of `view` is carried out here, within a part of a frame.
    pub(super) fn is_quick(&self, edit: &Edit, view: Option<&View>) -> bool {
        let cost = match (&self.local, view) {
            (Some(local), _) => edit.cost(local.edited.adapter()),
            (None, Some(view)) => edit.cost(view.edited().adapter()),
            (None, None) => None,
        };
        cost.is_some_and(|cost| cost <= LARGEST)
    }

    /// Assigns a number to a change that is sent to the document, and also carries it out in `shown` if that is quick.
    pub fn send(&mut self, change: &Change, shown: &mut Option<View>) -> u64 {
        self.sent += 1;
        match change {
            Change::Edit(edit, gesture) => {
                if !self.carry_out(edit, *gesture, shown) {
                    self.skipped = Some((self.sent, *gesture));
                }
            }
            Change::Cancel(gesture) => {
                if let Some(local) = &mut self.local
                    && local.edited.cancel(*gesture)
                {
                    local.number = self.sent;
                    *shown = Some(local.view());
                } else {
                    self.skipped = Some((self.sent, Some(*gesture)));
                }
            }
            Change::Release(gesture) => {
                if let Some(local) = &mut self.local {
                    local.gesture.take_if(|held| held == gesture);
                }
            }
            // The next view shows the result.
            Change::Undo | Change::Redo | Change::GoTo(_) => {
                (self.local, self.skipped) = (None, Some((self.sent, None)));
            }
        }
        self.sent
    }

    /// Carries an edit out if that is quick. Returns whether it is quick, even if the edit is refused: the document
    /// refuses it as well, and its answer gives the reason.
    fn carry_out(&mut self, edit: &Edit, gesture: Option<Gesture>, shown: &mut Option<View>) -> bool {
        let answered = self.answered;
        self.local.take_if(|local| {
            let continues = gesture.is_some() && local.gesture == gesture;
            local.number <= answered && !continues
        });
        if self.waits_for_answer(gesture) {
            return false;
        }
        let local = match (self.local.take(), &*shown) {
            (Some(local), _) => Some(local),
            (None, Some(view)) => {
                Some(LocalEdits { number: answered, gesture, edited: view.edited(), document: view.clone() })
            }
            (None, None) => None,
        };
        let Some(mut local) = local else { return false };
        local.gesture = gesture;
        let quick = edit.cost(local.edited.adapter()).is_some_and(|cost| cost <= LARGEST);
        if quick && local.edited.ask(edit.clone(), gesture).is_ok() {
            local.number = self.sent;
            *shown = Some(local.view());
        }
        if local.number > answered || gesture.is_some() {
            self.local = Some(local);
        }
        quick
    }

    /// Returns whether an edit applies to the result of a change that was not carried out here.
    fn waits_for_answer(&self, gesture: Option<Gesture>) -> bool {
        self.skipped.is_some_and(|(number, of)| match gesture {
            // The edits of a drag replace each other, and all apply to the takes as they were at its start.
            Some(_) if of == gesture => self.local.is_none(),
            Some(_) | None => number > self.answered,
        })
    }

    /// Receives a view of the document. Returns what to show from now on: the view, with the edits that it does not
    /// contain yet. If `shown` was a local preview, replaces it by the previous view of the document.
    pub fn receive(&mut self, view: View, shown: &mut Option<View>) -> View {
        self.answered = self.answered.max(view.answered);
        let Some(mut local) = self.local.take() else { return view };
        *shown = Some(local.document);
        let same_model = shown.as_ref().is_some_and(|old| Arc::ptr_eq(&old.loaded, &view.loaded));
        if !same_model {
            return view;
        }
        local.document = view.clone();
        let is_answered = local.number <= self.answered;
        let shows = if is_answered { view } else { local.view() };
        if !is_answered || local.gesture.is_some() {
            self.local = Some(local);
        }
        shows
    }

    /// Forgets all changes that were not answered, because the document was lost.
    pub fn forget(&mut self) {
        self.answered = self.sent;
        (self.local, self.skipped) = (None, None);
    }
}

impl LocalEdits {
    fn view(&self) -> View {
        self.document.echo(self.number, &self.edited)
    }
}
