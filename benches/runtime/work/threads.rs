//! Threads that are no part of what is measured: producers, and who makes noise.

use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

/// Starts a bare OS thread; what it panics with is passed on by [`join`].
pub fn start<T: Send + 'static>(
    name: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> thread::JoinHandle<T> {
    thread::Builder::new().name(name.into()).spawn(work).expect("the system has a thread left")
}

/// Waits for a thread of [`start`].
pub fn join<T>(thread: thread::JoinHandle<T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Waits without using a processor for `flag`; may notice it up to some milliseconds late.
pub fn wait_for(flag: &AtomicBool) {
    while !flag.load(Ordering::Acquire) {
        thread::park_timeout(Duration::from_micros(50));
    }
}

/// Waits for `when`: asleep as long as there is time, then on the processor, so that the wait ends on time.
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

/// Lets sleeps of the calling thread end within microseconds of the time that was asked for; Linux adds 50 µs otherwise.
pub fn sleep_exactly() {
    if let Some(id) = own_id() {
        // Where it cannot be written, sleeps end later, which is measured and printed.
        let _ = std::fs::write(format!("/proc/{id}/timerslack_ns"), "1");
    }
}

/// The system's number of the calling thread; `None` where there is no `/proc`.
pub fn own_id() -> Option<String> {
    Some(std::fs::read_link("/proc/thread-self").ok()?.file_name()?.to_str()?.to_owned())
}

/// One of the cores that this program may use.
#[derive(Clone, Copy)]
pub enum Place {
    /// The first of them.
    First,
    /// The last of them.
    Last,
}

/// The cores that this program could use before any thread was bound, as Linux lists them; nothing where it does not.
fn cores() -> &'static str {
    static CORES: OnceLock<String> = OnceLock::new();
    CORES.get_or_init(|| {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
        list.unwrap_or_default().trim().to_owned()
    })
}

/// Binds the calling thread, and those it starts from now on, to a core. `false` where that cannot be done.
pub fn stay(place: Place) -> bool {
    let mut numbers = cores().split([',', '-']);
    let core = match place {
        Place::First => numbers.next(),
        Place::Last => numbers.next_back(),
    };
    bind(core.unwrap_or_default())
}

/// Lets the calling thread run anywhere again.
pub fn roam() -> bool {
    bind(cores())
}

/// With the program that Linux has for it: the system call would want code that is not safe, or a dependency.
fn bind(cores: &str) -> bool {
    let Some(id) = own_id().filter(|_| !cores.is_empty()) else { return false };
    let bind = Command::new("taskset").args(["-p", "-c", cores, &id]).output();
    bind.is_ok_and(|output| output.status.success())
}

/// Keeps one core busy for as long as it lives.
pub struct Noise {
    over: Arc<AtomicBool>,
    thread: Option<thread::JoinHandle<()>>,
}

impl Noise {
    /// Starts it.
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
