//! The owner of a journal: a process, and the computer it runs on.

use super::stamp::hash;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A process on a computer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JournalOwner {
    /// Process number on that computer.
    pub process: u32,
    /// Name of the computer.
    pub host: String,
}

/// Whether the process that opened a journal still runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OwnerStatus {
    /// It runs.
    Running,
    /// It has exited, normally or not.
    Exited,
    /// It ran on another computer and did not record that it closed the journal.
    OnOtherHost,
}

impl JournalOwner {
    /// Returns this process.
    pub fn this() -> Self {
        Self { process: std::process::id(), host: system::host() }
    }

    /// Returns the status of this process as far as its number and computer show it, for file systems
    /// without locks.
    pub(super) fn owner_status(&self) -> OwnerStatus {
        if self.host != system::host() {
            return OwnerStatus::OnOtherHost;
        }
        if process_runs(self.process) == Some(false) { OwnerStatus::Exited } else { OwnerStatus::Running }
    }
}

impl fmt::Display for JournalOwner {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "process {} on {}", self.process, self.host)
    }
}

/// Returns whether a process with this number runs on this computer; `None` where the system cannot tell.
pub(super) fn process_runs(process: u32) -> Option<bool> {
    system::process_runs(process)
}

/// Hash of the name of this computer, for file names.
pub(super) fn host_hash() -> u32 {
    (hash(system::host().as_bytes()) >> 32) as u32
}

#[cfg(unix)]
mod system {
    use rustix::process::{Pid, test_kill_process};

    pub(super) fn host() -> String {
        rustix::system::uname().nodename().to_string_lossy().into_owned()
    }

    pub(super) fn process_runs(process: u32) -> Option<bool> {
        let process = i32::try_from(process).ok().filter(|process| *process > 0).and_then(Pid::from_raw)?;
        match test_kill_process(process) {
            Err(rustix::io::Errno::SRCH) => Some(false),
            // The process exists, even if this one may not signal it.
            _ => Some(true),
        }
    }
}

#[cfg(not(unix))]
mod system {
    pub(super) fn host() -> String {
        std::env::var("COMPUTERNAME").unwrap_or_else(|_| "this machine".to_owned())
    }

    pub(super) fn process_runs(_: u32) -> Option<bool> {
        None
    }
}
