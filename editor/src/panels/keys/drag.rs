//! A drag of keys: one gesture, one undo step, drawn without waiting for the document.
//!
//! During the drag the timeline draws the take as it was when the drag began, with the dragged keys displaced. An edit
//! is sent only when the previous one was answered, so a slow edit makes the result coarse in time, and the pointer is
//! never late.

use super::KeyEditing;
use super::selection::KeySelection;
use super::shift::Shift;
use crate::panels::echo::Echo;
use dragonfly_anim::data::Take;
use dragonfly_document::Change;
use dragonfly_document::edit::{
    DuplicateKeys, Edit, KeySet, MoveKeys, RippleKeys, SAME_TIME, ScaleKeys, SnapKeys, TakeRef,
};
use dragonfly_document::history::Gesture;
use std::sync::Arc;

/// The operation of a drag on keys, always relative to the start of the drag.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyDragOp {
    /// Moves the selected keys by this many seconds.
    Move(f32),
    /// Scales the times of the selected keys about a time.
    Scale {
        /// Seconds.
        about: f32,
        /// Factor, not zero.
        factor: f32,
    },
    /// Duplicates the selected keys this many seconds later.
    Duplicate(f32),
    /// Moves every key from a time on.
    Ripple {
        /// Seconds.
        from: f32,
        /// Seconds.
        by: f32,
    },
    /// Moves the selected keys to whole frames at this rate per second.
    Snap(f32),
    /// Applies an edit as it is: values, tangents.
    Edit(Edit),
}

impl KeyDragOp {
    /// Returns where the keys are moved.
    pub fn shift(&self) -> Shift {
        match *self {
            Self::Move(by) | Self::Duplicate(by) | Self::Ripple { by, .. } => Shift::Move(by),
            Self::Scale { about, factor } => Shift::Scale { about, factor },
            Self::Snap(rate) => Shift::Snap(rate),
            Self::Edit(_) => Shift::NONE,
        }
    }

    /// Whether it changes nothing.
    fn idle(&self) -> bool {
        match *self {
            Self::Move(by) | Self::Duplicate(by) | Self::Ripple { by, .. } => {
                !by.is_finite() || by.abs() <= SAME_TIME
            }
            Self::Scale { factor, .. } => factor == 1.0 || factor == 0.0 || !factor.is_finite(),
            Self::Snap(_) | Self::Edit(_) => false,
        }
    }

    fn edit(&self, take: TakeRef, keys: &[KeySet]) -> Edit {
        let keys = || keys.to_vec();
        match *self {
            Self::Move(by) => Edit::MoveKeys(MoveKeys { take, keys: keys(), by }),
            Self::Scale { about, factor } => Edit::ScaleKeys(ScaleKeys { take, keys: keys(), about, factor }),
            Self::Duplicate(by) => Edit::DuplicateKeys(DuplicateKeys { take, keys: keys(), by }),
            Self::Ripple { from, by } => Edit::RippleKeys(RippleKeys { take, from, by }),
            Self::Snap(rate) => Edit::SnapKeys(SnapKeys { take, keys: keys(), rate }),
            Self::Edit(ref edit) => edit.clone(),
        }
    }
}

/// A drag of keys, until it is released and answered.
#[derive(Clone, Debug)]
pub struct KeyDrag {
    /// Identifies the drag in the history.
    pub gesture: Gesture,
    /// The take as it was when the drag began.
    pub base: Arc<Take>,
    /// The keys that move.
    pub moving: KeySelection,
    /// The newest operation.
    pub op: KeyDragOp,
    take: TakeRef,
    keys: Vec<KeySet>,
    /// The operation that was requested last.
    requested: Option<KeyDragOp>,
    answer: Outstanding,
    released: bool,
}

/// The answer of the document that a drag waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outstanding {
    /// Nothing was ever sent.
    None,
    /// To a change that has no number yet: it is sent at the end of the frame.
    ToUnsent,
    /// To the change with this number.
    To(u64),
}

impl KeyDrag {
    /// Begins with `op`.
    pub fn begin(
        gesture: Gesture,
        take: TakeRef,
        base: Arc<Take>,
        moving: KeySelection,
        op: KeyDragOp,
    ) -> Self {
        let keys = moving.key_sets(&base);
        let answer = Outstanding::None;
        Self { gesture, base, moving, op, take, keys, requested: None, answer, released: false }
    }

    /// Returns whether the drag is in progress, not released yet.
    pub fn held(&self) -> bool {
        !self.released
    }

    /// Returns the change to send now. While an answer is outstanding there is none, so a slow edit makes the drag coarse
    /// and never late; `last`, when no later call follows, sends in any case.
    pub fn send(&mut self, echo: &Echo, last: bool) -> Option<Change> {
        if (!self.is_answered(echo) && !last) || self.requested.as_ref() == Some(&self.op) {
            return None;
        }
        let change = match (self.op.idle(), &self.requested) {
            (true, None) => return None,
            (true, Some(_)) => Change::Cancel(self.gesture),
            (false, _) => Change::Edit(self.op.edit(self.take.clone(), &self.keys), Some(self.gesture)),
        };
        self.requested = (!self.op.idle()).then(|| self.op.clone());
        self.answer = Outstanding::ToUnsent;
        Some(change)
    }

    fn is_answered(&self, echo: &Echo) -> bool {
        match self.answer {
            Outstanding::None => true,
            Outstanding::ToUnsent => false,
            Outstanding::To(number) => echo.has_answered(number),
        }
    }

    /// The button is up, and the drag counts.
    pub fn release(&mut self) {
        self.released = true;
    }

    /// Whether anything was sent that a cancel has to undo.
    pub fn has_sent(&self) -> bool {
        self.answer != Outstanding::None
    }

    /// The document refused the last edit.
    pub fn refused(&mut self) {
        self.requested = None;
    }

    /// Whether the drag is released, and everything that it sent is answered.
    pub fn is_settled(&self, echo: &Echo) -> bool {
        self.released && self.is_answered(echo)
    }

    /// Returns how many keys the drag was to add to the take; `None` if it moved none.
    pub fn brings(&self) -> Option<usize> {
        self.requested.as_ref()?;
        match self.op {
            KeyDragOp::Duplicate(_) => Some(self.moving.count(&self.base)),
            KeyDragOp::Move(_) | KeyDragOp::Scale { .. } | KeyDragOp::Snap(_) => Some(0),
            KeyDragOp::Ripple { .. } | KeyDragOp::Edit(_) => None,
        }
    }

    /// Returns the keys that moved, in the take as it is now.
    pub fn moved(&self, take: &Take) -> KeySelection {
        match self.op {
            KeyDragOp::Ripple { .. } | KeyDragOp::Edit(_) => self.moving.clone(),
            _ if self.requested.is_none() => self.moving.clone(),
            _ => self.moving.shifted(&self.base, take, self.op.shift()),
        }
    }
}

impl KeyEditing {
    /// Notes the number under which a change of the drag was sent.
    pub(in crate::panels) fn sent(&mut self, gesture: Gesture, number: u64) {
        if let Some(drag) = self.drag.as_mut().filter(|drag| drag.gesture == gesture) {
            drag.answer = Outstanding::To(number);
        }
    }

    /// Drops the drag of this gesture, whose changes are not sent any more.
    pub(in crate::panels) fn forget_drag(&mut self, gesture: Gesture) {
        self.drag.take_if(|drag| drag.gesture == gesture);
    }

    /// Whether keys are being dragged, and the drag is not released yet.
    pub fn is_dragging(&self) -> bool {
        self.drag.as_ref().is_some_and(KeyDrag::held)
    }
}
