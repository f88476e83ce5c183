//! A test's own process: running a test alone in one, and looking at its memory and threads.

use std::process::Command;

const ALONE: &str = "DRAGONFLY_ALONE";

/// Runs `body` in a process of its own, where no other test runs beside it.
///
/// `test` is the test's full name in its binary. What the child prints is printed here.
///
/// # Panics
/// When the child fails.
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
    let said = String::from_utf8_lossy(&output.stdout);
    let complained = String::from_utf8_lossy(&output.stderr);
    print!("{said}");
    eprint!("{complained}");
    assert!(said.contains("1 passed"), "{test} alone: {}\n{said}\n{complained}", output.status);
}

/// Memory of this process that is in use now, in bytes (Linux; elsewhere 0).
///
/// 0 as well when `DRAGONFLY_SANITIZER` is set: there it is the sanitizer's memory that grows.
pub fn resident_bytes() -> usize {
    if std::env::var_os("DRAGONFLY_SANITIZER").is_some() {
        return 0;
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<usize>().ok());
    kibibytes.unwrap_or(0) * 1024
}

/// An OS thread of this process.
#[derive(Clone, Debug)]
pub struct OsThread {
    /// Its name, of which the system keeps 15 bytes.
    pub name: String,
    /// `S` while it sleeps, `R` while it runs.
    pub state: char,
    /// How often it gave up the processor of its own accord, to wait for something.
    pub waits: u64,
}

/// The OS threads of this process (Linux; elsewhere none). One that ends meanwhile is left out.
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

/// Returns whether this process ignores `signal`, and with it every process that it starts. What a script starts in the
/// background ignores Ctrl+C.
#[cfg(unix)]
pub fn ignores(signal: rustix::process::Signal) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or_default();
    let ignores = mask >> (signal.as_raw() - 1) & 1 == 1;
    if ignores {
        println!("skipped: {signal:?}, which whoever started this ignores");
    }
    ignores
}
