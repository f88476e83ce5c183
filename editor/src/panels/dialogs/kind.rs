//! The interface of a question: a name for the log, the first text of its field, and a function that draws it.

use super::ask::Ask;
use dragonfly_document::View;

/// A kind of question: its data, and how it is drawn.
pub(super) trait QuestionKind {
    /// Returns the name of the question for the log.
    fn name(&self) -> &'static str;

    /// Returns the text that its field contains at first.
    fn proposal(&self, view: Option<&View>) -> String {
        let _ = view;
        String::new()
    }

    /// Draws the question.
    fn show(&self, ask: &mut Ask<'_>);
}
