//! The list of the changes that do not fit the new version of a file.

use super::ask::{Ask, Tone};
use super::kind::QuestionKind;
use super::line_list::line_list;
use crate::panels::request::Request;
use std::sync::Arc;

/// The file was loaded again, and some of the unsaved changes do not fit it.
#[derive(Clone, Debug, PartialEq)]
pub struct UnfitQuestion {
    /// The changes with the reasons, one line for each.
    pub lines: Arc<[String]>,
}

impl QuestionKind for UnfitQuestion {
    fn name(&self) -> &'static str {
        "showed which changes do not fit"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(620.0);
        ask.title("Some changes do not fit");
        ask.says(match self.lines.len() {
            1 => "The new version of the file is open. One change does not fit it:".to_owned(),
            count => format!("The new version of the file is open. {count} changes do not fit it:"),
        });
        line_list(ask.ui, &self.lines);
        ask.adds("All other changes are applied and can be undone. Your work before loading is in the bin of the autosave folder.");
        let close = ("Close", "Continue with the new version", Tone::First, ());
        if ask.buttons(&[close]).is_some() {
            ask.requests.push(Request::Dismiss);
        }
    }
}
