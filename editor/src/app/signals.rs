//! Signals by which the system asks the program to end: a session ends, a terminal is closed, Ctrl+C is pressed in one.
//!
//! No question is asked then. There may be no user to answer, and a program that does not end soon is killed. So the program
//! ends in order; unsaved changes are in its journal and are offered at the next start, as after a crash.

use super::event::UserEvent;
use winit::event_loop::EventLoopProxy;

/// Ends the loop of `proxy` on these signals.
pub(super) fn watch(proxy: EventLoopProxy<UserEvent>) {
    on_signals(move |signal| {
        // Fails only when the loop has ended, and then the program ends soon.
        let _ = proxy.send_event(UserEvent::Signal(signal));
    });
}

/// Calls `act` with each of these signals, in a thread of its own; a second one after a moment ends the process at once. Signals that the program was
/// started to ignore stay ignored.
///
/// Does nothing on systems without signals.
pub fn on_signals(act: impl FnMut(i32) + Send + 'static) {
    #[cfg(unix)]
    if let Err(error) = unix::watch(act) {
        tracing::warn!("signals cannot be handled, so one ends the program at once: {error}");
    }
    #[cfg(not(unix))]
    drop(act);
}

/// Ends this process as `signal` ends one that does not handle it, so that the parent process sees why it ended.
/// Returns only where that is not possible.
pub fn end_by(signal: i32) {
    #[cfg(unix)]
    let _ = signal_hook::low_level::emulate_default_handler(signal);
    #[cfg(not(unix))]
    let _ = signal;
}

#[cfg(unix)]
mod unix {
    use dragonfly_runtime::Job;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::time::{Duration, Instant};

    /// Time after the first signal from which another one ends the program at once. Systems may send two signals
    /// together; a user who sends a second one has waited longer than this.
    const PATIENCE: Duration = Duration::from_secs(1);

    pub(super) fn watch(mut act: impl FnMut(i32) + Send + 'static) -> std::io::Result<()> {
        let ignored = ignored(&std::fs::read_to_string("/proc/self/status").unwrap_or_default());
        let heard = [SIGTERM, SIGHUP, SIGINT].into_iter().filter(|signal| !ignored(*signal));
        let mut signals = Signals::new(heard)?;
        let listen = move || {
            let mut first: Option<Instant> = None;
            for signal in signals.forever() {
                tracing::info!(signal, "asked to end");
                if first.get_or_insert_with(Instant::now).elapsed() > PATIENCE {
                    super::end_by(signal);
                }
                act(signal);
            }
        };
        Job::start_detached("signals", listen)
    }

    /// Returns the signals that a process ignores, from its `status` file: a program started with `nohup` outlives the terminal.
    fn ignored(status: &str) -> impl Fn(i32) -> bool + use<> {
        let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
        move |signal| (1..=64).contains(&signal) && mask >> (signal - 1) & 1 == 1
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn the_ignored_signals_are_read_from_the_status_file_of_the_process() {
            let ignored = ignored("Name:\tdragonfly\nSigIgn:\t0000000000001001\nSigCgt:\tffffffffffffffff\n");
            assert!(ignored(SIGHUP) && ignored(13));
            assert!(!ignored(SIGTERM) && !ignored(SIGINT) && !ignored(0) && !ignored(99));
            assert!(!super::ignored("")(SIGHUP));
        }
    }
}
