//! Properties of the machine, measured before anything else: its clock, its wake-ups, and the background load.

use crate::Distribution;
use std::fs;
use std::thread;
use std::time::{Duration, Instant};

/// The machine, and the cost of its clock and wake-ups.
pub struct Machine {
    /// Name of the processor.
    pub processor: String,
    /// Number of cores that this program may use.
    pub cores: usize,
    /// Release of the kernel.
    pub kernel: String,
    /// Cost of reading the clock, in nanoseconds.
    pub clock_cost: f64,
    /// Smallest observed step of the clock, in nanoseconds.
    pub clock_step: u64,
    /// Round trips between two threads that only wake each other: two wake-ups each.
    pub wake_ups: Distribution,
    /// Lateness of a sleep of one millisecond.
    pub overshoot: Distribution,
}

impl Machine {
    /// Reads and measures all properties, which takes about half a second.
    pub fn measure() -> Self {
        let cpu = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let processor = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
        let kernel = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
        let (clock_cost, clock_step) = clock();
        Self {
            processor: processor.map_or_else(|| "unknown".into(), |(_, name)| name.to_owned()),
            cores: thread::available_parallelism().map_or(1, usize::from),
            kernel: kernel.trim().to_owned(),
            clock_cost,
            clock_step,
            wake_ups: wake_ups(),
            overshoot: overshoot(),
        }
    }
}

fn clock() -> (f64, u64) {
    const READS: u32 = 100_000;
    let begin = Instant::now();
    let mut last = begin;
    let mut step = u64::MAX;
    for _ in 0..READS {
        let now = Instant::now();
        let passed = (now - last).as_nanos() as u64;
        if passed > 0 {
            step = step.min(passed);
        }
        last = now;
    }
    (begin.elapsed().as_nanos() as f64 / f64::from(READS), step)
}

/// Measures round trips of two threads that unpark each other: the lower limit for messages between sleeping threads.
fn wake_ups() -> Distribution {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};
    const TURNS: u32 = 5_000;
    let mut all = Distribution::new();
    let turn = Arc::new(AtomicU32::new(0));
    let (theirs, me) = (Arc::clone(&turn), thread::current());
    let other = thread::Builder::new().name("wake-ups".into()).spawn(move || {
        for round in 0..TURNS {
            while theirs.load(Ordering::SeqCst) != 2 * round + 1 {
                thread::park();
            }
            theirs.store(2 * round + 2, Ordering::SeqCst);
            me.unpark();
        }
    });
    let other = other.expect("the system has a thread left");
    for round in 0..TURNS {
        let begin = Instant::now();
        turn.store(2 * round + 1, Ordering::SeqCst);
        other.thread().unpark();
        while turn.load(Ordering::SeqCst) != 2 * round + 2 {
            thread::park();
        }
        all.record(begin.elapsed());
    }
    other.join().expect("it does nothing that fails");
    all
}

fn overshoot() -> Distribution {
    let mut all = Distribution::new();
    let asked = Duration::from_millis(1);
    for _ in 0..100 {
        let begin = Instant::now();
        thread::park_timeout(asked);
        all.record(begin.elapsed().saturating_sub(asked));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::load::CpuLoad;

    #[test]
    fn work_of_this_program_does_not_count_as_background_load() {
        let load = CpuLoad::now();
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_millis(200) {}
        let own = load.own_since();
        assert!(own >= Duration::from_millis(50), "{own:?} of 200 ms of work were seen");
        assert!(load.background_since() >= 0.0);
    }
}
