//! The text that was written in one frame, as steps of the history.

use super::typing::{TypedWord, WrittenText, words};
use crate::panels::scene::ScriptChange;
use dragonfly_anim::stage::splice::TextSplice;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::history::Gesture;
use std::sync::Arc;

/// A change of the text, and the gesture that is over before it.
pub(super) struct TypedStep {
    pub(super) over: Option<Gesture>,
    pub(super) change: ScriptChange,
}

/// Returns the changes that lead from the text `before` to the one `after`, each word as one: letters that come in one frame are the same steps as
/// those that come in several. A new gesture is one that `new` returns.
pub(super) fn typed_steps(
    word: &mut TypedWord,
    [before, after]: [&str; 2],
    written: WrittenText,
    time: f64,
    new: impl Fn() -> Gesture,
) -> Vec<TypedStep> {
    let Some(TextSplice { mut range, text }) = TextSplice::between(before, after) else { return Vec::new() };
    let is_typed = written == WrittenText::Typed && !text.is_empty();
    let parts: Vec<&str> = if is_typed { words(&text).collect() } else { vec![text.as_str()] };
    let mut shown = before.to_owned();
    let step = |part: &str| {
        let splice = TextSplice { range: range.clone(), text: part.to_owned() };
        let (gesture, over) = word.gesture(&splice, written, time, &new);
        let label = match (range.is_empty(), part.is_empty(), written) {
            (_, true, _) => ScriptLabel::DeleteText,
            (false, false, _) => ScriptLabel::ReplaceText,
            (true, false, WrittenText::Pasted) => ScriptLabel::PasteText,
            (true, false, WrittenText::Typed | WrittenText::Suggested) => ScriptLabel::Type,
        };
        let from: Arc<str> = shown.as_str().into();
        shown.replace_range(range.clone(), part);
        let end = range.start + part.len();
        range = end..end;
        let (text, gesture) = (shown.clone(), Some(gesture));
        let change = ScriptChange { from, text, also: Vec::new(), label, gesture, things: Arc::default() };
        TypedStep { over, change }
    };
    parts.into_iter().map(step).collect()
}
