//! The cage: rights that the child gives up before it reads the file, for good.
//!
//! Linux has all of it: limits of the process, Landlock (no file, no network, no signal to others), and a filter that allows
//! only the system calls of reading, writing, memory and ending. Other Unix systems have the limits. What is missing is
//! reported to the parent, which logs it; a crash stays in the child on every system.

#[cfg(unix)]
mod limits;
#[cfg(target_os = "linux")]
mod linux;

use crate::answer::CageReport;

/// Closes the cage of this process. `memory`: bytes that the import may use.
pub(super) fn close(memory: u64) -> CageReport {
    let mut report = CageReport::default();
    // In this order: nothing can be measured once files are forbidden, Landlock opens a file for its rules, which the limits
    // forbid, and the filter forbids to set limits.
    #[cfg(unix)]
    let program = limits::program_bytes();
    #[cfg(target_os = "linux")]
    report.missing.extend(linux::forbid_files_and_network().err());
    #[cfg(unix)]
    report.missing.extend(limits::set(program, memory));
    #[cfg(target_os = "linux")]
    report.missing.extend(linux::forbid_system_calls().err());
    #[cfg(all(unix, not(target_os = "linux")))]
    report.missing.push("files, network and system calls: no sandbox on this system".to_owned());
    #[cfg(not(unix))]
    {
        let _ = memory;
        report.missing.push("memory, files and network: no sandbox on this system".to_owned());
    }
    report
}
