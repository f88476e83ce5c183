//! Saving, leaving and coming back, as the panels see it: what a person is asked, and what they may answer.

use super::state::{Effect, State};
use super::status::Level;
use dragonfly_document::{Decision, Offer, SaveOrder, SaveTo, Then};
use dragonfly_store::FileState;
use std::path::PathBuf;
use std::sync::Arc;

/// Something that a person has to decide before anything else goes on.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// What becomes of what is not saved.
    Unsaved(Then),
    /// Somebody else changed the file, or took it away. With the order that it stands in the way of.
    Changed(FileState, Option<SaveOrder>),
    /// Another file is there.
    Exists(PathBuf, SaveOrder),
    /// What a save will change, a line each; saved after that, if there is an order.
    Plan(Arc<[String]>, Option<SaveOrder>),
    /// Unsaved work of an earlier time.
    Recover {
        /// What there is, last written first.
        offers: Vec<Offer>,
        /// Was it lost just now, by a mistake in the program?
        lost: bool,
    },
    /// Where the file of unsaved work is now.
    Find {
        /// The work.
        offer: Box<Offer>,
        /// A file that was chosen and is another one; its path is asked for where there is none.
        other: Option<PathBuf>,
    },
    /// The path to save at, typed.
    Where {
        /// Does the document stay that of its own file?
        copy: bool,
        /// What comes after.
        then: Option<Then>,
    },
}

impl Question {
    /// What happens, for the log.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Unsaved(_) => "asked what becomes of unsaved work",
            Self::Changed(..) => "asked what becomes of a changed file",
            Self::Exists(..) => "asked whether a file is to be replaced",
            Self::Plan(..) => "showed what will be saved",
            Self::Recover { .. } => "offered unsaved work",
            Self::Find { other: None, .. } => "asked where a file is now",
            Self::Find { .. } => "said that it is another file",
            Self::Where { .. } => "asked where to save",
        }
    }
}

/// What only the document, or who opens dialogs, can do.
#[derive(Clone, Debug, PartialEq)]
pub enum Deed {
    /// Saves.
    Save(SaveOrder),
    /// Asks what a save would change.
    Plan(Option<SaveOrder>),
    /// Asks the person where to save.
    Where {
        /// Does the document stay that of its own file?
        copy: bool,
        /// What comes after.
        then: Option<Then>,
    },
    /// Goes on without saving.
    DoNotSave(Then),
    /// Goes back to what was saved.
    Revert,
    /// Reads the file again; what is not saved is given up.
    Reload,
    /// Says what becomes of unsaved work of an earlier time.
    Decide(Box<Offer>, Decision),
    /// Asks the person where the file of unsaved work is now.
    Find(Box<Offer>),
    /// It is here.
    FoundAt(Box<Offer>, PathBuf),
    /// Looks for unsaved work.
    Search,
    /// Opens a model or ends the program, unless the document has unsaved work.
    Leave(Then),
    /// Ends the program: nothing is unsaved.
    QuitNow,
    /// Asks whether somebody else changed the file.
    LookAtFile,
}

impl State {
    /// What must be decided next.
    pub fn question(&self) -> Option<&Question> {
        self.questions.front().map(|(_, question)| question)
    }

    /// Tells one question from all others that were asked before.
    pub(super) fn question_number(&self) -> Option<u64> {
        self.questions.front().map(|(number, _)| *number)
    }

    /// Asks, behind what is asked already; the same thing is not asked twice.
    pub fn ask(&mut self, question: Question) {
        let same = std::mem::discriminant(&question);
        // The newer one knows better.
        self.questions.retain(|(_, other)| std::mem::discriminant(other) != same);
        self.asked += 1;
        self.questions.push_back((self.asked, question));
        self.stand_still();
    }

    /// Nothing moves behind a question.
    fn stand_still(&mut self) {
        if self.playback.playing {
            self.stop_at(self.time());
        }
    }

    /// Asks before everything else where a file is now, or says that it is another one.
    pub fn ask_where_it_is(&mut self, offer: Box<Offer>, other: Option<PathBuf>) {
        self.questions.retain(|(_, question)| !matches!(question, Question::Find { .. }));
        self.asked += 1;
        self.questions.push_front((self.asked, Question::Find { offer, other }));
        self.stand_still();
    }

    /// Somebody said where the file of this work is: it is neither offered nor asked for any more.
    pub fn offer_is_answered(&mut self, offer: &Offer) {
        let same = |other: &Offer| other.found.journal == offer.found.journal;
        self.questions
            .retain(|(_, question)| !matches!(question, Question::Find { offer, .. } if same(offer)));
        for (_, question) in &mut self.questions {
            if let Question::Recover { offers, .. } = question {
                offers.retain(|other| !same(other));
            }
        }
        self.questions.retain(
            |(_, question)| !matches!(question, Question::Recover { offers, .. } if offers.is_empty()),
        );
    }

    /// Takes the question away that was answered.
    pub(super) fn answered(&mut self, deed: Deed) -> Option<Effect> {
        match (&deed, self.questions.front_mut().map(|(_, question)| question)) {
            // The other offers still wait for a decision.
            (
                Deed::Decide(offer, Decision::Discard | Decision::Later),
                Some(Question::Recover { offers, .. }),
            ) => {
                offers.retain(|other| other.found.journal != offer.found.journal);
                if offers.is_empty() {
                    self.questions.pop_front();
                }
            }
            // A dialog for files may be closed without an answer.
            (Deed::Find(_), Some(Question::Recover { .. } | Question::Find { .. })) => {}
            _ => {
                self.questions.pop_front();
            }
        }
        Some(match deed {
            Deed::Save(order) => self.save(order)?,
            deed => Effect::Deed(deed),
        })
    }

    /// The person does not want to decide: nothing is done. Unsaved work stays where it is.
    pub(super) fn dismiss(&mut self) -> Option<Effect> {
        match self.questions.pop_front()? {
            (number, Question::Recover { mut offers, lost }) => {
                let offer = offers.pop()?;
                if !offers.is_empty() {
                    self.questions.push_front((number, Question::Recover { offers, lost }));
                }
                Some(Effect::Deed(Deed::Decide(Box::new(offer), Decision::Later)))
            }
            _ => None,
        }
    }

    /// Saves where it was saved before; what was never saved, where the person says.
    pub(super) fn save_command(&mut self) -> Option<Effect> {
        let order = SaveOrder::own(None);
        if self.settings.show_changes && self.has_file() {
            return Some(Effect::Deed(Deed::Plan(Some(order))));
        }
        self.save(order)
    }

    /// Saves what is open as an order says, or asks where.
    fn save(&mut self, order: SaveOrder) -> Option<Effect> {
        if order.to == SaveTo::Own && !self.has_file() {
            return Some(Effect::Deed(Deed::Where { copy: false, then: order.then }));
        }
        Some(Effect::Deed(Deed::Save(order)))
    }

    fn has_file(&self) -> bool {
        self.view.as_ref().is_some_and(|view| view.file.path.is_some())
    }

    /// Asks what is in the way of a save, or says it.
    pub fn not_saved(&mut self, order: SaveOrder, reason: dragonfly_document::NotSaved) -> Option<Effect> {
        use dragonfly_document::NotSaved::{Changed, Exists, Failed, NoFile};
        match reason {
            NoFile => return Some(Effect::Deed(Deed::Where { copy: false, then: order.then })),
            Changed => self.ask(Question::Changed(FileState::Changed, Some(order))),
            Exists(path) => self.ask(Question::Exists(path, order)),
            Failed(reason) => {
                self.status.say(Level::Error, format!("Not saved: {reason}"));
                // Who wanted to leave is asked again what to do with it.
                if let Some(then) = order.then {
                    self.ask(Question::Unsaved(then));
                }
            }
        }
        None
    }
}
