//! Circumstances that measured numbers depend on: the command, the commit and the machine.

use super::page::FigurePage;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Returns the root of the repository.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns names and values of what the results of `command` depend on.
///
/// The commit is marked if files differ from it, other than those that a recorded run of `page` replaces.
pub fn description(command: &str, page: &FigurePage) -> Vec<(String, String)> {
    let cpu = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let processor = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let processor = processor.map_or("unknown processor", |(_, name)| name);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let kernel = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    let kernel = kernel.split('-').next().unwrap_or_default().trim();
    // Recorded results of earlier runs do not affect the measurement.
    let [folder, file] = page.outputs().map(|path| format!(":!{path}"));
    let changes = output("git", &["status", "--porcelain", "--", ".", &folder, &file]);
    let changed = if changes.is_empty() { "" } else { " with changes" };
    let flags = std::env::var("RUSTFLAGS").unwrap_or_default();
    let flags = if flags.is_empty() { "no further flags".to_owned() } else { flags };
    let (prefix, priority) = match real_time_priority() {
        Some(level) => (format!("chrt -f {level} "), format!("real-time (SCHED_FIFO {level})")),
        None => (String::new(), "normal".to_owned()),
    };
    [
        ("command", format!("{prefix}{command}")),
        ("commit", format!("{}{changed}", output("git", &["rev-parse", "--short=10", "HEAD"]))),
        ("machine", format!("{processor}, {cores} cores")),
        ("system", format!("Linux {kernel}")),
        ("priority", priority),
        ("rust", format!("{}, profile bench (thin LTO), {flags}", output("rustc", &["--version"]))),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into()
}

/// Returns the priority of this thread among those of the scheduling policy `SCHED_FIFO`; `None` under another policy.
fn real_time_priority() -> Option<u32> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name in brackets may contain spaces; what follows it does not.
    let words: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let [priority, policy] = words.get(37..39)? else { return None };
    (*policy == "1").then(|| priority.parse().ok())?
}

/// Returns what a program prints; nothing if it cannot be run.
fn output(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).current_dir(root()).output();
    output.map_or(String::new(), |output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
