//! Cancellation and progress of long work on another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that the caller raises and that the work checks between its steps. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Requests the work to stop soon.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether the work was cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A stage of loading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadStage {
    /// Reading the file.
    Reading,
    /// Parsing the bytes.
    Understanding,
    /// Decoding textures.
    Decoding,
}

impl LoadStage {
    /// Returns the text for the status line.
    pub fn title(self) -> &'static str {
        match self {
            Self::Reading => "Reading",
            Self::Understanding => "Understanding",
            Self::Decoding => "Decoding textures",
        }
    }
}

/// The progress of loading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The present stage.
    pub stage: LoadStage,
    /// Fraction of the whole work, 0 to 1; never decreases.
    pub done: f32,
}
