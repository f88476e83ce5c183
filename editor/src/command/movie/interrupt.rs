//! Signals that ask a command to end, such as Ctrl+C: the movie ends between two frames.

use crate::app::{end_by, on_signals};
use dragonfly_document::Cancel;
use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};

/// The last signal of this process.
pub(super) struct Interrupt(Arc<AtomicI32>);

impl Interrupt {
    /// Raises `cancel` with the first signal.
    pub(super) fn watch(cancel: &Cancel) -> Self {
        let (signal, cancel) = (Arc::new(AtomicI32::new(0)), cancel.clone());
        let seen = Arc::clone(&signal);
        on_signals(move |number| {
            seen.store(number, Ordering::Relaxed);
            cancel.cancel();
        });
        Self(signal)
    }

    /// Ends the process as the signal does where there was one, so that the parent process sees why.
    pub(super) fn end(&self) {
        match self.0.load(Ordering::Relaxed) {
            0 => {}
            signal => end_by(signal),
        }
    }
}
