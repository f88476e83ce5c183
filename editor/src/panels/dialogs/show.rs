//! The question that is open, drawn over everything else.

use super::ask::{Ask, QuestionFields};
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::style::GRID;
use crate::panels::theme::Theme;
use egui::{Frame, Id, Modal, Ui};

/// State of the controls in questions.
#[derive(Debug, Default)]
pub(in crate::panels) struct Dialogs {
    fields: QuestionFields,
    shown: Option<u64>,
    /// Whether the question was written to the log.
    told: bool,
}

impl Dialogs {
    /// Draws the question that is open.
    pub(in crate::panels) fn show(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let number = context.prompts.question_number();
        let fresh = self.shown != number;
        self.shown = number;
        let Some(question) = context.question() else { return };
        if fresh {
            self.told = false;
            // The keyboard focus arrives with the next frame.
            ui.ctx().request_repaint();
            let path = question.kind().proposal(context.view);
            self.fields = QuestionFields { path, ..QuestionFields::default() };
        }
        if !fresh && !std::mem::replace(&mut self.told, true) {
            tracing::info!(target: "dragonfly::question", "{}", question.kind().name());
        }
        let modal = Modal::new(Id::unique(("question", format!("{:?}", std::mem::discriminant(question)))))
            .backdrop_color(Theme::of(ui).backdrop)
            .frame(Frame::popup(ui.style()).inner_margin(20));
        let response = modal.show(ui.ctx(), |ui| {
            ui.spacing_mut().item_spacing.y = 2.0 * GRID;
            question.kind().show(&mut Ask {
                ui,
                view: context.view,
                looked_folder: context.prompts.looked_folder(),
                fresh,
                requests,
                fields: &mut self.fields,
            });
        });
        if response.should_close() {
            requests.push(Request::Dismiss);
        }
    }
}
