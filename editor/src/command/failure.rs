//! How a command ends when it does not end well: one line on stderr and a code that scripts can rely on.

use dragonfly_document::LoadError;
use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

/// Why a command stops.
#[derive(Debug)]
pub enum Failure {
    /// Code 2: a file or an argument is wrong. Says file, place and reason.
    Input(String),
    /// Code 1: the check found something, or the comparison a difference. The result is on stdout already.
    Difference,
    /// Code 3: the machine cannot do it. Says what, and what to do about it.
    Machine(String),
    /// Whoever read our output has gone: nothing is wrong, and nobody is left to tell.
    NobodyListens,
}

impl Failure {
    /// `place: reason`, where the input is wrong.
    pub fn input(place: impl Display, reason: impl Display) -> Self {
        Self::Input(format!("{place}: {reason}"))
    }

    /// Tells it, and gives the code to exit with.
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
            Self::NobodyListens => ExitCode::SUCCESS,
        }
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Self::Input(error.to_string())
    }
}

/// One message for a person, on stderr. Unlike `eprintln!` it does not mind that stderr is closed.
pub fn tell(message: impl Display) {
    let _ = writeln!(io::stderr(), "dragonfly: {message}");
}
