//! Progress of long operations on stderr; short ones print nothing.

use dragonfly_document::{LoadStage, Progress};
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Duration up to which operations print no progress.
pub(super) const PATIENCE: Duration = Duration::from_millis(300);

/// Progress of one operation.
pub(super) struct Teller {
    title: String,
    began: Instant,
    terminal: bool,
    /// The stage printed last, so that a log file gets one line per stage instead of one per percent.
    said: Option<LoadStage>,
}

impl Teller {
    /// Starts an operation on `title`.
    pub(super) fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), began: Instant::now(), terminal: io::stderr().is_terminal(), said: None }
    }

    /// Prints the progress if the operation already takes long.
    pub(super) fn tell(&mut self, progress: Progress) {
        if self.began.elapsed() < PATIENCE || (!self.terminal && self.said == Some(progress.stage)) {
            return;
        }
        self.said = Some(progress.stage);
        let line = format!(
            "dragonfly: {}: {} {:.0} %",
            self.title,
            progress.stage.title().to_lowercase(),
            progress.done * 100.0
        );
        let mut stderr = io::stderr();
        // Carriage return and "erase to the end of the line": the next text overwrites this one.
        let _ = if self.terminal { write!(stderr, "\r{line}\x1b[K") } else { writeln!(stderr, "{line}") };
    }
}

impl Drop for Teller {
    fn drop(&mut self) {
        if self.terminal && self.said.is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
