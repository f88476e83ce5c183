//! The process of a test: running a test alone in one, and reading its memory and threads.

use std::process::Command;
use std::time::Duration;

const ALONE: &str = "DRAGONFLY_ALONE";

/// Runs `body` in a process of its own, in which no other test runs.
///
/// `test` is the full name of the test in its binary. The output of the child process is printed.
///
/// # Panics
/// When the child process fails.
pub fn alone(test: &str, body: impl FnOnce()) {
    if std::env::var_os(ALONE).is_some_and(|name| name == test) {
        return body();
    }
    let program = std::env::current_exe().expect("a running test has a file");
    let output = Command::new(program)
        .args([test, "--exact", "--nocapture", "--test-threads=1"])
        .env(ALONE, test)
        .output()
        .expect("the test's own file can be started");
    let output_text = String::from_utf8_lossy(&output.stdout);
    let error_text = String::from_utf8_lossy(&output.stderr);
    print!("{output_text}");
    eprint!("{error_text}");
    assert!(output_text.contains("1 passed"), "{test} alone: {}\n{output_text}\n{error_text}", output.status);
}

/// Returns the resident memory of this process in bytes (on Linux; 0 elsewhere).
///
/// Also 0 when `DRAGONFLY_SANITIZER` is set, because the sanitizer's own memory grows.
pub fn resident_bytes() -> usize {
    if std::env::var_os("DRAGONFLY_SANITIZER").is_some() {
        return 0;
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<usize>().ok());
    kibibytes.unwrap_or(0) * 1024
}

/// Returns the most resident memory that process `id` had so far, in bytes (on Linux; 0 elsewhere, and for a process that
/// has ended).
pub fn peak_bytes(id: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kibibytes.unwrap_or(0) * 1024
}

/// Returns the processor time that the calling thread has used, to a few milliseconds (on Linux; zero elsewhere). Unlike the
/// time on a clock, it does not depend on what else the machine does.
pub fn thread_time() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split_whitespace().next().and_then(|number| number.parse().ok());
    Duration::from_nanos(nanoseconds.unwrap_or(0))
}

/// An OS thread of this process.
#[derive(Clone, Debug)]
pub struct OsThread {
    /// Name of the thread, of which the system keeps 15 bytes.
    pub name: String,
    /// State: `S` while it sleeps, `R` while it runs.
    pub state: char,
    /// Number of voluntary context switches: how often it blocked.
    pub waits: u64,
}

/// Returns the OS threads of this process (on Linux; none elsewhere), without those that end during the call.
pub fn os_threads() -> Vec<OsThread> {
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    tasks.filter_map(|task| read_thread(&task.path())).collect()
}

fn read_thread(task: &std::path::Path) -> Option<OsThread> {
    let status = std::fs::read_to_string(task.join("status")).ok()?;
    let field = |name| {
        let line = status.lines().find_map(|line| line.strip_prefix(name));
        line.map(str::trim)
    };
    Some(OsThread {
        name: field("Name:")?.to_owned(),
        state: field("State:")?.chars().next()?,
        waits: field("voluntary_ctxt_switches:")?.parse().ok()?,
    })
}

/// Returns whether this process, and so every process that it starts, ignores `signal`. For example, a program that a
/// script starts in the background ignores Ctrl+C.
#[cfg(unix)]
pub fn ignores(signal: rustix::process::Signal) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or_default();
    let ignores = mask >> (signal.as_raw() - 1) & 1 == 1;
    if ignores {
        crate::skip::skip(
            crate::skip::TestNeed::Signal,
            format!("the caller of the tests ignores {signal:?}"),
        );
    }
    ignores
}
