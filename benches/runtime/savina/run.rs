//! One run of one benchmark: its start and its end, with detection of panics and hangs.

use std::mem;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Time after which a run counts as stuck.
pub(crate) const DEADLINE: Duration = Duration::from_secs(60);

/// Result of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish {
    /// Time from before the creation of the first actor to the last message that the result needs.
    pub(crate) took: Duration,
    /// Number of messages that the result needs; each benchmark documents which it counts.
    pub(crate) messages: u64,
    /// Number of refused and repeated requests, in benchmarks that have them.
    pub(crate) retries: Option<u64>,
}

/// Shared by the actors of a run. Every actor can end the run, and no panic goes unnoticed.
pub(crate) struct Run {
    begin: Instant,
    verdict: mpsc::Sender<Result<Finish, ActorPanicked>>,
}

/// Sent when an actor panicked; the reason has been printed.
struct ActorPanicked;

impl Run {
    /// Starts the clock.
    pub(crate) fn begin() -> (Self, RunEnd) {
        let (verdict, found) = mpsc::channel();
        (Self { begin: Instant::now(), verdict }, RunEnd(found))
    }

    /// Stops the clock and ends the run.
    pub(crate) fn finish(&self, messages: u64, retries: Option<u64>) {
        let finish = Finish { took: self.begin.elapsed(), messages, retries };
        // Fails only when the run was given up.
        let _ = self.verdict.send(Ok(finish));
    }

    /// Calls an actor. A panic fails the run at once, whatever the actor system does with it.
    ///
    /// Costs nothing without a panic: the failure is sent by a drop that only an unwinding stack reaches.
    pub(crate) fn watch<T>(&self, call: impl FnOnce() -> T) -> T {
        struct Alarm<'a>(&'a Run);
        impl Drop for Alarm<'_> {
            fn drop(&mut self) {
                let _ = self.0.verdict.send(Err(ActorPanicked));
            }
        }
        let alarm = Alarm(self);
        let answer = call();
        mem::forget(alarm);
        answer
    }
}

/// Receives the end of a run.
pub(crate) struct RunEnd(mpsc::Receiver<Result<Finish, ActorPanicked>>);

impl RunEnd {
    /// Waits for the end of the run. Returns the reason if it failed.
    pub(crate) fn wait(&self) -> Result<Finish, String> {
        self.within(DEADLINE)
    }

    /// Returns the end of a run in which no actor has work left. Returns the reason if it failed.
    pub(crate) fn now(&self) -> Result<Finish, String> {
        self.within(Duration::ZERO).map_err(|_| "all actors are idle, and none has ended the run".into())
    }

    /// Returns whether no actor has panicked after the end.
    pub(crate) fn is_clean(&self) -> bool {
        self.0.try_iter().all(|end| end.is_ok())
    }

    fn within(&self, limit: Duration) -> Result<Finish, String> {
        match self.0.recv_timeout(limit) {
            Ok(Ok(finish)) => Ok(finish),
            Ok(Err(ActorPanicked)) => Err("an actor panicked".into()),
            Err(_) => Err(format!("no end within {limit:?}")),
        }
    }
}
