//! Stopping long work from another thread, and hearing how far it is.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that the asker raises and the work looks at between its steps; clones share it.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Asks the work to end soon.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Was the work asked to end?
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What loading is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Bytes from the disk.
    Reading,
    /// Bytes to data.
    Understanding,
    /// Textures to pixels.
    Decoding,
}

impl Stage {
    /// For the status line.
    pub fn title(self) -> &'static str {
        match self {
            Self::Reading => "Reading",
            Self::Understanding => "Understanding",
            Self::Decoding => "Decoding textures",
        }
    }
}

/// How far the work is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// 0..1 of the whole work, never smaller than said before.
    pub done: f32,
}
