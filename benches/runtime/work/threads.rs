//! Threads that are not part of the measured code: producers, and background noise.

use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

/// Starts an OS thread. [`join`] propagates its panic.
pub fn start<T: Send + 'static>(
    name: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> thread::JoinHandle<T> {
    thread::Builder::new().name(name.into()).spawn(work).expect("the system has a thread left")
}

/// Waits for a thread that [`start`] started.
pub fn join<T>(thread: thread::JoinHandle<T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Waits for `flag` without using the CPU. May return up to some milliseconds late.
pub fn wait_for(flag: &AtomicBool) {
    while !flag.load(Ordering::Acquire) {
        thread::park_timeout(Duration::from_micros(50));
    }
}

/// Waits until `when`: asleep first, then spinning, so that the wait ends on time.
pub fn wait_until(when: Instant) {
    const SPIN: Duration = Duration::from_micros(30);
    loop {
        let left = when.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return;
        }
        match left.checked_sub(SPIN) {
            Some(sleep) if sleep > SPIN => thread::park_timeout(sleep),
            _ => std::hint::spin_loop(),
        }
    }
}

/// Makes sleeps of the calling thread end within microseconds of the requested time; by default Linux adds 50 µs.
pub fn sleep_exactly() {
    if let Some(id) = own_id() {
        // If the file cannot be written, sleeps end later, which is measured and printed.
        let _ = std::fs::write(format!("/proc/{id}/timerslack_ns"), "1");
    }
}

/// Returns the system's id of the calling thread; `None` where there is no `/proc`.
pub fn own_id() -> Option<String> {
    Some(std::fs::read_link("/proc/thread-self").ok()?.file_name()?.to_str()?.to_owned())
}

/// One of the cores that this program may use.
#[derive(Clone, Copy)]
pub enum CoreChoice {
    /// The first core.
    First,
    /// The last core.
    Last,
}

/// Returns the list of cores that this program could use before any thread was bound, as Linux prints it; empty on
/// other systems.
fn cores() -> &'static str {
    static CORES: OnceLock<String> = OnceLock::new();
    CORES.get_or_init(|| {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
        list.unwrap_or_default().trim().to_owned()
    })
}

/// Binds the calling thread, and those that it starts afterwards, to a core. Returns whether that succeeded.
pub fn stay(place: CoreChoice) -> bool {
    let mut numbers = cores().split([',', '-']);
    let core = match place {
        CoreChoice::First => numbers.next(),
        CoreChoice::Last => numbers.next_back(),
    };
    bind(core.unwrap_or_default())
}

/// Lets the calling thread run on any core again.
pub fn roam() -> bool {
    bind(cores())
}

/// Calls a program of Linux, because the system call would need unsafe code or a dependency.
fn bind(cores: &str) -> bool {
    let Some(id) = own_id().filter(|_| !cores.is_empty()) else { return false };
    let bind = Command::new("taskset").args(["-p", "-c", cores, &id]).output();
    bind.is_ok_and(|output| output.status.success())
}

/// Keeps one core busy until it is dropped.
pub struct Noise {
    over: Arc<AtomicBool>,
    thread: Option<thread::JoinHandle<()>>,
}

impl Noise {
    /// Starts the thread.
    pub fn start() -> Self {
        let over: Arc<AtomicBool> = Arc::default();
        let end = Arc::clone(&over);
        let thread = start("noise", move || {
            while !end.load(Ordering::Relaxed) {
                std::hint::spin_loop();
            }
        });
        Self { over, thread: Some(thread) }
    }
}

impl Drop for Noise {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        self.thread.take().into_iter().for_each(join);
    }
}
