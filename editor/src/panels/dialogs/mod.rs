//! The questions to the user, one per file. A question covers everything else until it is answered.
//!
//! A new question is a file here, with a type that has its data and implements [`QuestionKind`], and a line in the list
//! `questions!` below. Its buttons push requests. A caller asks it with [`crate::panels::State::ask`], and
//! `tests/editor/questions.rs` has an example of each.

mod changed;
mod exists;
mod find;
mod place;
mod plan;
mod recover;
mod unsaved;

use super::context::PanelContext;
use super::request::Request;
use super::style::{GRID, RADIUS};
use super::theme::Theme;
use egui::{Button, CornerRadius, Id, Modal, Response, RichText, Ui, vec2};

/// A kind of question: its data, and how it is drawn.
trait QuestionKind {
    /// Returns the name of the question for the log.
    fn name(&self) -> &'static str;

    /// Returns the text that its field contains at first.
    fn proposal(&self, state: &PanelContext<'_>) -> String {
        let _ = state;
        String::new()
    }

    /// Draws it.
    fn show(&self, ask: &mut Ask<'_>);
}

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

/// The path that the user typed in a question, and the line that the user chose.
#[derive(Debug, Default)]
struct QuestionFields {
    path: String,
    chosen: usize,
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
    pub(super) fn show(&mut self, ui: &mut Ui, state: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let number = state.prompts.question_number();
        let fresh = self.shown != number;
        self.shown = number;
        let Some(question) = state.question() else { return };
        if fresh {
            self.told = false;
            // The keyboard focus arrives with the next frame.
            ui.ctx().request_repaint();
            self.fields = QuestionFields { path: question.kind().proposal(state), chosen: 0 };
        }
        if !fresh && !std::mem::replace(&mut self.told, true) {
            tracing::info!(target: "dragonfly::question", "{}", question.kind().name());
        }
        let modal = Modal::new(Id::unique(("question", format!("{:?}", std::mem::discriminant(question)))))
            .backdrop_color(Theme::of(ui).backdrop)
            .frame(egui::Frame::popup(ui.style()).inner_margin(20));
        let response = modal.show(ui.ctx(), |ui| {
            ui.spacing_mut().item_spacing.y = 2.0 * GRID;
            question.kind().show(&mut Ask { ui, state, fresh, requests, fields: &mut self.fields });
        });
        if response.should_close() {
            requests.push(Request::Dismiss);
        }
    }
}

/// A question that is being drawn.
struct Ask<'a> {
    ui: &'a mut Ui,
    state: &'a PanelContext<'a>,
    /// Whether this is its first frame, in which the default button gets the focus.
    fresh: bool,
    requests: &'a mut Vec<Request>,
    fields: &'a mut QuestionFields,
}

/// Style of a button.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tone {
    /// The default button, which Enter presses.
    First,
    Plain,
    /// The button of a choice that discards something, or moves it where it is hard to find.
    Loses,
}

impl Ask<'_> {
    fn title(&mut self, text: &str) {
        self.ui.label(RichText::new(text).heading());
    }

    /// Draws a sentence.
    fn says(&mut self, text: impl Into<String>) {
        self.ui.label(text.into());
    }

    /// Draws a secondary sentence.
    fn adds(&mut self, text: impl Into<String>) {
        let weak = Theme::of(self.ui).weak;
        self.ui.label(RichText::new(text).color(weak));
    }

    /// Draws a warning.
    fn warns(&mut self, text: impl Into<String>) {
        let warning = Theme::of(self.ui).warning;
        self.ui.label(RichText::new(text).color(warning));
    }

    /// Draws the row of buttons: those that discard something on the left, the others on the right with the default one
    /// last. Returns the one that was pressed.
    fn buttons<T: Copy>(&mut self, choices: &[(&str, &str, Tone, T)]) -> Option<T> {
        self.ui.add_space(GRID);
        let mut pressed = None;
        let fresh = self.fresh;
        self.ui.horizontal(|ui| {
            for (title, help, tone, choice) in choices.iter().filter(|(_, _, tone, _)| *tone == Tone::Loses) {
                if button(ui, title, *tone, true).on_hover_text(*help).clicked() {
                    pressed = Some(*choice);
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let rest = choices.iter().filter(|(_, _, tone, _)| *tone != Tone::Loses);
                for (title, help, tone, choice) in rest {
                    let response = button(ui, title, *tone, true).on_hover_text(*help);
                    if fresh && *tone == Tone::First {
                        response.request_focus();
                    }
                    if response.clicked() {
                        pressed = Some(*choice);
                    }
                }
            });
        });
        pressed
    }
}

/// Draws a button of a question.
fn button(ui: &mut Ui, title: &str, tone: Tone, able: bool) -> Response {
    let theme = Theme::of(ui);
    let text = match tone {
        Tone::First => RichText::new(title).color(theme.on_accent),
        Tone::Plain => RichText::new(title),
        Tone::Loses => RichText::new(title).color(theme.error),
    };
    let mut button = Button::new(text).min_size(vec2(88.0, 28.0)).corner_radius(CornerRadius::same(RADIUS));
    if tone == Tone::First {
        button = button.fill(theme.accent);
    }
    let response = ui.add_enabled(able, button);
    super::widgets::focus_ring(ui, &response, response.rect.expand(2.0));
    response
}
