//! Says on stderr how far long work is; silent about work that is done before one would wonder.

use dragonfly_document::{LoadStage, Progress};
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Shorter work is not worth a word.
const PATIENCE: Duration = Duration::from_millis(300);

/// One piece of work.
pub(super) struct Teller {
    title: String,
    began: Instant,
    terminal: bool,
    /// What was said last, so that a log file gets a line a stage and not a line a percent.
    said: Option<LoadStage>,
}

impl Teller {
    /// Work on `title` begins.
    pub(super) fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), began: Instant::now(), terminal: io::stderr().is_terminal(), said: None }
    }

    /// The work is this far.
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
        // Carriage return and "erase to the end of the line": the next word goes over this one.
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
