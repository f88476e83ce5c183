//! Guarding work that may panic. wgpu panics in unexpected places (a lost device during a wait, a surface that is not
//! configured): everything that touches the device runs guarded, and a panic there means that the device is lost.
//! Inputs of the window are guarded too, so that a bug in handling one of them ends neither the others nor the
//! program.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `work` and returns its result, or the message of its panic.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    // A half-done frame is dropped or drawn again, so no one observes inconsistent state.
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| dragonfly_runtime::panic_text(&*panic).to_owned())
}
