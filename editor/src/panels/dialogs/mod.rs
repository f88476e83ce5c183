//! The questions to the user, one per file. A question covers everything else until it is answered.
//!
//! A new question is a file here, with a type that has its data and implements `QuestionKind`, and a line in the list
//! `questions!` below. Its buttons push requests. A caller asks it with [`crate::panels::State::ask`], and
//! `tests/editor/questions.rs` has an example of each.

mod ask;
mod changed;
mod changed_models;
mod copy;
mod exists;
mod find;
mod kind;
mod line_list;
mod missing;
mod outdated;
mod place;
mod plan;
mod recover;
mod rewrite;
mod show;
mod unfit;
mod unsaved;

pub(super) use show::Dialogs;

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
    Rewrite => rewrite::RewriteQuestion,
    Plan => plan::PlanQuestion,
    Recover => recover::RecoverQuestion,
    Find => find::FindQuestion,
    Place => place::PlaceQuestion,
    Unfit => unfit::UnfitQuestion,
    Outdated => outdated::OutdatedQuestion,
    ChangedModels => changed_models::ChangedModelsQuestion,
    Copy => copy::CopyQuestion,
    Missing => missing::MissingQuestion,
}
