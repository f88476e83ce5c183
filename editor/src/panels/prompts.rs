//! Modal dialogs and overlays shown over the panels.

pub use super::dialogs::Question;
pub use super::overlay::Overlay;

use super::dialogs::{FindQuestion, RecoverQuestion};
use super::looked_folder::LookedFolder;
use dragonfly_document::{Decision, Offer};
use std::collections::VecDeque;
use std::path::PathBuf;

/// Questions in their order, the overlay, and the search field's request for the cursor.
#[derive(Debug, Default)]
pub struct Prompts {
    /// Each question with its number; the first is shown.
    questions: VecDeque<(u64, Question)>,
    /// Number of questions asked so far.
    asked: u64,
    /// Whether the document was lost by an internal error and its work is not offered yet.
    lost: bool,
    overlay: Option<Overlay>,
    /// Whether the search field is to get the cursor.
    find: bool,
    /// The folder that was looked at last, because its path is typed.
    looked_folder: Option<LookedFolder>,
}

impl Prompts {
    /// Returns the question that is shown.
    pub fn question(&self) -> Option<&Question> {
        self.questions.front().map(|(_, question)| question)
    }

    /// Returns the number of the question that is shown; no two questions have the same.
    pub(super) fn question_number(&self) -> Option<u64> {
        self.questions.front().map(|(number, _)| *number)
    }

    /// Returns all questions in their order, each with its number.
    pub fn questions(&self) -> &VecDeque<(u64, Question)> {
        &self.questions
    }

    /// Asks a question after those that are already waiting. A question of the same kind replaces the older one.
    pub(super) fn ask(&mut self, question: Question) {
        let same = std::mem::discriminant(&question);
        self.questions.retain(|(_, other)| std::mem::discriminant(other) != same);
        self.asked += 1;
        self.questions.push_back((self.asked, question));
    }

    /// Asks before all other questions where the file of unsaved work is, or reports that `other` is another file.
    pub(super) fn ask_where_it_is(&mut self, offer: Box<Offer>, other: Option<PathBuf>) {
        self.questions.retain(|(_, question)| !matches!(question, Question::Find(_)));
        self.asked += 1;
        self.questions.push_front((self.asked, Question::Find(FindQuestion { offer, other })));
    }

    /// Asks about unsaved work, together with the offers that were made before and not answered.
    pub(super) fn ask_to_recover(&mut self, mut offers: Vec<Offer>) {
        for (_, question) in &self.questions {
            if let Question::Recover(RecoverQuestion { offers: before, .. }) = question {
                let new =
                    |other: &&Offer| !offers.iter().any(|offer| offer.found.journal == other.found.journal);
                let before: Vec<Offer> = before.iter().filter(new).cloned().collect();
                offers.extend(before);
            }
        }
        let lost = std::mem::take(&mut self.lost);
        self.ask(RecoverQuestion { offers, lost }.into());
    }

    /// Notes that the document was lost by an internal error; the next offer of unsaved work mentions it.
    pub fn document_lost(&mut self) {
        self.lost = true;
    }

    /// Removes the questions about this unsaved work: its file was found.
    pub fn offer_is_answered(&mut self, offer: &Offer) {
        let same = |other: &Offer| other.found.journal == offer.found.journal;
        self.questions.retain(|(_, question)| !matches!(question, Question::Find(find) if same(&find.offer)));
        for (_, question) in &mut self.questions {
            if let Question::Recover(RecoverQuestion { offers, .. }) = question {
                offers.retain(|other| !same(other));
            }
        }
        self.questions.retain(
            |(_, question)| !matches!(question, Question::Recover(recover) if recover.offers.is_empty()),
        );
    }

    /// Removes the question where a missing file of the scene is: it was found.
    pub(super) fn close_missing(&mut self) {
        self.questions.retain(|(_, question)| !matches!(question, Question::Missing(_)));
    }

    /// Returns the folder that was looked at last.
    pub(super) fn looked_folder(&self) -> Option<&LookedFolder> {
        self.looked_folder.as_ref()
    }

    /// Notes the folder that was looked at.
    pub(super) fn set_looked_folder(&mut self, folder: LookedFolder) {
        self.looked_folder = Some(folder);
    }

    /// Removes the question that was answered.
    pub(super) fn pop(&mut self) {
        self.questions.pop_front();
    }

    /// Removes one offer from the question that is shown; the other offers wait for a decision.
    pub(super) fn decided(&mut self, offer: &Offer) {
        let Some((_, Question::Recover(RecoverQuestion { offers, .. }))) = self.questions.front_mut() else {
            return self.pop();
        };
        offers.retain(|other| other.found.journal != offer.found.journal);
        if offers.is_empty() {
            self.pop();
        }
    }

    /// Removes the question that is shown without an answer. Returns the decision that this is for unsaved work: it stays
    /// where it is.
    pub(super) fn dismiss(&mut self) -> Option<(Offer, Decision)> {
        match self.questions.pop_front()? {
            (number, Question::Recover(RecoverQuestion { mut offers, lost })) => {
                let offer = offers.pop()?;
                if !offers.is_empty() {
                    self.questions.push_front((number, RecoverQuestion { offers, lost }.into()));
                }
                Some((offer, Decision::Later))
            }
            _ => None,
        }
    }

    /// Returns the overlay that is shown.
    pub fn overlay(&self) -> Option<Overlay> {
        self.overlay
    }

    /// Shows an overlay, or none.
    pub fn show(&mut self, overlay: Option<Overlay>) {
        self.overlay = overlay;
    }

    /// Shows an overlay, or closes it if it is shown.
    pub(super) fn toggle(&mut self, overlay: Overlay) {
        self.overlay = if self.overlay == Some(overlay) { None } else { Some(overlay) };
    }

    /// Closes the overlay. Returns whether one was shown.
    pub(super) fn close_overlay(&mut self) -> bool {
        self.overlay.take().is_some()
    }

    /// Returns whether the search field is to get the cursor.
    pub fn finds(&self) -> bool {
        self.find
    }

    /// Gives the cursor to the search field in the next frame, or not any more.
    pub fn set_find(&mut self, find: bool) {
        self.find = find;
    }
}
