//! The newest text of a file of a scene: what was asked for or sent, before a view of the document has it.

use super::ScriptChange;
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, EditScript, TextRef};
use dragonfly_document::history::Gesture;
use std::sync::Arc;

/// The newest text of one file, as far as it differs from that of the view.
#[derive(Clone, Debug, Default)]
pub(super) struct NewestText {
    /// The newest text that was asked for and not passed on yet.
    proposed: Option<Arc<str>>,
    /// The newest text that was sent and not answered yet.
    sent: Option<SentText>,
    /// The gesture in progress, with the text at its start.
    gesture: Option<(Gesture, Arc<str>)>,
    /// The last changes of that gesture in other texts.
    also: Vec<EditScript>,
}

/// A text that was sent.
#[derive(Clone, Debug)]
struct SentText {
    text: Arc<str>,
    /// Number of the change.
    number: u64,
}

impl NewestText {
    /// Returns the newest text; `view` is that of the view.
    pub(super) fn text<'a>(&'a self, view: &'a Arc<str>) -> &'a Arc<str> {
        let sent = self.sent.as_ref().map(|sent| &sent.text);
        self.proposed.as_ref().or(sent).unwrap_or(view)
    }

    /// Returns whether a change is on its way through the document.
    pub(super) fn is_awaited(&self) -> bool {
        self.proposed.is_some() || self.sent.is_some()
    }

    /// Returns whether a gesture is in progress here.
    pub(super) fn has_gesture(&self, gesture: Option<Gesture>) -> bool {
        gesture.is_some() && self.gesture.as_ref().map(|own| own.0) == gesture
    }

    /// Adapts to a newer view.
    pub(super) fn update(&mut self, answered: u64) {
        self.sent.take_if(|sent| sent.number <= answered);
    }

    /// Returns the change of the document that makes a text the newest one; `None` where it is that already. `file` is the text as edits name it.
    ///
    /// # Errors
    ///
    /// The text was made from another one than the newest.
    pub(super) fn change(
        &mut self,
        view: &Arc<str>,
        file: Option<TextRef>,
        change: &ScriptChange,
    ) -> Result<Option<Change>, &'static str> {
        let known = self.gesture.as_ref().filter(|(gesture, _)| Some(*gesture) == change.gesture);
        let base = known.map_or(self.text(view), |(_, base)| base);
        // A word is typed letter by letter; a drag always begins with the text at its start.
        let is_known = |text: &Arc<str>| Arc::ptr_eq(text, &change.from) || **text == *change.from;
        if !is_known(base) && !is_known(self.text(view)) {
            return Err("The script has changed meanwhile: try again");
        }
        let also: &[EditScript] = known.map_or(&[], |_| &self.also);
        if **self.text(view) == *change.text && *also == *change.also {
            return Ok(None);
        }
        let base = Arc::clone(base);
        let text: Arc<str> = change.text.as_str().into();
        let own = EditScript::between(&base, &text, Some(change.label));
        let own = own.map(|edit| EditScript { text: file, ..edit });
        let mut parts = own.into_iter().chain(change.also.iter().cloned());
        let edit = parts.next().map(|first| EditScript { also: parts.collect(), ..first });
        self.gesture = change.gesture.map(|gesture| (gesture, base));
        self.also = change.also.clone();
        let change = match (edit, change.gesture) {
            (Some(edit), gesture) => Some(Change::Edit(Edit::EditScript(edit), gesture)),
            // A drag is back where it began.
            (None, Some(gesture)) => Some(Change::Cancel(gesture)),
            (None, None) => None,
        };
        self.proposed = change.is_some().then_some(text);
        Ok(change)
    }

    /// Notes the number of a change that was passed on.
    pub(super) fn passed_on(&mut self, number: u64, change: &Change) {
        match change {
            Change::Edit(Edit::EditScript(_), gesture) => match (self.proposed.take(), &mut self.sent) {
                (Some(text), sent) => *sent = Some(SentText { text, number }),
                // Another movement of the same gesture, whose text was noted with the one before.
                (None, Some(sent))
                    if gesture.is_some() && *gesture == self.gesture.as_ref().map(|own| own.0) =>
                {
                    sent.number = number;
                }
                (None, sent) => *sent = None,
            },
            // A gesture that something else cancelled has no text: the next view has it.
            Change::Cancel(_) => self.sent = self.proposed.take().map(|text| SentText { text, number }),
            Change::Undo | Change::Redo | Change::GoTo(_) => self.forget(),
            Change::Edit(..) | Change::Release(_) => {}
        }
    }

    /// Forgets a text whose change was dropped: its gesture is over.
    pub(super) fn dropped(&mut self) {
        self.proposed = None;
    }

    /// Forgets a text that the document refused.
    pub(super) fn refused(&mut self) {
        self.gesture = None;
        self.forget();
    }

    fn forget(&mut self) {
        (self.proposed, self.sent) = (None, None);
    }
}
