//! Progress of a conversion on stderr.

use super::super::tell;
use super::report::FileOutcome;
use std::io::{self, IsTerminal, Write};

/// One line that changes, and a line for each failure.
pub(super) struct ConvertProgress {
    total: usize,
    done: usize,
    is_terminal: bool,
}

impl ConvertProgress {
    pub(super) fn new(total: usize) -> Self {
        Self { total, done: 0, is_terminal: io::stderr().is_terminal() }
    }

    pub(super) fn tell(&mut self, outcome: &FileOutcome) {
        self.done += 1;
        if let Err(reason) = &outcome.result {
            self.clear();
            tell(reason);
        }
        if self.is_terminal && self.total > 1 {
            let _ = write!(io::stderr(), "\rdragonfly: {} of {} files\x1b[K", self.done, self.total);
        }
    }

    fn clear(&self) {
        if self.is_terminal && self.total > 1 {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

impl Drop for ConvertProgress {
    fn drop(&mut self) {
        self.clear();
    }
}
