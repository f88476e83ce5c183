//! Posing by hand: pure functions from a skeleton and its poses to the poses that a drag results in.
//!
//! A drag starts with a [`PoseDragState`], which captures the poses at its start. Each move of the mouse then calls
//! [`poses_of_drag`], which returns the poses of all bones that change. They are always calculated from the start of
//! the drag, so errors do not accumulate. The caller makes them keys or pending poses.

pub mod clipboard;
mod hold;
mod look;
pub mod mirror;
pub mod mirror_take;
mod reach;
mod stick_figure;

pub use hold::{Goal, IkMode, LONGEST_CHAIN, PoseDragState, poses_of_drag, poses_of_pins};
pub use look::{forward_of, look_at};
pub use stick_figure::{StickLine, blended_pose, stick_figure};
