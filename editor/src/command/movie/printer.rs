//! Progress of a movie on stderr: a line that changes, or JSON lines for other programs.

use super::super::choice::plain;
use super::super::progress::PATIENCE;
use super::super::tell;
use crate::movie_render::{MovieNews, MovieProgress};
use serde::Serialize;
use std::io::{self, IsTerminal, Write};
use std::time::Instant;

/// The form of the progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum ProgressChoice {
    /// Text for users
    Text,
    /// A line for each frame, such as {"frame":12,"of":240,"seconds_left":8.5}
    Json,
}

/// A line of JSON.
#[derive(Serialize)]
struct ProgressLine {
    /// Number of frames that are done.
    frame: u64,
    of: u64,
    seconds_left: f64,
}

/// Prints the progress of one movie.
pub(super) struct ProgressPrinter {
    choice: ProgressChoice,
    title: String,
    began: Instant,
    is_terminal: bool,
    has_line: bool,
}

impl ProgressPrinter {
    /// Starts a movie of the file `title`.
    pub(super) fn new(choice: ProgressChoice, title: &str) -> Self {
        let is_terminal = io::stderr().is_terminal();
        Self { choice, title: plain(title), began: Instant::now(), is_terminal, has_line: false }
    }

    /// Prints what happened.
    pub(super) fn tell(&mut self, news: MovieNews<'_>) {
        match news {
            MovieNews::Warning(warning) => {
                self.clear();
                tell(format_args!("{}: warning: {}", self.title, plain(warning)));
            }
            MovieNews::Frame(progress) => match self.choice {
                ProgressChoice::Text => self.text(progress),
                ProgressChoice::Json => json(progress),
            },
        }
    }

    /// Prints text: on a terminal after each frame, and otherwise after each tenth of them.
    fn text(&mut self, progress: MovieProgress) {
        let MovieProgress { done, of, seconds_left, .. } = progress;
        let is_tenth = done * 10 / of.max(1) != done.saturating_sub(1) * 10 / of.max(1);
        if self.began.elapsed() < PATIENCE || !(self.is_terminal || is_tenth) {
            return;
        }
        let line =
            format!("dragonfly: {}: frame {done} of {of}, {} left", self.title, duration(seconds_left));
        let mut stderr = io::stderr();
        // Carriage return and "erase to the end of the line": the next text overwrites this one.
        let _ = if self.is_terminal { write!(stderr, "\r{line}\x1b[K") } else { writeln!(stderr, "{line}") };
        self.has_line = self.is_terminal;
    }

    /// Removes the line that changes.
    fn clear(&mut self) {
        if std::mem::take(&mut self.has_line) {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

impl Drop for ProgressPrinter {
    fn drop(&mut self) {
        self.clear();
    }
}

fn json(progress: MovieProgress) {
    let seconds_left = (progress.seconds_left * 10.0).round() / 10.0;
    let line = ProgressLine { frame: progress.done, of: progress.of, seconds_left };
    // A number that is not finite becomes null.
    let text = serde_json::to_string(&line).unwrap_or_default();
    let _ = writeln!(io::stderr(), "{text}");
}

/// Returns a duration in words, such as `1 h 05 min`.
fn duration(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        _ => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_two_units_at_most() {
        let found = [0.4, 59.6, 61.0, 3599.0, 3661.0].map(duration);
        assert_eq!(found, ["0 s", "1 min 00 s", "1 min 01 s", "59 min 59 s", "1 h 01 min"]);
        assert_eq!(duration(f64::NAN), "0 s");
    }
}
