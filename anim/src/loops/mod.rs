//! Loops: how far a take is from repeating without a jump, the best loop in a long take, and closing a loop.
//!
//! | function | result |
//! |---|---|
//! | [`loop_gaps`] | the gap of position, velocity and rotation of each bone |
//! | [`is_one_frame_short`] | whether the last frame is missing |
//! | [`find_loop`] | the range of a long take that repeats best |
//! | [`LoopFinder`] | several such ranges, searched in steps |
//! | [`close_loop`] | a take whose end leads into its start |
//! | [`shift_loop`] | a take that begins elsewhere in its loop |
//!
//! All compare poses in scene space, or relative to the bone that travels, if one is given: a walk across the floor repeats in
//! everything but the place of its hips.

mod close;
mod gap;
mod part;
mod search;
mod shift;

pub use close::{CloseError, CloseSettings, close_loop};
pub use gap::{BoneLoopGap, is_one_frame_short, loop_gaps};
pub use search::{FoundLoop, LoopFinder, LoopSearch, find_loop};
pub use shift::{ShiftError, ShiftSettings, shift_loop};
