//! The questions to the user, one per file. A question covers everything else until it is answered.

mod ask;
mod changed;
mod exists;
mod find;
mod place;
mod plan;
mod recover;
mod unsaved;

use super::context::PanelContext;
use super::prompts::Question;
use super::request::Request;
use super::style::GRID;
use super::theme::Theme;
use ask::Ask;
use egui::{Id, Modal, Ui};

/// State of the controls in questions.
#[derive(Debug, Default)]
pub(super) struct Dialogs {
    path: String,
    chosen: usize,
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
            self.chosen = 0;
            self.path = match question {
                Question::Find { offer, .. } => find::proposal(offer),
                question => place::proposal(context, matches!(question, Question::Where { copy: true, .. })),
            };
        }
        if !fresh && !std::mem::replace(&mut self.told, true) {
            tracing::info!(target: "dragonfly::question", "{}", question.name());
        }
        let modal = Modal::new(Id::unique(("question", format!("{:?}", std::mem::discriminant(question)))))
            .backdrop_color(Theme::of(ui).backdrop)
            .frame(egui::Frame::popup(ui.style()).inner_margin(20));
        let response = modal.show(ui.ctx(), |ui| {
            ui.spacing_mut().item_spacing.y = 2.0 * GRID;
            let mut ask = Ask { ui, context, fresh, requests };
            match question {
                Question::Unsaved(then) => unsaved::show(&mut ask, then),
                Question::Changed(file, order) => changed::show(&mut ask, *file, order.as_ref()),
                Question::Exists(path, order) => exists::show(&mut ask, path, order),
                Question::Plan(lines, order) => plan::show(&mut ask, lines, order.as_ref()),
                Question::Recover { offers, lost } => {
                    recover::show(&mut ask, offers, *lost, &mut self.chosen)
                }
                Question::Find { offer, other } => {
                    find::show(&mut ask, offer, other.as_deref(), &mut self.path)
                }
                Question::Where { copy, then } => place::show(&mut ask, *copy, then.as_ref(), &mut self.path),
            }
        });
        if response.should_close() {
            requests.push(Request::Dismiss);
        }
    }
}
