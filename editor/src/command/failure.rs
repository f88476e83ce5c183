//! Failures of commands: one line on stderr, and an exit code that scripts can rely on.

use dragonfly_document::LoadError;
use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

/// The reason why a command stops.
#[derive(Debug)]
pub enum Failure {
    /// Exit code 2: a file or an argument is wrong. Contains the file, the position in it and the reason.
    Input(String),
    /// Exit code 1: the check found something, or the comparison a difference. The result is on stdout already.
    Difference,
    /// Exit code 3: a system error. Contains what failed, and what to do about it.
    Machine(String),
    /// Exit code 0: the process that read our output closed the pipe, which is no error.
    OutputClosed,
}

impl Failure {
    /// Returns a failure `place: reason` of wrong input.
    pub fn input(place: impl Display, reason: impl Display) -> Self {
        Self::Input(format!("{place}: {reason}"))
    }

    /// Prints the message to stderr and returns the exit code.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Input(reason) => {
                tell(reason);
                ExitCode::from(2)
            }
            Self::Difference => ExitCode::from(1),
            Self::Machine(reason) => {
                tell(reason);
                ExitCode::from(3)
            }
            Self::OutputClosed => ExitCode::SUCCESS,
        }
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Self::Input(error.to_string())
    }
}

/// Prints a message for the user to stderr. Unlike `eprintln!`, it does not panic if stderr is closed.
pub fn tell(message: impl Display) {
    let _ = writeln!(io::stderr(), "dragonfly: {message}");
}
