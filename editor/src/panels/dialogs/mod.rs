//! The questions to the user, one per file. A question covers everything else until it is answered.
//!
//! A new question is a file here, with a type that has its data and implements `QuestionKind`, and a line in the list
//! `questions!` below. Its buttons push requests. A caller asks it with [`crate::panels::State::ask`], and
//! `tests/editor/questions.rs` has an example of each.

mod ask;
mod changed;
mod exists;
mod find;
mod kind;
mod place;
mod plan;
mod recover;
mod unsaved;

use super::context::PanelContext;
use super::request::Request;
use super::style::GRID;
use super::theme::Theme;
use ask::{Ask, QuestionFields};
use egui::{Frame, Id, Modal, Ui};
use kind::QuestionKind;

/// Declares [`Question`] from a list of `Name => module::Type` lines.
macro_rules! questions {
    ($($Name:ident => $module:ident::$Kind:ident,)*) => {
        $(pub use $module::$Kind;)*

        /// A modal question that the user must answer before working on.
        #[derive(Clone, Debug, PartialEq)]
        // Each variant is documented at its type.
        #[allow(missing_docs)]
        pub enum Question {
            $($Name($Kind),)*
        }

        impl Question {
            /// The names of all kinds of questions.
            pub const KINDS: &[&str] = &[$(stringify!($Name)),*];

            fn kind(&self) -> &dyn QuestionKind {
                match self { $(Self::$Name(question) => question,)* }
            }
        }

        $(impl From<$Kind> for Question {
            fn from(question: $Kind) -> Self {
                Self::$Name(question)
            }
        })*
    };
}

questions! {
    Unsaved => unsaved::UnsavedQuestion,
    Changed => changed::ChangedQuestion,
    Exists => exists::ExistsQuestion,
    Plan => plan::PlanQuestion,
    Recover => recover::RecoverQuestion,
    Find => find::FindQuestion,
    Place => place::PlaceQuestion,
}

/// State of the controls in questions.
#[derive(Debug, Default)]
pub(super) struct Dialogs {
    fields: QuestionFields,
    shown: Option<u64>,
    /// Whether the question was written to the log.
    told: bool,
}

impl Dialogs {
    /// Draws the question that is open.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let number = context.prompts.question_number();
        let fresh = self.shown != number;
        self.shown = number;
        let Some(question) = context.question() else { return };
        if fresh {
            self.told = false;
            // The keyboard focus arrives with the next frame.
            ui.ctx().request_repaint();
            self.fields = QuestionFields { path: question.kind().proposal(context), chosen: 0 };
        }
        if !fresh && !std::mem::replace(&mut self.told, true) {
            tracing::info!(target: "dragonfly::question", "{}", question.kind().name());
        }
        let modal = Modal::new(Id::unique(("question", format!("{:?}", std::mem::discriminant(question)))))
            .backdrop_color(Theme::of(ui).backdrop)
            .frame(Frame::popup(ui.style()).inner_margin(20));
        let response = modal.show(ui.ctx(), |ui| {
            ui.spacing_mut().item_spacing.y = 2.0 * GRID;
            question.kind().show(&mut Ask { ui, context, fresh, requests, fields: &mut self.fields });
        });
        if response.should_close() {
            requests.push(Request::Dismiss);
        }
    }
}
