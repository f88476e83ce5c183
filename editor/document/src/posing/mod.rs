//! Posing by hand: pure functions from a skeleton and its poses to the poses that a hand wants.
//!
//! A drag begins with a [`Hold`], which remembers how everything stood; every move of the hand then asks
//! [`poses_of_drag`] for the poses of all bones that change, always computed from how it stood at the begin, so nothing
//! adds up. What comes out goes through `State::pose_edit` and becomes keys, or pending poses.

pub mod clipboard;
mod hold;
mod look;
pub mod mirror;
mod reach;

pub use hold::{Goal, Hold, IkMode, LONGEST_CHAIN, poses_of_drag, poses_of_pins};
pub use look::{forward_of, look_at};
