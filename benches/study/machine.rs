//! What the machine itself costs, measured before anything else: its clock, its wake-ups, and who else is working.

use crate::Distribution;
use std::fs;
use std::thread;
use std::time::{Duration, Instant};

/// What the machine is, and what its clock and wake-ups cost.
pub struct Machine {
    /// The processor's name.
    pub processor: String,
    /// Cores that this program may use.
    pub cores: usize,
    /// The kernel's release.
    pub kernel: String,
    /// What reading the clock costs, in nanoseconds.
    pub clock_cost: f64,
    /// The smallest step of the clock that was seen, in nanoseconds.
    pub clock_step: u64,
    /// There and back between two threads that wake each other with nothing else to do: two wake-ups.
    pub wake_ups: Distribution,
    /// How much later than asked a sleep of one millisecond ends.
    pub overshoot: Distribution,
}

impl Machine {
    /// Looks and measures; takes about half a second.
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

/// Two bare threads that unpark each other: the least that any message between sleeping threads can cost.
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
    fn work_of_this_program_is_not_laid_to_others() {
        let load = CpuLoad::now();
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_millis(200) {}
        let own = load.own_since();
        assert!(own >= Duration::from_millis(50), "{own:?} of 200 ms of work were seen");
        assert!(load.others_since() >= 0.0);
    }
}
