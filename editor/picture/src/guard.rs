//! Work that may panic. wgpu does where one does not expect it (a lost device during a wait, a surface that is not
//! configured): whatever touches the device runs in here, and a panic means there that the device is lost. Inputs of the
//! window run in here too, since a mistake in one of them ends neither the others nor the program.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// What `work` gives, or the words it panicked with.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    // What a half-done frame leaves behind is dropped or made anew, so nobody sees it broken.
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let words = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        words
            .or_else(|| panic.downcast_ref::<String>().cloned())
            .unwrap_or_else(|| "a panic without words".to_owned())
    })
}
