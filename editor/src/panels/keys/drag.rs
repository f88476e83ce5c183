//! A drag of keys: one gesture, one undo step.
//!
//! The next edit is sent as soon as the previous one is shown: at once where the [`Echo`] carries it out, else when the
//! document has answered it. So the keys follow in larger steps if an edit is slow, but they never lag further and
//! further behind the pointer. What is drawn is always the take that an edit resulted in, and the selection follows the
//! keys.

use super::buttonless::{ButtonlessDrag, ButtonlessKind, ButtonlessStep};
use super::op::KeyDragOp;
use super::selection::KeySelection;
use super::{Drawn, EndedDrag, KeyEditing};
use crate::panels::echo::Echo;
use dragonfly_anim::data::Take;
use dragonfly_document::Change;
use dragonfly_document::edit::{KeySet, TakeRef};
use dragonfly_document::history::Gesture;
use std::sync::Arc;

/// A drag of keys, until it is released and answered.
#[derive(Clone, Debug)]
pub struct KeyDrag {
    /// Identifies the drag in the history.
    gesture: Gesture,
    /// The take as it was when the drag began.
    base: Arc<Take>,
    /// The selection as it was when the drag began.
    selected: KeySelection,
    /// The keys that move, as they were when the drag began.
    moving: KeySelection,
    /// The keys that move, as they are in the take that is shown.
    moved: KeySelection,
    /// The newest operation.
    op: KeyDragOp,
    take: TakeRef,
    keys: Vec<KeySet>,
    /// The operation that was sent last; `None` if nothing was, or the last one was cancelled.
    sent: Option<KeyDragOp>,
    /// The operation whose result is in the take that is shown.
    shown: Option<KeyDragOp>,
    answer: Outstanding,
    /// Whether the document refused the operation that was sent last.
    refused: bool,
    released: bool,
}

/// The answer of the document that a drag waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outstanding {
    /// No answer: nothing was ever sent.
    None,
    /// The answer to a change that has no number yet: it is sent at the end of the frame.
    ToUnsent,
    /// The answer to the change with this number.
    To(u64),
}

impl KeyDrag {
    /// Begins a drag with `op` on the keys `moving` of `base`.
    pub(in crate::panels) fn begin(
        gesture: Gesture,
        take: TakeRef,
        base: Arc<Take>,
        moving: KeySelection,
        op: KeyDragOp,
    ) -> Self {
        Self {
            gesture,
            selected: KeySelection::default(),
            keys: moving.key_sets(&base),
            base,
            moved: moving.clone(),
            moving,
            op,
            take,
            sent: None,
            shown: None,
            answer: Outstanding::None,
            refused: false,
            released: false,
        }
    }

    /// Returns whether the drag is in progress, not released yet.
    pub fn held(&self) -> bool {
        !self.released
    }

    /// Returns the time of the first key that moves when the drag began, seconds.
    pub(in crate::panels) fn first_time(&self) -> Option<f32> {
        self.moving.extent(&self.base).map(|[first, _]| first)
    }

    /// Returns the change to send now; none while the previous one is not shown. With `last`, which means that no later
    /// call follows, the change is sent in any case.
    fn send(&mut self, echo: &Echo, last: bool) -> Option<Change> {
        if (!self.is_shown(echo) && !last) || self.sent.as_ref() == Some(&self.op) {
            return None;
        }
        let change = match (self.op.idle(), &self.sent) {
            (true, None) => return None,
            (true, Some(_)) => Change::Cancel(self.gesture),
            (false, _) => {
                let shapes = self.moving.finite_shapes(&self.base);
                Change::Edit(self.op.edit(self.take.clone(), &self.keys, &shapes), Some(self.gesture))
            }
        };
        self.sent = (!self.op.idle()).then(|| self.op.clone());
        (self.answer, self.refused) = (Outstanding::ToUnsent, false);
        Some(change)
    }

    /// Returns whether the change that was sent last is shown or refused.
    fn is_shown(&self, echo: &Echo) -> bool {
        match self.answer {
            Outstanding::None => true,
            Outstanding::ToUnsent => false,
            Outstanding::To(number) => echo.shows(number),
        }
    }

    /// Returns whether the drag is released, and everything that it sent is answered.
    fn is_settled(&self, echo: &Echo) -> bool {
        let answered = match self.answer {
            Outstanding::None => true,
            Outstanding::ToUnsent => false,
            Outstanding::To(number) => echo.has_answered(number),
        };
        self.released && answered
    }

    /// Returns whether anything was sent that a cancel has to undo.
    fn has_sent(&self) -> bool {
        self.answer != Outstanding::None
    }

    /// Notes that `take` is shown. Returns the selection in it if it has the result of another operation than before.
    fn follow(&mut self, take: &Take, echo: &Echo) -> Option<KeySelection> {
        if !self.is_shown(echo) || self.refused || self.shown == self.sent {
            return None;
        }
        self.shown.clone_from(&self.sent);
        self.moved = match &self.shown {
            Some(op) => self.moving.shifted(&self.base, take, op.shift()),
            None => self.moving.clone(),
        };
        Some(match &self.shown {
            None | Some(KeyDragOp::Edit(_)) => self.selected.clone(),
            Some(KeyDragOp::Ripple { from, by }) => self.selected.rippled(take, *from, *by),
            Some(
                KeyDragOp::Move(_)
                | KeyDragOp::Scale { .. }
                | KeyDragOp::Stretch { .. }
                | KeyDragOp::Duplicate(_)
                | KeyDragOp::Snap(_),
            ) => self.moved.clone(),
        })
    }

    /// Returns the number of keys that the drag was to add to the take; `None` if its operation is one for which
    /// replaced keys are not counted.
    fn added(&self) -> Option<usize> {
        match self.shown.as_ref()? {
            KeyDragOp::Duplicate(_) => Some(self.moving.count(&self.base)),
            KeyDragOp::Move(_) | KeyDragOp::Scale { .. } | KeyDragOp::Snap(_) => Some(0),
            KeyDragOp::Ripple { .. } | KeyDragOp::Stretch { .. } | KeyDragOp::Edit(_) => None,
        }
    }
}

impl KeyEditing {
    /// Returns the drag in progress.
    pub fn drag(&self) -> Option<&KeyDrag> {
        self.drag.as_ref()
    }

    /// Returns whether keys are being dragged, and the drag is not released yet.
    pub fn is_dragging(&self) -> bool {
        self.drag.as_ref().is_some_and(KeyDrag::held)
    }

    /// Returns the take whose times the timeline shows: during a drag the one from its start, so that time stays where it is
    /// under the pointer.
    pub(super) fn timed<'a>(&'a self, take: &'a Take) -> &'a Take {
        self.drag.as_ref().map_or(take, |drag| &drag.base)
    }

    /// Starts or continues a drag in the timeline. Returns whether that is allowed: a drag that was released and waits for its
    /// answer ends first.
    pub(in crate::panels) fn may_drag(&mut self) -> bool {
        self.gain_focus();
        self.drag.as_ref().is_none_or(KeyDrag::held)
    }

    /// Returns the drag that follows the pointer without a button.
    pub fn buttonless(&self) -> Option<&ButtonlessDrag> {
        self.buttonless.as_ref()
    }

    /// Begins a drag that follows the pointer without a button, unless there is a drag already.
    pub(in crate::panels) fn begin_buttonless(&mut self, kind: ButtonlessKind) {
        if self.drag.is_none() && self.buttonless.is_none() {
            self.buttonless = Some(ButtonlessDrag::new(kind));
        }
    }

    /// Changes the drag that follows the pointer without a button.
    pub(in crate::panels) fn step_buttonless(&mut self, step: ButtonlessStep) {
        if let Some(drag) = &mut self.buttonless {
            drag.step(step);
        }
    }

    /// Begins a drag.
    pub(in crate::panels) fn begin_drag(&mut self, drag: KeyDrag) {
        self.drag = Some(KeyDrag { selected: self.selection.clone(), ..drag });
    }

    /// Continues the drag with its newest operation. Returns the change to send.
    pub(in crate::panels) fn continue_drag(&mut self, op: KeyDragOp, echo: &Echo) -> Option<Change> {
        let drag = self.drag.as_mut()?;
        drag.op = op;
        drag.send(echo, false)
    }

    /// Notes the number under which a change of the drag was sent.
    pub(in crate::panels) fn sent(&mut self, gesture: Gesture, number: u64) {
        if let Some(drag) = self.drag.as_mut().filter(|drag| drag.gesture == gesture) {
            drag.answer = Outstanding::To(number);
        }
    }

    /// Lets the selection follow the dragged keys: `take` is shown now.
    pub(in crate::panels) fn follow_drag(&mut self, take: Option<&Take>, echo: &Echo) {
        if let Some((drag, take)) = self.drag.as_mut().zip(take)
            && let Some(selection) = drag.follow(take, echo)
        {
            self.selection = selection;
        }
    }

    /// Notes that the document refused what the drag sent last.
    pub(super) fn drag_refused(&mut self) {
        if let Some(drag) = &mut self.drag {
            drag.refused = true;
        }
    }

    /// Releases the drag. Returns the changes to send; `None` if no drag is held.
    pub(in crate::panels) fn release_drag(&mut self, echo: &Echo) -> Option<Vec<Change>> {
        self.buttonless = None;
        let drag = self.drag.as_mut().filter(|drag| drag.held())?;
        let change = drag.send(echo, true);
        drag.released = true;
        let over = drag.has_sent().then_some(Change::Release(drag.gesture));
        Some(change.into_iter().chain(over).collect())
    }

    /// Cancels the drag that is held. Returns the change to send, if anything was sent.
    pub(in crate::panels) fn cancel_drag(&mut self) -> Option<Change> {
        let drag = self.drop_if(KeyDrag::held)?;
        drag.has_sent().then_some(Change::Cancel(drag.gesture))
    }

    /// Drops the drag that is held, as if it had never begun: the document undoes it elsewhere.
    pub(in crate::panels) fn drop_held(&mut self) {
        self.drop_if(KeyDrag::held);
    }

    /// Drops any drag: its edits are refused.
    pub(in crate::panels) fn drop_drag(&mut self) {
        self.drop_if(|_| true);
    }

    /// Drops the drag of this gesture, whose changes are not sent any more.
    pub(in crate::panels) fn forget_drag(&mut self, gesture: Gesture) {
        self.drop_if(|drag| drag.gesture == gesture);
    }

    /// Drops the drag if `is_one` returns true for it, and selects what was selected before it.
    fn drop_if(&mut self, is_one: impl Fn(&KeyDrag) -> bool) -> Option<KeyDrag> {
        self.buttonless.take_if(|_| self.drag.as_ref().is_none_or(&is_one));
        let drag = self.drag.take_if(|drag| is_one(drag))?;
        self.selection = drag.selected.clone();
        Some(drag)
    }

    /// Ends a drag that was released and is done; `take` is shown now.
    pub(in crate::panels) fn settle(&mut self, take: Option<&Take>, echo: &Echo) -> Option<EndedDrag> {
        self.follow_drag(take, echo);
        let drag = self.drag.take_if(|drag| drag.is_settled(echo))?;
        drag.added().map(|added| EndedDrag { before: drag.base.keys(), added })
    }

    /// Returns the keys as they are to be drawn: the dragged ones as selected.
    pub(in crate::panels) fn drawn(&self, take: Option<&Arc<Take>>) -> Option<Drawn> {
        let dragged = self.drag.as_ref().filter(|drag| !matches!(drag.op, KeyDragOp::Edit(_)));
        let selection = dragged.map_or(&self.selection, |drag| &drag.moved);
        Some(Drawn { take: Arc::clone(take?), selection: selection.clone() })
    }
}
