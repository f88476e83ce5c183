//! The operation of a drag on keys.

use super::shift::Shift;
use dragonfly_document::edit::{
    DuplicateKeys, Edit, KeySet, MoveKeys, RippleKeys, SAME_TIME, ScaleKeys, SnapKeys, StretchTime, TakeRef,
};

/// The operation of a drag on keys, always relative to the start of the drag.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyDragOp {
    /// Moves the selected keys by this many seconds.
    Move(f32),
    /// Scales the times of the selected keys about a time.
    Scale {
        /// Time that stays where it is, seconds.
        about: f32,
        /// Factor, not zero.
        factor: f32,
    },
    /// Duplicates the selected keys this many seconds later.
    Duplicate(f32),
    /// Moves every key from a time on.
    Ripple {
        /// Time from which on keys move, seconds.
        from: f32,
        /// Distance, seconds.
        by: f32,
    },
    /// Scales the part of the take between two times, and moves everything after it.
    Stretch {
        /// Start and end of the part, seconds.
        part: [f32; 2],
        /// Factor, more than 0.
        factor: f32,
    },
    /// Moves the selected keys to whole frames at this rate per second.
    Snap(f32),
    /// Applies an edit as it is: values, tangents.
    Edit(Edit),
}

impl KeyDragOp {
    /// Returns where the keys are moved to.
    pub fn shift(&self) -> Shift {
        match *self {
            Self::Move(by) | Self::Duplicate(by) | Self::Ripple { by, .. } => Shift::Move(by),
            Self::Scale { about, factor } => Shift::Scale { about, factor },
            Self::Stretch { part: [about, _], factor } => Shift::Scale { about, factor },
            Self::Snap(rate) => Shift::Snap(rate),
            Self::Edit(_) => Shift::NONE,
        }
    }

    /// Returns whether it changes nothing.
    pub(super) fn idle(&self) -> bool {
        match *self {
            Self::Move(by) | Self::Duplicate(by) | Self::Ripple { by, .. } => {
                !by.is_finite() || by.abs() <= SAME_TIME
            }
            Self::Scale { factor, .. } | Self::Stretch { factor, .. } => {
                factor == 1.0 || factor == 0.0 || !factor.is_finite()
            }
            Self::Snap(_) | Self::Edit(_) => false,
        }
    }

    /// Returns the edit that applies it to `keys` of `take`, and to its keys of shape keys in the stretches of time `shapes`.
    pub(super) fn edit(&self, take: TakeRef, keys: &[KeySet], shapes: &[[f32; 2]]) -> Edit {
        let (keys, shapes) = (|| keys.to_vec(), || shapes.to_vec());
        match *self {
            Self::Move(by) => Edit::MoveKeys(MoveKeys { take, keys: keys(), shapes: shapes(), by }),
            Self::Scale { about, factor } => {
                Edit::ScaleKeys(ScaleKeys { take, keys: keys(), shapes: shapes(), about, factor })
            }
            Self::Duplicate(by) => {
                Edit::DuplicateKeys(DuplicateKeys { take, keys: keys(), shapes: shapes(), by })
            }
            Self::Ripple { from, by } => Edit::RippleKeys(RippleKeys { take, from, by }),
            Self::Stretch { part: [from, to], factor } => {
                Edit::StretchTime(StretchTime { take, from, to, factor })
            }
            Self::Snap(rate) => Edit::SnapKeys(SnapKeys { take, keys: keys(), shapes: shapes(), rate }),
            Self::Edit(ref edit) => edit.clone(),
        }
    }
}
