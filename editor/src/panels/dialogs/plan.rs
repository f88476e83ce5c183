//! The list of changes that a save would make, before it is written.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use super::line_list::line_list;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use dragonfly_document::{DocumentMessage, SaveOrder};
use std::sync::Arc;

/// Lists the changes that a save will make; confirming saves if there is an order.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanQuestion {
    /// The changes, one line for each.
    pub lines: Arc<[String]>,
    /// The order to save.
    pub order: Option<SaveOrder>,
}

impl QuestionKind for PlanQuestion {
    fn name(&self) -> &'static str {
        "showed what will be saved"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(620.0);
        ask.title("What will be saved");
        let (lines, order) = (&self.lines[..], self.order.as_ref());
        let nothing = lines.is_empty() || lines.iter().any(|line| line == "nothing changes");
        if nothing {
            ask.says("Nothing: the file stays the same, byte for byte.");
        } else {
            // The heading above the list contains the amount.
            let lines = match lines {
                [summary, list @ ..] if !list.is_empty() => {
                    ask.says(format!("{summary}."));
                    list
                }
                lines => lines,
            };
            ask.adds("Everything else is kept byte for byte.".to_owned());
            egui::CollapsingHeader::new("Details")
                .default_open(false)
                .show(ask.ui, |ui| line_list(ui, lines));
        }
        let close = ("Close", "Close without saving", Tone::First, false);
        let cancel = ("Cancel", "Close without saving", Tone::Plain, false);
        let save = ("Save", "Write exactly these changes", Tone::First, true);
        let pressed = if order.is_some() { ask.buttons(&[save, cancel]) } else { ask.buttons(&[close]) };
        match (pressed, order) {
            (Some(true), Some(order)) => {
                ask.requests.push(Request::Answer(FileAction::Send(DocumentMessage::Save(order.clone()))))
            }
            (Some(_), _) => ask.requests.push(Request::Dismiss),
            (None, _) => {}
        }
    }
}
