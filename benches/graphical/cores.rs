//! Restricts this program to fewer cores for a while, with the command `taskset` of Linux.

use std::process::Command;

/// Until it is dropped, the program runs only on the given cores.
pub struct Pinned {
    before: String,
}

/// Makes all threads of this program, and those that they start, run on `cores` only. `None` where that is not
/// possible.
pub fn pin(cores: &str) -> Option<Pinned> {
    let own = std::process::id().to_string();
    let asked = Command::new("taskset").args(["-cp", &own]).output().ok()?;
    let text = String::from_utf8(asked.stdout).ok()?;
    let before = text.trim().rsplit_once(": ")?.1.to_owned();
    set(cores).then_some(Pinned { before })
}

fn set(cores: &str) -> bool {
    let own = std::process::id().to_string();
    let done = Command::new("taskset").args(["-acp", cores, &own]).output();
    done.is_ok_and(|done| done.status.success())
}

impl Drop for Pinned {
    fn drop(&mut self) {
        assert!(set(&self.before), "the program cannot be given its cores back");
    }
}
