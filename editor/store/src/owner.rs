//! Who has a journal: a process, and the machine it runs on.

use super::stamp::hash;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A process on a machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owner {
    /// Its number there.
    pub process: u32,
    /// The machine's name.
    pub host: String,
}

/// Does somebody still work with a journal?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    /// Yes.
    Lives,
    /// No: it ended, in order or not.
    Gone,
    /// It ran on another machine, and did not say that it ended.
    Elsewhere,
}

impl Owner {
    /// This process.
    pub fn this() -> Self {
        Self { process: std::process::id(), host: system::host() }
    }

    /// What can be told of it by its number alone, where files cannot be locked.
    pub(super) fn life(&self) -> Life {
        if self.host != system::host() {
            return Life::Elsewhere;
        }
        if process_lives(self.process) == Some(false) { Life::Gone } else { Life::Lives }
    }
}

impl fmt::Display for Owner {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "process {} on {}", self.process, self.host)
    }
}

/// Is there a process of this number on this machine? `None` where one cannot ask.
pub(super) fn process_lives(process: u32) -> Option<bool> {
    system::process_lives(process)
}

/// A number for this machine's name, for names of files.
pub(super) fn host_hash() -> u32 {
    (hash(system::host().as_bytes()) >> 32) as u32
}

#[cfg(unix)]
mod system {
    use rustix::process::{Pid, test_kill_process};

    pub(super) fn host() -> String {
        rustix::system::uname().nodename().to_string_lossy().into_owned()
    }

    pub(super) fn process_lives(process: u32) -> Option<bool> {
        let process = i32::try_from(process).ok().filter(|process| *process > 0).and_then(Pid::from_raw)?;
        match test_kill_process(process) {
            Err(rustix::io::Errno::SRCH) => Some(false),
            // It exists, even if we may not signal it.
            _ => Some(true),
        }
    }
}

#[cfg(not(unix))]
mod system {
    pub(super) fn host() -> String {
        std::env::var("COMPUTERNAME").unwrap_or_else(|_| "this machine".to_owned())
    }

    pub(super) fn process_lives(_: u32) -> Option<bool> {
        None
    }
}
