//! How busy other programs keep the machine while something is measured.

use std::fs;
use std::time::{Duration, Instant};

/// Processor time since the machine started, in ticks of the kernel: of all programs together, and of this one with the
/// processes that it measures.
#[derive(Clone)]
pub struct CpuLoad {
    when: Instant,
    all: u64,
    own: u64,
    /// Processes whose time counts as this program's own.
    processes: Vec<u32>,
}

/// Ticks per second, as Linux reports them to programs whatever the kernel's own rate is.
const TICKS: f64 = 100.0;

impl CpuLoad {
    /// Returns the processor time until now; zero where there is no `/proc`.
    pub fn now() -> Self {
        Self::with(&[])
    }

    /// As [`now`](Self::now); the time of the running `processes` counts as this program's own.
    pub fn with(processes: &[u32]) -> Self {
        let number = |word: &str| word.parse::<u64>().unwrap_or(0);
        let stat = fs::read_to_string("/proc/stat").unwrap_or_default();
        // The columns are: user nice system idle iowait irq softirq steal. The others repeat user time.
        let first: Vec<u64> =
            stat.lines().next().unwrap_or("").split_whitespace().skip(1).map(number).collect();
        let all = first.iter().take(8).sum::<u64>() - first.get(3).unwrap_or(&0) - first.get(4).unwrap_or(&0);
        let own = processes.iter().map(|process| ticks(&process.to_string())).sum::<u64>() + ticks("self");
        Self { when: Instant::now(), all, own, processes: processes.to_vec() }
    }

    /// Returns how many cores other programs have kept busy since `self`, on average.
    pub fn background_since(&self) -> f64 {
        let now = Self::with(&self.processes);
        let others = (now.all - self.all).saturating_sub(now.own.saturating_sub(self.own)) as f64;
        others / TICKS / (now.when - self.when).as_secs_f64().max(1e-9)
    }

    /// Returns the processor time of this program since `self`, all its threads together.
    pub fn own_since(&self) -> Duration {
        let now = Self::with(&self.processes);
        Duration::from_secs_f64(now.own.saturating_sub(self.own) as f64 / TICKS)
    }
}

/// Returns the user and system time of a process, in ticks.
fn ticks(process: &str) -> u64 {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // The name in brackets may contain spaces; what follows it does not.
    let rest = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let words: Vec<u64> = rest.split_whitespace().map(|word| word.parse().unwrap_or(0)).collect();
    words.get(11).unwrap_or(&0) + words.get(12).unwrap_or(&0)
}
