//! Keys that are dragged: one gesture, one undo step, and a picture that does not wait for the document.
//!
//! While it lasts, the timeline draws the take as it was when the drag began, with the dragged keys displaced. An edit is
//! sent only when the one before was answered, so a slow edit makes the picture coarse in time and the hand never slow.

use super::selection::KeySelection;
use super::shift::Shift;
use dragonfly_anim::data::Take;
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, KeySet, SAME_TIME, TakeRef};
use dragonfly_document::history::Gesture;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What a hand does to keys; always as seen from the begin of the drag.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyDragOp {
    /// The selected keys, seconds later.
    Move(f32),
    /// The selected keys about a time.
    Scale {
        /// Seconds.
        about: f32,
        /// Not zero.
        factor: f32,
    },
    /// Copies of the selected keys, seconds later.
    Duplicate(f32),
    /// Every key from a time on, seconds later.
    Ripple {
        /// Seconds.
        from: f32,
        /// Seconds.
        by: f32,
    },
    /// The selected keys to whole frames a second.
    Snap(f32),
    /// Something else, ready to be sent: values, tangents.
    Edit(Edit),
}

impl KeyDragOp {
    /// Where it brings keys.
    pub fn shift(&self) -> Shift {
        match *self {
            Self::Move(by) | Self::Duplicate(by) | Self::Ripple { by, .. } => Shift::Move(by),
            Self::Scale { about, factor } => Shift::Scale { about, factor },
            Self::Snap(rate) => Shift::Snap(rate),
            Self::Edit(_) => Shift::NONE,
        }
    }

    /// Does it leave everything as it is?
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
            Self::Move(by) => Edit::MoveKeys { take, keys: keys(), by },
            Self::Scale { about, factor } => Edit::ScaleKeys { take, keys: keys(), about, factor },
            Self::Duplicate(by) => Edit::DuplicateKeys { take, keys: keys(), by },
            Self::Ripple { from, by } => Edit::Ripple { take, from, by },
            Self::Snap(rate) => Edit::SnapKeys { take, keys: keys(), rate },
            Self::Edit(ref edit) => edit.clone(),
        }
    }
}

/// A drag under way, or one that was let go and waits for its answer.
#[derive(Clone, Debug)]
pub struct KeyDrag {
    /// Names it in the history.
    pub gesture: Gesture,
    /// The take as it was when it began.
    pub base: Arc<Take>,
    /// The keys that move.
    pub moving: KeySelection,
    /// The newest.
    pub op: KeyDragOp,
    take: TakeRef,
    keys: Vec<KeySet>,
    sent: Option<KeyDragOp>,
    /// Was anything ever sent?
    touched: bool,
    sent_at: Instant,
    /// The generation of the view in which everything that was sent is done.
    expects: u64,
    released: bool,
}

/// An answer that takes longer will not come.
const LATE: Duration = Duration::from_secs(2);

impl KeyDrag {
    /// Begins with `op`.
    pub fn begin(
        gesture: Gesture,
        take: TakeRef,
        base: Arc<Take>,
        moving: KeySelection,
        op: KeyDragOp,
        now: Instant,
    ) -> Self {
        let keys = moving.key_sets(&base);
        Self {
            gesture,
            base,
            moving,
            op,
            take,
            keys,
            sent: None,
            touched: false,
            sent_at: now,
            expects: 0,
            released: false,
        }
    }

    /// Is the hand still on it?
    pub fn held(&self) -> bool {
        !self.released
    }

    /// What is to be sent now, if anything is; `last` where no later one will come.
    pub fn send(&mut self, generation: u64, last: bool, now: Instant) -> Option<Change> {
        let waits = generation < self.expects && now.saturating_duration_since(self.sent_at) < LATE;
        if (waits && !last) || self.sent.as_ref() == Some(&self.op) {
            return None;
        }
        let change = match (self.op.idle(), &self.sent) {
            (true, None) => return None,
            (true, Some(_)) => Change::Cancel(self.gesture),
            (false, _) => Change::Edit(self.op.edit(self.take.clone(), &self.keys), Some(self.gesture)),
        };
        self.sent = (!self.op.idle()).then(|| self.op.clone());
        self.touched = true;
        self.sent_at = now;
        self.expects = self.expects.max(generation) + 1;
        Some(change)
    }

    /// The hand is off.
    pub fn release(&mut self) {
        self.released = true;
    }

    /// Was anything sent that a cancel has to take back?
    pub fn has_sent(&self) -> bool {
        self.touched
    }

    /// An edit was refused: nothing is on its way any more.
    pub fn refused(&mut self) {
        self.expects = 0;
        self.sent = None;
    }

    /// Let go, and everything that was sent is done?
    pub fn settled(&self, generation: u64, now: Instant) -> bool {
        let late = now.saturating_duration_since(self.sent_at) >= LATE;
        self.released && (self.sent.is_none() || generation >= self.expects || late)
    }

    /// Keys that it was to add to the take; `None` where it brought none anywhere.
    pub fn brings(&self) -> Option<usize> {
        self.sent.as_ref()?;
        match self.op {
            KeyDragOp::Duplicate(_) => Some(self.moving.count(&self.base)),
            KeyDragOp::Move(_) | KeyDragOp::Scale { .. } | KeyDragOp::Snap(_) => Some(0),
            KeyDragOp::Ripple { .. } | KeyDragOp::Edit(_) => None,
        }
    }

    /// The keys that moved, in the take as it is now.
    pub fn moved(&self, take: &Take) -> KeySelection {
        match self.op {
            KeyDragOp::Ripple { .. } | KeyDragOp::Edit(_) => self.moving.clone(),
            _ if self.sent.is_none() => self.moving.clone(),
            _ => self.moving.shifted(&self.base, take, self.op.shift()),
        }
    }
}
